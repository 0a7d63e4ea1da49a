// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "features/grown_planes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "common/compiler.h"
#include "common/vectors.h"
#include "common/widest.h"
#include "features/sorting_pairs.h"

namespace segorient::detail {
#define SEGORIENT_KERNELS "features/grown_lanes.inl"
#include "common/each_width.inl"
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

void fitGrownPlanes(const LocalFitJob& job, const int* sizes, std::size_t count, std::size_t begin,
                    std::size_t end, GrownPlanes* planes) {
  SEGORIENT_WIDEST(fitGrown)(job, sizes, count, begin, end, planes);
}

void findMedians(const float* values, std::size_t count, float* medians) {
  SEGORIENT_WIDEST(mediansOf)(values, count, medians);
}

}  // namespace segorient::detail
