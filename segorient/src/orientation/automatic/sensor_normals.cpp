// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/automatic/sensor_normals.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "common/dot.h"
#include "common/threads.h"
#include "features/sheet_fit.h"

namespace segorient::detail {
namespace {

// Neighbours whose normals are compared, and those of planes; the largest one only where the one
// before contradicts the normal by more than 6 degrees.
constexpr int kNearest = 8;
constexpr int kNear = 16;
constexpr int kWide = 32;
constexpr int kWidest = 60;
constexpr float kAgree = 0.995F;
// Of the variances across a plane and along its shorter side: a third of the plane's weight. 30
// points on two faces of an edge have .1 and more.
constexpr float kFlat = 0.05F;
// A larger plane that leaves more than this times the variance that few neighbours leave is bent,
// or of two faces: it counts less in proportion. Of one surface with noise, such estimates differ
// by half.
constexpr float kSameNoise = 2.F;
// Radians: what is left where all agree.
constexpr float kLeast = 0.02F;
// A neighbour's plane counts while the point is within a tenth of a spacing of it, and noise.
constexpr float kOffset = 0.1F;
// Surfaces seen at a smaller cosine are sampled by a third of the density of what is seen face on:
// beside an edge, a normal that says so is more likely the other face's.
constexpr float kSeldom = 1.F / 3.F;
// ns a point, see resolveThreads().
constexpr double kFitTime = 1500.0;
constexpr double kMeanTime = 300.0;

struct Vector {
  float x = 0.F, y = 0.F, z = 0.F;

  void add(const float* v, float weight) {
    x += weight * v[0];
    y += weight * v[1];
    z += weight * v[2];
  }
  float length() const { return std::sqrt(x * x + y * y + z * z); }
};

// The direction of `n` that is likeliest if it is known to variance `square`. With c the cosine to
// the sensor, c (c - c0) = square.
void lean(const float* toward, float square, Vector& n) {
  const float c0 = n.x * toward[0] + n.y * toward[1] + n.z * toward[2];
  const float c = 0.5F * (c0 + std::sqrt(c0 * c0 + 4.F * square));
  n.add(toward, c - c0);
}

bool scaleToUnit(Vector& n) {
  const float length = n.length();
  if (!(length > 0.F)) return false;
  n = {n.x / length, n.y / length, n.z / length};
  return true;
}

// Of unit vectors with a mean of that length: twice the mean of 1 - cosine.
float scatterOf(float mean_length) {
  return 2.F * std::max(0.F, 1.F - mean_length);
}

// Sums up the planes of one point's neighbours, each of them a few more.
class GrowingPlane {
 public:
  GrowingPlane(const PointView& points, std::size_t i, float scale)
      : points_(points), p_(points[i]), scale_(scale) {}

  void add(pcl::index_t neighbor) {
    const float* q = points_[static_cast<std::size_t>(neighbor)];
    moments_.add((q[0] - p_[0]) * scale_, (q[1] - p_[1]) * scale_, (q[2] - p_[2]) * scale_);
  }
  Plane plane() const { return fitPlane(moments_); }

 private:
  const PointView& points_;
  const float* p_;
  float scale_;
  Moments moments_;
};

class Leaner {
 public:
  Leaner(MoreNeighbors& more, const Neighborhoods& nb, const std::vector<float>& toward,
         const std::vector<std::uint8_t>& sure, int threads, std::vector<float>& normals)
      : more_(more),
        points_(more.points()),
        nb_(nb),
        toward_(toward),
        sure_(sure),
        threads_(threads),
        normals_(normals) {}

  void run() {
    more_.prepareRows();
    leaned_ = normals_;
    tolerance_.assign(points_.size, 0.F);
    int t = resolveThreads(threads_, points_.size, kFitTime);
#pragma omp parallel for num_threads(t) schedule(dynamic, 512)
    for (std::size_t i = 0; i < points_.size; ++i) {
      if (isKnown(i)) isSure(i) ? leanSure(i) : leanOne(i);
    }
    t = resolveThreads(threads_, points_.size, kMeanTime);
#pragma omp parallel for num_threads(t) schedule(dynamic, 1024)
    for (std::size_t i = 0; i < points_.size; ++i) {
      if (isKnown(i)) isSure(i) ? keep(i) : followAround(i);
    }
  }

 private:
  const float* toward(std::size_t i) const {
    return &toward_[3 * i];
  }
  bool isKnown(std::size_t i) const {
    return dot(toward(i), toward(i)) > 0.F && std::isfinite(normals_[4 * i]);
  }

  bool isSure(std::size_t i) const {
    return !sure_.empty() && sure_[i] != 0 && dot(&normals_[4 * i], toward(i)) > kSeldom;
  }

  void leanSure(std::size_t i) {
    float* n = &normals_[4 * i];
    Vector mean{n[0], n[1], n[2]};
    lean(toward(i), kLeast * kLeast, mean);
    if (!scaleToUnit(mean)) return;
    store(mean, &leaned_[4 * i]);
  }

  void keep(std::size_t i) {
    std::copy_n(&leaned_[4 * i], 3, &normals_[4 * i]);
  }

