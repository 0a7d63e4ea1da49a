// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "features/automatic_normals.h"

#include <algorithm>
#include <iomanip>
#include <limits>
#include <numeric>
#include <sstream>
#include <utility>

#include "features/cloud_noise.h"
#include "features/surface_sizes.h"

namespace segorient {
namespace {

using detail::CloudNoise;
using detail::cubicSize;
using detail::Explained;
using detail::kCubicNeighbors;
using detail::kTriangulationNeighbors;
using detail::Surfaces;

// A cubic surface is the better one where it leaves so much less than a quadratic one does, in
// standard deviations: noise alone makes one point in eight look so (F test). They are taken where
// most points look so: what fits nothing on scans without edges are stray points, and they bend
// cubic surfaces most.
constexpr double kBetter = 0.9;
// Without noise, a quadratic surface that leaves less than this share of what a plane leaves has
// found a bend, even a sharp one: of an edge through the middle it leaves a quarter.
constexpr double kBend = 0.2;
// Cubic surfaces that leave less than this share of what quadratic ones do of most points have
// found the next term of a series: noise alone makes one point in seven look so (F test).
constexpr double kNextTerm = 0.5;
// Near edges, where a plane fits a few neighbours as well as noise lets it, they are all on one
// side.
constexpr int kPlaneNeighbors = 6;

std::vector<pcl::index_t> allRows(std::size_t size) {
  std::vector<pcl::index_t> rows(size);
  std::iota(rows.begin(), rows.end(), 0);
  return rows;
}

/// The estimation of one cloud, step by step: each leaves fewer points open.
class Estimation {
 public:
  Estimation(const PointView& points, const Neighborhoods& table, const CloudNoise& noise,
             const AutomaticNormalTraits* known, int threads, float* normals,
             const std::vector<pcl::index_t>* rows)
      : points_(points),
        table_(table),
        known_(known),
        noise_(noise.length),
        in_spacings_(std::max(detail::kLeastNoise, noise.in_spacings)),
        threads_(threads),
        normals_(normals),
        rows_(rows != nullptr ? *rows : allRows(table.size())),
        open_(rows_) {
    report_.noise = static_cast<float>(noise.in_spacings);
    report_.traits.noise = noise.length;
    report_.traits.in_spacings = noise.in_spacings;
  }

  AutomaticNormalReport run(std::vector<pcl::index_t>* unexplained) {
    takeQuadratics();
    if (unexplained != nullptr) *unexplained = open_;
    if (detail::isClean(in_spacings_)) {
      keepEdges();
      if (isAnalytic()) takeCubics();
    }
    report_.traits.analytic = report_.analytic;
    report_.at_edges = open_.size();
    report_.triangulated = detail::fewTell(in_spacings_);
    if (report_.triangulated) {
      takePlanes();
      triangulate();
    } else {
      takeCubicsAtEdges();
    }
    for (const pcl::index_t r : rows_) {
      report_.undefined += isFinite(normals_ + 4 * static_cast<std::size_t>(r)) ? 0 : 1;
    }
    return report_;
  }

 private:
  int available() const { return table_.k() - 1; }
  float* normalOf(pcl::index_t row) const { return normals_ + 4 * static_cast<std::size_t>(row); }

  /// Closes the points that a condition holds for. \return how many
  template <typename Condition>
  std::size_t close(const Condition& condition) {
    const auto left = std::remove_if(open_.begin(), open_.end(), [&](pcl::index_t r) {
      return condition(static_cast<std::size_t>(r));
    });
    const auto closed = static_cast<std::size_t>(open_.end() - left);
    open_.erase(left, open_.end());
    return closed;
  }

  /// Closes the points whose residuals noise explains. \return how many
  template <typename Residual>
  std::size_t closeExplained(int freedom, const Residual& residual) {
    const Explained explained(points_, table_, noise_, freedom);
    return close(
        [&](std::size_t row) { return explained(row, static_cast<double>(residual(row))); });
  }

  void takeQuadratics() {
    for (const int k : detail::quadraticSizes(in_spacings_, available())) {
      quadratics_.fitInto(normals_, points_, table_, k, threads_, open_);
      report_.surfaces.emplace_back(
          k, closeExplained(k + 1 - 6, [&](std::size_t i) { return quadratics_.residuals[i]; }));
      report_.edge_k = k;
    }
  }

