// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/sensors/depth_steps.h"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "common/directions.h"
#include "common/dot.h"
#include "common/median.h"
#include "common/parallel_for.h"
#include "search/index_of.h"

namespace segorient::detail {
namespace {

// In direction: in a thinned cloud what is near has fewer points to an angle than what is far, at a
// fifth of its distance one of 25.
constexpr int kAround = 256;
// Spacings of what is nearer: what is farther away from all of it is not beside it.
constexpr float kReach = 3.F;
// Spacings from the place, within which the points of a surface lie in all directions.
constexpr float kNearest = 5.F;

}  // namespace

DepthSteps::DepthSteps(const FlatPoints& flat, const std::array<float, 3>& place, int threads)
    : flat_(flat), seen_(seeFrom(place, flat.view(), threads)), directions_(seen_.index(threads)) {}

float DepthSteps::openShare() const {
  constexpr std::size_t kDirections = 1000;  // shares of a two-hundredth are five of them
  // Where it is on a surface itself, there is something all around. A stray point is none.
  int near = 0;
  for (std::size_t i = 0; i < flat_.size(); ++i) {
    near += seen_.distance[i] < kNearest * flat_.spacing(i) ? 1 : 0;
  }
  if (near > FlatPoints::kPlane) return 0.F;
  int open = 0;
  for (std::size_t k = 0; k < kDirections; ++k) {
    const std::array<double, 3> u = evenDirection(k, kDirections);
    const std::array<float, 4> ray{static_cast<float>(u[0]), static_cast<float>(u[1]),
                                   static_cast<float>(u[2]), 0.F};
    const search::Nearest nearest(directions_, ray.data());
    if (nearest.point < 0) return 1.F;
    const auto q = static_cast<std::size_t>(nearest.point);
    const float reach = kReach * flat_.spacing(q) / seen_.distance[q];
    open += nearest.square > reach * reach ? 1 : 0;
  }
  return static_cast<float>(open) / static_cast<float>(kDirections);
}

// What is nearer or farther by a step: at least `margin`.
struct DepthSteps::Across {
  std::vector<std::size_t> all;
  std::vector<std::size_t> on_surfaces;
  float widest = 0.F;  ///< square of the chord to the last of them
};

DepthSteps::Step DepthSteps::at(std::size_t i, Side side) const {
  const float* u = &seen_.direction[4 * i];
  const float incidence = std::fabs(dot(flat_.normal(i), u));
  // A place in the plane of a face sees nothing of it, only holes in it.
  if (incidence < kLeastIncidence) return Step::NONE;
  const float margin = depthStep(flat_.spacing(i), incidence, seen_.distance[i], seen_.depth);
  std::array<pcl::index_t, kAround> rows;
  std::array<float, kAround> squares;
  const int found = directions_.nearestK(u, kAround, rows.data(), squares.data());
  const Around around{rows.data(), squares.data(), static_cast<std::size_t>(std::max(found, 0))};
  const Across across = lookAcross(i, side, margin, around);
  if (across.on_surfaces.size() < kNoStray) return Step::NONE;
  std::vector<float> widths;
  for (const std::size_t q : across.on_surfaces) widths.push_back(flat_.spacing(q));
  const float width = std::max(median(widths), flat_.spacing(i));
  const float gap = gapOf(i, side, across.widest, around);
  if (!(gap > depthStep(width, 1.F, seen_.distance[i], seen_.depth))) return Step::NONE;
  if (isWithin(i, across.on_surfaces)) return Step::COVERED;
  return isWithin(i, across.all) ? Step::HIDDEN : Step::BESIDE;
}

DepthSteps::Across DepthSteps::lookAcross(std::size_t i, Side side, float margin,
                                          const Around& around) const {
  const float d = seen_.distance[i];
  Across out;
  for (std::size_t j = 0; j < around.size; ++j) {
    const auto q = static_cast<std::size_t>(around.rows[j]);
    const float step = side == Side::BEFORE ? d - seen_.distance[q] : seen_.distance[q] - d;
    if (!(flat_.spacing(q) > 0.F) || !(step > margin)) continue;
    const std::size_t nearer = side == Side::BEFORE ? q : i;
    if (seen_.distance[nearer] < kNearest * flat_.spacing(nearer)) continue;
    const float reach = kReach * flat_.spacing(nearer) / seen_.distance[nearer];
    if (!(around.squares[j] < reach * reach)) continue;
    out.all.push_back(q);
    if (!flat_.isOnSurface(q)) continue;
    out.on_surfaces.push_back(q);
    out.widest = around.squares[j];
  }
  return out;
}

// The largest in depth: a surface that rises steeply has points at all depths.
float DepthSteps::gapOf(std::size_t i, Side side, float widest, const Around& around) const {
  const float d = seen_.distance[i];
  std::vector<float> depth;
  for (std::size_t j = 0; j < around.size && around.squares[j] <= widest; ++j) {
    const float at = seen_.distance[static_cast<std::size_t>(around.rows[j])];
    if (side == Side::BEFORE ? at <= d : at >= d) depth.push_back(at);
  }
  std::sort(depth.begin(), depth.end());
  float gap = 0.F;
  for (std::size_t k = 1; k < depth.size(); ++k) gap = std::max(gap, depth[k] - depth[k - 1]);
  return gap;
}

std::vector<DepthSteps::Step> DepthSteps::of(const std::vector<std::size_t>& points, Side side,
                                             int threads) const {
  constexpr double kStepTime = 50000.0;  // ns, see resolveThreads()
  std::vector<Step> out(points.size(), Step::NONE);
  parallelFor(points.size(), threads, kStepTime,
              [&](std::size_t s) { out[s] = at(points[s], side); });
  return out;
}

// Whether a point's direction is among those of others, rather than beside them all.
bool DepthSteps::isWithin(std::size_t i, const std::vector<std::size_t>& others) const {
  constexpr float kCircle = 2.F * static_cast<float>(kPi);  // radians
  constexpr float kHalf = 0.45F * kCircle;  // less than half: at the rim, errors decide
  if (others.size() < 3) return false;
  const float* u = &seen_.direction[4 * i];
  const Eigen::Vector3f ray(u[0], u[1], u[2]);
  const Eigen::Vector3f x = ray.unitOrthogonal();
  const Eigen::Vector3f y = ray.cross(x);
  std::vector<float> angles;
  for (const std::size_t q : others) {
    const float* v = &seen_.direction[4 * q];
    const Eigen::Vector3f off(v[0] - u[0], v[1] - u[1], v[2] - u[2]);
    angles.push_back(std::atan2(off.dot(y), off.dot(x)));
  }
  std::sort(angles.begin(), angles.end());
  float widest = angles.front() + kCircle - angles.back();
  for (std::size_t k = 1; k < angles.size(); ++k) {
    widest = std::max(widest, angles[k] - angles[k - 1]);
  }
  return widest < kHalf;
}

}  // namespace segorient::detail
