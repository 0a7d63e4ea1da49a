// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/export.h>
#include <segorient/common/neighborhoods.h>
#include <segorient/common/point_view.h>
#include <segorient/search/median_hash_index.h>

#include <cstddef>
#include <functional>

#include "features/grown_planes.h"
#include "features/more_neighbors.h"

namespace segorient::detail {

/// What a normal may be turned by noise, in radians: 3.5 degrees, as edges then still show.
constexpr float kMostNormalError = 0.061F;

/// Whether a cloud has many points whose noise asks for clearly larger neighbourhoods than the
/// cloud's median does: scans have, whose spacing falls far below the noise near the sensor, and
/// whose nearest neighbours are of one ring or one step of depth.
/// \param smallest neighbourhood that the cloud's noise allows
/// \param neighborhoods kSheetNeighbors of each point
bool needsScanScales(const PointView& points, const Neighborhoods& neighborhoods, int smallest,
                     int threads);

/// Whether a cloud shows that a scanner saw it by lines: of more points than chance makes so, the
/// nearest 18 are on one line.
/// \param neighborhoods 18 of each point at least
bool showsScanLines(const PointView& points, const Neighborhoods& neighborhoods, int threads);
/// The same where there is no table of so many.
SEGORIENT_FEATURES_EXPORT bool showsScanLines(const PointView& points,
                                              const search::MedianHashIndex& index, int threads);

/// Whether the spacing varies so much over the cloud that its noise, in spacings, asks for several
/// scales: from the densest to the sparsest tenth by a factor of two, as where scans overlap that
/// were made from near and far.
/// \param neighborhoods 12 of each point at least
bool isUneven(const PointView& points, const Neighborhoods& neighborhoods);

/// Takes point i's plane, at [r] of some.
using ScanPlaneTaker = std::function<void(std::size_t i, const GrownPlanes& planes, std::size_t r)>;

/// Planes at the scale that the noise around each point asks for.
///
/// Noise saturates as neighbourhoods grow, what curvature and edges do goes on growing: of the
/// residuals of 8 to 60 neighbours, medians over the points around, the first from which they stay
/// flat is the noise. The scale is the smallest at which that noise turns a plane's normal by less
/// than 3.5 degrees, and at which the neighbours spread in two directions.
/// \param more the points, and their neighbours
/// \param smallest neighbourhood that the cloud's noise allows
/// \param take called from several threads for each point whose scale is clearly larger and
///        that has a plane there
void fitScanPlanes(MoreNeighbors& more, int smallest, int threads, const ScanPlaneTaker& take);

}  // namespace segorient::detail
