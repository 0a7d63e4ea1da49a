// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "features/automatic_normals.h"

#include <algorithm>
#include <cstdint>
#include <iomanip>
#include <limits>
#include <mutex>
#include <numeric>
#include <sstream>
#include <utility>

#include "features/cloud_noise.h"
#include "features/local_fit_job.h"
#include "features/surface_sizes.h"

namespace segorient {
namespace {

using detail::CloudNoise;
using detail::cubicSize;
using detail::Explained;
using detail::kCubicNeighbors;
using detail::kTriangulationNeighbors;
using detail::Surfaces;
using detail::Surroundings;

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

/// Cubic surfaces at what no quadratic one fits.
struct EdgeCubics {
  int k = 0;  ///< neighbours; 0 where there are no such surfaces
  std::vector<pcl::index_t> rows;
  std::vector<float> normals;  ///< 4 a row
  std::size_t nearer = 0;      ///< of the rows: they are clearly nearer than quadratic ones

  /// Takes them, if they fit most of the rows better.
  void takeIfBetter(const AutomaticNormalTraits* known, float* all,
                    AutomaticNormalReport& report) const {
    const bool better = known != nullptr ? known->cubic_edges : 2 * nearer > rows.size();
    if (k == 0 || !better) return;
    for (std::size_t r = 0; r < rows.size(); ++r) {
      std::copy_n(&normals[4 * r], 4, all + 4 * static_cast<std::size_t>(rows[r]));
    }
    report.traits.cubic_edges = true;
    report.cubic = true;
    report.edge_k = k;
  }
};

/// The estimation of one cloud, step by step: each leaves fewer points open.
class Estimation {
 public:
  /// \param normals 4 floats for each row of the table
  Estimation(const Surroundings& surroundings, const CloudNoise& noise,
             const AutomaticNormalTraits* known, int threads, float* normals,
             const std::vector<pcl::index_t>* rows)
      : of_(surroundings),
        known_(known),
        noise_(noise.length),
        in_spacings_(std::max(detail::kLeastNoise, noise.in_spacings)),
        threads_(threads),
        normals_(normals),
        rows_(rows != nullptr ? *rows : allRows(of_.table.size())),
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
    countUndefined();
    return report_;
  }

  /// The first steps of a cloud whose few neighbours tell little, of a part of it.
  AutomaticNormalReport runPart(EdgeCubics& cubics) {
    takeQuadratics();
    report_.at_edges = open_.size();
    countUndefined();
    cubics = cubicsAtEdges();
    return report_;
  }

 private:
  void countUndefined() {
    for (const pcl::index_t r : rows_) {
      report_.undefined += isFinite(normals_ + 4 * static_cast<std::size_t>(r)) ? 0 : 1;
    }
  }

  int available() const { return of_.table.k() - 1; }
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
    const Explained explained(of_, noise_, freedom);
    return close(
        [&](std::size_t row) { return explained(row, static_cast<double>(residual(row))); });
  }

