// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/surface/segment_mesh.h>

#include <cstdint>
#include <vector>

#include "surface/delaunay.h"

namespace segorient::surface {

/// The triangles of a Delaunay triangulation that make up the shape of its points.
struct Selection {
  std::vector<std::uint8_t> kept;  ///< by triangle
  float critical_length = 0.F;
};

/// Last maximum of the histogram of lengths, times the factor.
/// \param typical their median
float criticalLength(const std::vector<float>& lengths, float typical,
                     const TriangulationOptions& options);

/// \param lengths of the edges, in space
/// \param points number of points, duplicates included
Selection selectTriangles(const PlanarTriangulation& mesh, const std::vector<float>& lengths,
                          std::size_t points, const TriangulationOptions& options);

}  // namespace segorient::surface
