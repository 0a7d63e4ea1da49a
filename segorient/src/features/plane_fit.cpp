// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <algorithm>
#include <cmath>
#include <limits>

#include "features/local_fit_job.h"
#include "features/symmetric_eigen.h"

namespace segorient::detail {

bool fitPlaneExactly(const LocalFitJob& job, std::size_t row, float* normal) {
  std::fill_n(normal, 4, std::numeric_limits<float>::quiet_NaN());
  const int count = job.count(row);
  if (count < 3) return false;
  const float* p = job.queries[row];
  const pcl::index_t* neighbors = job.neighborhoods->indices(row);
  const auto offset = [&](int j, int axis) {
    return static_cast<double>(job.xyz[4 * static_cast<std::size_t>(neighbors[j]) +
                                       static_cast<std::size_t>(axis)]) -
           static_cast<double>(p[axis]);
  };
  double mean[3] = {0, 0, 0};
  for (int j = 0; j < count; ++j) {
    for (int a = 0; a < 3; ++a) mean[a] += offset(j, a);
  }
  for (double& m : mean) m /= count;
  SymmetricMatrix3 cov{};
  for (int j = 0; j < count; ++j) {
    const double d[3] = {offset(j, 0) - mean[0], offset(j, 1) - mean[1], offset(j, 2) - mean[2]};
    cov.add(d);
  }
  const SymmetricEigen3 eigen = symmetricEigen(cov);
  // A second direction counts if it is wider than the coordinates' own rounding (a unit in the last
  // place) and than what is left of a line in arbitrary direction.
  double size = 0;
  for (int j = 0; j < count; ++j) {
    for (int a = 0; a < 3; ++a) {
      size = std::max(size, std::abs(offset(j, a) + static_cast<double>(p[a])));
    }
  }
  const double rounding = size * std::numeric_limits<float>::epsilon();
  const double width = eigen.values[1] / count;
  if (!(width > rounding * rounding) || !(eigen.values[1] > 1e-12 * eigen.values[2])) return false;
  for (int a = 0; a < 3; ++a) normal[a] = static_cast<float>(eigen.vectors[0][a]);
  const double trace = eigen.values[0] + eigen.values[1] + eigen.values[2];
  normal[3] = static_cast<float>(std::max(0.0, eigen.values[0] / trace));
  return true;
}

}  // namespace segorient::detail
