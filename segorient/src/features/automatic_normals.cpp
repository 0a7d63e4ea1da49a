// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "features/automatic_normals.h"

#include <algorithm>
#include <cstdint>
#include <iomanip>
#include <mutex>
#include <sstream>
#include <utility>

#include "features/local_fit_job.h"
#include "features/surface_estimation.h"
#include "features/surface_sizes.h"

namespace segorient {
namespace {

using detail::CloudNoise;
using detail::EdgeCubics;
using detail::SurfaceEstimation;
using detail::Surroundings;

CloudNoise noiseOf(const PointView& points, const Neighborhoods& neighborhoods, int threads,
                   const AutomaticNormalTraits* known) {
  if (known != nullptr) return known->noise;
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
      : xyz_(points),
        points_{xyz_.data(), 4, points.size},
        noise_(noise),
        known_(known),
        normals_(normals) {
    report_.traits.noise = noise;
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
        SurfaceEstimation(of, noise_, known_, 1, normals.data(), &rows).runPart(cubics);
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

  const detail::FourFloats xyz_;
  const PointView points_;
  CloudNoise noise_;
  const AutomaticNormalTraits* known_;
  float* normals_;
  std::vector<std::uint8_t> wanted_;  ///< empty = all
  std::mutex mutex_;
  AutomaticNormalReport report_;
  EdgeCubics cubics_;
};

}  // namespace

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
  return SurfaceEstimation(of, noise, known, threads, normals, rows).run(unexplained);
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
  const auto estimate = [&](const Neighborhoods& table) {
    const Surroundings of{points, points, table};
    return SurfaceEstimation(of, noise, known, threads, normals, rows, &index).run(unexplained);
  };
  const bool all = static_cast<std::size_t>(neighborhoods.k()) >= points.size;
  if (all || neighborhoods.k() > wanted) return estimate(neighborhoods);
  // Where few neighbours tell something, whole tables of them are small, and steps that look at all
  // points come in between.
  if (!detail::fewTell(inSpacings(noise))) {
    return EstimationByRegion(points, noise, known, normals, rows).run(index, unexplained);
  }
  Neighborhoods wider;
  index.nearestKAll(wanted + 1, wider, false);
  return estimate(wider);
}

std::string AutomaticNormalReport::text() const {
  std::ostringstream out;
  out << "noise " << std::setprecision(2) << static_cast<float>(traits.noise.in_spacings)
      << " of the spacing";
  for (const auto& [k, count] : surfaces) {
    out << ", " << count << " points by quadratic surfaces of " << k << " neighbours";
  }
  if (across > 0)
    out << ", " << across << " by larger ones, as a few of two lines of a scan tell no slope";
  if (analytic) out << " or cubic ones of " << detail::kCubicNeighbors << " where these fit better";
  out << ", " << at_edges << " that none of these fits, as at edges"
      << (traits.lines && triangulated ? " and where neighbours are of one line, " : ", ");
  if (planes > 0)
    out << planes << " of them by planes of " << detail::kPlaneNeighbors << " and the others ";
  const char* others = cubic ? "cubic surfaces" : "quadratic surfaces";
  out << "by " << (triangulated ? "local Delaunay triangulation" : others) << " of " << edge_k;
  if (lined > 0) out << " or, along lines of a scan, planes across them";
  if (undefined > 0) out << ", " << undefined << " without a normal";
  return out.str();
}

}  // namespace segorient
