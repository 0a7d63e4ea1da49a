// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/segmentation/segmentation.h>

#include "features/more_neighbors.h"
#include "orientation/automatic/orient_points.h"
#include "search/prepared_cloud.h"

namespace segorient::detail {

/// The most accurate normals that the library has for a cloud, with the signs that were found.
///
/// The filter that settles the signs averages over neighbours, which costs accuracy where a surface
/// bends. So each point gets the normal of the surface that estimateNormalsAutomatically() fits,
/// towards the side that it faces; near sharp edges the mean of the faces' normals by how likely it
/// belongs to each (OneSidedNormal::EXPECTED). With noise it gets the mean of that and of the
/// filtered one, which err in different ways: the one by noise, the other by what the surface
/// bends; beside sharp edges, where the filtered one is a mean over both faces, with the less of
/// it the less noise there is. The filtered normal stays where neighbours are of another wall, at
/// what cannot be fitted beside sharp edges, and on scans whose noise only many neighbours show,
/// see SheetTraits.
///
/// \param cloud whose neighbours are known
/// \param more of the same points, which are sought where the noise asks for them, unless
///        `only_known`
/// \param segments by the filtered normals
/// \param known of the cloud that this one is part of; null = measured
/// \param oriented normals are replaced; the residuals stay
/// \return as measured, or as told
FinalTraits fitFinalNormals(const PreparedCloud& cloud, MoreNeighbors& more,
                            const Segmentation& segments, bool only_known, int threads,
                            const FinalTraits* known, AutoNormals& oriented);

}  // namespace segorient::detail
