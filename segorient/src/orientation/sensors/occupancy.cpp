// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/sensors/occupancy.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace segorient::detail {
namespace {

// Cubes hold a surface without holes, and are not so many that filling them takes long.
constexpr double kOfReach = 1.5;
constexpr double kMostAcross = 90.0;
// What is hidden all the same has some points: cubes are coarse, and edges half visible.
constexpr float kHidden = 0.1F;
// One cube alone may be a stray point, or the surface itself.
constexpr int kHits = 2;

}  // namespace

Occupancy::Occupancy(const PointView& points, const DensityPatches& patches, const Extent& extent) {
  const double diagonal = extent.diagonal();
  side_ = static_cast<float>(
      std::max(kOfReach * static_cast<double>(patches.reach), diagonal / kMostAcross));
  std::size_t cubes = 1;
  for (std::size_t a = 0; a < 3; ++a) {
    // The extent leaves out what is rare; that hides nothing that matters if it is far out.
    const double margin = 0.1 * diagonal;
    low_[a] = static_cast<float>(extent.low[a] - margin);
    count_[a] = 1 + static_cast<int>((extent.high[a] - extent.low[a] + 2.0 * margin) /
                                     static_cast<double>(side_));
    cubes *= static_cast<std::size_t>(count_[a] + 2);
  }
  filled_.assign(cubes, 0);
  for (std::size_t i = 0; i < points.size; ++i) {
    std::size_t cell = 0;
    bool inside = true;
    for (std::size_t a = 0; a < 3; ++a) {
      const float at = (points[i][a] - low_[a]) / side_;
      inside = inside && at >= 0.F && at < static_cast<float>(count_[a]);
      if (!inside) break;
      cell = cell * static_cast<std::size_t>(count_[a] + 2) + static_cast<std::size_t>(at) + 1;
    }
    if (inside) filled_[cell] = 1;
  }
}

bool Occupancy::clear(const float* from, const float* to, float distance, float start) const {
  std::array<float, 3> at{};
  std::array<float, 3> step{};
  const float scale = 1.F / side_;
  for (std::size_t a = 0; a < 3; ++a) {
    const float along = (to[a] - from[a]) / distance;
    at[a] = (from[a] + start * along - low_[a]) * scale;
    step[a] = along;
  }
  auto steps =
      static_cast<float>(static_cast<int>(std::min((distance - start) * scale - 0.5F, 1000.F)));
  // As far as the grid's end: whoever has left it does not come back. By rounding, the last step
  // may be just beyond, in the empty layer, which is why cubes are counted from 1.
  for (std::size_t a = 0; a < 3; ++a) {
    const auto last = static_cast<float>(count_[a]);
    if (!(at[a] >= 0.F && at[a] < last)) return true;
    if (step[a] != 0.F) steps = std::min(steps, ((step[a] > 0.F ? last : 0.F) - at[a]) / step[a]);
    at[a] += 1.F;
  }
  const auto row = static_cast<std::uint32_t>(count_[2] + 2);
  const std::uint32_t layer = row * static_cast<std::uint32_t>(count_[1] + 2);
  const std::uint8_t* const filled = filled_.data();
  int hits = 0;
  for (float s = 0.F; s < steps; s += 1.F) {
    hits += filled[static_cast<std::uint32_t>(at[0]) * layer +
                   static_cast<std::uint32_t>(at[1]) * row + static_cast<std::uint32_t>(at[2])];
    if (hits == kHits) return false;
    for (std::size_t a = 0; a < 3; ++a) at[a] += step[a];
  }
  return true;
}

void Occupancy::visibility(const DensityPatches& patches, const std::array<double, 3>& place,
                           float* out) const {
  const float to[3] = {static_cast<float>(place[0]), static_cast<float>(place[1]),
                       static_cast<float>(place[2])};
  const float* const at[3] = {patches.x.data(), patches.y.data(), patches.z.data()};
  const float* const normal[3] = {patches.nx.data(), patches.ny.data(), patches.nz.data()};
  for (std::size_t i = 0, n = patches.size(); i < n; ++i) {
    const float from[3] = {at[0][i], at[1][i], at[2][i]};
    const float v[3] = {to[0] - from[0], to[1] - from[1], to[2] - from[2]};
    const float d = std::sqrt(std::max(v[0] * v[0] + v[1] * v[1] + v[2] * v[2], 1e-12F));
    const float cosine =
        std::fabs(v[0] * normal[0][i] + v[1] * normal[1][i] + v[2] * normal[2][i]) / d;
    // Far enough to be out of the surface's own cubes.
    const float start = side_ * std::min(std::max(1.5F / std::max(cosine, 0.03F), 2.5F), 12.F);
    out[i] = start >= d || clear(from, to, d, start) ? 1.F : kHidden;
  }
}

}  // namespace segorient::detail
