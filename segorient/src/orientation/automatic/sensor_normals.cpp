// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/automatic/sensor_normals.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>

#include "common/dot.h"
#include "common/parallel_for.h"
#include "features/grown_planes.h"
#include "features/local_fit_job.h"
#include "features/sheet_fit.h"

namespace segorient::detail {
namespace {

// Neighbours of planes: one ring and a few, two, and as many as all stages share, ...
constexpr std::array<int, 3> kSizes{8, 16, 32};
enum PlaneOf : std::size_t { NEAREST, NEAR, WIDE };
// ... the largest one only where the one before contradicts the normal by more than 6 degrees.
constexpr int kWidest = MoreNeighbors::kMost;
// Neighbours whose normals are compared.
constexpr int kNear = kSizes[NEAR];
constexpr float kAgree = 0.995F;
// Of the variances across a plane and along its shorter side: a third of the plane's weight. 30
// points on two faces of an edge have .1 and more.
constexpr float kFlat = 0.05F;
// A larger plane that leaves more than this times the variance that few neighbours leave is bent,
// or of two faces: it counts less in proportion. Of one surface with noise, such estimates differ
// by half.
constexpr float kSameNoise = 2.F;
// The square of a radian: noise turns a normal at will about a line that all points around are on.
constexpr float kAtWill = 1.F;
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

class Leaner {
 public:
  Leaner(MoreNeighbors& more, const Neighborhoods& nb, const std::vector<float>& toward,
         const std::vector<std::uint8_t>& sure, bool only_many_show_noise, int threads,
         std::vector<float>& normals)
      : more_(more),
        points_(more.points()),
        xyz_(points_),
        nb_(nb),
        toward_(toward),
        sure_(sure),
        only_many_show_noise_(only_many_show_noise),
        threads_(threads),
        normals_(normals) {}

  void run() {
    more_.index();
    leaned_ = normals_;
    tolerance_.assign(points_.size, 0.F);
    doubt_.assign(points_.size, kLeast * kLeast);
    const std::size_t blocks = (points_.size + GrownPlanes::kRows - 1) / GrownPlanes::kRows;
    parallelFor(
        blocks, threads_, timeOfEach(blocks, points_.size, kFitTime),
        [] { return std::make_unique<Room>(); },
        [&](std::size_t block, std::unique_ptr<Room>& room) {
          const std::size_t begin = block * GrownPlanes::kRows;
          leanBlock(begin, std::min(points_.size, begin + GrownPlanes::kRows), *room);
        });
    parallelFor(points_.size, threads_, kMeanTime, [&](std::size_t i) {
      if (isKnown(i)) isSure(i) ? keep(i) : followAround(i);
    });
  }

 private:
  const float* toward(std::size_t i) const { return &toward_[3 * i]; }
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

  void keep(std::size_t i) { std::copy_n(&leaned_[4 * i], 3, &normals_[4 * i]); }

  // What is known of one point in the first round.
  struct Lean {
    std::size_t i = 0;
    Vector mean;      // of the normal and the planes
    float few = 0.F;  // variances across planes
    float variance = 0.F;
    float agreement = 1.F;
    float around = 1.F;  // length of the mean of the normals around
    bool nearest_on_line = false;
    bool noisy_line = false;  // all points around are on it, and noise takes the nearest off it
  };
  // Of one thread, for a block of points.
  struct Room {
    std::vector<pcl::index_t> rows;
    std::vector<Lean> leans;
    std::vector<std::size_t> asking;  // leans that the widest plane is needed for
    Neighborhoods wider;
    std::vector<float> asking_at;
    std::array<GrownPlanes, kSizes.size()> planes;
  };

  // With the planes around, in the first round.
  void leanBlock(std::size_t begin, std::size_t end, Room& room) {
    room.rows.clear();
    for (std::size_t i = begin; i < end; ++i) {
      if (!isKnown(i)) continue;
      if (isSure(i)) {
        leanSure(i);
      } else {
        room.rows.push_back(static_cast<pcl::index_t>(i));
      }
    }
    LocalFitJob job = jobOf(points_, xyz_, nb_, kSizes[WIDE]);
    job.rows = room.rows.data();
    fitGrownPlanes(job, kSizes.data(), kSizes.size(), 0, room.rows.size(), room.planes.data());
    room.leans.clear();
    room.asking.clear();
    for (std::size_t r = 0; r < room.rows.size(); ++r) {
      room.leans.push_back(startLean(static_cast<std::size_t>(room.rows[r]), room.planes, r));
      if (room.leans[r].agreement < kAgree) room.asking.push_back(r);
    }
    addWidest(room);
    for (Lean& of_point : room.leans) finishLean(of_point);
  }

  Lean startLean(std::size_t i, const std::array<GrownPlanes, kSizes.size()>& planes,
                 std::size_t r) const {
    const float* n = &normals_[4 * i];
    Lean out;
    out.i = i;
    out.mean.add(n, 1.F);
    const pcl::index_t* row = nb_.indices(i);
    const int end = std::min(nb_.count(i), kNear + 1);
    Vector around;
    float used = 0.F;
    for (int j = 0; j < end; ++j) {
      const float* other = &normals_[4 * static_cast<std::size_t>(row[j])];
      if (!std::isfinite(other[0])) continue;
      around.add(other, 1.F);
      used += 1.F;
    }
    if (used > 0.F) out.around = around.length() / used;
    out.nearest_on_line = isOneLine(planes[NEAREST].at(r));
    const Plane wide = planes[WIDE].at(r);
    out.few = varianceOf(planes[NEAR].at(r));
    out.variance = std::min({varianceOf(planes[NEAREST].at(r)), out.few, varianceOf(wide)});
    if (only_many_show_noise_ && wide.valid) out.few = out.variance = varianceOf(wide);
    if (wide.valid) {
      out.agreement = std::min(1.F, std::fabs(dot(wide.normal.data(), n)));
      addPlane(wide, out);
    }
    return out;
  }

