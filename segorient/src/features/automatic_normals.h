// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/export.h>
#include <segorient/common/neighborhoods.h>
#include <segorient/common/point_view.h>
#include <segorient/search/median_hash_index.h>

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "features/cloud_noise.h"

namespace segorient {

/// What estimateNormalsAutomatically() measures of a whole cloud; for a part of one it is told.
struct AutomaticNormalTraits {
  detail::CloudNoise noise;
  bool analytic = false;     ///< so smooth that cubic surfaces are nearer at most points
  bool cubic_edges = false;  ///< whether cubic surfaces fit most points at edges better
  bool lines = false;        ///< whether the neighbours of many points are of one line
};

/// What estimateNormalsAutomatically() found out about a cloud, and what it chose.
struct AutomaticNormalReport {
  /// Neighbourhoods of quadratic surfaces that were tried, largest first, and how many points they
  /// were taken for; with the last one also bends, and points that only a cubic surface fits.
  std::vector<std::pair<int, std::size_t>> surfaces;
  std::size_t across = 0;        ///< points by larger ones, as those tell no slope along lines
  bool analytic = false;         ///< so smooth that cubic surfaces are nearer at most points
  std::size_t at_edges = 0;      ///< the points left, those with neighbours of one line included
  std::size_t planes = 0;        ///< of these, those that a plane of six neighbours does fit
  int edge_k = 0;                ///< neighbourhood used at the others
  std::size_t lined = 0;         ///< the others' points that got planes across a scanner's lines
  bool triangulated = false;     ///< by local Delaunay triangulation, ...
  bool cubic = false;            ///< ... by cubic surfaces, else by the smallest quadratic ones
  std::size_t undefined = 0;     ///< points without a normal
  AutomaticNormalTraits traits;  ///< as measured, or as told

  /// The same in a sentence.
  SEGORIENT_FEATURES_EXPORT std::string text() const;
};

/// Neighbours beside the point itself that estimateNormalsAutomatically() makes use of at most.
constexpr int kMostAutomaticNeighbors = 64;

/// Normals without a choice to make. The noise is estimated from the residuals of quadratic
/// surfaces; every point then gets the largest neighbourhood whose residual the noise explains:
/// large ones on noisy scans, small ones where the surface bends, cubic ones if without noise they
/// are nearer to most points. Where not even the smallest is explained there is an edge, unless
/// without noise the surface follows the neighbours so much better than a plane that it is a bend
/// between few points. At edges a clean cloud gets planes of six neighbours where these are all on
/// one side, else local Delaunay triangulations, which smooth least, and a noisy one cubic surfaces
/// if these fit most such points better, else the smallest quadratic ones. In a clean cloud that a
/// scanner saw by lines, neighbours that are all of one line tell no normal, however well something
/// fits them: such points get the plane of as few neighbours as spread in two directions, unless
/// that is of two faces, or of more than there are. Nor do those of two lines tell the slope of a
/// quadratic surface: such points get one of more neighbours, see takeAcrossLines().
///
/// \param points distinct points \param neighborhoods of them, the wider the table the better up to
///        kMostAutomaticNeighbors; with a narrow one noisy clouds are served less well
/// \param normals 4 floats a row, as from estimateNormals()
/// \param unexplained where not null: rows at which noise explains the residual of none of the
///        quadratic surfaces, ascending
/// \param rows ascending rows to do, or null for all; others are left as they are
/// \param known of the cloud that the points are part of; null = measured
SEGORIENT_FEATURES_EXPORT AutomaticNormalReport estimateNormalsAutomatically(
    const PointView& points, const Neighborhoods& neighborhoods, int threads, float* normals,
    std::vector<pcl::index_t>* unexplained = nullptr,
    const std::vector<pcl::index_t>* rows = nullptr, const AutomaticNormalTraits* known = nullptr);

/// The same, with more neighbours where the noise asks for them: then they are sought again.
/// \param index built on `points`
SEGORIENT_FEATURES_EXPORT AutomaticNormalReport estimateNormalsAutomatically(
    const PointView& points, const search::MedianHashIndex& index,
    const Neighborhoods& neighborhoods, int threads, float* normals,
    std::vector<pcl::index_t>* unexplained = nullptr,
    const std::vector<pcl::index_t>* rows = nullptr, const AutomaticNormalTraits* known = nullptr);

/// How many neighbours beside the point itself estimateNormalsAutomatically() makes use of.
SEGORIENT_FEATURES_EXPORT int automaticNeighbors(const PointView& points,
                                                 const Neighborhoods& neighborhoods,
                                                 int threads = 0,
                                                 const AutomaticNormalTraits* known = nullptr);

}  // namespace segorient
