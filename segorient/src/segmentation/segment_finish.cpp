// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <Eigen/Eigenvalues>

#include <array>
#include <utility>
#include <vector>

#include "common/in_double.h"
#include "features/symmetric_eigen.h"
#include "segmentation/growth_state.h"
#include "segmentation/segment_order.h"

namespace segorient::segmentation {
namespace {

/// Moments of a segment's points about one of them: far from the origin nothing is lost.
struct Moments {
  std::array<double, 3> origin{0, 0, 0};
  std::array<double, 3> sum{0, 0, 0};
  detail::SymmetricMatrix3 products{};
  double area = 0;

  void add(const float* point) {
    std::array<double, 3> offset = inDouble(point);
    for (std::size_t c = 0; c < 3; ++c) sum[c] += offset[c] -= origin[c];
    products.add(offset.data());
  }
};

void setShape(const Moments& m, Segment& segment) {
  const double n = segment.size;
  Eigen::Vector3d mean(m.sum[0] / n, m.sum[1] / n, m.sum[2] / n);
  for (std::size_t c = 0; c < 3; ++c) {
    segment.centroid[c] = static_cast<float>(m.origin[c] + mean[static_cast<Eigen::Index>(c)]);
  }
  segment.area = static_cast<float>(m.area);
  if (segment.size < 4) return;  // three points lie in their plane
  const detail::SymmetricMatrix3& s = m.products;
  Eigen::Matrix3d covariance;
  covariance << s.xx, s.xy, s.xz, s.xy, s.yy, s.yz, s.xz, s.yz, s.zz;
  covariance = covariance / n - mean * mean.transpose();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(covariance, Eigen::EigenvaluesOnly);
  segment.rms = static_cast<float>(std::sqrt(std::max(0.0, solver.eigenvalues()[0])));
}

// Point by point, not segment by segment: in whatever order the points are, each is read once.
void measure(const PointView& points, const GrowthState& state, Segmentation& result) {
  std::vector<Moments> moments(result.segments.size());
  std::vector<bool> begun(moments.size(), false);
  const double scale = 1.0 / static_cast<double>(state.scale);
  for (std::size_t p = 0; p < result.labels.size(); ++p) {
    if (result.labels[p] < 0) continue;
    const auto s = static_cast<std::size_t>(result.labels[p]);
    Moments& m = moments[s];
    for (std::size_t c = 0; c < 3 && !begun[s]; ++c) {
      m.origin[c] = static_cast<double>(points[p][c]);
    }
    begun[s] = true;
    const double side = static_cast<double>(state.nodes[p].spacing) * scale;
    m.area += side * side;
    m.add(points[p]);
  }
  for (std::size_t s = 0; s < moments.size(); ++s) setShape(moments[s], result.segments[s]);
}

}  // namespace

Segmentation rank(const GrowthState& state, std::vector<std::int32_t> labels,
                  std::vector<std::int8_t> signs) {
  std::vector<std::uint32_t> sizes;
  sizes.reserve(state.clusters.size());
  for (const Cluster& cluster : state.clusters) sizes.push_back(cluster.size);
  Segmentation result;
  for (const std::size_t s : rankLabels(sizes, labels)) {
    Segment& segment = result.segments.emplace_back();
    const NormalSum& n = state.clusters[s].normal;
    const double length = std::sqrt(n.squaredNorm());
    if (length > 0.0) {
      segment.reference_normal = {static_cast<float>(n.x / length),
                                  static_cast<float>(n.y / length),
                                  static_cast<float>(n.z / length)};
    }
    segment.kind = state.kinds[s];
    segment.size = state.clusters[s].size;
  }
  result.labels = std::move(labels);
  result.signs = std::move(signs);
  return result;
}

Segmentation finish(const PointView& points, const GrowthState& state,
                    std::vector<std::int32_t> labels, std::vector<std::int8_t> signs) {
  Segmentation result = rank(state, std::move(labels), std::move(signs));
  measure(points, state, result);
  return result;
}

}  // namespace segorient::segmentation
