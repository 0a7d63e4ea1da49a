// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/sensors/view_pyramid.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <cstdio>
#include <cstdlib>

#include "common/every_nth.h"
#include "common/median.h"
#include "common/parallel_for.h"
#include "orientation/sensors/simplex.h"

namespace segorient::detail {
namespace {

using Vector = Eigen::Vector3d;

// Directions that bounding planes are looked for in, 4.6 degrees apart; of these the best are
// followed.
constexpr std::size_t kDirections = 600;
constexpr std::size_t kPoints = 8192;
constexpr std::size_t kFollowed = 10;
constexpr double kLongest = 4.0;
constexpr int kEvaluations = 40;
// Fewer points on a plane touch it by chance.
constexpr std::size_t kFewest = 30;
// Surfaces that a plane cuts come up to it with as many points in its first spacing as in the
// next; faces that lie in it have many more, what it only touches has fewer.
constexpr double kCut = 3.0;
// Sides of an image meet at angles: three that do not say where.
constexpr double kLeastVolume = 0.1;
constexpr std::size_t kSides = 3;
constexpr std::size_t kMostApexes = 8;
// A camera sees no more than this far from its axis: 80 degrees.
constexpr double kWidest = 0.17;

/// A plane that has all points on one side: normal . p <= offset.
struct Bound {
  Vector normal = Vector::Zero();
  double offset = 0.0;
  std::size_t touching = 0;  // points within a spacing
  bool cuts = false;
};

/// Some of the points, column by column, and what lies behind the plane that bounds all of them.
class Columns {
 public:
  explicit Columns(const FlatPoints& flat) {
    const EveryNth some(flat.size(), kPoints);
    const PointView points = flat.view();
    // Whole runs: those behind the last point repeat it.
    size_ = (some.size() + kLanes - 1) / kLanes * kLanes;
    count_ = some.size();
    for (std::size_t a = 0; a < 3; ++a) {
      column_[a].resize(size_);
      for (std::size_t i = 0; i < size_; ++i) {
        column_[a][i] = points[some[std::min(i, count_ - 1)]][a];
      }
    }
    behind_.resize(size_);
  }

  /// By direction, which stays the current one.
  void face(const Vector& direction) {
    const float u[3] = {static_cast<float>(direction[0]), static_cast<float>(direction[1]),
                        static_cast<float>(direction[2])};
    const float* const x = column_[0].data();
    const float* const y = column_[1].data();
    const float* const z = column_[2].data();
    float* const h = behind_.data();
    float most[kLanes];
    std::fill_n(most, kLanes, std::numeric_limits<float>::lowest());
    for (std::size_t i = 0; i < size_; i += kLanes) {
      for (std::size_t l = 0; l < kLanes; ++l) {
        h[i + l] = u[0] * x[i + l] + u[1] * y[i + l] + u[2] * z[i + l];
        most[l] = h[i + l] > most[l] ? h[i + l] : most[l];
      }
    }
    highest_ = *std::max_element(most, most + kLanes);
    for (std::size_t i = 0; i < size_; ++i) h[i] = highest_ - h[i];
  }

  double highest() const { return static_cast<double>(highest_); }
  float farthest() const { return *std::max_element(behind_.begin(), behind_.end()); }

  std::size_t countWithin(double from, double to) const {
    const auto low = static_cast<float>(from);
    const auto high = static_cast<float>(to);
    std::size_t count = 0;
    for (std::size_t i = 0; i < count_; ++i) {
      count += static_cast<std::size_t>(behind_[i] >= low) & static_cast<std::size_t>(behind_[i] < high);
    }
    return count;
  }

  /// Sum of how far points are nearer than that.
  double nearness(double reach) const {
    const auto far = static_cast<float>(reach);
    float sum[kLanes] = {};
    for (std::size_t i = 0; i < size_; i += kLanes) {
      for (std::size_t l = 0; l < kLanes; ++l) {
        const float left = far - behind_[i + l];
        sum[l] += left > 0.F ? left : 0.F;
      }
    }
    return static_cast<double>(std::accumulate(sum, sum + kLanes, 0.F));
  }

