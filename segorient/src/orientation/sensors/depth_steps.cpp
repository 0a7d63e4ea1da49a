// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/sensors/depth_steps.h"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "common/dot.h"
#include "common/median.h"
#include "common/parallel_for.h"
#include "search/index_of.h"

namespace segorient::detail {
namespace {

// In direction: in a thinned cloud what is near has fewer points to an angle than what is far, at a
// fifth of its distance one of 25.
constexpr int kAround = 256;
// A surface that is seen at less rises by many spacings, and ends nowhere for sure.
constexpr float kLeastIncidence = 0.15F;
// Spacings that a step takes at least, and the part of a cloud's depth that it does: steps of depth
// cameras, and their noise.
constexpr float kStepSpacings = 4.F;
constexpr float kStepDepth = 0.03F;
// Spacings of what is nearer: what is farther away from all of it is not beside it.
constexpr float kReach = 3.F;
// Spacings from the place, within which the points of a surface lie in all directions.
constexpr float kNearest = 5.F;

}  // namespace

DepthSteps::DepthSteps(const FlatPoints& flat, const std::array<float, 3>& place, int threads)
    : flat_(flat), seen_(seeFrom(place, flat.view(), threads)), directions_(seen_.index(threads)) {}

// Directions all around, by the golden angle.
float DepthSteps::openShare() const {
  constexpr int kDirections = 1000;
  constexpr float kGolden = 2.39996323F;
  // Where it is on a surface itself, there is something all around. A stray point is none.
  int near = 0;
  for (std::size_t i = 0; i < flat_.size(); ++i) {
    near += seen_.distance[i] < kNearest * flat_.spacing(i) ? 1 : 0;
  }
  if (near > FlatPoints::kPlane) return 0.F;
  int open = 0;
  for (int k = 0; k < kDirections; ++k) {
    const float z = 1.F - (2.F * static_cast<float>(k) + 1.F) / static_cast<float>(kDirections);
    const float r = std::sqrt(1.F - z * z);
    const float turn = kGolden * static_cast<float>(k);
    const std::array<float, 4> ray{r * std::cos(turn), r * std::sin(turn), z, 0.F};
    const search::Nearest nearest(directions_, ray.data());
    if (nearest.point < 0) return 1.F;
    const auto q = static_cast<std::size_t>(nearest.point);
    const float reach = kReach * flat_.spacing(q) / seen_.distance[q];
    open += nearest.square > reach * reach ? 1 : 0;
  }
  return static_cast<float>(open) / static_cast<float>(kDirections);
}

DepthSteps::Step DepthSteps::at(std::size_t i) const {
  constexpr std::size_t kTwo = 2;  // a single point that floats before the others hides nothing
  const float* u = &seen_.direction[4 * i];
  const float d = seen_.distance[i];
  const float incidence = std::fabs(dot(flat_.normal(i), u));
  // A place in the plane of a face sees nothing of it, only holes in it.
  if (incidence < kLeastIncidence) return Step::NONE;
  const float steps = kStepDepth * std::min(d, seen_.depth);
  const float margin = std::max(kStepSpacings * flat_.spacing(i) / incidence, steps);
  std::array<pcl::index_t, kAround> around;
  std::array<float, kAround> squares;
  const int found = directions_.nearestK(u, kAround, around.data(), squares.data());
  std::vector<std::size_t> before;
  std::vector<std::size_t> nearer;  // of these, those on surfaces
  float widest = 0.F;
  for (int j = 0; j < found; ++j) {
    const auto at = static_cast<std::size_t>(j);
    const auto q = static_cast<std::size_t>(around[at]);
    if (!(flat_.spacing(q) > 0.F) || seen_.distance[q] >= d - margin) continue;
    if (seen_.distance[q] < kNearest * flat_.spacing(q)) continue;
    const float reach = kReach * flat_.spacing(q) / seen_.distance[q];
    if (!(squares[at] < reach * reach)) continue;
    before.push_back(q);
    if (!flat_.isOnSurface(q)) continue;
    nearer.push_back(q);
    widest = squares[at];
  }
  if (nearer.size() < kTwo) return Step::NONE;
  // A surface that rises steeply has points at all depths.
  std::vector<float> depth;
  for (int j = 0; j < found && squares[static_cast<std::size_t>(j)] <= widest; ++j) {
    const float at = seen_.distance[static_cast<std::size_t>(around[static_cast<std::size_t>(j)])];
    if (at <= d) depth.push_back(at);
  }
  std::sort(depth.begin(), depth.end());
  float gap = 0.F;
  for (std::size_t k = 1; k < depth.size(); ++k) gap = std::max(gap, depth[k] - depth[k - 1]);
  std::vector<float> widths;
  for (const std::size_t q : nearer) widths.push_back(flat_.spacing(q));
  const float width = std::max(median(widths), flat_.spacing(i));
  if (!(gap > std::max(kStepSpacings * width, steps))) return Step::NONE;
  if (isWithin(i, nearer)) return Step::COVERED;
  return isWithin(i, before) ? Step::HIDDEN : Step::BESIDE;
}

std::vector<DepthSteps::Step> DepthSteps::of(const EveryNth& some, int threads) const {
  constexpr double kStepTime = 50000.0;  // ns, see resolveThreads()
  std::vector<Step> out(some.size(), Step::NONE);
  parallelFor(some.size(), threads, kStepTime,
              [&](std::size_t s) { out[s] = at(flat_.onSurfaces()[some[s]]); });
  return out;
}

// Whether a point's direction is among those of others, rather than beside them all.
bool DepthSteps::isWithin(std::size_t i, const std::vector<std::size_t>& others) const {
  constexpr float kPi = 3.14159265F;
  constexpr float kHalf = 0.9F * kPi;  // less than that: at the rim, errors decide
  if (others.size() < 3) return false;
  const float* u = &seen_.direction[4 * i];
  std::size_t least = 0;
  for (std::size_t a = 1; a < 3; ++a) {
    if (std::fabs(u[a]) < std::fabs(u[least])) least = a;
  }
  Eigen::Vector3f axis = Eigen::Vector3f::Zero();
  axis[static_cast<Eigen::Index>(least)] = 1.F;
  const Eigen::Vector3f ray(u[0], u[1], u[2]);
  const Eigen::Vector3f x = ray.cross(axis).normalized();
  const Eigen::Vector3f y = ray.cross(x);
  std::vector<float> angles;
  for (const std::size_t q : others) {
    const float* v = &seen_.direction[4 * q];
    const Eigen::Vector3f off(v[0] - u[0], v[1] - u[1], v[2] - u[2]);
    angles.push_back(std::atan2(off.dot(y), off.dot(x)));
  }
  std::sort(angles.begin(), angles.end());
  float widest = angles.front() + 2.F * kPi - angles.back();
  for (std::size_t k = 1; k < angles.size(); ++k) {
    widest = std::max(widest, angles[k] - angles[k - 1]);
  }
  return widest < kHalf;
}

}  // namespace segorient::detail
