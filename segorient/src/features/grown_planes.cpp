// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "features/grown_planes.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "common/compiler.h"
#include "common/instruction_set.h"
#include "common/vectors.h"

namespace segorient::detail {

#define SEGORIENT_KERNELS "features/grown_lanes.inl"
#include "features/each_width.inl"
#undef SEGORIENT_KERNELS

Plane GrownPlanes::at(std::size_t i, float length) const {
  const float scale = unit[i] / length;
  Plane plane;
  plane.normal = {normal[0][i], normal[1][i], normal[2][i]};
  plane.lambda = Eigen::Vector3f(lambda[0][i], lambda[1][i], lambda[2][i]) * (scale * scale);
  plane.mean = Eigen::Vector3f(mean[0][i], mean[1][i], mean[2][i]) * scale;
  plane.valid = n[i] >= 3.F && spansTwo(plane.lambda) && plane.normal.allFinite();
  return plane;
}

namespace {

struct Kernels {
  decltype(&portable::fitGrown) fit_grown;
  decltype(&portable::mediansOf) medians_of;
};

Kernels chooseKernels() {
#if SEGORIENT_X86
  if (instructionSet() >= InstructionSet::Avx512) return {&avx512::fitGrown, &avx512::mediansOf};
  if (instructionSet() >= InstructionSet::Avx2) return {&avx2::fitGrown, &avx2::mediansOf};
#endif
  return {&portable::fitGrown, &portable::mediansOf};
}

}  // namespace

void fitGrownPlanes(const LocalFitJob& job, const int* sizes, std::size_t count, std::size_t begin,
                    std::size_t end, GrownPlanes* planes) {
  chooseKernels().fit_grown(job, sizes, count, begin, end, planes);
}

void findMedians(const float* values, std::size_t count, float* medians) {
  chooseKernels().medians_of(values, count, medians);
}

}  // namespace segorient::detail
