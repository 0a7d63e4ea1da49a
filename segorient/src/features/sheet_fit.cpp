// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "features/sheet_fit.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "common/vectors.h"
#include "common/widest.h"
#include "features/symmetric_eigen.h"

namespace segorient::detail {
namespace {

// Nearest neighbours, two of which make a plane through the point: its own face holds several.
constexpr int kTriples = 12;
// Planes of these and the one to begin with, in whole registers.
constexpr std::size_t kMostPlanes = 80;
static_assert(kMostPlanes % 16 == 0 && kMostPlanes > kTriples * (kTriples - 1) / 2);

// Planes through a point, and its neighbours.
struct SupportedPlanes {
  const float *offset_x, *offset_y, *offset_z, *weight;  // kSheetNeighbors
  float inverse_tolerance;
  float x[kMostPlanes], y[kMostPlanes], z[kMostPlanes];  // unit normals
  std::size_t count;

  void add(const Eigen::Vector3f& n) {
    x[count] = n.x();
    y[count] = n.y();
    z[count] = n.z();
    ++count;
  }
};

#define SEGORIENT_KERNELS "features/support_lanes.inl"
#include "common/each_width.inl"
#undef SEGORIENT_KERNELS

// The plane that most of the neighbourhood lies on: what a neighbour counts for falls smoothly to 0
// at the tolerance.
Eigen::Vector3f bestSupported(const Offsets& o, const Eigen::Vector3f& start, float tolerance) {
  constexpr float kLeastSine2 = 0.1F;  // thinner triangles say little about a plane
  SupportedPlanes planes{};
  planes.offset_x = o.x.data();
  planes.offset_y = o.y.data();
  planes.offset_z = o.z.data();
  planes.weight = o.weight.data();
  planes.inverse_tolerance = 1.F / tolerance;
  planes.add(start);
  const int m = std::min(o.n, kTriples);
  for (int a = 0; a < m; ++a) {
    const auto i = static_cast<std::size_t>(a);
    const Eigen::Vector3f da(o.x[i], o.y[i], o.z[i]);
    for (int b = a + 1; b < m; ++b) {
      const auto j = static_cast<std::size_t>(b);
      const Eigen::Vector3f db(o.x[j], o.y[j], o.z[j]);
      const Eigen::Vector3f n = da.cross(db);
      const float l2 = n.squaredNorm();
      if (l2 > kLeastSine2 * da.squaredNorm() * db.squaredNorm()) planes.add(n / std::sqrt(l2));
    }
  }
  std::array<float, kMostPlanes> support;
  SEGORIENT_WIDEST(supportPlanes)(planes, support.data());
  const auto* const best = std::max_element(support.data(), support.data() + planes.count);
  const auto at = static_cast<std::size_t>(best - support.data());
  return {planes.x[at], planes.y[at], planes.z[at]};
}

SymmetricMatrix3 covarianceOf(const Moments& m, double mx, double my, double mz) {
  const double w = 1.0 / static_cast<double>(m.n);
  return {static_cast<double>(m.xx) * w - mx * mx, static_cast<double>(m.xy) * w - mx * my,
          static_cast<double>(m.xz) * w - mx * mz, static_cast<double>(m.yy) * w - my * my,
          static_cast<double>(m.yz) * w - my * mz, static_cast<double>(m.zz) * w - mz * mz};
}

// The smallest root of the characteristic polynomial: from 0, Newton's method climbs to it without
// passing it, in few steps where it is well below the others, as it is for a plane.
double smallestEigenvalue(double trace, double minors, double determinant) {
  // Newton's method doubles the digits each time once it is near.
  constexpr int kSteps = 12;
  double x = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const double value = ((x - trace) * x + minors) * x - determinant;
    const double slope = (3.0 * x - 2.0 * trace) * x + minors;
    if (!(slope > 0.0)) break;
    const double step = value / slope;
    x -= step;
    if (!(std::fabs(step) > 1e-9 * trace)) break;
  }
  return std::max(x, 0.0);
}

// Of a set of offsets.
struct Spectrum {
  Eigen::Vector3d mean;
  SymmetricMatrix3 covariance;
  double trace, minors, smallest;

