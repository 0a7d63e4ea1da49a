// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "orientation/automatic/orient_points.h"
#include "tiles/tile_share.h"

namespace segorient::detail {

/// The points of a tile, or an even subset of them, with what was found of their sheets: the scale
/// whose pieces and votes go into the join. All arrays have one entry a point.
struct TileScale {
  PointView points;
  float unit = 1.F;                    ///< of the points, in that of the tile's input
  std::vector<std::uint32_t> rows;     ///< of the tile's input
  std::vector<std::uint8_t> own;       ///< whether it is the tile's own
  std::vector<float> whole;            ///< see workOnTile(), in the unit of the points
  std::vector<std::int32_t> patch_of;  ///< of its own points; see cutPatches()
  SheetRecord record;

  /// What the record has to know before the points are oriented: this object must stay in place.
  void prepareRecord() {
    record.voters = &own;
    record.whole = &whole;
  }
  /// The same, if the signs of the whole are known. \param hints of the points
  void prepareRecord(const TileSigns& signs, std::uint32_t patch_points, const PointHints& hints);

  /// Adds what the join needs.
  void list(std::uint32_t patch_points, TileShare& out);
  /// Of own points by their patches, of most points each. \param normals 4 floats a point,
  /// oriented \param followed the piece whose sign each follows \param pieces with the signs that
  /// they are oriented by
  void listFieldPoints(const std::vector<float>& normals, const std::vector<float>& confidences,
                       const std::vector<std::int32_t>& followed,
                       const std::vector<SegmentOrientationResult>& pieces, std::uint32_t most,
                       TileShare& out);
  /// A point's normal as its piece is turned.
  void pieceNormal(std::size_t i, float* out) const;

 private:
  AutoOrientation orientAsKnown(const Segmentation& pieces, const std::vector<float>& spacing,
                                const TileSigns& signs, const PointHints& hints) const;
  void cutPatches(const Segmentation& pieces, std::uint32_t most);
  void listVotes(TileShare& out) const;
  void makePatches(TileShare& out) const;
};

}  // namespace segorient::detail
