// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/sensors/scan_checks.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "common/dot.h"
#include "common/in_double.h"
#include "common/parallel_for.h"
#include "features/sheet_fit.h"
#include "orientation/sensors/density_patches.h"
#include "orientation/sensors/flat_points.h"
#include "orientation/sensors/sampling_law.h"
#include "orientation/sensors/station_search.h"
#include "search/index_of.h"

namespace segorient::detail {
namespace {

// Enough for shares of a hundredth.
constexpr std::size_t kSamples = 3000;
// Neighbours of the plane that density and incidence are measured in: as many as an edge leaves
// flat and noise of half a spacing does not tilt.
constexpr int kPlane = 24;
// In angle: of a nearer surface, and of the point's own.
constexpr int kAroundRay = 24;
// Of points before others, those on surfaces, over as many as chance would have there. In four
// woods seen from the air .00 to .10, around and in bodies .24 (in noise) and more.
constexpr double kFarFewer = 0.15;
// So many as chance would have there: three and less are far fewer then.
constexpr double kEnoughBefore = 20.0;
// ns a point, see resolveThreads().
constexpr double kRayTime = 2000.0;
constexpr double kThroughTime = 20000.0;
constexpr double kPairTime = 1000.0;

Plane planeOf(const PointView& points, const Neighborhoods& nb, std::size_t i, int k) {
  return detail::planeOf(points, i, nb.indices(i), std::min(nb.count(i), k + 1));
}

}  // namespace

Plane planeOf(const PointView& points, std::size_t i, const pcl::index_t* row, int count) {
  Moments m;
  m.addOrigin();
  const float* p = points[i];
  const float h = meanDistance(points, i, row + 1, std::min(count - 1, kFirstRing));
  const float scale = h > 0.F ? 1.F / h : 0.F;
  for (int j = 1; j < count; ++j) {
    const float* q = points[static_cast<std::size_t>(row[j])];
    m.add((q[0] - p[0]) * scale, (q[1] - p[1]) * scale, (q[2] - p[2]) * scale);
  }
  return fitPlane(m);
}

// The nearest of one point, itself first.
struct Scan::Row {
  std::array<pcl::index_t, kPlane + 1> room;
  const pcl::index_t* indices = nullptr;
  int count = 0;
};

struct Scan::Before {
  std::array<std::size_t, kAroundRay> points;
  std::size_t count = 0;
};

Scan::Scan(const PointView& points, const std::vector<std::uint32_t>& rows,
           const std::array<float, 3>& sensor, const Neighborhoods* neighborhoods, int threads)
    : view_(points), sensor_(sensor), threads_(threads) {
  const bool all = rows.size() == points.size;
  if (!all) {
    xyz_.assign(4 * rows.size(), 0.F);
    for (std::size_t i = 0; i < rows.size(); ++i) std::copy_n(points[rows[i]], 3, &xyz_[4 * i]);
    view_ = {xyz_.data(), 4, rows.size()};
  }
  for (std::size_t i = 0; i < view_.size; ++i) box_.add(view_[i]);
  if (!rows.empty()) extent_ = box_.diagonal();
  seen_ = seeFrom(sensor, view_, threads);
  directions_ = seen_.index(threads);
  if (all && neighborhoods != nullptr && neighborhoods->k() > kPlane) {
    near_ = neighborhoods;
    return;
  }
  index_ = search::indexOf(view_, threads);
}

void Scan::nearest(std::size_t i, int entries, Row& out) const {
  if (near_ != nullptr) {
    out.indices = near_->indices(i);
    out.count = std::min(near_->count(i), entries);
    return;
  }
  std::array<float, kPlane + 1> squares;
  out.indices = out.room.data();
  out.count = index_.nearestK(view_[i], entries, out.room.data(), squares.data(), 0.F);
}

float Scan::spacingOf(std::size_t i) const {
  Row row;
  nearest(i, kFirstRing + 1, row);
  return meanDistance(view_, i, row.indices + 1, row.count - 1);
}

EveryNth Scan::sample() const {
  return {size(), kSamples};
}

std::vector<std::uint8_t> Scan::hidden() const {
  const EveryNth some = sample();
  const std::size_t n = some.size();
  std::vector<std::uint8_t> out(n, 0);
  parallelFor(n, threads_, kRayTime,
              [&](std::size_t s) { out[s] = before(some[s], kNoStray).count >= kNoStray ? 1 : 0; });
  return out;
}

bool Scan::seesThrough(const std::vector<std::uint8_t>& hidden) const {
  const auto isOnSurface = [&](std::size_t i) {
    const Plane plane = planeAt(i);
    return plane.valid && FlatPoints::isFlat(plane);
  };
  const EveryNth some = sample();
  struct Found {
    int on_surface = 0;
    int before = 0;  // of a point on a surface that is hidden
    int before_on_surfaces = 0;
  };
  std::vector<Found> found(hidden.size());
  parallelFor(hidden.size(), threads_, kThroughTime, [&](std::size_t s) {
    if (!isOnSurface(some[s])) return;
    found[s].on_surface = 1;
    if (hidden[s] == 0) return;
    const Before those = before(some[s], kAroundRay);
    for (std::size_t j = 0; j < those.count; ++j) {
      ++found[s].before;
      found[s].before_on_surfaces += isOnSurface(those.points[j]) ? 1 : 0;
    }
  });
  double on_surfaces = 0.0;
  double all = 0.0;
  double flat = 0.0;
  for (const Found& f : found) {
    on_surfaces += f.on_surface;
    all += f.before;
    flat += f.before_on_surfaces;
  }
  const double expected = all * on_surfaces / static_cast<double>(found.size());
  return expected > kEnoughBefore && flat < kFarFewer * expected;
}

Plane Scan::planeAt(std::size_t i) const {
  Row row;
  nearest(i, kPlane + 1, row);
  return planeOf(view_, i, row.indices, row.count);
}

Scan::Before Scan::before(std::size_t i, std::size_t most) const {
  const Plane plane = planeAt(i);
  const float incidence =
      plane.valid ? std::fabs(dot(plane.normal.data(), &seen_.direction[4 * i])) : 1.F;
  const float d = seen_.distance[i];
  const float margin = depthStep(spacingOf(i), incidence, d, extent_);
  std::array<pcl::index_t, kAroundRay> around;
  std::array<float, kAroundRay> squares;
  const int found =
      directions_.nearestK(&seen_.direction[4 * i], kAroundRay, around.data(), squares.data());
  Before out;
  for (int j = 0; j < found && out.count < most; ++j) {
    const auto at = static_cast<std::size_t>(j);
    const auto q = static_cast<std::size_t>(around[at]);
    if (seen_.distance[q] >= d - margin) continue;
    const float reach = spacingOf(q) / seen_.distance[q];
    if (squares[at] < reach * reach) out.points[out.count++] = q;
  }
  return out;
}

Scan::Density Scan::density() const {
  constexpr std::size_t kFewest = 50;  // patches: their mean deviation is sure to a tenth
  // Equal angles crowd at the poles of the sensor's axis: no nearer than 6 degrees.
  constexpr float kPole = 0.1F;
  constexpr std::size_t kLaws = 5;  // no axis, three axes, an image
  std::array<double, 3> mean{0.0, 0.0, 0.0};
  for (std::size_t i = 0; i < size(); ++i) {
    for (std::size_t a = 0; a < 3; ++a) mean[a] += static_cast<double>(seen_.direction[4 * i + a]);
  }
  const double length = std::sqrt(mean[0] * mean[0] + mean[1] * mean[1] + mean[2] * mean[2]);
  float gaze[3] = {0.F, 0.F, 0.F};
  for (std::size_t a = 0; a < 3 && length > 0.0; ++a) {
    gaze[a] = static_cast<float>(mean[a] / length);
  }
  std::vector<float> constant;
  std::array<std::vector<float>, kLaws> laws;
  Row row;
  for (const std::size_t i : sample()) {
    nearest(i, kPlane + 1, row);
    const Plane plane = planeOf(view_, i, row.indices, row.count);
    const Eigen::Vector3f& l = plane.lambda;
    const float spacing =
        meanDistance(view_, i, row.indices + 1, std::min(row.count - 1, kFirstRing));
    if (!plane.valid || !isPieceOfSurface(l[0], l[1], l[2])) continue;
    if (!(seen_.distance[i] > 0.F) || !(spacing > 0.F)) continue;
    const float* u = &seen_.direction[4 * i];
    const float log_density = -0.5F * std::log(l[1] * l[2]) - 2.F * std::log(spacing);
    const float incidence = std::max(std::fabs(dot(plane.normal.data(), u)), kGrazing);
    const float plain = log_density - std::log(incidence) + 2.F * std::log(seen_.distance[i]);
    constant.push_back(log_density);
    laws[0].push_back(plain);
    for (std::size_t a = 0; a < 3; ++a) {
      const float from_axis = std::sqrt(std::max(1.F - u[a] * u[a], kPole * kPole));
      laws[1 + a].push_back(plain + std::log(from_axis));
    }
    laws[4].push_back(plain + 3.F * std::log(std::max(dot(gaze, u), kPole)));
  }
  Density out;
  if (constant.size() < kFewest) return out;
  out.constant = deviation(constant);
  if (!(out.constant > 0.F)) return out;
  for (std::vector<float>& law : laws) {
    out.ratio = std::min(out.ratio, deviation(law) / out.constant);
  }
  return out;
}

bool Scan::stoodElsewhere() const {
  const search::MedianHashIndex own =
      near_ != nullptr ? search::indexOf(view_, threads_) : search::MedianHashIndex();
  const DensityPatches patches = densityPatches(view_, near_ != nullptr ? own : index_, threads_);
  if (!patches.tell_laws) return false;
  const FittedPlace said = fitAt(patches, inDouble(sensor_.data()));
  const FittedPlace beside = fitBeside(patches, said);
  if (beside.cost > kSureFound * deviation(patches.log_density) ||
      beside.cost > kMuchBetter * said.cost) {
    return false;
  }
  // A place that is off by little sees from the other side what it sees edge-on.
  constexpr double kFewTurned = 0.01;
  const auto turned = static_cast<double>(countTurned(patches, said, beside));
  return turned > kFewTurned * static_cast<double>(patches.size());
}

std::vector<ScanPairs> findContraryPairs(const PointView& points, const Neighborhoods& nb,
                                         const float* spacing, const std::vector<float>& toward,
                                         const std::vector<std::int32_t>& scan, int threads) {
  // Enough to find a hundredth of the pairs of each two of some twenty scans.
  constexpr std::size_t kPairSamples = 40000;
  constexpr int kAround = 8;         // the nearest: of one sheet
  constexpr float kClear = 0.3F;     // 17 degrees above grazing
  constexpr float kParallel = 0.9F;  // and no edge between them
  constexpr float kOffset = 0.7F;    // spacings: less than what walls are apart
  const EveryNth some(points.size, kPairSamples);
  const std::size_t n = some.size();
  struct Pairs {
    std::array<std::int32_t, kAround> scan;
    std::array<std::int8_t, kAround> agree;  // 0 where nothing is said
  };
  std::vector<Pairs> found(n);
  parallelFor(n, threads, kPairTime, [&](std::size_t s) {
    found[s].agree.fill(0);
    const std::size_t i = some[s];
    if (scan[i] < 0) return;
    const Plane mine = planeOf(points, nb, i, kSheetNeighbors);
    const float view = mine.valid ? dot(mine.normal.data(), &toward[3 * i]) : 0.F;
    if (std::fabs(view) < kClear) return;
    const int count = std::min(nb.count(i) - 1, kAround);
    for (int j = 0; j < count; ++j) {
      const auto q = static_cast<std::size_t>(nb.indices(i)[j + 1]);
      if (scan[q] < 0) continue;
      const Plane other = planeOf(points, nb, q, kSheetNeighbors);
      if (!other.valid) continue;
      const float seen = dot(other.normal.data(), &toward[3 * q]);
      const float parallel = mine.normal.dot(other.normal);
      float offset = 0.F;
      for (std::size_t a = 0; a < 3; ++a) {
        offset += (points[q][a] - points[i][a]) * mine.normal[static_cast<Eigen::Index>(a)];
      }
      if (std::fabs(seen) < kClear || std::fabs(parallel) < kParallel) continue;
      if (std::fabs(offset) > kOffset * spacing[i]) continue;
      const auto at = static_cast<std::size_t>(j);
      found[s].scan[at] = scan[q];
      found[s].agree[at] = view * seen * parallel > 0.F ? 1 : -1;
    }
  });
  // Of many scans, few are neighbours of each other.
  std::map<std::pair<std::size_t, std::size_t>, std::pair<double, double>> counts;
  for (std::size_t s = 0; s < n; ++s) {
    for (std::size_t j = 0; j < kAround; ++j) {
      if (found[s].agree[j] == 0) continue;
      const auto a = static_cast<std::size_t>(scan[some[s]]);
      const auto b = static_cast<std::size_t>(found[s].scan[j]);
      for (const auto& pair : {std::pair(a, b), std::pair(b, a)}) {
        auto& [pairs, contrary] = counts[pair];
        pairs += 1.0;
        if (found[s].agree[j] < 0) contrary += 1.0;
      }
    }
  }
  std::vector<ScanPairs> out;
  out.reserve(counts.size());
  for (const auto& [ends, count] : counts) {
    out.push_back({ends.first, ends.second, count.first, count.second});
  }
  return out;
}

}  // namespace segorient::detail
