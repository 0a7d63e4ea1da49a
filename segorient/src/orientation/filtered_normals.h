// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <vector>

namespace segorient {

/// Final normals of points, and how sure their signs are.
struct FilteredNormals {
  std::vector<float> normals;  ///< 4 floats a point: oriented unit normal, residual as given; NaN
                               ///< only where no neighbour has a normal either
  std::vector<float> confidences;  ///< 0 to 1: how far the oriented normals around agree
};

}  // namespace segorient
