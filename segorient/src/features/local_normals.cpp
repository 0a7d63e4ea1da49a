// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "features/local_normals.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "common/compiler.h"
#include "common/parallel_for.h"
#include "common/vectors.h"
#include "common/widest.h"
#include "features/local_fit_job.h"
#include "features/surface_fit.h"

namespace segorient {
namespace detail {

#define SEGORIENT_KERNELS "features/local_kernels.inl"
#include "common/each_width.inl"
#undef SEGORIENT_KERNELS

FourFloats::FourFloats(const PointView& points) : data_(points.data) {
  if (points.stride == 4) return;
  copy_.resize(4 * points.size);
  for (std::size_t i = 0; i < points.size; ++i) {
    std::copy_n(points[i], 3, &copy_[4 * i]);
    copy_[4 * i + 3] = 0.0F;
  }
  data_ = copy_.data();
}

std::vector<float> positionsOf(const PointView& points, const std::vector<pcl::index_t>& which) {
  std::vector<float> out(4 * which.size());
  for (std::size_t i = 0; i < which.size(); ++i) {
    std::copy_n(points[static_cast<std::size_t>(which[i])], 3, &out[4 * i]);
  }
  return out;
}

LocalFitJob jobOf(const PointView& queries, const FourFloats& xyz, const Neighborhoods& table,
                  int k) {
  LocalFitJob job;
  job.queries = queries;
  job.xyz = xyz.data();
  job.neighborhoods = &table;
  job.entries = k > 0 ? std::min(table.k() - 1, k) + 1 : table.k();
  return job;
}

void estimateNormals(const PointView& queries, const PointView& points,
                     const Neighborhoods& neighborhoods, const LocalNormalOptions& options,
                     float* normals, LocalCurvature* curvatures, float* residuals,
                     const std::vector<pcl::index_t>* rows) {
  const FourFloats xyz(points);
  LocalFitJob job = jobOf(queries, xyz, neighborhoods, options.k);
  job.same_points = queries.data == points.data && queries.stride == points.stride;
  job.rows = rows ? rows->data() : nullptr;
  job.estimator = options.estimator;
  job.first_guess = options.first_guess;
  job.normals = normals;
  job.curvatures = curvatures;
  job.residuals = residuals;

  constexpr double kPointTime = 300.0;  // ns
  const auto kernel = options.portable ? &portable::estimateRows : SEGORIENT_WIDEST(estimateRows);
  const std::size_t count = rows ? rows->size() : neighborhoods.size();
  constexpr std::size_t kBlock = 1024;
  const std::size_t blocks = (count + kBlock - 1) / kBlock;
  parallelFor(blocks, options.threads, timeOfEach(blocks, count, kPointTime),
              [&](std::size_t b) { kernel(job, b * kBlock, std::min(count, (b + 1) * kBlock)); });
}

}  // namespace detail

void estimateNormals(const PointView& queries, const PointView& points,
                     const Neighborhoods& neighborhoods, const LocalNormalOptions& options,
                     float* normals, LocalCurvature* curvatures,
                     const std::vector<pcl::index_t>* rows) {
  detail::estimateNormals(queries, points, neighborhoods, options, normals, curvatures, nullptr,
                          rows);
}

}  // namespace segorient
