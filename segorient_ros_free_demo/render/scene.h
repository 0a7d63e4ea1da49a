// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "io/cloud_table.h"
#include "render/rasterizer.h"

namespace segorient::program {

/// What the colours of a picture mean.
enum class Coloring {
  Normal,   ///< light grey where the normal points to the viewer, red where it points away
  Segment,  ///< by the field `label`
  /// As Normal, with a tint of each segment's own, hard segments in a colour of their own
  Orientation,
  Rgb  ///< by the field `rgb`
};

/// Reads a name of --color; "auto" takes Normal if the cloud has normals, else Segment or Rgb.
/// Throws UsageError for another name, FileError if the cloud lacks what it needs.
Coloring parseColoring(const std::string& name, const CloudTable& table, const std::string& path);

/// The cloud's triangles if it has any, else its points as splats: as wide as the points around are
/// apart, so that surfaces look closed, and cut where a sharp edge is, so that they do not stick
/// out.
/// \param normals 4 floats a point to draw instead of the table's own, or null
/// \param hard labels of hard segments, ascending; only Coloring::Orientation shows them
Scene makeScene(const CloudTable& table, const LocalPoints& points, const float* normals,
                Coloring coloring, int threads, const std::vector<std::uint32_t>& hard = {});

/// The scene from one direction and, if `both`, beside it from the opposite one.
Picture drawViews(const Scene& scene, const View& view, bool both);

}  // namespace segorient::program
