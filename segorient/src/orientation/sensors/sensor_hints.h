// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/export.h>
#include <segorient/common/point_view.h>
#include <segorient/orientation/orientation_hints.h>
#include <segorient/orientation/sensors.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

#include "orientation/sensors/sensor_search.h"
#include "search/prepared_cloud.h"

namespace segorient::detail {

/// Cosine from which on two directions to a sensor are one: 14 degrees. True places are 10 at most
/// from what was found beside them; the middle of a scan, 18 and more where it sees the surface
/// from another side.
constexpr double kSameWay = 0.97;

/// Whether a place says where a point was seen from: it is known, and not the point itself, as some
/// files have it where nobody knew.
template <typename T>
bool saysPlace(const T* place, const T* point) {
  return std::all_of(place, place + 3, [](T v) { return std::isfinite(v); }) &&
         !std::equal(place, place + 3, point);
}

/// Whether places are given that points were seen from.
bool saysPlaces(const OrientationHints& hints);

/// The same, or a direction that they were seen from.
bool saysSensors(const OrientationHints& hints);

/// Whether it is worth looking for sensors: none is known, no normals are, and the cloud is not
/// said to be closed. Places that are given are known ones.
bool lacksSensors(const OrientationHints& hints);

/// Whether the cloud is one image, which tells where its camera is.
bool isImage(const OrientationHints& hints, std::size_t rows);

/// Looks for sensors; what is sure becomes a hint of each row, as if it were given.
/// \param points the rows that `cloud` was prepared from
SensorReport addFoundSensors(const PointView& points, PreparedCloud& cloud, int threads,
                             OrientationHints& hints, SeenShadows& shadows);

/// The hints without what they say of places that a sensor had.
SEGORIENT_ORIENTATION_EXPORT OrientationHints withoutPlaces(const OrientationHints& hints);

/// Nor of the direction that it was in.
SEGORIENT_ORIENTATION_EXPORT OrientationHints withoutSensors(const OrientationHints& hints);

/// The place that all rows are said to have been seen from, if that is one.
std::optional<std::array<float, 3>> onlyPlace(const OrientationHints& hints, std::size_t rows);

/// Whether sensors were found for sure, and some of them elsewhere than the place that somebody
/// gave for all points, as seen from the points.
bool contradictsPlace(const PreparedCloud& cloud, const SensorReport& report,
                      const std::array<float, 3>& place);

}  // namespace segorient::detail
