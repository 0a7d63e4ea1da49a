// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "features/surface_estimation.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <numeric>
#include <utility>

#include "common/parallel_for.h"
#include "features/across_lines.h"
#include "features/slope_gain.h"
#include "features/spread_planes.h"
#include "features/surface_sizes.h"

namespace segorient::detail {
namespace {

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
// ns a point, see resolveThreads().
constexpr double kTellingTime = 500.0;

std::vector<pcl::index_t> allRows(std::size_t size) {
  std::vector<pcl::index_t> rows(size);
  std::iota(rows.begin(), rows.end(), 0);
  return rows;
}

}  // namespace

void EdgeCubics::takeIfBetter(const AutomaticNormalTraits* known, float* all,
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

SurfaceEstimation::SurfaceEstimation(const Surroundings& surroundings, const CloudNoise& noise,
                                     const AutomaticNormalTraits* known, int threads,
                                     float* normals, const std::vector<pcl::index_t>* rows,
                                     const search::MedianHashIndex* index)
    : of_(surroundings),
      index_(index),
      known_(known),
      noise_(noise.length),
      in_spacings_(std::max(kLeastNoise, noise.in_spacings)),
      threads_(threads),
      normals_(normals),
      rows_(rows != nullptr ? *rows : allRows(of_.table.size())),
      open_(rows_) {
  report_.traits.noise = noise;
  report_.traits.lines =
      known_ != nullptr ? known_->lines : fewTell(in_spacings_) && seesLines(of_);
  // Noise asks for more neighbours than a line has nearby.
  lines_ = report_.traits.lines && fewTell(in_spacings_);
}

// Of the open rows, which of them k neighbours tell a normal of by what was fitted to them: without
// lines all.
void SurfaceEstimation::findTelling(int k, Fitted fitted) {
  if (!lines_) return;
  telling_.resize(of_.table.size());
  parallelFor(open_.size(), threads_, kTellingTime, [&](std::size_t o) {
    const auto row = static_cast<std::size_t>(open_[o]);
    const bool tells = fitted == Fitted::PLANES ? spreads(of_, row, k)
                                                : tellsSlope(of_, row, k, normalOf(open_[o]));
    telling_[row] = tells ? 1 : 0;
  });
}

bool SurfaceEstimation::tells(std::size_t row) const {
  return telling_.empty() || telling_[row] != 0;
}

AutomaticNormalReport SurfaceEstimation::run(std::vector<pcl::index_t>* unexplained) {
  takeQuadratics();
  if (lines_) acrossLines();
  if (unexplained != nullptr) *unexplained = open_;
  if (isClean(in_spacings_)) {
    keepEdges();
    if (isAnalytic()) takeCubics();
  }
  report_.traits.analytic = report_.analytic;
  report_.at_edges = open_.size();
  report_.triangulated = fewTell(in_spacings_);
  if (report_.triangulated) {
    takePlanes();
    triangulate();
  } else {
    cubicsAtEdges().takeIfBetter(known_, normals_, report_);
  }
  countUndefined();
  return report_;
}

AutomaticNormalReport SurfaceEstimation::runPart(EdgeCubics& cubics) {
  takeQuadratics();
  report_.at_edges = open_.size();
  countUndefined();
  cubics = cubicsAtEdges();
  return report_;
}

void SurfaceEstimation::countUndefined() {
  for (const pcl::index_t r : rows_) {
    report_.undefined += isFinite(normals_ + 4 * static_cast<std::size_t>(r)) ? 0 : 1;
  }
}

// Closes the points that a condition holds for. \return how many
template <typename Condition>
std::size_t SurfaceEstimation::close(const Condition& condition) {
  const auto left = std::remove_if(open_.begin(), open_.end(), [&](pcl::index_t r) {
    return condition(static_cast<std::size_t>(r));
  });
  const auto closed = static_cast<std::size_t>(open_.end() - left);
  open_.erase(left, open_.end());
  return closed;
}

// Closes the points whose residuals noise explains, and whose neighbours tell a normal.
// \param k neighbours that something was fitted to \return how many
template <typename Residual>
std::size_t SurfaceEstimation::closeExplained(int k, Fitted fitted, const Residual& residual) {
  const Explained explained(of_, noise_, k, fitted);
  findTelling(k, fitted);
  return close([&](std::size_t row) {
    return explained(row, static_cast<double>(residual(row))) && tells(row);
  });
}

void SurfaceEstimation::takeQuadratics() {
  for (const int k : quadraticSizes(in_spacings_, available())) {
    quadratics_.fitInto(normals_, of_, k, threads_, open_);
    report_.surfaces.emplace_back(k, closeExplained(k, Fitted::QUADRATICS, [&](std::size_t i) {
                                    return quadratics_.residuals[i];
                                  }));
    report_.edge_k = k;
  }
}

// Along lines of a scan, larger surfaces where the smallest tell nothing.
void SurfaceEstimation::acrossLines() {
  std::vector<pcl::index_t> left = takeAcrossLines(of_, index_, open_, noise_, threads_, normals_);
  report_.across = open_.size() - left.size();
  open_ = std::move(left);
}

// Leaves open only what looks like an edge: where points are few for how much the surface bends,
// the quadratic surfaces are the best there is.
void SurfaceEstimation::keepEdges() {
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
    const double plane = planeResidual(of_, row, options.k, normals_ + 4 * row);
    return static_cast<double>(quadratics_.residuals[row]) < kBend * plane && tells(row);
  });
  for (std::size_t r = 0; r < rows.size(); ++r)
    std::copy_n(&quadratic[4 * r], 4, normalOf(rows[r]));
}

