// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/sensors/view_pyramid.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>

#include "common/directions.h"
#include "common/every_nth.h"
#include "common/median.h"
#include "common/parallel_for.h"
#include "orientation/sensors/simplex.h"

namespace segorient::detail {
namespace {

using Vector = Eigen::Vector3d;

// Directions that bounding planes are looked for in: 4 degrees apart, since a side of the image and
// another plane may be ten apart.
constexpr std::size_t kDirections = 2400;
// Points that planes are fitted to, where the sides of an image have some hundred each, and that
// they are looked for with.
constexpr std::size_t kPoints = 8192;
constexpr std::size_t kFewPoints = 4096;
constexpr int kEvaluations = 40;
// Fewer points on a plane touch it by chance.
constexpr std::size_t kFewest = 30;
// What a plane cuts comes up to it with as many points in its last spacing as in the one before,
// about; of what it only touches far fewer do.
constexpr double kCut = 1.0 / 3.0;
// In extents: points that touch a plane would make a chain of that length, a spacing between two,
// where it cuts a view of the scene. Faces that lie in a plane have many more.
constexpr double kLongest = 8.0;
// Of the planes that cut, those with most points; of the places that sides of an image meet
// in, those that most planes and points meet in.
constexpr std::size_t kMostPlanes = 10;
constexpr std::size_t kMostApexes = 8;
// Volume that the normals of three planes span: with less, they do not say where they meet.
constexpr double kLeastVolume = 0.1;
// Cosine: no image is wider than 80 degrees, or reaches farther than 50 from the middle of what it
// holds. Corners of what was cut to a box do.
constexpr double kOpposite = -0.17;
constexpr double kWidest = 0.64;
// Of cosines: what a side between two others may be tilted more towards one of them, as the axis of
// a camera need not be in the middle of its image.
constexpr double kUneven = 0.06;
// Cosines: planes that differ by 1 degree go on to the same one; found ones that differ by 3.6 are
// the same but for what a few points tilt.
constexpr double kAlike = 0.9998;
constexpr double kSame = 0.998;

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
  Columns(const FlatPoints& flat, std::size_t most) {
    const EveryNth some(flat.size(), most);
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
    for (std::size_t i = 0; i < count_; ++i) h[i] = highest_ - h[i];
    std::fill(behind_.begin() + static_cast<std::ptrdiff_t>(count_), behind_.end(),
              std::numeric_limits<float>::max());
  }

  std::size_t size() const { return count_; }
  double highest() const { return static_cast<double>(highest_); }
  float farthest() const {
    return *std::max_element(behind_.begin(),
                             behind_.begin() + static_cast<std::ptrdiff_t>(count_));
  }