 private:
  static constexpr std::size_t kLanes = 16;
  std::array<std::vector<float>, 3> column_;
  std::vector<float> behind_;
  std::size_t size_ = 0;
  std::size_t count_ = 0;
  float highest_ = 0.F;
};

// A spiral from pole to pole.
std::vector<Vector> directionsAllAround() {
  const double golden = 3.14159265358979323846 * (1.0 + std::sqrt(5.0));
  std::vector<Vector> out;
  for (std::size_t i = 0; i < kDirections; ++i) {
    const double at = static_cast<double>(i) + 0.5;
    const double z = 1.0 - 2.0 * at / static_cast<double>(kDirections);
    const double r = std::sqrt(1.0 - z * z);
    out.emplace_back(r * std::cos(golden * at), r * std::sin(golden * at), z);
  }
  return out;
}

class BoundFinder {
 public:
  BoundFinder(const FlatPoints& flat, int threads) : points_(flat), threads_(threads) {
    std::vector<float> spacings;
    for (std::size_t i = 0; i < flat.size(); ++i) spacings.push_back(flat.spacing(i));
    const EveryNth some(flat.size(), kPoints);
    const double part = static_cast<double>(some.size()) / static_cast<double>(flat.size());
    spacing_ = static_cast<double>(median(std::move(spacings))) / std::sqrt(part);
    double square = 0.0;
    for (int a = 0; a < 3; ++a) {
      points_.face(Vector::Unit(a));
      const auto side = static_cast<double>(points_.farthest());
      square += side * side;
    }
    // What the next direction's plane is off by across half of the cloud.
    extent_ = std::sqrt(square);
    coarse_ = std::max(spacing_, 0.02 * extent_);
  }

  double spacing() const { return spacing_; }

  /// Planes that cut what they bound, those that most points touch first.
  std::vector<Bound> run() {
    const std::vector<Vector> starts = startDirections();
    std::vector<Bound> found(starts.size());
    parallelFor(
        starts.size(), threads_, 1e6, [&] { return points_; },
        [&](std::size_t i, Columns& points) { found[i] = follow(starts[i], points); });
    std::stable_sort(found.begin(), found.end(),
                     [](const Bound& a, const Bound& b) { return a.touching > b.touching; });
    if (std::getenv("APEX")) for (const Bound& b : found) std::fprintf(stderr,"B %.2f %.2f %.2f off %.4f t %zu cuts %d sp %g co %g\n",b.normal[0],b.normal[1],b.normal[2],b.offset,b.touching,b.cuts,spacing_,coarse_);
    std::vector<Bound> out;
    for (const Bound& b : found) {
      if (b.cuts && !isKnown(b, out)) out.push_back(b);
    }
    if (out.size() > kFollowed) out.resize(kFollowed);
    return out;
  }

 private:
  // The same plane, but for what a few spacings tilt it.
  static bool isKnown(const Bound& b, const std::vector<Bound>& known) {
    constexpr double kSame = 0.998;  // 3.6 degrees
    return std::any_of(known.begin(), known.end(),
                       [&](const Bound& k) { return k.normal.dot(b.normal) > kSame; });
  }

  // Those that more points are near the bounding plane of than of all around.
  std::vector<Vector> startDirections() {
    const std::vector<Vector> directions = directionsAllAround();
    std::vector<std::size_t> near(directions.size());
    for (std::size_t d = 0; d < directions.size(); ++d) {
      points_.face(directions[d]);
      near[d] = points_.countWithin(0.0, coarse_);
    }
    constexpr double kAround = 0.985;  // 10 degrees: twice as far as the next
    std::vector<Vector> out;
    for (std::size_t d = 0; d < directions.size(); ++d) {
      bool is_best = true;
      for (std::size_t e = 0; e < directions.size() && is_best; ++e) {
        const bool more = near[e] > near[d] || (near[e] == near[d] && e < d);
        is_best = !more || directions[d].dot(directions[e]) < kAround;
      }
      if (is_best) out.push_back(directions[d]);
    }
    return out;
  }

  // How many more points are in the plane's first so much than in the next.
  static double ratioAt(double width, const Columns& points) {
    const std::size_t next = std::max<std::size_t>(1, points.countWithin(width, 2.0 * width));
    return static_cast<double>(points.countWithin(0.0, width)) / static_cast<double>(next);
  }

