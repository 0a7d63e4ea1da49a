// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/export.h>
#include <segorient/common/point_view.h>
#include <segorient/orientation/orientation_hints.h>

#include <cstdint>
#include <vector>

#include "common/bulk_bounds.h"
#include "orientation/sensors/point_hints.h"

// What one tile of a large cloud contributes to its orientation. The structures of numbers are
// stored as they are in memory.
namespace segorient {

/// What no tile can tell by itself: properties of the whole cloud, the same for all tiles.
struct TileTraits {
  float noise = 0.F;         ///< rms distance from a plane over few neighbours, in spacings
  float wide_noise = 0.F;    ///< over many
  float residual = 0.F;      ///< median residual of the normals' planes, in spacings
  std::uint8_t thin = 0;     ///< whether many neighbourhoods see two walls
  std::uint8_t scan = 0;     ///< whether normals need the larger neighbourhoods of scans
  std::uint8_t denoise = 0;  ///< whether positions are smoothed first

  // Of the surfaces that final normals come from.
  std::uint8_t edges = 0;          ///< whether there are sharp edges
  std::uint8_t analytic = 0;       ///< whether the surface is as smooth as one that a formula makes
  std::uint8_t cubic_edges = 0;    ///< whether cubic surfaces fit edges better
  std::uint8_t level_thin = 0;     ///< `thin` of the level
  std::uint8_t noisy = 0;          ///< whether borders tell too little of which way sheets go on
  std::uint8_t consistent = 0;     ///< see NoiseField
  std::uint8_t judged = 0;         ///< whether signs contradict each other somewhere
  std::uint8_t edges_sampled = 0;  ///< whether there are points on sharp edges themselves
  std::uint8_t fine_field = 0;     ///< see NoiseField::fine
  std::uint32_t lines = 0;         ///< see SheetTraits; no hidden bytes: stored as it is
  float surface_noise = 0.F;       ///< standard deviation, in the points' unit
  float surface_ratio = 0.F;       ///< the same, in spacings
  float typical_offset = 0.F;      ///< see FinishedSegments

  // Of the coarser level whose signs the cloud takes, see followCoarserLevels().
  float level = 0.F;         ///< its radius in spacings, 0 = none
  float level_radius = 0.F;  ///< in the points' unit
  float level_noise = 0.F;   ///< as above, of the level's points
  float level_wide_noise = 0.F;
  float level_residual = 0.F;

  /// Whether the field of all points goes before what borders tell.
  bool hasField() const { return noisy != 0 || level > 0.F; }
  /// Whether all points are asked for one: of means of several, parts of a spacing are no more.
  bool wantsFieldPoints(std::uint32_t patch_points) const {
    return hasField() || (judged != 0 && patch_points == 1);
  }
};

/// Orients the points by the default method, and takes what it measured on the way.
/// \param points the whole cloud, or neighbourhoods from all over it, as dense as they are
/// \param k neighbours, 0 = the default
/// \param hints as for orientCloud(); they are not sought where there are none
SEGORIENT_TILES_EXPORT TileTraits measureTileTraits(const PointView& points, int k,
                                                    const OrientationHints& hints, int threads = 0);

/// Which points of a tile's input are its own.
enum class TileRole : std::uint8_t {
  HALO,   ///< another tile's
  OWN,    ///< its own
  SHARED  ///< its own, and in the halo of others
};

inline bool isOwn(TileRole role) {
  return role == TileRole::OWN || role == TileRole::SHARED;
}

/// Votes along the border of two pieces, see borderVotes(): sums of votes, of their absolute
/// values, and of those that are reliable.
struct TileVote {
  std::int32_t a = 0;
  std::int32_t b = 0;
  float sheet[3] = {0.F, 0.F, 0.F};
  float wall[3] = {0.F, 0.F, 0.F};
  std::uint32_t count = 0;
};

/// Some neighbouring points of one piece, as one: the tile's part of the far field.
struct TilePatch {
  float position[3] = {0.F, 0.F, 0.F};  ///< relative to the tile's origin
  float normal[3] = {0.F, 0.F, 0.F};    ///< as the piece is turned
  float spacing = 0.F;                  ///< its square is the sum over the points
  float residual = 0.F;                 ///< mean, in spacings
  std::int32_t piece = -1;
  std::uint32_t points = 0;
  std::uint32_t reliable = 0;  ///< how many of them
  std::uint32_t row = 0;       ///< of the tile's input: the first of them
};

/// A point, or the mean of some, for the field of all points, where noise or layers hide which way
/// sheets go on.
struct FieldPoint {
  float position[3] = {0.F, 0.F, 0.F};  ///< as measured, relative to the tile's origin
  float normal[3] = {0.F, 0.F, 0.F};    ///< filtered, as `piece` is turned
  std::int32_t piece = -1;              ///< whose sign the first one's normal follows
  float confidence = 0.F;               ///< mean: whether the normals around agree
};

/// A point that two tiles know, as one of them sees it.
struct TileTie {
  std::uint32_t row = 0;  ///< of the tile's input
  std::int32_t piece = -1;
  std::int32_t label = -1;
  float normal[3] = {0.F, 0.F, 0.F};  ///< as the piece is turned; 0 where there is none
};

/// Two segments of a tile that are next to each other, a < b.
struct LabelBorder {
  std::int32_t a = 0;
  std::int32_t b = 0;
};

/// A tile worked on alone. Pieces are parts of the surface that are oriented in themselves, sheet
/// segments; which way each is turned is for the join.
struct TileShare {
  // By row of the tile's input.
  std::vector<float> normals;        ///< 4 floats: normal as its piece is turned, curvature; or NaN
  std::vector<std::int32_t> labels;  ///< segment, -1 where there is no normal
  /// The piece whose sign the normal follows; -1 where there is none, or the sign is right already.
  std::vector<std::int32_t> followed;

