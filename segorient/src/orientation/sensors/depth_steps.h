// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/search/median_hash_index.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "orientation/sensors/flat_points.h"
#include "orientation/sensors/seen_from.h"

namespace segorient::detail {

/// Where depth steps, as seen from a place.
class DepthSteps {
 public:
  /// What there is beside or before a point on a surface, or behind it.
  enum class Step : std::uint8_t {
    NONE,    ///< nothing that is away from it by a step
    BESIDE,  ///< something on one side: a shadow may end there
    HIDDEN,  ///< points all around, not all of them on surfaces
    COVERED  ///< surfaces all around: one of both cannot be seen from there
  };
  enum class Side : std::uint8_t { BEFORE, BEHIND };

  /// \param flat must outlive this
  DepthSteps(const FlatPoints& flat, const std::array<float, 3>& place, int threads);

  /// Of all directions, those in which there is nothing; 0 for a place on a surface.
  float openShare() const;
  /// \param points some of FlatPoints::onSurfaces()
  std::vector<Step> of(const std::vector<std::size_t>& points, Side side, int threads) const;

 private:
  struct Across;
  struct Around {
    const pcl::index_t* rows;
    const float* squares;  // of chords, ascending
    std::size_t size;
  };
  Step at(std::size_t i, Side side) const;
  Across lookAcross(std::size_t i, Side side, float margin, const Around& around) const;
  float gapOf(std::size_t i, Side side, float widest, const Around& around) const;
  bool isWithin(std::size_t i, const std::vector<std::size_t>& others) const;

  const FlatPoints& flat_;
  SeenFrom seen_;
  search::MedianHashIndex directions_;
};

}  // namespace segorient::detail
