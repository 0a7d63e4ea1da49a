// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/search/median_hash_index.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/every_nth.h"
#include "orientation/sensors/flat_points.h"
#include "orientation/sensors/seen_from.h"

namespace segorient::detail {

/// Where depth steps, as seen from a place.
class DepthSteps {
 public:
  /// What is before a point on a surface, and beside it.
  enum class Step : std::uint8_t {
    NONE,    ///< nothing that is nearer by a step
    BESIDE,  ///< something on one side: the point may be where its shadow ends
    HIDDEN,  ///< points all around, not all of them on surfaces
    COVERED  ///< surfaces all around: it could not be seen from there
  };

  /// \param flat must outlive this
  DepthSteps(const FlatPoints& flat, const std::array<float, 3>& place, int threads);

  /// Of all directions, those in which there is nothing; 0 for a place on a surface.
  float openShare() const;
  /// \param i one of FlatPoints::onSurfaces()
  Step at(std::size_t i) const;
  /// Of some of them.
  std::vector<Step> of(const EveryNth& some, int threads) const;

 private:
  bool isWithin(std::size_t i, const std::vector<std::size_t>& others) const;

  const FlatPoints& flat_;
  SeenFrom seen_;
  search::MedianHashIndex directions_;
};

}  // namespace segorient::detail