  // With the planes around, in the first round.
  void leanOne(std::size_t i) {
    const pcl::index_t* row = nb_.indices(i);
    const int end = std::min(nb_.count(i), kWide + 1);
    const float h = meanDistance(points_, nb_, i, 6);
    if (!(h > 0.F)) return;
    const float* n = &normals_[4 * i];
    GrowingPlane sum(points_, i, 1.F / h);
    float nearest = std::numeric_limits<float>::infinity();
    float few = nearest;
    Vector around;
    float used = 0.F;
    for (int j = 0; j < end; ++j) {
      sum.add(row[j]);
      if (j == kNearest) nearest = varianceOf(sum.plane());
      if (j == kNear) few = varianceOf(sum.plane());
      const float* other = &normals_[4 * static_cast<std::size_t>(row[j])];
      if (j > kNear || !std::isfinite(other[0])) continue;
      around.add(other, 1.F);
      used += 1.F;
    }
    Vector mean{n[0], n[1], n[2]};
    const Plane wide = sum.plane();
    float variance = std::min({nearest, few, varianceOf(wide)});
    float agreement = 1.F;
    if (wide.valid) {
      agreement = std::min(1.F, std::fabs(dot(wide.normal.data(), n)));
      addPlane(wide, i, few, mean);
      if (agreement < kAgree) {
        const Plane widest = planeAround(i, 1.F / h);
        variance = std::min(variance, varianceOf(widest));
        addPlane(widest, i, few, mean);
      }
    }
    tolerance_[i] = h * h * (kOffset * kOffset + (std::isfinite(variance) ? variance : 0.F));
    if (!scaleToUnit(mean)) return;
    const float square = kLeast * kLeast + scatterOf(agreement) +
                         0.25F * scatterOf(used > 0.F ? around.length() / used : 1.F);
    lean(toward(i), square, mean);
    if (scaleToUnit(mean)) store(mean, &leaned_[4 * i]);
  }

  static float varianceOf(const Plane& plane) {
    return plane.valid ? std::max(0.F, plane.lambda[0]) : std::numeric_limits<float>::infinity();
  }

  Plane planeAround(std::size_t i, float scale) const {
    MoreNeighbors::Room room;
    const MoreNeighbors::Row row = more_.row(i, kWidest + 1, room);
    GrowingPlane sum(points_, i, scale);
    for (int j = 0; j < row.count; ++j) sum.add(row.indices[j]);
    return sum.plane();
  }

  // Flat planes that leave no more than few neighbours do count as much as the normal itself.
  void addPlane(const Plane& plane, std::size_t i, float few, Vector& mean) const {
    if (!plane.valid || !(plane.lambda[1] > 0.F)) return;
    const float across = plane.lambda[0];
    const float same = across > kSameNoise * few ? kSameNoise * few / across : 1.F;
    const float weight = same / (1.F + across / (kFlat * plane.lambda[1]));
    const float* p = plane.normal.data();
    mean.add(p, dot(p, toward(i)) < 0.F ? -weight : weight);
  }

  // What the neighbours say that the point lies in the plane of, in the second round: twice.
  void followAround(std::size_t i) {
    const pcl::index_t* row = nb_.indices(i);
    const int count = std::min(nb_.count(i), kNear + 1);
    const float* p = points_[i];
    const float scale = tolerance_[i] > 0.F ? 0.5F / tolerance_[i] : 0.F;
    Vector around;
    float total = 0.F;
    for (int j = 1; j < count; ++j) {
      const auto q = static_cast<std::size_t>(row[j]);
      const float* n = &leaned_[4 * q];
      if (!std::isfinite(n[0])) continue;
      const float* at = points_[q];
      const float off = (at[0] - p[0]) * n[0] + (at[1] - p[1]) * n[1] + (at[2] - p[2]) * n[2];
      const float weight = std::exp(-scale * off * off);
      around.add(n, weight);
      total += weight;
    }
    Vector mean;
    mean.add(&leaned_[4 * i], 1.F);
    float square = kLeast * kLeast;
    if (total > 1e-9F) {
      const float length = around.length() / total;
      square += 0.5F * scatterOf(length);
      const float* sum = &around.x;
      mean.add(sum, 2.F / total);
      if (!scaleToUnit(mean)) return;
    }
    lean(toward(i), square, mean);
    if (scaleToUnit(mean)) store(mean, &normals_[4 * i]);
  }

  static void store(const Vector& n, float* out) {
    out[0] = n.x;
    out[1] = n.y;
    out[2] = n.z;
  }

  MoreNeighbors& more_;
  const PointView& points_;
  const Neighborhoods& nb_;
  const std::vector<float>& toward_;
  const std::vector<std::uint8_t>& sure_;
  int threads_;
  std::vector<float>& normals_;
  std::vector<float> leaned_;
  std::vector<float> tolerance_;  // squares of distances
};

}  // namespace

void leanToSensors(MoreNeighbors& more, const Neighborhoods& neighborhoods,
                   const std::vector<float>& toward, const std::vector<std::uint8_t>& sure,
                   int threads, std::vector<float>& normals) {
  Leaner(more, neighborhoods, toward, sure, threads, normals).run();
}

}  // namespace segorient::detail