  // Turns the plane until most points touch it.
  Bound follow(Vector direction, Columns& points) const {
    Bound out;
    for (const double width : {0.5 * coarse_, 0.25 * coarse_, spacing_, spacing_}) {
      const double reach = 2.0 * std::max(width, spacing_);
      const Vector across = direction.unitOrthogonal();
      const Vector along = direction.cross(across);
      const auto turned = [&](const std::vector<double>& by) {
        return (direction + by[0] * across + by[1] * along).normalized().eval();
      };
      const auto cost = [&](const std::vector<double>& by) {
        points.face(turned(by));
        return -points.nearness(reach);
      };
      const double step = 0.08 * std::min(1.0, reach / coarse_);
      std::vector<double> by{0.0, 0.0};
      minimize(cost, {step, step}, kEvaluations, by);
      direction = turned(by);
    }
    points.face(direction);
    out.normal = direction;
    out.offset = points.highest();
    out.touching = points.countWithin(0.0, spacing_);
    const double ratio = ratioAt(spacing_, points);
    out.cuts = out.touching >= kFewest && static_cast<double>(out.touching) * spacing_ <= kLongest * extent_ && ratio >= 1.0 / kCut;
    return out;
  }

  Columns points_;
  int threads_;
  double spacing_ = 0.0;
  double extent_ = 0.0;
  double coarse_ = 0.0;
};

struct Apex {
  Vector place = Vector::Zero();
  std::size_t sides = 0;
  std::size_t touching = 0;
};

// The place nearest to all planes that pass three of them's common point.
Apex meetAt(const Vector& place, const std::vector<Bound>& bounds, double spacing) {
  // By how much planes that are known to a spacing miss a place that far from the cloud.
  const double near = spacing;
  Apex out;
  Eigen::Matrix3d normals = Eigen::Matrix3d::Zero();
  Vector offsets = Vector::Zero();
  for (const Bound& b : bounds) {
    if (std::fabs(b.normal.dot(place) - b.offset) > near) continue;
    ++out.sides;
    out.touching += b.touching;
    normals += b.normal * b.normal.transpose();
    offsets += b.offset * b.normal;
  }
  out.place = normals.ldlt().solve(offsets);
  return out;
}

bool seesAll(const FlatPoints& flat, const Vector& place, const Vector& middle) {
  const Eigen::Vector3f from = place.cast<float>();
  const Eigen::Vector3f axis = (middle - place).normalized().cast<float>();
  const PointView points = flat.view();
  for (std::size_t i = 0; i < points.size; ++i) {
    const Eigen::Vector3f to(points[i][0] - from[0], points[i][1] - from[1],
                             points[i][2] - from[2]);
    if (!(to.dot(axis) > static_cast<float>(kWidest) * to.norm())) return false;
  }
  return true;
}

}  // namespace

std::vector<std::array<float, 3>> findApexes(const FlatPoints& flat, int threads) {
  if (flat.size() < kPoints / 16) return {};
  BoundFinder finder(flat, threads);
  const std::vector<Bound> bounds = finder.run();
  const std::array<float, 3> m = flat.middle();
  const Vector middle = Eigen::Vector3f(m[0], m[1], m[2]).cast<double>();
  std::vector<Apex> apexes;
  for (std::size_t a = 0; a < bounds.size(); ++a) {
    for (std::size_t b = a + 1; b < bounds.size(); ++b) {
      for (std::size_t c = b + 1; c < bounds.size(); ++c) {
        Eigen::Matrix3d normals;
        normals << bounds[a].normal.transpose(), bounds[b].normal.transpose(),
            bounds[c].normal.transpose();
        if (std::fabs(normals.determinant()) < kLeastVolume) continue;
        const Vector place = normals.inverse() *
                             Vector(bounds[a].offset, bounds[b].offset, bounds[c].offset);
        const Apex apex = meetAt(place, bounds, finder.spacing());
        if (apex.sides >= kSides) apexes.push_back(apex);
      }
    }
  }
  std::stable_sort(apexes.begin(), apexes.end(), [](const Apex& a, const Apex& b) {
    return a.sides != b.sides ? a.sides > b.sides : a.touching > b.touching;
  });
  std::vector<std::array<float, 3>> out;
  std::vector<Vector> places;
  for (const Apex& apex : apexes) {
    const bool known = std::any_of(places.begin(), places.end(), [&](const Vector& p) {
      return (p - apex.place).norm() < 0.1 * (apex.place - middle).norm();
    });
    if (known || !seesAll(flat, apex.place, middle)) continue;
    places.push_back(apex.place);
    const Eigen::Vector3f place = apex.place.cast<float>();
    out.push_back({place[0], place[1], place[2]});
    if (out.size() == kMostApexes) break;
  }
  return out;
}

}  // namespace segorient::detail
