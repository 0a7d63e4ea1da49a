// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <segorient/common/median.h>
#include <segorient/features/automatic_normals.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iomanip>
#include <limits>
#include <sstream>

#include "local_fit_job.h"

namespace segorient {
namespace {

// Neighbourhoods of the quadratic surfaces that are tried.
constexpr std::array<int, 6> kSizes{10, 16, 24, 32, 48, kMostAutomaticNeighbors};
// The noise is what is left of quadratic surfaces through the fewest neighbours that leave
// anything: larger ones take what the surface bends beyond a quadratic for noise.
constexpr int kNoiseNeighbors = 8;
// Median of a standard deviation estimated with as much freedom as they have (3).
constexpr double kMedianShare = 0.888;
// A residual is taken for noise up to this many of its own standard deviations.
constexpr double kTolerance = 2.5;
// Least noise, in spacings: less cannot be told from what a quadratic leaves of a smooth surface.
constexpr double kLeastNoise = 0.01;
// Up to this noise the smallest neighbourhood is the best one wherever it fits.
constexpr double kCleanNoise = 0.03;
// Up to this noise local triangulations beat small surfaces at edges.
constexpr double kTriangulationNoise = 0.1;
// Smallest neighbourhood beyond that.
constexpr int kSmallestNoisy = 16;
constexpr int kTriangulationNeighbors = 12;
// Up to this noise cubic surfaces, which can bend at an edge, beat quadratic ones there.
constexpr double kCubicNoise = 0.35;
// Neighbourhoods of cubic surfaces, per unit of noise over spacing: they have nearly twice the
// coefficients.
constexpr double kCubicPerNoise = 150.0;
// A cubic surface is the better one where it leaves so much less than a quadratic one does, in
// standard deviations: noise alone makes one point in eight look so (F test). They are taken where
// most points look so: what fits nothing on scans without edges are stray points, and they bend
// cubic surfaces most.
constexpr double kBetter = 0.9;
// Near edges, where a plane fits a few neighbours as well as noise lets it, they are all on one
// side.
constexpr int kPlaneNeighbors = 6;
// Neighbourhoods that are worth trying, per unit of noise over spacing. Noise turns the normals of
// k neighbours by about noise / (spacing k): with 400 it has sunk to a fraction of a degree, below
// 90 it is several degrees, more than what the larger neighbourhood costs at an edge.
constexpr double kLargestPerNoise = 400.0;
constexpr double kSmallestPerNoise = 90.0;
// Beyond this noise a few neighbours are a ball of points, whose residual hardly grows with the
// noise and says nothing of the surface: then only the largest neighbourhood is left.
constexpr double kSaturatedNoise = 0.45;
// Points that the noise is estimated from.
constexpr std::size_t kSamples = 4000;

double spacingAt(const PointView& points, const Neighborhoods& table, std::size_t row) {
  const int count = std::min(table.count(row), 7);
  double sum = 0;
  for (int j = 1; j < count; ++j) {
    const float* p = points[row];
    const float* q = points[static_cast<std::size_t>(table.indices(row)[j])];
    double squares = 0;
    for (int a = 0; a < 3; ++a) {
      const double d = static_cast<double>(p[a]) - static_cast<double>(q[a]);
      squares += d * d;
    }
    sum += std::sqrt(squares);
  }
  return count > 1 ? sum / (count - 1) : 0.0;
}

/// Surfaces of one size.
struct Surfaces {
  NormalEstimator estimator = NormalEstimator::AwASQuadratic;
  std::vector<float> normals;
  std::vector<float> residuals;

