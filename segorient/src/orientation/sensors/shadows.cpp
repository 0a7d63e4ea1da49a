// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/sensors/shadows.h"

#include <segorient/common/neighborhoods.h>
#include <segorient/search/median_hash_index.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

#include "common/dot.h"
#include "common/every_nth.h"
#include "common/median.h"
#include "common/parallel_for.h"
#include "features/sheet_fit.h"
#include "orientation/sensors/scan_checks.h"
#include "orientation/sensors/seen_from.h"
#include "search/index_of.h"

namespace segorient::detail {
namespace {

// Steps are some spacings wide: more than once or twice as many make them no easier to tell.
constexpr std::size_t kMostPoints = 40000;
// Enough for shares of a hundredth.
constexpr std::size_t kSamples = 1500;
// The least that a plane shows a surface by.
constexpr int kPlane = 12;
// In direction: in a thinned cloud what is near has fewer points to an angle than what is far, at a
// fifth of its distance one of 25.
constexpr int kAround = 256;
// ns a point, see resolveThreads().
constexpr double kPlaneTime = 500.0;
constexpr double kRayTime = 50000.0;

// Of points on surfaces, and how many of them at least: bodies seen whole from within have up to
// .04, where a limb begins.
constexpr float kFewSteps = 0.05F;
constexpr float kFewest = 15.F;
// Of these, with nearer ones all around. True places of 12 virtual and 15 real scans, as they were
// and thinned in seven ways, leave .00 to .17, among trees up to .40 and in noise of depth .46. In
// and around 30 closed bodies it is .46 and more (of one with clumps of outliers .415), nearly
// always above .5; in the middle of several stations .24 and more.
constexpr float kMostCovered = 0.2F;
constexpr float kAllowed = 0.41F;
constexpr float kDenied = 0.5F;
// The same with points before them that noise has taken off all surfaces: true places .38 to .68 of
// the steps of thinned depth images, bodies in noise .9 and more.
constexpr float kMostHidden = 0.8F;
// Of directions: scanners that turn about an axis leave more, bodies around a place none.
constexpr float kOpen = 0.1F;
constexpr float kFewOpen = 0.005F;
constexpr float kMostOpen = 0.5F;
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

using Place = std::array<float, 3>;

class ShadowSearch {
 public:
  ShadowSearch(const PointView& points, int threads) : threads_(threads) {
    const EveryNth some(points.size, kMostPoints);
    xyz_.assign(4 * some.size(), 0.F);
    for (std::size_t i = 0; i < some.size(); ++i) std::copy_n(points[some[i]], 3, &xyz_[4 * i]);
    findSurfaces();
  }

  // \param least_open share of directions without which steps are not looked for
  Shadows run(const Place& place, float least_open) {
    Shadows out = lookFrom(place, least_open);
    if (!out.confirm()) return out;
    const Place middle = middleOf();
    if (!isOutside(place, middle)) return out;
    Place across;
    for (std::size_t a = 0; a < 3; ++a) across[a] = 2.F * middle[a] - place[a];
    const Shadows other = lookFrom(across, least_open);
    out.better_across = other.confirm() && other.coveredOfSteps() <= out.coveredOfSteps();
    return out;
  }

 private:
  std::size_t size() const { return spacing_.size(); }
  PointView view() const { return {xyz_.data(), 4, xyz_.size() / 4}; }

  Place middleOf() const {
    std::array<double, 3> sum{0.0, 0.0, 0.0};
    for (std::size_t i = 0; i < size(); ++i) {
      for (std::size_t a = 0; a < 3; ++a) sum[a] += static_cast<double>(xyz_[4 * i + a]);
    }
    Place out;
    for (std::size_t a = 0; a < 3; ++a) {
      out[a] = static_cast<float>(sum[a] / static_cast<double>(size()));
    }
    return out;
  }

  // Of the least ball around the middle that holds the points.
  bool isOutside(const Place& place, const Place& middle) const {
    const SeenFrom seen = seeFrom(middle, view(), threads_);
    const SeenFrom it = seeFrom(middle, {place.data(), 3, 1}, 1);
    return it.distance[0] > *std::max_element(seen.distance.begin(), seen.distance.end());
  }

