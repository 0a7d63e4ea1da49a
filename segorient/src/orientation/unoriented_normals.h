// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/neighborhoods.h>
#include <segorient/common/point_view.h>
#include <segorient/orientation/pipeline.h>
#include <segorient/search/median_hash_index.h>

#include <string>
#include <vector>

namespace segorient::detail {

/// Normals by `options.normals`. Automatic ones have the neighbours of `neighborhoods` and, unless
/// the options say how many, more of them where the noise asks for more.
/// \param index built on `points`
/// \param normals 4 floats a point
/// \return how they were found, and why so
std::string findUnorientedNormals(const PointView& points, const search::MedianHashIndex& index,
                                  const Neighborhoods& neighborhoods,
                                  const PipelineOptions& options, std::vector<float>& normals);

}  // namespace segorient::detail
