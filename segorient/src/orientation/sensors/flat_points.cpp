// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/sensors/flat_points.h"

#include <segorient/common/neighborhoods.h>

#include <algorithm>

#include "common/every_nth.h"
#include "common/parallel_for.h"
#include "features/sheet_fit.h"
#include "orientation/sensors/scan_checks.h"
#include "search/index_of.h"

namespace segorient::detail {
namespace {

// Steps of depth are some spacings wide: of denser points none is easier to tell.
constexpr std::size_t kMostPoints = 40000;
// ns a point, see resolveThreads().
constexpr double kPlaneTime = 500.0;

}  // namespace

bool FlatPoints::isFlat(const Plane& plane) {
  // Of variances: noise of a third of a spacing is a tenth of what 12 points spread, and lines are
  // six times as far apart as the points on them.
  constexpr float kFlat = 0.1F;
  constexpr float kWide = 0.03F;
  const Eigen::Vector3f& l = plane.lambda;
  return l[0] < kFlat * l[1] && l[1] > kWide * l[2];
}

FlatPoints::FlatPoints(const PointView& points, int threads) {
  const EveryNth some(points.size, kMostPoints);
  const std::size_t n = some.size();
  xyz_.assign(4 * n, 0.F);
  for (std::size_t i = 0; i < n; ++i) std::copy_n(points[some[i]], 3, &xyz_[4 * i]);
  normal_.assign(4 * n, 0.F);
  width_.assign(n, 0.F);
  index_ = search::indexOf(view(), threads);
  Neighborhoods near;
  index_.nearestKAll(kPlane + 1, near, false);
  parallelFor(n, threads, kPlaneTime, [&](std::size_t i) {
    const pcl::index_t* row = near.indices(i);
    const int count = near.count(i);
    const float h = meanDistance(view(), i, row + 1, std::min(count - 1, kFirstRing));
    width_[i] = h;
    if (!(h > 0.F)) return;
    const Plane plane = planeOf(view(), i, row, count);
    if (!plane.valid || !isFlat(plane)) return;
    for (std::size_t a = 0; a < 3; ++a) {
      normal_[4 * i + a] = plane.normal[static_cast<Eigen::Index>(a)];
    }
  });
  for (std::size_t i = 0; i < n; ++i) {
    if (isOnSurface(i)) on_surfaces_.push_back(i);
  }
}

std::vector<std::size_t> FlatPoints::someOnSurfaces(std::size_t count) const {
  std::vector<std::size_t> out;
  for (const std::size_t k : EveryNth(on_surfaces_.size(), count)) out.push_back(on_surfaces_[k]);
  return out;
}

std::array<float, 3> FlatPoints::middle() const {
  std::array<double, 3> sum{0.0, 0.0, 0.0};
  for (std::size_t i = 0; i < size(); ++i) {
    for (std::size_t a = 0; a < 3; ++a) sum[a] += static_cast<double>(xyz_[4 * i + a]);
  }
  std::array<float, 3> out{};
  for (std::size_t a = 0; a < 3; ++a) {
    out[a] = static_cast<float>(sum[a] / static_cast<double>(size()));
  }
  return out;
}

}  // namespace segorient::detail
