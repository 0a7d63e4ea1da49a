// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/segmentation/segmentation.h>

#include <cstddef>
#include <cstdint>
#include <vector>

#include "io/cloud_writer.h"

namespace segorient::program {

/// What a command found out about a cloud.
struct Results {
  const std::vector<float>* normals = nullptr;  ///< 4 floats a point: normal, curvature
  const Segmentation* segmentation = nullptr;   ///< null: no segments
  bool kinds = false;                           ///< whether to write the segments' kinds
  bool keep_colors = false;  ///< whether colours that the input has come before the segments'
  const std::vector<Triangle>* triangles = nullptr;  ///< null: no mesh
};

/// \param normals 4 floats a point
/// \return points whose normal is NaN
std::size_t countWithoutNormal(const std::vector<float>& normals);

/// Writes x, y, z, the results as normal_x, normal_y, normal_z, curvature, rgb, label (4294967295
/// where there is none) and segment_kind (0 regular, 1 connected, 2 isolated), and all other fields
/// of the input. Does not commit.
void writeResults(const CloudTable& table, const Results& results, OutputFile& file);

}  // namespace segorient::program