// Of how many rows cubic surfaces leave less than a share of what quadratic ones do.
// \param cubic what the cubic surface of rows[r] leaves, by r
template <typename Residual>
std::size_t SurfaceEstimation::countCubic(const std::vector<pcl::index_t>& rows,
                                          const Residual& cubic, double share) const {
  std::size_t nearer = 0;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const float quadratic = quadratics_.residuals[static_cast<std::size_t>(rows[r])];
    const bool less = static_cast<double>(cubic(r)) < share * static_cast<double>(quadratic);
    nearer += less ? 1 : 0;
  }
  return nearer;
}

// Whether the cloud is of a surface without noise and smooth nearly everywhere, as a formula
// makes it: then what quadratic surfaces leave is the next term of its series.
bool SurfaceEstimation::isAnalytic() {
  // Those of lines fit better the less their points tell.
  if (available() < kCubicNeighbors || lines_) return false;
  if (known_ != nullptr) return known_->analytic;
  const std::vector<pcl::index_t> rows = sampleRows(rows_);
  const std::vector<float> cubic = sampleResiduals(NormalEstimator::AWAS_CUBIC, of_.points,
                                                   of_.table, kCubicNeighbors, threads_, rows);
  const auto of_row = [&](std::size_t r) { return cubic[r]; };
  return 2 * countCubic(rows, of_row, kNextTerm) > rows.size();
}

// Cubic surfaces wherever they leave less than the quadratic ones, and where only they fit.
void SurfaceEstimation::takeCubics() {
  Surfaces cubics(NormalEstimator::AWAS_CUBIC);
  cubics.fit(of_, kCubicNeighbors, threads_, rows_);
  report_.analytic = true;
  const auto nearer = [&](std::size_t i) { return cubics.residuals[i] < quadratics_.residuals[i]; };
  for (const pcl::index_t r : rows_) {
    const auto i = static_cast<std::size_t>(r);
    if (nearer(i)) cubics.copyNormal(i, normals_);
  }
  report_.surfaces.back().second +=
      closeExplained(kCubicNeighbors, Fitted::CUBICS, [&](std::size_t i) {
        return nearer(i) ? cubics.residuals[i] : std::numeric_limits<float>::infinity();
      });
}

// Planes where these fit.
void SurfaceEstimation::takePlanes() {
  LocalNormalOptions options;
  options.k = kPlaneNeighbors;
  options.threads = threads_;
  estimateNormals(of_.at, of_.points, of_.table, options, normals_, nullptr, &open_);
  report_.planes = closeExplained(kPlaneNeighbors, Fitted::PLANES, [&](std::size_t row) {
    return planeResidual(of_, row, kPlaneNeighbors, normals_ + 4 * row);
  });
}

void SurfaceEstimation::triangulate() {
  LocalNormalOptions options;
  options.threads = threads_;
  options.estimator = NormalEstimator::LDT;
  options.k = report_.edge_k = kTriangulationNeighbors;
  estimateNormals(of_.at, of_.points, of_.table, options, normals_, nullptr, &open_);
  findTelling(kTriangulationNeighbors, Fitted::PLANES);
  std::vector<pcl::index_t> lined;
  std::copy_if(open_.begin(), open_.end(), std::back_inserter(lined),
               [&](pcl::index_t r) { return !tells(static_cast<std::size_t>(r)); });
  report_.lined = takeSpreadPlanes(of_, index_, lined, threads_, normals_);
}

// Cubic surfaces at what is open.
EdgeCubics SurfaceEstimation::cubicsAtEdges() {
  EdgeCubics out;
  out.rows = open_;
  out.k = cubicSize(in_spacings_, available());
  if (out.k == 0) return out;
  Surfaces cubics(NormalEstimator::AWAS_CUBIC);
  quadratics_.fit(of_, out.k, threads_, open_);
  cubics.fit(of_, out.k, threads_, open_);
  const auto cubic = [&](std::size_t o) {
    return cubics.residuals[static_cast<std::size_t>(open_[o])];
  };
  out.nearer = countCubic(open_, cubic, kBetter);
  for (const pcl::index_t o : open_) {
    const float* n = &cubics.normals[4 * static_cast<std::size_t>(o)];
    out.normals.insert(out.normals.end(), n, n + 4);
  }
  return out;
}

}  // namespace segorient::detail
