// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "features/local_normals.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "common/compiler.h"
#include "common/instruction_set.h"
#include "common/threads.h"
#include "common/vectors.h"
#include "features/local_fit_job.h"
#include "features/surface_fit.h"

namespace segorient {
namespace detail {

namespace portable {
namespace {
#define SEGORIENT_LANES 4
#include "features/local_kernels.inl"
#undef SEGORIENT_LANES
}  // namespace
}  // namespace portable

#if SEGORIENT_X86
SEGORIENT_TARGET_BEGIN("avx2")
namespace avx2 {
namespace {
#define SEGORIENT_LANES 8
#include "features/local_kernels.inl"
#undef SEGORIENT_LANES
}  // namespace
}  // namespace avx2
SEGORIENT_TARGET_END
SEGORIENT_TARGET_BEGIN("avx512f,avx512vl")
namespace avx512 {
namespace {
#define SEGORIENT_LANES 16
#include "features/local_kernels.inl"
#undef SEGORIENT_LANES
}  // namespace
}  // namespace avx512
SEGORIENT_TARGET_END
#endif

namespace {

using Kernel = void (*)(const LocalFitJob&, std::size_t, std::size_t);

Kernel chooseKernel(bool portable_only) {
#if SEGORIENT_X86
  if (!portable_only && instructionSet() >= InstructionSet::Avx512) return &avx512::estimateRows;
  if (!portable_only && instructionSet() >= InstructionSet::Avx2) return &avx2::estimateRows;
#endif
  static_cast<void>(portable_only);
  return &portable::estimateRows;
}

/// The kernels read 4 floats a point: rows laid out otherwise are copied.
const float* packed(const PointView& points, std::vector<float>& copy) {
  if (points.stride == 4) return points.data;
  copy.resize(4 * points.size);
  for (std::size_t i = 0; i < points.size; ++i) {
    std::copy_n(points[i], 3, &copy[4 * i]);
    copy[4 * i + 3] = 0.0F;
  }
  return copy.data();
}

}  // namespace

void estimateNormals(const PointView& queries, const PointView& points,
                     const Neighborhoods& neighborhoods, const LocalNormalOptions& options,
                     float* normals, LocalCurvature* curvatures, float* residuals,
                     const std::vector<pcl::index_t>* rows) {
  std::vector<float> copy;
  LocalFitJob job;
  job.queries = queries;
  job.xyz = packed(points, copy);
  job.same_points = queries.data == points.data && queries.stride == points.stride;
  job.neighborhoods = &neighborhoods;
  job.rows = rows ? rows->data() : nullptr;
  job.estimator = options.estimator;
  job.first_guess = options.first_guess;
  job.entries = options.k > 0 ? std::min(neighborhoods.k() - 1, options.k) + 1 : neighborhoods.k();
  job.normals = normals;
  job.curvatures = curvatures;
  job.residuals = residuals;

  constexpr double kPointTime = 300.0;  // ns
  const Kernel kernel = chooseKernel(options.portable);
  const auto count = static_cast<std::ptrdiff_t>(rows ? rows->size() : neighborhoods.size());
  constexpr std::ptrdiff_t kBlock = 1024;
  const std::ptrdiff_t blocks = (count + kBlock - 1) / kBlock;
  const int threads = resolveThreads(options.threads, static_cast<std::size_t>(count), kPointTime);
#pragma omp parallel for schedule(dynamic) num_threads(threads)
  for (std::ptrdiff_t b = 0; b < blocks; ++b) {
    kernel(job, static_cast<std::size_t>(b * kBlock),
           static_cast<std::size_t>(std::min(count, (b + 1) * kBlock)));
  }
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