  Shadows lookFrom(const Place& place, float least_open) {
    seen_ = seeFrom(place, view(), threads_);
    directions_ = seen_.index(threads_);
    Shadows out;
    out.open = openShare();
    if (!(out.open >= least_open)) return out;
    const EveryNth some(on_surfaces_.size(), kSamples);
    const std::size_t n = some.size();
    std::vector<Step> found(n, Step::NONE);
    parallelFor(n, threads_, kRayTime,
                [&](std::size_t s) { found[s] = lookAt(on_surfaces_[some[s]]); });
    const auto share = [&](Step what) {
      return static_cast<float>(std::count(found.begin(), found.end(), what));
    };
    const auto surface = static_cast<float>(n);
    const float hidden = share(Step::COVERED) + share(Step::HIDDEN);
    const float steps = hidden + share(Step::BESIDE);
    if (steps >= kFewest) {
      out.covered = share(Step::COVERED) / surface;
      out.hidden = hidden / surface;
      out.steps = steps / surface;
    }
    return out;
  }

  // Directions all around, by the golden angle.
  float openShare() const {
    constexpr int kDirections = 1000;
    constexpr float kGolden = 2.39996323F;
    // Where it is on a surface itself, there is something all around. A stray point is none.
    int near = 0;
    for (std::size_t i = 0; i < size(); ++i) {
      near += seen_.distance[i] < kNearest * width_[i] ? 1 : 0;
    }
    if (near > kPlane) return 0.F;
    int open = 0;
    for (int k = 0; k < kDirections; ++k) {
      const float z = 1.F - (2.F * static_cast<float>(k) + 1.F) / static_cast<float>(kDirections);
      const float r = std::sqrt(1.F - z * z);
      const float turn = kGolden * static_cast<float>(k);
      const std::array<float, 4> ray{r * std::cos(turn), r * std::sin(turn), z, 0.F};
      pcl::index_t nearest = 0;
      float square = 0.F;
      if (directions_.nearestK(ray.data(), 1, &nearest, &square) < 1) return 1.F;
      const auto q = static_cast<std::size_t>(nearest);
      const float reach = kReach * width_[q] / seen_.distance[q];
      open += square > reach * reach ? 1 : 0;
    }
    return static_cast<float>(open) / static_cast<float>(kDirections);
  }

  enum class Step : std::uint8_t { NONE, BESIDE, HIDDEN, COVERED };

  // Spacing of the points that a plane explains as well as that of a surface; 0 of others: noise
  // that is as deep as the points are apart hides points from each other, too.
  void findSurfaces() {
    constexpr float kFlat = 0.1F;
    constexpr float kWide = 0.03F;
    Neighborhoods near;
    search::indexOf(view(), threads_).nearestKAll(kPlane + 1, near, false);
    const std::size_t n = view().size;
    normal_.assign(4 * n, 0.F);
    spacing_.assign(n, 0.F);
    width_.assign(n, 0.F);
    parallelFor(n, threads_, kPlaneTime, [&](std::size_t i) {
      const pcl::index_t* row = near.indices(i);
      const int count = near.count(i);
      const float h = meanDistance(view(), i, row + 1, std::min(count - 1, kFirstRing));
      width_[i] = h;
      if (!(h > 0.F)) return;
      const Plane plane = planeOf(view(), i, row, count);
      const Eigen::Vector3f& l = plane.lambda;
      if (!plane.valid || !(l[0] < kFlat * l[1]) || !(l[1] > kWide * l[2])) return;
      spacing_[i] = h;
      for (std::size_t a = 0; a < 3; ++a) {
        normal_[4 * i + a] = plane.normal[static_cast<Eigen::Index>(a)];
      }
    });
    for (std::size_t i = 0; i < n; ++i) {
      if (spacing_[i] > 0.F) on_surfaces_.push_back(i);
    }
  }

