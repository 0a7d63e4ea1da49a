// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/point_view.h>
#include <segorient/orientation/sensors.h>

#include <cstddef>
#include <optional>

namespace segorient::detail {

/// The pinhole camera that an organised cloud comes from, wherever it stood: the projection that
/// takes points to their pixels, by the direct linear transformation (Hartley and Zisserman,
/// Multiple View Geometry, 7.1). Nothing if there is none: too few points, a scene that leaves it
/// open (a plane), rows that are no image, or rays that are not those of a pinhole.
/// \param points row by row, not finite where the image has nothing
std::optional<FoundSensor> cameraOfImage(const PointView& points, std::size_t width);

}  // namespace segorient::detail