  void fit(const PointView& points, const Neighborhoods& table, int k, int threads,
           const std::vector<pcl::index_t>& rows) {
    LocalNormalOptions options;
    options.estimator = estimator;
    options.k = k;
    options.threads = threads;
    normals.resize(4 * points.size);
    residuals.resize(points.size);
    detail::estimateNormals(points, points, table, options, normals.data(), nullptr,
                            residuals.data(), &rows);
  }
};

/// The sizes to try, largest first.
std::vector<int> sizesFor(double noise, int available) {
  std::vector<int> sizes;
  const bool clean = noise < kCleanNoise;
  const double largest = clean ? kSizes.front() : kLargestPerNoise * noise;
  const double least = noise < kTriangulationNoise ? kSizes.front() : kSmallestNoisy;
  const double smallest = std::max(least, kSmallestPerNoise * noise);
  for (std::size_t s = kSizes.size(); s-- > 0;) {
    const bool enough = s > 0 && !sizes.empty() && kSizes[s] < smallest;
    if (enough) break;
    if (s == 0 || (kSizes[s] <= largest && kSizes[s] <= available)) sizes.push_back(kSizes[s]);
  }
  if (sizes.size() > 1 && sizes.back() < smallest) sizes.pop_back();
  if (noise > kSaturatedNoise) sizes.resize(1);
  return sizes;
}

// Standard deviation of the nearest neighbours, the point itself among them, from their plane.
double planeResidual(const PointView& points, const Neighborhoods& table, std::size_t row,
                     const float* normal) {
  const int count = std::min(table.count(row), kPlaneNeighbors + 1);
  const float* origin = points[row];
  double sum = 0;
  double squares = 0;
  for (int j = 0; j < count; ++j) {
    const float* p = points[static_cast<std::size_t>(table.indices(row)[j])];
    double offset = 0;
    for (int a = 0; a < 3; ++a) {
      offset += (static_cast<double>(p[a]) - static_cast<double>(origin[a])) *
                static_cast<double>(normal[a]);
    }
    sum += offset;
    squares += offset * offset;
  }
  if (count < 4) return std::numeric_limits<double>::infinity();
  return std::sqrt(std::max(0.0, squares - sum * sum / count) / (count - 3));
}

struct Noise {
  double length = 0.0;  ///< standard deviation
  double in_spacings = 0.0;
};

/// Medians over a sample: edges and creases, where surfaces do not fit, are the minority.
Noise sampleNoise(const PointView& points, const Neighborhoods& neighborhoods, int threads) {
  if (points.size < kSmallestNoisy || neighborhoods.size() != points.size) return {};
  std::vector<pcl::index_t> rows;
  const std::size_t step = std::max<std::size_t>(1, points.size / kSamples);
  for (std::size_t i = 0; i < points.size; i += step) rows.push_back(static_cast<pcl::index_t>(i));
  Surfaces surfaces;
  surfaces.fit(points, neighborhoods, kNoiseNeighbors, threads, rows);
  std::vector<float> lengths;
  std::vector<float> ratios;
  for (const pcl::index_t r : rows) {
    const auto row = static_cast<std::size_t>(r);
    const float length = surfaces.residuals[row];
    const auto ratio =
        static_cast<float>(static_cast<double>(length) / spacingAt(points, neighborhoods, row));
    if (!std::isfinite(ratio)) continue;
    lengths.push_back(length);
    ratios.push_back(ratio);
  }
  return {static_cast<double>(median(std::move(lengths))) / kMedianShare,
          static_cast<double>(median(std::move(ratios))) / kMedianShare};
}

/// Whether noise explains what a surface leaves of a neighbourhood: its standard deviation, with
/// the scatter of such estimates.
class Explained {
 public:
  /// \param freedom points less coefficients
  Explained(const PointView& points, const Neighborhoods& table, double noise, int freedom)
      : points_(points),
        table_(table),
        noise_(noise),
        scatter_(1.0 + kTolerance / std::sqrt(2.0 * freedom)) {}

  bool operator()(std::size_t row, double residual) const {
    const double least = kLeastNoise * spacingAt(points_, table_, row);
    return residual <= scatter_ * std::max(noise_, least);
  }

