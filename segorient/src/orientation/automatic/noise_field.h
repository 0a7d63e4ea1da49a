// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/neighborhoods.h>
#include <segorient/common/point_view.h>

#include "orientation/automatic/orient_points.h"

namespace segorient::detail {

/// Where noise hides which way sheets go on, the field of all points knows more than borders do.
///
/// On an even subset with averaged positions, normals are found that agree with the winding
/// number's field (FieldSolver): from nothing, and from the oriented normals as they are. They
/// replace those where FieldEnergy says that they are clearly better, first as a whole, then patch
/// by patch where both differ. At last each point's normal is averaged with the direction of the
/// field where the point was measured.
///
/// \param points positions as measured, finite, near ones side by side
/// \param neighborhoods of them, six at least
/// \param found normals and confidences may change
void followField(const PointView& points, const Neighborhoods& neighborhoods, int threads,
                 AutoNormals& found);

}  // namespace segorient::detail
