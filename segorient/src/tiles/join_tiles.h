// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/export.h>
#include <segorient/orientation/orientation_hints.h>
#include <segorient/orientation/orientation_result.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "tiles/tile_share.h"

namespace segorient {

namespace detail {

/// What the points that two tiles both have say of a piece (or a segment) of one and one of the
/// other.
struct PieceTie {
  std::int32_t a = 0;
  std::int32_t b = 0;
  float weight = 0.F;    ///< sum of the cosines between both tiles' normals
  float absolute = 0.F;  ///< sum of their absolute values
  std::uint32_t count = 0;
  bool most = false;  ///< whether it is most of what each of the two has in the other's tile
};

}  // namespace detail

/// What is known of the whole cloud when its tiles are joined. Places are relative to the origin
/// that tiles are given offsets from.
struct JoinOptions {
  TileTraits traits;
  std::uint32_t patch_points = 1;  ///< most points of a patch
  /// As for orientCloud(), but by patch, in the order in which tiles and their patches were added.
  OrientationHints hints;
  CloudPlace place;  ///< of the whole cloud
  /// Whether the viewpoints were found, not given: they are followed only if none of them sees
  /// sheets from both sides.
  bool sensors_found = false;
  int threads = 0;
};

struct JoinedTiles {
  std::vector<TileSigns> tiles;
  CloudField field;
  std::vector<ComponentOrientationResult> components;  ///< by descending number of points
  std::size_t pieces = 0;                              ///< of all tiles
  bool sensors_dropped = false;  ///< whether those that are known are left aside
};

/// Puts tiles together: pieces that two tiles see the same points of vote on each other as pieces
/// along a border do; then the whole graph is oriented by the default method as a cloud in memory
/// is, with patches for points. Memory is linear in pieces, votes and patches.
class SEGORIENT_TILES_EXPORT TileJoiner {
 public:
  TileJoiner();
  ~TileJoiner();
  TileJoiner(const TileJoiner&) = delete;
  TileJoiner& operator=(const TileJoiner&) = delete;

  /// Tiles one after another. \param field_points maybe none
  /// \param offset of the tile's origin
  void addTile(const std::vector<std::uint32_t>& piece_sizes, const std::vector<TileVote>& votes,
               const std::vector<TilePatch>& patches, const std::vector<FieldPoint>& field_points,
               const std::array<double, 3>& offset);
  /// Points that two tiles both have: entry i of both is one point.
  void tie(std::size_t tile_a, const std::vector<TileTie>& of_a, std::size_t tile_b,
           const std::vector<TileTie>& of_b);
  /// After all tiles and ties; once.
  JoinedTiles join(const JoinOptions& options);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Puts the segments of all tiles together: those that most of the points which two tiles both have
/// tie together are one, unless a tile knows that they are two.
class SEGORIENT_TILES_EXPORT LabelJoiner {
 public:
  /// Tiles one after another. \param segment_sizes own rows of each segment
  void addTile(const std::vector<std::uint32_t>& segment_sizes,
               const std::vector<LabelBorder>& borders);
  /// Points that two tiles both have: entry i of both is one point.
  void tie(std::size_t tile_a, const std::vector<TileTie>& of_a, std::size_t tile_b,
           const std::vector<TileTie>& of_b);
  /// \param count the segments of the whole cloud
  /// \return by tile, and by its own label: the whole cloud's, 0 the largest
  std::vector<std::vector<std::uint32_t>> join(std::size_t& count) const;

 private:
  std::vector<std::size_t> first_{0};  // label of each tile, and behind the last one
  std::vector<std::uint32_t> sizes_;
  std::vector<LabelBorder> borders_;
  std::vector<detail::PieceTie> ties_;
};

}  // namespace segorient