  Step lookAt(std::size_t i) const {
    constexpr std::size_t kTwo = 2;  // a single point that floats before the others hides nothing
    const float* u = &seen_.direction[4 * i];
    const float d = seen_.distance[i];
    const float incidence = std::fabs(dot(&normal_[4 * i], u));
    // A place in the plane of a face sees nothing of it, only holes in it.
    if (incidence < kLeastIncidence) return Step::NONE;
    const float steps = kStepDepth * std::min(d, seen_.depth);
    const float margin = std::max(kStepSpacings * width_[i] / incidence, steps);
    std::array<pcl::index_t, kAround> around;
    std::array<float, kAround> squares;
    const int found = directions_.nearestK(u, kAround, around.data(), squares.data());
    std::vector<std::size_t> before;
    std::vector<std::size_t> nearer;  // of these, those on surfaces
    float widest = 0.F;
    for (int j = 0; j < found; ++j) {
      const auto at = static_cast<std::size_t>(j);
      const auto q = static_cast<std::size_t>(around[at]);
      if (!(width_[q] > 0.F) || seen_.distance[q] >= d - margin) continue;
      if (seen_.distance[q] < kNearest * width_[q]) continue;
      const float reach = kReach * width_[q] / seen_.distance[q];
      if (!(squares[at] < reach * reach)) continue;
      before.push_back(q);
      if (!(spacing_[q] > 0.F)) continue;
      nearer.push_back(q);
      widest = squares[at];
    }
    if (nearer.size() < kTwo) return Step::NONE;
    // A surface that rises steeply has points at all depths.
    std::vector<float> depth;
    for (int j = 0; j < found && squares[static_cast<std::size_t>(j)] <= widest; ++j) {
      const float at =
          seen_.distance[static_cast<std::size_t>(around[static_cast<std::size_t>(j)])];
      if (at <= d) depth.push_back(at);
    }
    std::sort(depth.begin(), depth.end());
    float gap = 0.F;
    for (std::size_t k = 1; k < depth.size(); ++k) gap = std::max(gap, depth[k] - depth[k - 1]);
    std::vector<float> widths;
    for (const std::size_t q : nearer) widths.push_back(spacing_[q]);
    const float width = std::max(median(widths), width_[i]);
    if (!(gap > std::max(kStepSpacings * width, steps))) return Step::NONE;
    if (isWithin(i, nearer)) return Step::COVERED;
    return isWithin(i, before) ? Step::HIDDEN : Step::BESIDE;
  }

  // Whether a point's direction is among those of others, rather than beside them all.
  bool isWithin(std::size_t i, const std::vector<std::size_t>& others) const {
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

  int threads_;
  std::vector<float> xyz_;      ///< 4 floats
  std::vector<float> normal_;   ///< 4 floats
  std::vector<float> width_;    ///< spacing
  std::vector<float> spacing_;  ///< the same, 0 off all surfaces
  std::vector<std::size_t> on_surfaces_;
  SeenFrom seen_;
  search::MedianHashIndex directions_;
};

}  // namespace

bool Shadows::confirm() const {
  return steps > kFewSteps && covered < kMostCovered * steps && hidden < kMostHidden * steps &&
         !better_across;
}

bool Shadows::reveal() const {
  return open > kOpen && confirm();
}

bool Shadows::inARoom() const {
  return open > kFewOpen && open < kMostOpen;
}

bool Shadows::deny() const {
  return steps > kFewSteps && covered > kDenied * steps;
}

bool Shadows::allow() const {
  return steps > kFewSteps && covered < kAllowed * steps && hidden < kMostHidden * steps;
}

bool Shadows::excuse() const {
  return open > kOpen && steps > 0.F && covered < kAllowed * steps && hidden < kMostHidden * steps;
}

Shadows findShadows(const PointView& points, const std::array<float, 3>& place, int threads,
                    bool to_reveal) {
  if (points.size == 0) return {};
  return ShadowSearch(points, threads).run(place, to_reveal ? kOpen : 0.F);
}

}  // namespace segorient::detail
