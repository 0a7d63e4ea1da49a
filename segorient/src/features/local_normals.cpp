// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "features/local_normals.h"

#include "common/instruction_set.h"

#include "common/kernel_macros.h"
#include "common/threads.h"
#include "features/local_fit_job.h"
#include "features/surface_fit.h"

#if defined(__SSE2__)
#include <immintrin.h>
#endif

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

// Vectors are passed between inlined functions of this file only, so their calling convention is of
// no consequence.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wpsabi"
#endif

namespace segorient {
namespace detail {

namespace portable {
namespace {
#define SEGORIENT_LANES 4
#include "features/local_kernels.inl"
#undef SEGORIENT_LANES
}  // namespace
}  // namespace portable

#if defined(__x86_64__)
#define SEGORIENT_X86_KERNELS
#if defined(__clang__)
#pragma clang attribute push(__attribute__((target("avx2"))), apply_to = function)
#else
#pragma GCC push_options
#pragma GCC target("avx2")
#endif
namespace avx2 {
namespace {
#define SEGORIENT_LANES 8
#include "features/local_kernels.inl"
#undef SEGORIENT_LANES
}  // namespace
}  // namespace avx2
#if defined(__clang__)
#pragma clang attribute pop
#pragma clang attribute push(__attribute__((target("avx512f,avx512vl"))), apply_to = function)
#else
#pragma GCC pop_options
#pragma GCC push_options
#pragma GCC target("avx512f,avx512vl")
#endif
namespace avx512 {
namespace {
#define SEGORIENT_LANES 16
#include "features/local_kernels.inl"
#undef SEGORIENT_LANES
}  // namespace
}  // namespace avx512
#if defined(__clang__)
#pragma clang attribute pop
#else
#pragma GCC pop_options
#endif
#endif

namespace {

using Kernel = void (*)(const LocalFitJob&, std::size_t, std::size_t);

Kernel chooseKernel(bool portable_only) {
#if defined(SEGORIENT_X86_KERNELS)
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