  std::vector<std::uint32_t> piece_sizes;    ///< own distinct points
  std::vector<std::uint32_t> segment_sizes;  ///< own rows
  std::vector<LabelBorder> segment_borders;
  std::vector<TileVote> votes;           ///< of own points, or those of a level, as patches are
  std::vector<TilePatch> patch_list;     ///< of own points
  std::vector<FieldPoint> field_points;  ///< of own points, or none where they are not asked for
  std::vector<std::int8_t> piece_signs;  ///< that the tile alone found, and followed
  std::vector<TileTie> ties;             ///< of HALO and SHARED rows, ascending by row
};

/// What the whole cloud says of a tile.
struct TileSigns {
  std::vector<std::int8_t> pieces;       ///< what the normals of each piece are to be multiplied by
  std::vector<std::uint8_t> inside_out;  ///< one a piece, see AutoOrientation::inside_out
  std::vector<std::int8_t> patches;      ///< the same where sensors know single patches better
  std::vector<float> toward;  ///< 3 a patch: unit vector to its sensor, 0 = unknown; or empty
};

/// A cell of a CloudField.
struct FieldCell {
  float position[3] = {0.F, 0.F, 0.F};
  float vector[3] = {0.F, 0.F, 0.F};  ///< in noise the normal times the area, else the normal
  float value = 0.F;                  ///< in noise the area, else the sign that points take
  std::uint32_t keeps = 0;            ///< in noise: see NoiseField
};

/// What the field of all points tells where borders do not know: an even subset of the whole cloud.
/// See NoiseField and CellSigns in orientation/automatic.
struct CloudField {
  std::vector<FieldCell> cells;  ///< none = it says nothing
  float radius = 0.F;            ///< of the smoothing in noise, else the spacing of patches
  /// Which of the two it is: 0, or in noise whether NoiseField::consistent.
  std::uint8_t noise = 0;
  static constexpr std::uint8_t kNoise = 1;
  static constexpr std::uint8_t kConsistentNoise = 2;
  float averaged_below = 0.F;  ///< in noise: see NoiseField
};

struct TileOptions {
  TileTraits traits;
  int k = 0;            ///< neighbours, 0 = the default
  float alpha = 0.F;    ///< radians, 0 = the default: largest angle between neighbours' normals,
  float beta = 0.F;     ///< between a normal and its segment's,
  float epsilon = 0.F;  ///< and what clean-up allows beyond that
  std::uint32_t patch_points = 1;  ///< most points of a patch
  /// Of the whole cloud, relative to the tile's origin: points have the order that they have there,
  /// so that where order decides, it decides as it does in memory. Without points, of the tile.
  Bounds frame;
  int threads = 0;  ///< 0 = all cores; the result does not depend on it
  /// What is known beforehand, by row of the tile's input. It helps the tile where its normals need
  /// signs; what it says of the whole is for the join.
  OrientationHints hints;
  CloudPlace place;  ///< of the whole cloud
};

/// Neighbours, normals, pieces, votes and segments of a tile: all but the signs. Where the cloud
/// takes the signs of a coarser level, pieces, votes and patches are those of the level's points.
///
/// \param points of the tile and of the halo around it
/// \param roles one a point
/// \param whole one a point: within what distance of it all points of the cloud are there. Points
/// of
///        the halo whose neighbours are farther are neighbours only
SEGORIENT_TILES_EXPORT TileShare workOnTile(const PointView& points,
                                            const std::vector<TileRole>& roles,
                                            const std::vector<float>& whole,
                                            const TileOptions& options);

/// Whether signs that the tile took for right, and made final normals from, are wrong in so many
/// places that these have to be made again; always where signs come from a coarser level or from
/// sensors.
/// \param share what workOnTile() found: votes, sizes and signs of pieces
SEGORIENT_TILES_EXPORT bool needsFinishing(const TileTraits& traits, const TileShare& share,
                                           const TileSigns& signs);

/// The same work with the signs of the whole cloud: final normals and segments as they are in it.
/// All else as for workOnTile(); there are no votes and patches.
/// \param field relative to the tile's origin
SEGORIENT_TILES_EXPORT TileShare finishTile(const PointView& points,
                                            const std::vector<TileRole>& roles,
                                            const std::vector<float>& whole,
                                            const TileOptions& options, const TileSigns& signs,
                                            const CloudField& field);

}  // namespace segorient
