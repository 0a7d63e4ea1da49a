// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <Eigen/Core>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "common/median.h"
#include "orientation/orient_segments.h"
#include "orientation/pipeline_stages.h"

namespace segorient::detail {
namespace {

constexpr std::size_t kSample = 4000;  // medians of so many are sure to some percent
constexpr int kNear = 6;               // the first ring of neighbours on a surface
constexpr int kFit = 18;               // the first two rings

// Spacing and noise of a cloud, from a sample of its points.
struct CloudScale {
  float spacing = 0.F;  // median of the mean distance to the 6 nearest
  float noise = 0.F;    // median of the rms distance of 18 neighbours from their plane, in spacings
};

// Root of the smallest eigenvalue of the covariance.
double planeResidual(const PointView& points, const float* origin, const pcl::index_t* rows,
                     int count) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  for (int j = 0; j < count; ++j) {
    const float* q = points[static_cast<std::size_t>(rows[j])];
    const Eigen::Vector3d d(static_cast<double>(q[0]) - origin[0],
                            static_cast<double>(q[1]) - origin[1],
                            static_cast<double>(q[2]) - origin[2]);
    mean += d;
    moments += d * d.transpose();
  }
  mean /= count;
  moments = moments / count - mean * mean.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(moments, Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(0.0, solver.eigenvalues()[0]));
}

// \param index built on all of `points`
CloudScale measureScale(const PointView& points, const search::MedianHashIndex& index) {
  std::vector<float> spacings;
  std::vector<float> residuals;
  std::array<pcl::index_t, kFit + 1> rows{};
  std::array<float, kFit + 1> squared{};
  const std::size_t samples = std::min(points.size, kSample);
  for (std::size_t i = 0; i < samples; ++i) {
    const float* p = points[i * points.size / samples];
    const int found = index.nearestK(p, kFit + 1, rows.data(), squared.data());
    const int near = std::min(found, kNear + 1);
    if (near < 2) continue;
    float sum = 0.F;
    for (int j = 1; j < near; ++j) sum += std::sqrt(squared[static_cast<std::size_t>(j)]);
    const float spacing = sum / static_cast<float>(near - 1);
    spacings.push_back(spacing);
    if (found < 4 || !(spacing > 0.F)) continue;
    residuals.push_back(static_cast<float>(planeResidual(points, p, rows.data(), found) / spacing));
  }
  CloudScale scale;
  scale.spacing = median(std::move(spacings));
  scale.noise = median(std::move(residuals));
  return scale;
}

// How many neighbours normals and segments should rest on at that noise: few on clean clouds,
// where more would round off the edges; many where a few would not see the surface for the noise.
int neighborsForNoise(float noise) {
  if (noise < 0.15F) return 12;
  return noise < 0.28F ? 18 : 30;
}

// Turns the distinct points' normals and segments as they were oriented. The normals' own signs now
// say it all, so a point's sign in its segment is what is left: -1 where it disagrees with it.
void applyOrientation(OrientedStages& work) {
  constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  const OrientationResult& orientation = work.orientation;
  std::vector<float>& normals = work.surface.normals;
  Segmentation& segmentation = work.surface.segmentation;
  for (std::size_t i = 0; i < work.surface.cloud.size(); ++i) {
    const auto sign = static_cast<float>(orientation.point_signs[i]);
    for (std::size_t a = 0; a < 3; ++a) normals[4 * i + a] *= sign == 0.F ? kNone : sign;
    if (sign == 0.F) normals[4 * i + 3] = kNone;
    const std::int32_t label = segmentation.labels[i];
    if (label < 0) continue;
    const int segment_sign = orientation.segments[static_cast<std::size_t>(label)].sign;
    segmentation.signs[i] =
        static_cast<std::int8_t>(segmentation.signs[i] * orientation.point_signs[i] * segment_sign);
  }
  for (std::size_t s = 0; s < segmentation.segments.size(); ++s) {
    for (float& c : segmentation.segments[s].reference_normal) {
      c *= static_cast<float>(orientation.segments[s].sign);
    }
  }
}

}  // namespace

void runPaper(const PipelineOptions& options, StageClock& clock, OrientedStages& work,
              PipelineReport& report) {
  SurfaceStages& surface = work.surface;
  const CloudScale scale = measureScale(surface.cloud.points(), surface.cloud.index());
  report.spacing = scale.spacing;
  report.noise = scale.noise;
  surface.findNeighbors(options.k > 0 ? options.k : neighborsForNoise(scale.noise));
  report.k = surface.k;
  clock.begin("normals", 0.4);
  surface.findNormals(options);
  report.normals_chosen = surface.normals_chosen;
  surface.recomputeNormals(options, clock);
  clock.begin("segmentation", 0.75);
  SegmentationOptions cuts{options.segmentation, 0, options.threads};
  cuts.unite_smooth = false;
  // A point of a thin part that is given to the other side's segment is turned over with it.
  cuts.settle_edges = false;
  surface.findSegments(cuts);
  clock.begin("orientation", 0.8);
  const OrientationOptions how{options.orientation, options.threads};
  const Neighborhoods& neighborhoods = surface.cloud.neighborhoods();
  work.orientation = orientSegments(surface.cloud.points(), surface.normalView(), neighborhoods,
                                    surface.segmentation, how);
  applyOrientation(work);
}

}  // namespace segorient::detail