  void takeQuadratics() {
    for (const int k : detail::quadraticSizes(in_spacings_, available())) {
      quadratics_.fitInto(normals_, of_, k, threads_, open_);
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
    estimateNormals(of_.at, of_.points, of_.table, options, normals_, nullptr, &open_);
    const std::vector<pcl::index_t> rows = open_;
    report_.surfaces.back().second += close([&](std::size_t row) {
      const double plane = detail::planeResidual(of_, row, options.k, normals_ + 4 * row);
      return static_cast<double>(quadratics_.residuals[row]) < kBend * plane;
    });
    for (std::size_t r = 0; r < rows.size(); ++r)
      std::copy_n(&quadratic[4 * r], 4, normalOf(rows[r]));
  }

  /// Of how many rows cubic surfaces leave less than a share of what quadratic ones do.
  /// \param cubic what the cubic surface of rows[r] leaves, by r
  template <typename Residual>
  std::size_t countCubic(const std::vector<pcl::index_t>& rows, const Residual& cubic,
                         double share) const {
    std::size_t nearer = 0;
    for (std::size_t r = 0; r < rows.size(); ++r) {
      const float quadratic = quadratics_.residuals[static_cast<std::size_t>(rows[r])];
      const bool less = static_cast<double>(cubic(r)) < share * static_cast<double>(quadratic);
      nearer += less ? 1 : 0;
    }
    return nearer;
  }

  /// Whether the cloud is of a surface without noise and smooth nearly everywhere, as a formula
  /// makes it: then what quadratic surfaces leave is the next term of its series.
  bool isAnalytic() {
    if (available() < kCubicNeighbors) return false;
    if (known_ != nullptr) return known_->analytic;
    const std::vector<pcl::index_t> rows = detail::sampleRows(rows_);
    const std::vector<float> cubic = detail::sampleResiduals(
        NormalEstimator::AWAS_CUBIC, of_.points, of_.table, kCubicNeighbors, threads_, rows);
    const auto of_row = [&](std::size_t r) { return cubic[r]; };
    return 2 * countCubic(rows, of_row, kNextTerm) > rows.size();
  }

  /// Cubic surfaces wherever they leave less than the quadratic ones, and where only they fit.
  void takeCubics() {
    Surfaces cubics(NormalEstimator::AWAS_CUBIC);
    cubics.fit(of_, kCubicNeighbors, threads_, rows_);
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
    estimateNormals(of_.at, of_.points, of_.table, options, normals_, nullptr, &open_);
    report_.planes = closeExplained(kPlaneNeighbors + 1 - 3, [&](std::size_t row) {
      return detail::planeResidual(of_, row, kPlaneNeighbors, normals_ + 4 * row);
    });
  }

  void triangulate() {
    LocalNormalOptions options;
    options.threads = threads_;
    options.estimator = NormalEstimator::LDT;
    options.k = report_.edge_k = kTriangulationNeighbors;
    estimateNormals(of_.at, of_.points, of_.table, options, normals_, nullptr, &open_);
  }

  /// Cubic surfaces at what is open.
  EdgeCubics cubicsAtEdges() {
    EdgeCubics out;
    out.k = cubicSize(in_spacings_, available());
    if (out.k == 0) return out;
    Surfaces cubics(NormalEstimator::AWAS_CUBIC);
    quadratics_.fit(of_, out.k, threads_, open_);
    cubics.fit(of_, out.k, threads_, open_);
    const auto cubic = [&](std::size_t o) {
      return cubics.residuals[static_cast<std::size_t>(open_[o])];
    };
    out.nearer = countCubic(open_, cubic, kBetter);
    out.rows = open_;
    for (const pcl::index_t o : open_) {
      const float* n = &cubics.normals[4 * static_cast<std::size_t>(o)];
      out.normals.insert(out.normals.end(), n, n + 4);
    }
    return out;
  }

  void takeCubicsAtEdges() { cubicsAtEdges().takeIfBetter(known_, normals_, report_); }

  const Surroundings of_;
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

double inSpacings(const CloudNoise& noise) {
  return std::max(detail::kLeastNoise, noise.in_spacings);
}

int neighborsFor(const CloudNoise& noise) {
  return detail::widestSize(inSpacings(noise));
}

/// The estimation of one cloud, part by part: there is no table of so many neighbours of all.
class EstimationByRegion {
 public:
  EstimationByRegion(const PointView& points, const CloudNoise& noise,
                     const AutomaticNormalTraits* known, float* normals,
                     const std::vector<pcl::index_t>* rows)
      : points_(points), noise_(noise), known_(known), normals_(normals) {
    if (rows == nullptr) return;
    wanted_.resize(points.size);
    for (const pcl::index_t row : *rows) wanted_[static_cast<std::size_t>(row)] = 1;
  }

  AutomaticNormalReport run(const search::MedianHashIndex& index,
                            std::vector<pcl::index_t>* unexplained) {
    index.nearestKByRegion(neighborsFor(noise_) + 1,
                           [this](const std::vector<pcl::index_t>& rows,
                                  const Neighborhoods& table) { takeRegion(rows, table); });
    cubics_.takeIfBetter(known_, normals_, report_);
    if (unexplained != nullptr) {
      *unexplained = std::move(cubics_.rows);
      std::sort(unexplained->begin(), unexplained->end());
    }
    return report_;
  }

 private:
  void takeRegion(const std::vector<pcl::index_t>& of_region, const Neighborhoods& table) {
    std::vector<pcl::index_t> rows;
    for (std::size_t i = 0; i < of_region.size(); ++i) {
      if (wanted_.empty() || wanted_[static_cast<std::size_t>(of_region[i])] != 0)
        rows.push_back(static_cast<pcl::index_t>(i));
    }
    if (rows.empty()) return;
    const std::vector<float> at = detail::positionsOf(points_, of_region);
    std::vector<float> normals(at.size());
    const Surroundings of{{at.data(), 4, of_region.size()}, points_, table};
    EdgeCubics cubics;
    const AutomaticNormalReport report =
        Estimation(of, noise_, known_, 1, normals.data(), &rows).runPart(cubics);
    for (const pcl::index_t row : rows) {
      const auto i = static_cast<std::size_t>(row);
      std::copy_n(&normals[4 * i], 4, normals_ + 4 * static_cast<std::size_t>(of_region[i]));
    }
    for (pcl::index_t& row : cubics.rows) row = of_region[static_cast<std::size_t>(row)];
    const std::lock_guard<std::mutex> lock(mutex_);
    add(report);
    cubics_.k = cubics.k;
    cubics_.nearer += cubics.nearer;
    cubics_.rows.insert(cubics_.rows.end(), cubics.rows.begin(), cubics.rows.end());
    cubics_.normals.insert(cubics_.normals.end(), cubics.normals.begin(), cubics.normals.end());
  }

  void add(const AutomaticNormalReport& of_region) {
    if (report_.surfaces.empty()) {
      report_ = of_region;
      return;
    }
    for (std::size_t s = 0; s < report_.surfaces.size(); ++s) {
      report_.surfaces[s].second += of_region.surfaces[s].second;
    }
    report_.at_edges += of_region.at_edges;
    report_.undefined += of_region.undefined;
  }

  const PointView& points_;
  CloudNoise noise_;
  const AutomaticNormalTraits* known_;
  float* normals_;
  std::vector<std::uint8_t> wanted_;  ///< empty = all
  std::mutex mutex_;
  AutomaticNormalReport report_;
  EdgeCubics cubics_;
};

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
  const Surroundings of{points, points, neighborhoods};
  return Estimation(of, noise, known, threads, normals, rows).run(unexplained);
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
    const Surroundings of{points, points, neighborhoods};
    return Estimation(of, noise, known, threads, normals, rows).run(unexplained);
  }
  // Where few neighbours tell something, whole tables of them are small, and steps that look at all
  // points come in between.
  if (!detail::fewTell(inSpacings(noise))) {
    return EstimationByRegion(points, noise, known, normals, rows).run(index, unexplained);
  }
  Neighborhoods wider;
  index.nearestKAll(wanted + 1, wider, false);
  const Surroundings of{points, points, wider};
  return Estimation(of, noise, known, threads, normals, rows).run(unexplained);
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
