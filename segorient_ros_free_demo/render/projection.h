// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <array>

#include "render/rasterizer.h"

namespace segorient::program {

/// World to picture: right, down and towards the viewer, in pixels.
class Projection {
 public:
  /// Parallel, so that all that the scene shows lies in the picture.
  Projection(const View& view, const Scene& scene);

  float scale() const { return static_cast<float>(scale_); }  ///< pixels a unit
  std::array<float, 3> direction(const std::array<float, 3>& d) const;
  std::array<float, 3> point(const std::array<float, 3>& p) const;

 private:
  // In double, as sums of the largest floats overflow.
  std::array<double, 3> turned(const std::array<float, 3>& p) const;
  void fit(const View& view, const Scene& scene);

  std::array<std::array<float, 3>, 3> axes_;
  double scale_ = 1.0;
  std::array<double, 2> shift_{0.0, 0.0};
};

/// A splat in the picture.
struct FlatSplat {
  std::array<float, 3> center;
  std::array<float, 3> normal;  ///< towards the viewer, too, where the splat has none
  float radius = 0.F;           ///< pixels
};

}  // namespace segorient::program
