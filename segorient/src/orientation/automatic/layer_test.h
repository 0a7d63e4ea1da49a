// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/neighborhoods.h>
#include <segorient/common/point_view.h>

#include <vector>

namespace segorient::detail {

/// How much the thickness of what coarser points take for one surface varies: the standard
/// deviation of a local measure of it, over its mean; 0 where it cannot be measured. Samples count
/// as if all directions were equally common, so that the faces of a plate are not all that is seen.
///
/// The measure is the standard deviation of the offsets of the 16 nearest points along the coarse
/// normal, where that is well defined.
/// \param around 4 floats a point: mean normal of the coarse points around, cosine of their spread
float thicknessScatter(const PointView& points, const Neighborhoods& neighborhoods,
                       const std::vector<float>& around, int threads);

/// Whether what coarser points take for one surface are layers that cross each other, as scans of
/// one object do that lie beside each other by a rigid motion, and not the two sides of a wall.
///
/// Moved by t, a surface is |t.n| off along its normal n. All around a closed body that is anything
/// from 0 to |t|, equally often on a sphere: its scatter is .58. A wall is equally thick
/// everywhere, and so is noise: all that varies is the measure itself, by .16 or less, since
/// standard deviations of 16 numbers scatter by 1 / sqrt(2 * 15) = .18 if they are normally
/// distributed, and less between two sides.
bool layersCross(const PointView& points, const Neighborhoods& neighborhoods,
                 const std::vector<float>& around, int threads);

}  // namespace segorient::detail
