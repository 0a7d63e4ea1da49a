// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/export.h>
#include <segorient/common/neighborhoods.h>
#include <segorient/common/point_view.h>

#include "orientation/automatic/orient_points.h"

namespace segorient::detail {

/// Normals of closed bodies that so few points were taken of that a neighbourhood is as large as
/// their parts: planes are fitted across edges and through walls then, and borders of segments tell
/// little. The field of all points knows no neighbourhoods, see consistentNormals(). Nothing is
/// done unless the cloud has few points, may be closed with the normals that were found, and is
/// with those of the field, which contradict each other not much more, or, in noise, clearly less.
/// Points that have no normal get none.
/// \param points finite, near ones side by side
/// \param neighborhoods eight at least
/// \param noise in spacings
/// \param found normals and confidences may change
/// \return whether they have
SEGORIENT_ORIENTATION_EXPORT bool takeSparseField(const PointView& points,
                                                  const Neighborhoods& neighborhoods, float noise,
                                                  int threads, AutoNormals& found);

}  // namespace segorient::detail