  void addWidest(Room& room) const {
    const std::size_t count = room.asking.size();
    room.wider.reset(count, kWidest + 1, false);
    room.asking_at.resize(4 * count);
    for (std::size_t a = 0; a < count; ++a) {
      const std::size_t i = room.leans[room.asking[a]].i;
      std::copy_n(points_[i], 3, &room.asking_at[4 * a]);
      room.wider.setCount(a, more_.nearest(i, kWidest + 1, room.wider.mutableIndices(a)));
    }
    GrownPlanes& planes = room.planes[WIDE];
    fitGrownPlanes(jobOf({room.asking_at.data(), 4, count}, xyz_, room.wider, kWidest), &kWidest, 1,
                   0, count, &planes);
    for (std::size_t a = 0; a < count; ++a) {
      const Plane widest = planes.at(a);
      Lean& of_point = room.leans[room.asking[a]];
      of_point.variance = std::min(of_point.variance, varianceOf(widest));
      of_point.noisy_line = isOneLine(widest) && !of_point.nearest_on_line;
      addPlane(widest, of_point);
    }
  }

  void finishLean(Lean& of_point) {
    const std::size_t i = of_point.i;
    const float h = meanDistance(points_, nb_, i, kFirstRing);
    if (!(h > 0.F)) return;
    tolerance_[i] =
        h * h * kOffset * kOffset + (std::isfinite(of_point.variance) ? of_point.variance : 0.F);
    if (!scaleToUnit(of_point.mean)) return;
    doubt_[i] = kLeast * kLeast + scatterOf(of_point.agreement) +
                0.25F * scatterOf(of_point.around) + (of_point.noisy_line ? kAtWill : 0.F);
    lean(toward(i), doubt_[i], of_point.mean);
    if (scaleToUnit(of_point.mean)) store(of_point.mean, &leaned_[4 * i]);
  }

  static float varianceOf(const Plane& plane) {
    return plane.valid ? std::max(0.F, plane.lambda[0]) : std::numeric_limits<float>::infinity();
  }

  // Through one line, as a ring is, there are many planes.
  static bool isOneLine(const Plane& plane) {
    return plane.valid && !(plane.lambda[1] > kOneLine * plane.lambda[2]);
  }

  // Flat planes that leave no more than few neighbours do count as much as the normal itself.
  void addPlane(const Plane& plane, Lean& to) const {
    if (!plane.valid || isOneLine(plane)) return;
    const float across = plane.lambda[0];
    const float same = across > kSameNoise * to.few ? kSameNoise * to.few / across : 1.F;
    const float weight = same / (1.F + across / (kFlat * plane.lambda[1]));
    const float* p = plane.normal.data();
    to.mean.add(p, dot(p, toward(to.i)) < 0.F ? -weight : weight);
  }

  // Of the variances around, which are more than noise where planes are of two faces, the least.
  float noiseAround(std::size_t i, int count) const {
    const pcl::index_t* row = nb_.indices(i);
    float least = std::numeric_limits<float>::infinity();
    for (int j = 0; j < count; ++j) {
      const float t = tolerance_[static_cast<std::size_t>(row[j])];
      if (t > 0.F) least = std::min(least, t);
    }
    return least;
  }

  // What the neighbours say that the point lies in the plane of, the surer ones more, in the second
  // round: together as much as it says itself.
  void followAround(std::size_t i) {
    const pcl::index_t* row = nb_.indices(i);
    const int count = std::min(nb_.count(i), kNear + 1);
    const float* p = points_[i];
    const float scale = 0.5F / noiseAround(i, count);
    Vector around;
    float total = 0.F;
    for (int j = 1; j < count; ++j) {
      const auto q = static_cast<std::size_t>(row[j]);
      const float* n = &leaned_[4 * q];
      if (!std::isfinite(n[0])) continue;
      const float* at = points_[q];
      const float off = (at[0] - p[0]) * n[0] + (at[1] - p[1]) * n[1] + (at[2] - p[2]) * n[2];
      const float weight = std::exp(-scale * off * off) / std::sqrt(doubt_[q]);
      around.add(n, weight);
      total += weight;
    }
    Vector mean;
    mean.add(&leaned_[4 * i], 1.F);
    float square = kLeast * kLeast;
    if (total > 1e-9F) {
      const float length = around.length() / total;
      square += scatterOf(length);
      const float* sum = &around.x;
      mean.add(sum, 1.F / total);
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
  const FourFloats xyz_;
  const Neighborhoods& nb_;
  const std::vector<float>& toward_;
  const std::vector<std::uint8_t>& sure_;
  const bool only_many_show_noise_;
  int threads_;
  std::vector<float>& normals_;
  std::vector<float> leaned_;
  std::vector<float> tolerance_;  // squares of distances; 0 = not measured
  std::vector<float> doubt_;      // squares of angles, known roughly: weights are of the angles
};

}  // namespace

void leanToSensors(MoreNeighbors& more, const Neighborhoods& neighborhoods,
                   const std::vector<float>& toward, const std::vector<std::uint8_t>& sure,
                   bool only_many_show_noise, int threads, std::vector<float>& normals) {
  Leaner(more, neighborhoods, toward, sure, only_many_show_noise, threads, normals).run();
}

}  // namespace segorient::detail
