// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/export.h>

namespace segorient::detail {

struct SymmetricMatrix3 {
  double xx, xy, xz, yy, yz, zz;

  /// Adds the products of a vector's coordinates.
  void add(const double* v) {
    xx += v[0] * v[0];
    xy += v[0] * v[1];
    xz += v[0] * v[2];
    yy += v[1] * v[1];
    yz += v[1] * v[2];
    zz += v[2] * v[2];
  }
};

struct SymmetricEigen3 {
  double values[3];      ///< ascending
  double vectors[3][3];  ///< vectors[i] is the unit vector of values[i]; right-handed
};

/// All eigenvalues and eigenvectors by Jacobi rotations: slower than a closed form, and accurate to
/// the last bits for any spread of eigenvalues. A matrix with NaN or infinite entries gives NaN
/// values.
SEGORIENT_FEATURES_EXPORT SymmetricEigen3 symmetricEigen(const SymmetricMatrix3& m);

}  // namespace segorient::detail