  /// Leaves open only what looks like an edge: where points are few for how much the surface bends,
  /// the quadratic surfaces are the best there is.
  void keepEdges() {
    // Planes take the quadratic surfaces' place for a moment: an array of their own would be as
    // long as the cloud.
    std::vector<float> quadratic(4 * open_.size());
    for (std::size_t o = 0; o < open_.size(); ++o)
      std::copy_n(normalOf(open_[o]), 4, &quadratic[4 * o]);
    LocalNormalOptions options;
    options.k = report_.edge_k;
    options.threads = threads_;
    estimateNormals(points_, points_, table_, options, normals_, nullptr, &open_);
    const std::vector<pcl::index_t> rows = open_;
    report_.surfaces.back().second += close([&](std::size_t row) {
      const double plane =
          detail::planeResidual(points_, table_, row, options.k, normals_ + 4 * row);
      return static_cast<double>(quadratics_.residuals[row]) < kBend * plane;
    });
    for (std::size_t r = 0; r < rows.size(); ++r)
      std::copy_n(&quadratic[4 * r], 4, normalOf(rows[r]));
  }

  /// Whether cubic surfaces leave less than a share of what quadratic ones do of most rows.
  /// \param cubic what the cubic surface of rows[r] leaves, by r
  template <typename Residual>
  bool areCubic(const std::vector<pcl::index_t>& rows, const Residual& cubic, double share) const {
    std::size_t nearer = 0;
    for (std::size_t r = 0; r < rows.size(); ++r) {
      const float quadratic = quadratics_.residuals[static_cast<std::size_t>(rows[r])];
      const bool less = static_cast<double>(cubic(r)) < share * static_cast<double>(quadratic);
      nearer += less ? 1 : 0;
    }
    return 2 * nearer > rows.size();
  }

  /// Whether the cloud is of a surface without noise and smooth nearly everywhere, as a formula
  /// makes it: then what quadratic surfaces leave is the next term of its series.
  bool isAnalytic() {
    if (available() < kCubicNeighbors) return false;
    if (known_ != nullptr) return known_->analytic;
    const std::vector<pcl::index_t> rows = detail::sampleRows(rows_);
    const std::vector<float> cubic = detail::sampleResiduals(
        NormalEstimator::AWAS_CUBIC, points_, table_, kCubicNeighbors, threads_, rows);
    const auto of_row = [&](std::size_t r) { return cubic[r]; };
    return areCubic(rows, of_row, kNextTerm);
  }

  /// Cubic surfaces wherever they leave less than the quadratic ones, and where only they fit.
  void takeCubics() {
    Surfaces cubics(NormalEstimator::AWAS_CUBIC);
    cubics.fit(points_, table_, kCubicNeighbors, threads_, rows_);
    report_.analytic = true;
    const auto nearer = [&](std::size_t i) {
      return cubics.residuals[i] < quadratics_.residuals[i];
    };
    for (const pcl::index_t r : rows_) {
      const auto i = static_cast<std::size_t>(r);
      if (nearer(i)) cubics.copyNormal(i, normals_);
    }
    report_.surfaces.back().second += closeExplained(kCubicNeighbors + 1 - 10, [&](std::size_t i) {
      return nearer(i) ? cubics.residuals[i] : std::numeric_limits<float>::infinity();
    });
  }

  /// Planes where these fit.
  void takePlanes() {
    LocalNormalOptions options;
    options.k = kPlaneNeighbors;
    options.threads = threads_;
    estimateNormals(points_, points_, table_, options, normals_, nullptr, &open_);
    report_.planes = closeExplained(kPlaneNeighbors + 1 - 3, [&](std::size_t row) {
      return detail::planeResidual(points_, table_, row, kPlaneNeighbors, normals_ + 4 * row);
    });
  }

  void triangulate() {
    LocalNormalOptions options;
    options.threads = threads_;
    options.estimator = NormalEstimator::LDT;
    options.k = report_.edge_k = kTriangulationNeighbors;
    estimateNormals(points_, points_, table_, options, normals_, nullptr, &open_);
  }