  std::size_t countWithin(double from, double to) const {
    const auto low = static_cast<float>(from);
    const auto high = static_cast<float>(to);
    std::size_t count = 0;
    for (std::size_t i = 0; i < count_; ++i) {
      count +=
          static_cast<std::size_t>(behind_[i] >= low) & static_cast<std::size_t>(behind_[i] < high);
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
  static constexpr std::size_t kLanes = 16;  // floats in the widest registers
  std::array<std::vector<float>, 3> column_;
  std::vector<float> behind_;
  std::size_t size_ = 0;
  std::size_t count_ = 0;
  float highest_ = 0.F;
};

std::vector<Vector> directionsAllAround() {
  std::vector<Vector> out;
  for (std::size_t i = 0; i < kDirections; ++i) {
    const std::array<double, 3> u = evenDirection(i, kDirections);
    out.emplace_back(u[0], u[1], u[2]);
  }
  return out;
}

class BoundFinder {
 public:
  BoundFinder(const FlatPoints& flat, int threads)
      : few_(flat, kFewPoints), points_(flat, kPoints), threads_(threads) {
    std::vector<float> spacings;
    for (std::size_t i = 0; i < flat.size(); ++i) spacings.push_back(flat.spacing(i));
    const auto all = static_cast<double>(flat.size());
    const auto some = static_cast<double>(points_.size());
    spacing_ = static_cast<double>(median(std::move(spacings))) * std::sqrt(all / some);
    double square = 0.0;
    for (int a = 0; a < 3; ++a) {
      points_.face(Vector::Unit(a));
      const auto side = static_cast<double>(points_.farthest());
      square += side * side;
    }
    extent_ = std::sqrt(square);
    // What the next direction's plane is off by across half of the cloud.
    coarse_ = std::max(spacing_, 0.02 * extent_);
  }

  double spacing() const { return spacing_; }

  /// Planes that cut what they bound, those that most points touch first.
  std::vector<Bound> run() {
    std::vector<Bound> bounds;
    for (const Vector& start : startDirections()) {
      bounds.emplace_back();
      bounds.back().normal = start;
    }
    for (const double reach : {coarse_, 0.5 * coarse_}) {
      turnAll(std::max(reach, 2.0 * spacing_), few_, bounds);
    }
    bounds = different(bounds, kAlike);
    for (int round = 0; round < 2; ++round) {
      turnAll(2.0 * spacing_, points_, bounds);
    }
    bounds.erase(
        std::remove_if(bounds.begin(), bounds.end(), [](const Bound& b) { return !b.cuts; }),
        bounds.end());
    bounds = different(bounds, kSame);
    bounds.resize(std::min(bounds.size(), kMostPlanes));
    return bounds;
  }

 private:
  // Those that more points are near the bounding plane of than of all around.
  std::vector<Vector> startDirections() {
    constexpr double kAround = 0.996;  // 5 degrees: the next ones
    const std::vector<Vector> directions = directionsAllAround();
    std::vector<std::size_t> near(directions.size());
    for (std::size_t d = 0; d < directions.size(); ++d) {
      few_.face(directions[d]);
      near[d] = few_.countWithin(0.0, coarse_);
    }
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

  void turnAll(double reach, const Columns& by, std::vector<Bound>& bounds) const {
    constexpr double kPointTime = 1.0;  // ns, see resolveThreads()
    parallelFor(
        bounds.size(), threads_, kPointTime * kEvaluations * kPoints, [&] { return by; },
        [&](std::size_t i, Columns& points) { turn(reach, points, bounds[i]); });
  }

  // Turns the plane until most points are near it.
  void turn(double reach, Columns& points, Bound& bound) const {
    const Vector start = bound.normal;
    const Vector across = start.unitOrthogonal();
    const Vector along = start.cross(across);
    const auto turned = [&](const std::vector<double>& by) {
      return Vector((start + by[0] * across + by[1] * along).normalized());
    };
    const auto cost = [&](const std::vector<double>& by) {
      points.face(turned(by));
      return -points.nearness(reach);
    };
    // As far as the next start at first, then by what moves as much of the cloud.
    const double step = 0.04 * std::min(1.0, reach / coarse_);
    std::vector<double> by{0.0, 0.0};
    minimize(cost, {step, step}, kEvaluations, by);
    bound.normal = turned(by);
    points.face(bound.normal);
    bound.offset = points.highest();
    bound.touching = points.countWithin(0.0, spacing_);
    const auto touching = static_cast<double>(bound.touching);
    const double each = static_cast<double>(points_.size()) / static_cast<double>(points.size());
    bound.cuts =
        each * touching * spacing_ <= kLongest * extent_ && bound.touching >= kFewest &&
        touching >= kCut * static_cast<double>(points.countWithin(spacing_, 2.0 * spacing_));
  }

  // Those that most points touch first, each once.
  static std::vector<Bound> different(std::vector<Bound> bounds, double same) {
    std::stable_sort(bounds.begin(), bounds.end(),
                     [](const Bound& a, const Bound& b) { return a.touching > b.touching; });
    std::vector<Bound> out;
    for (const Bound& b : bounds) {
      const bool known = std::any_of(out.begin(), out.end(),
                                     [&](const Bound& k) { return k.normal.dot(b.normal) > same; });
      if (!known) out.push_back(b);
    }
    return out;
  }

  Columns few_;
  Columns points_;
  int threads_;
  double spacing_ = 0.0;
  double extent_ = 0.0;
  double coarse_ = 0.0;
};

struct Meeting {
  Vector place = Vector::Zero();
  bool whole = false;
  std::size_t sides = 0;
  std::size_t touching = 0;

  bool operator<(const Meeting& o) const {
    if (whole != o.whole) return whole;
    return sides != o.sides ? sides > o.sides : touching > o.touching;
  }
};

// Whether two planes are opposite sides of an image and the third lies between them: it is tilted
// towards both alike, as an image is a rectangle, by the sine of half the width times that of half
// the height.
bool areSides(const Bound& left, const Bound& right, const Bound& between) {
  const double to_left = between.normal.dot(left.normal);
  const double to_right = between.normal.dot(right.normal);
  return left.normal.dot(right.normal) < kOpposite && to_left > 0.0 && to_right > 0.0 &&
         to_left < 0.5 && to_right < 0.5 && std::fabs(to_left - to_right) < kUneven;
}

// Whether the side across from the one between two opposite ones is there as well.
bool isWhole(const Bound& left, const Bound& right, const Bound& between,
             const std::vector<Bound>& sides) {
  return std::any_of(sides.begin(), sides.end(), [&](const Bound& other) {
    return areSides(left, right, other) && areSides(between, other, left) &&
           areSides(between, other, right);
  });
}

// Where all planes meet that pass a place within a spacing. \param[out] sides these planes
Meeting meetAt(const Vector& place, const std::vector<Bound>& bounds, double spacing,
               std::vector<Bound>& sides) {
  Meeting out;
  sides.clear();
  Eigen::Matrix3d normals = Eigen::Matrix3d::Zero();
  Vector offsets = Vector::Zero();
  for (const Bound& b : bounds) {
    if (std::fabs(b.normal.dot(place) - b.offset) > spacing) continue;
    sides.push_back(b);
    out.touching += b.touching;
    normals += b.normal * b.normal.transpose();
    offsets += b.offset * b.normal;
  }
  out.sides = sides.size();
  out.place = normals.ldlt().solve(offsets);
  return out;
}

// Of each three planes that are sides of an image.
std::vector<Meeting> meetings(const std::vector<Bound>& bounds, double spacing) {
  std::vector<Meeting> out;
  std::vector<Bound> sides;
  // \param third between the other two
  const auto add = [&](const Bound& first, const Bound& second, const Bound& third) {
    if (!areSides(first, second, third)) return;
    Eigen::Matrix3d normals;
    normals << first.normal.transpose(), second.normal.transpose(), third.normal.transpose();
    if (std::fabs(normals.determinant()) < kLeastVolume) return;
    const Vector offsets(first.offset, second.offset, third.offset);
    out.push_back(meetAt(normals.inverse() * offsets, bounds, spacing, sides));
    out.back().whole = isWhole(first, second, third, sides);
  };
  for (std::size_t a = 0; a < bounds.size(); ++a) {
    for (std::size_t b = a + 1; b < bounds.size(); ++b) {
      for (std::size_t c = b + 1; c < bounds.size(); ++c) {
        add(bounds[a], bounds[b], bounds[c]);
        add(bounds[b], bounds[c], bounds[a]);
        add(bounds[c], bounds[a], bounds[b]);
      }
    }
  }
  std::stable_sort(out.begin(), out.end());
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

std::vector<Apex> findApexes(const FlatPoints& flat, int threads) {
  // With fewer points, few lie on a side.
  constexpr std::size_t kLeastPoints = 500;
  if (flat.size() < kLeastPoints) return {};
  constexpr double kElsewhere = 0.1;  // of the distance
  BoundFinder finder(flat, threads);
  if (!(finder.spacing() > 0.0)) return {};
  const std::vector<Bound> bounds = finder.run();
  const std::array<float, 3> m = flat.middle();
  const Vector middle = Eigen::Vector3f(m[0], m[1], m[2]).cast<double>();
  std::vector<Vector> places;
  std::vector<Apex> out;
  for (const Meeting& meeting : meetings(bounds, finder.spacing())) {
    const bool known = std::any_of(places.begin(), places.end(), [&](const Vector& p) {
      return (p - meeting.place).norm() < kElsewhere * (meeting.place - middle).norm();
    });
    if (known || !seesAll(flat, meeting.place, middle)) continue;
    places.push_back(meeting.place);
    const Eigen::Vector3f place = meeting.place.cast<float>();
    out.push_back({{place[0], place[1], place[2]}, meeting.whole});
    if (out.size() == kMostApexes) break;
  }
  return out;
}

}  // namespace segorient::detail