  // Ascending.
  Eigen::Vector3f variances() const {
    const double rest = trace - smallest;
    const double root = std::sqrt(std::max(0.0, rest * rest - 4.0 * (minors - smallest * rest)));
    return Eigen::Vector3d(smallest, 0.5 * (rest - root), 0.5 * (rest + root)).cast<float>();
  }
};

// \return false for fewer than 3 points
bool findSpectrum(const Moments& m, Spectrum& s) {
  if (m.n < 3.F) return false;
  const double w = 1.0 / static_cast<double>(m.n);
  s.mean = Eigen::Vector3d(static_cast<double>(m.x) * w, static_cast<double>(m.y) * w,
                           static_cast<double>(m.z) * w);
  const SymmetricMatrix3 c = covarianceOf(m, s.mean[0], s.mean[1], s.mean[2]);
  s.covariance = c;
  s.trace = c.xx + c.yy + c.zz;
  const double yz = c.yy * c.zz - c.yz * c.yz;
  s.minors = c.xx * (c.yy + c.zz) - c.xy * c.xy - c.xz * c.xz + yz;
  const double determinant =
      c.xx * yz + c.xy * (c.yz * c.xz - c.xy * c.zz) + c.xz * (c.xy * c.yz - c.yy * c.xz);
  s.smallest = smallestEigenvalue(s.trace, s.minors, determinant);
  return true;
}

// The longest row of the adjugate of c - x: all of them are multiples of the eigenvector.
Eigen::Vector3d eigenvector(const SymmetricMatrix3& c, double x) {
  const Eigen::Vector3d r0(c.xx - x, c.xy, c.xz);
  const Eigen::Vector3d r1(c.xy, c.yy - x, c.yz);
  const Eigen::Vector3d r2(c.xz, c.yz, c.zz - x);
  Eigen::Vector3d best = r0.cross(r1);
  for (const Eigen::Vector3d& v : {Eigen::Vector3d(r0.cross(r2)), Eigen::Vector3d(r1.cross(r2))}) {
    if (v.squaredNorm() > best.squaredNorm()) best = v;
  }
  return best;
}

// Slower, and good for eigenvalues that meet.
void decompose(const SymmetricMatrix3& c, Plane& plane) {
  Eigen::Matrix3d m;
  m << c.xx, c.xy, c.xz, c.xy, c.yy, c.yz, c.xz, c.yz, c.zz;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(m);
  plane.lambda = solver.eigenvalues().cwiseMax(0.0).cast<float>();
  plane.normal = solver.eigenvectors().col(0).cast<float>();
}

}  // namespace

Plane fitPlane(const Moments& m) {
  Plane plane;
  Spectrum s;
  if (!findSpectrum(m, s)) return plane;
  plane.mean = s.mean.cast<float>();
  if (!(s.trace > 0.0) || !std::isfinite(s.trace)) return plane;
  const Eigen::Vector3d normal = eigenvector(s.covariance, s.smallest);
  const double length = normal.norm();
  if (length > 1e-4 * s.trace * s.trace) {
    plane.lambda = s.variances();
    plane.normal = (normal / length).cast<float>();
  } else {
    decompose(s.covariance, plane);
  }
  plane.valid = spansTwo(plane.lambda) && plane.normal.allFinite();
  return plane;
}

double meanDistance(const float* from, const PointView& points, const pcl::index_t* others, int n) {
  double sum = 0.0;  // in double: squares of far or tiny offsets leave the range of float
  for (int j = 0; j < n; ++j) {
    const float* q = points[static_cast<std::size_t>(others[j])];
    double square = 0.0;
    for (int a = 0; a < 3; ++a) {
      const double d = static_cast<double>(q[a]) - static_cast<double>(from[a]);
      square += d * d;
    }
    sum += std::sqrt(square);
  }
  return n > 0 ? sum / n : 0.0;
}

float meanDistance(const PointView& points, const Neighborhoods& nb, std::size_t i, int k) {
  return meanDistance(points, i, nb.indices(i) + 1, std::min(nb.count(i) - 1, k));
}

Offsets gatherOffsets(const PointView& points, const Neighborhoods& nb, std::size_t i,
                      float spacing) {
  Offsets o;
  o.n = std::clamp(nb.count(i) - 1, 0, kSheetNeighbors);
  const pcl::index_t* row = nb.indices(i);
  const float* p = points[i];
  const float s = spacing > 0.F ? 1.F / spacing : 0.F;
  for (int j = 0; j < kSheetNeighbors; ++j) {
    const auto k = static_cast<std::size_t>(j);
    if (j < o.n) {
      const float* q = points[static_cast<std::size_t>(row[j + 1])];
      o.x[k] = (q[0] - p[0]) * s;
      o.y[k] = (q[1] - p[1]) * s;
      o.z[k] = (q[2] - p[2]) * s;
      o.weight[k] = 1.F - 0.5F * static_cast<float>(j) / static_cast<float>(kSheetNeighbors);
    } else {
      o.x[k] = o.y[k] = o.z[k] = o.weight[k] = 0.F;
    }
  }
  return o;
}

Moments momentsOf(const Offsets& o, int k) {
  Moments m;
  m.addOrigin();
  for (std::size_t j = 0; j < static_cast<std::size_t>(std::min(k, o.n)); ++j) {
    m.add(o.x[j], o.y[j], o.z[j]);
  }
  return m;
}

Plane fitDominant(const Offsets& o, const Plane& start, float tolerance) {
  Eigen::Vector3f normal = bestSupported(o, start.normal, tolerance);
  Plane plane;
  for (int round = 0; round < 2; ++round) {
    Moments m;
    m.addOrigin();
    for (std::size_t j = 0; j < static_cast<std::size_t>(o.n); ++j) {
      if (std::fabs(o.along(j, normal)) < tolerance) m.add(o.x[j], o.y[j], o.z[j]);
    }
    const Plane refined = fitPlane(m);
    // Few points, or a sliver of them, have no plane of their own.
    if (!refined.valid || m.n < 5.F || refined.lambda[1] < 0.02F * refined.lambda[2]) break;
    plane = refined;
    normal = plane.normal;
  }
  return plane;
}

}  // namespace segorient::detail
