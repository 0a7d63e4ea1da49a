// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/neighborhoods.h>
#include <segorient/common/point_view.h>
#include <segorient/orientation/orientation_result.h>

namespace segorient {

/// Orients every point that has a normal and no sign yet from the oriented points around it; those
/// with the most evidence first, each then speaking for its own neighbours. Where nothing oriented
/// is within reach, the first such point starts a component of its own.
///
/// A neighbour at offset d votes n_p . n_q - 2 (n_p . d)(n_q . d) / |d|^2: its normal mirrored
/// along the chord, which is right across sharp edges too (König and Gumhold 2009; Xie et al.
/// 2003). Linear in the number of neighbours.
///
/// \param result reads and completes point_signs (0 = to be done), point_confidences and
///        point_components; appends to components
void completeOrientation(const PointView& points, const PointView& normals,
                         const Neighborhoods& neighborhoods, OrientationResult& result);

}  // namespace segorient