  /// Cubic surfaces, if these fit most of what is open better.
  void takeCubicsAtEdges() {
    const int k = cubicSize(in_spacings_, available());
    if (k == 0) return;
    Surfaces cubics(NormalEstimator::AWAS_CUBIC);
    quadratics_.fit(points_, table_, k, threads_, open_);
    cubics.fit(points_, table_, k, threads_, open_);
    const auto cubic = [&](std::size_t o) {
      return cubics.residuals[static_cast<std::size_t>(open_[o])];
    };
    const bool better = known_ != nullptr ? known_->cubic_edges : areCubic(open_, cubic, kBetter);
    if (!better) return;
    report_.traits.cubic_edges = true;
    for (const pcl::index_t o : open_) cubics.copyNormal(static_cast<std::size_t>(o), normals_);
    report_.cubic = true;
    report_.edge_k = k;
  }

  const PointView& points_;
  const Neighborhoods& table_;
  const AutomaticNormalTraits* known_;
  double noise_;
  double in_spacings_;
  int threads_;
  float* normals_;
  AutomaticNormalReport report_;
  std::vector<pcl::index_t> rows_;
  std::vector<pcl::index_t> open_;
  Surfaces quadratics_;
};

CloudNoise noiseOf(const PointView& points, const Neighborhoods& neighborhoods, int threads,
                   const AutomaticNormalTraits* known) {
  if (known != nullptr) return {known->noise, known->in_spacings};
  return detail::sampleNoise(points, neighborhoods, threads);
}

int neighborsFor(const CloudNoise& noise) {
  return detail::widestSize(std::max(detail::kLeastNoise, noise.in_spacings));
}

}  // namespace

float estimateNoise(const PointView& points, const Neighborhoods& neighborhoods, int threads) {
  return static_cast<float>(detail::sampleNoise(points, neighborhoods, threads).in_spacings);
}

int automaticNeighbors(const PointView& points, const Neighborhoods& neighborhoods, int threads,
                       const AutomaticNormalTraits* known) {
  return neighborsFor(noiseOf(points, neighborhoods, threads, known));
}

AutomaticNormalReport estimateNormalsAutomatically(const PointView& points,
                                                   const Neighborhoods& neighborhoods, int threads,
                                                   float* normals,
                                                   std::vector<pcl::index_t>* unexplained,
                                                   const std::vector<pcl::index_t>* rows,
                                                   const AutomaticNormalTraits* known) {
  const CloudNoise noise = noiseOf(points, neighborhoods, threads, known);
  return Estimation(points, neighborhoods, noise, known, threads, normals, rows).run(unexplained);
}

AutomaticNormalReport estimateNormalsAutomatically(const PointView& points,
                                                   const search::MedianHashIndex& index,
                                                   const Neighborhoods& neighborhoods, int threads,
                                                   float* normals,
                                                   std::vector<pcl::index_t>* unexplained,
                                                   const std::vector<pcl::index_t>* rows,
                                                   const AutomaticNormalTraits* known) {
  const CloudNoise noise = noiseOf(points, neighborhoods, threads, known);
  const int wanted = neighborsFor(noise);
  const bool all = static_cast<std::size_t>(neighborhoods.k()) >= points.size;
  if (all || neighborhoods.k() > wanted) {
    return Estimation(points, neighborhoods, noise, known, threads, normals, rows).run(unexplained);
  }
  // The nearest of each point, which the noise comes from, are the same.
  Neighborhoods wider;
  index.nearestKAll(wanted + 1, wider, false);
  return Estimation(points, wider, noise, known, threads, normals, rows).run(unexplained);
}

std::string AutomaticNormalReport::text() const {
  std::ostringstream out;
  out << "noise " << std::setprecision(2) << noise << " of the spacing";
  for (const auto& [k, count] : surfaces) {
    out << ", " << count << " points by quadratic surfaces of " << k << " neighbours";
  }
  if (analytic) out << " or cubic ones of " << kCubicNeighbors << " where these fit better";
  out << ", " << at_edges << " that none of these fits, as at edges, ";
  if (planes > 0)
    out << planes << " of them by planes of " << kPlaneNeighbors << " and the others ";
  const char* others = cubic ? "cubic surfaces" : "quadratic surfaces";
  out << "by " << (triangulated ? "local Delaunay triangulation" : others) << " of " << edge_k;
  if (undefined > 0) out << ", " << undefined << " without a normal";
  return out.str();
}

}  // namespace segorient
