// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "orientation/sensors/flat_points.h"
#include "orientation/sensors/shadows.h"
#include "search/prepared_cloud.h"

namespace segorient::detail {

/// A place in the cloud's unit, and what shadows say of it.
struct RevealedPlace {
  std::array<float, 3> place;
  Shadows shadows;
  bool whole_image = false;  ///< all four sides of an image meet in it
};

/// What steps of depth tell of a cloud, looked for once and only if somebody asks.
class CameraViews {
 public:
  /// \param cloud must outlive this
  CameraViews(const PreparedCloud& cloud, int threads)
      : flat_(cloud.points(), threads), threads_(threads) {}

  const FlatPoints& flat() { return flat_.get(); }
  FlatPointsOnce& flatOnce() { return flat_; }
  /// Where the sides of an image meet: all four, and shadows allow or excuse a sensor; or three,
  /// and they reveal one. Whole ones first, then those that hide least.
  const std::vector<RevealedPlace>& cameras();

 private:
  FlatPointsOnce flat_;
  int threads_;
  std::optional<std::vector<RevealedPlace>> cameras_;
};

}  // namespace segorient::detail