 private:
  const PointView& points_;
  const Neighborhoods& table_;
  double noise_;
  double scatter_;
};

/// \param residual of a row's fit
/// \return the rows whose residual noise does not explain
template <typename Residual>
std::vector<pcl::index_t> unexplained(const std::vector<pcl::index_t>& rows,
                                      const Explained& explained, Residual residual) {
  std::vector<pcl::index_t> left;
  for (const pcl::index_t r : rows) {
    const auto row = static_cast<std::size_t>(r);
    if (!explained(row, static_cast<double>(residual(row)))) left.push_back(r);
  }
  return left;
}

/// Gives the rows that a plane fits its normal.
/// \return the others
std::vector<pcl::index_t> takePlanes(const PointView& points, const Neighborhoods& table,
                                     double noise, int threads,
                                     const std::vector<pcl::index_t>& rows, float* normals) {
  LocalNormalOptions options;
  options.k = kPlaneNeighbors;
  options.threads = threads;
  estimateNormals(points, points, table, options, normals, nullptr, &rows);
  const Explained explained(points, table, noise, kPlaneNeighbors + 1 - 3);
  return unexplained(rows, explained, [&](std::size_t row) {
    return planeResidual(points, table, row, normals + 4 * row);
  });
}

/// The neighbourhood of cubic surfaces for so much noise, or 0.
int cubicSize(double noise, int available) {
  if (noise < kTriangulationNoise || noise > kCubicNoise) return 0;
  for (const int k : kSizes) {
    if (k >= 24 && k >= kCubicPerNoise * noise) return k <= available ? k : 0;
  }
  return 0;
}

/// Gives the rows the normals of cubic surfaces, if these fit most of them better.
/// \return whether they do
bool takeCubics(const PointView& points, const Neighborhoods& table, int k, int threads,
                const std::vector<pcl::index_t>& rows, float* normals) {
  Surfaces quadratics;
  Surfaces cubics;
  cubics.estimator = NormalEstimator::AwASCubic;
  quadratics.fit(points, table, k, threads, rows);
  cubics.fit(points, table, k, threads, rows);
  const auto better = std::count_if(rows.begin(), rows.end(), [&](pcl::index_t r) {
    const auto row = static_cast<std::size_t>(r);
    return static_cast<double>(cubics.residuals[row]) <
           kBetter * static_cast<double>(quadratics.residuals[row]);
  });
  if (2 * static_cast<std::size_t>(better) <= rows.size()) return false;
  for (const pcl::index_t r : rows) {
    const std::size_t at = 4 * static_cast<std::size_t>(r);
    std::copy_n(&cubics.normals[at], 4, normals + at);
  }
  return true;
}

AutomaticNormalReport estimateByNoise(const PointView& points, const Neighborhoods& neighborhoods,
                                      const Noise& estimate, int threads, float* normals) {
  AutomaticNormalReport report;
  report.noise = static_cast<float>(estimate.in_spacings);
  const double noise = std::max(kLeastNoise, estimate.in_spacings);
  std::vector<pcl::index_t> open(neighborhoods.size());
  for (std::size_t i = 0; i < open.size(); ++i) open[i] = static_cast<pcl::index_t>(i);
  Surfaces surfaces;
  for (const int k : sizesFor(noise, neighborhoods.k() - 1)) {
    surfaces.fit(points, neighborhoods, k, threads, open);
    const Explained explained(points, neighborhoods, estimate.length, k + 1 - 6);
    for (const pcl::index_t o : open) {
      const auto i = static_cast<std::size_t>(o);
      std::copy_n(&surfaces.normals[4 * i], 4, normals + 4 * i);
    }
    std::vector<pcl::index_t> left =
        unexplained(open, explained, [&](std::size_t row) { return surfaces.residuals[row]; });
    report.surfaces.emplace_back(k, open.size() - left.size());
    open.swap(left);
    report.edge_k = k;
  }
  report.at_edges = open.size();
  report.triangulated = noise < kTriangulationNoise;
  if (report.triangulated) {
    open = takePlanes(points, neighborhoods, estimate.length, threads, open, normals);
    report.planes = report.at_edges - open.size();
    LocalNormalOptions options;
    options.threads = threads;
    options.estimator = NormalEstimator::LDT;
    options.k = report.edge_k = kTriangulationNeighbors;
    estimateNormals(points, points, neighborhoods, options, normals, nullptr, &open);
  }
  const int cubic_k = cubicSize(noise, neighborhoods.k() - 1);
  if (cubic_k > 0 && takeCubics(points, neighborhoods, cubic_k, threads, open, normals)) {
    report.cubic = true;
    report.edge_k = cubic_k;
  }
  for (std::size_t i = 0; i < neighborhoods.size(); ++i) {
    report.undefined += isFinite(normals + 4 * i) ? 0 : 1;
  }
  return report;
}

}  // namespace

float estimateNoise(const PointView& points, const Neighborhoods& neighborhoods, int threads) {
  return static_cast<float>(sampleNoise(points, neighborhoods, threads).in_spacings);
}

AutomaticNormalReport estimateNormalsAutomatically(const PointView& points,
                                                   const Neighborhoods& neighborhoods, int threads,
                                                   float* normals) {
  const Noise noise = sampleNoise(points, neighborhoods, threads);
  return estimateByNoise(points, neighborhoods, noise, threads, normals);
}

AutomaticNormalReport estimateNormalsAutomatically(const PointView& points,
                                                   const search::MedianHashIndex& index,
                                                   const Neighborhoods& neighborhoods, int threads,
                                                   float* normals) {
  const Noise noise = sampleNoise(points, neighborhoods, threads);
  const std::vector<int> sizes =
      sizesFor(std::max(kLeastNoise, noise.in_spacings), kMostAutomaticNeighbors);
  const int wanted = std::max(sizes.front(), kTriangulationNeighbors);
  const bool all = static_cast<std::size_t>(neighborhoods.k()) >= points.size;
  if (all || neighborhoods.k() > wanted) {
    return estimateByNoise(points, neighborhoods, noise, threads, normals);
  }
  // The nearest of each point, which the noise comes from, are the same.
  Neighborhoods wider;
  index.nearestKAll(wanted + 1, wider, false);
  return estimateByNoise(points, wider, noise, threads, normals);
}

std::string AutomaticNormalReport::text() const {
  std::ostringstream out;
  out << "noise " << std::setprecision(2) << noise << " of the spacing";
  for (const auto& [k, count] : surfaces) {
    out << ", " << count << " points by quadratic surfaces of " << k << " neighbours";
  }
  out << ", " << at_edges << " that none of these fits, as at edges, ";
  if (planes > 0)
    out << planes << " of them by planes of " << kPlaneNeighbors << " and the others ";
  const char* others = cubic ? "cubic surfaces" : "quadratic surfaces";
  out << "by " << (triangulated ? "local Delaunay triangulation" : others) << " of " << edge_k;
  if (undefined > 0) out << ", " << undefined << " without a normal";
  return out.str();
}

}  // namespace segorient
