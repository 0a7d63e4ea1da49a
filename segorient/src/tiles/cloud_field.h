// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/export.h>
#include <segorient/common/point_view.h>
#include <segorient/orientation/orientation_result.h>

#include <vector>

#include "orientation/automatic/noise_field.h"
#include "orientation/automatic/orient_points.h"
#include "search/prepared_cloud.h"
#include "tiles/tile_share.h"

namespace segorient::detail {

/// What noise leaves of the field, see findNoiseField().
/// \param places of the cloud as measured
/// \param normals 4 floats a row, oriented; gathered
/// \param confidences of their signs, by row
/// \param known of the cloud, as parts of it tell that were oriented one by one: some
///        points of tiles always follow the wrong piece
CloudField findNoise(const PointView& places, const std::vector<float>& normals,
                     const std::vector<float>& confidences, const KnownField& known, int threads);

/// The same without noise, see takeFineField(); often nothing.
SEGORIENT_TILES_EXPORT CloudField findFine(const PointView& places,
                                           const std::vector<float>& normals,
                                           const std::vector<float>& confidences, int threads);

/// What the field says of bodies that touch, see findCellSigns(); often nothing.
/// \param normals 4 floats a point of the cloud, oriented \param spacing in the cloud's unit
/// \param noisy see findCellSigns() \param hints see contradictHints()
CloudField findSigns(const PreparedCloud& cloud, const std::vector<float>& normals, float spacing,
                     const AutoOrientation& orientation, const PointHints& hints, bool noisy,
                     int threads);

/// Gives a tile's points what the field tells of them. \param points of the tile, with neighbours
/// \param unit theirs \param field relative to the tile's origin
SEGORIENT_TILES_EXPORT void takeField(const PointView& points, const Neighborhoods& neighborhoods,
                                      float unit, const CloudField& field, int threads,
                                      AutoNormals& found);

}  // namespace segorient::detail
