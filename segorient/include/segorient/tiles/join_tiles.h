// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/orientation/orientation_hints.h>
#include <segorient/orientation/orientation_result.h>
#include <segorient/tiles/tile_share.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace segorient {

/// What is known of the whole cloud when its tiles are joined. Places are relative to the origin
/// that tiles are given offsets from.
struct JoinOptions {
  TileTraits traits;
  /// As for orientCloud(), but by patch, in the order in which tiles and their patches were added.
  OrientationHints hints;
  int threads = 0;
};

/// The orientation of the whole cloud, by patch of each tile.
struct JoinedTile {
  std::vector<std::int8_t> signs;  ///< what the patch's normals are to be multiplied by
  std::vector<float> confidences;  ///< 0 to 1
  std::vector<float> toward;       ///< 3 a patch: unit vector to its sensor, 0 = unknown; or empty
  std::vector<std::uint32_t> labels;  ///< by the tile's own label: the whole cloud's
};

struct JoinedTiles {
  std::vector<JoinedTile> tiles;
  std::vector<ComponentOrientationResult> components;  ///< by descending number of points
  std::size_t pieces = 0;                              ///< of all tiles
  std::size_t segments = 0;                            ///< of the whole cloud
};

/// Puts tiles together: pieces that two tiles see the same points of vote on each other as pieces
/// along a border do; then the whole graph is oriented by the default method as a cloud in memory
/// is, with patches for points. Memory is linear in pieces, votes and patches.
class TileJoiner {
 public:
  TileJoiner();
  ~TileJoiner();
  TileJoiner(const TileJoiner&) = delete;
  TileJoiner& operator=(const TileJoiner&) = delete;

  /// Tiles one after another. \param offset of the tile's origin
  void addTile(const std::vector<std::uint32_t>& piece_sizes,
               const std::vector<std::uint32_t>& segment_sizes, const std::vector<TileVote>& votes,
               const std::vector<TilePatch>& patches, const std::array<double, 3>& offset);
  /// Points that two tiles both have: entry i of both is one point.
  void tie(std::size_t tile_a, const std::vector<TileTie>& of_a, std::size_t tile_b,
           const std::vector<TileTie>& of_b);
  /// After all tiles and ties; once.
  JoinedTiles join(const JoinOptions& options);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Turns final normals to their sensors wherever their own error leaves no doubt.
/// \param toward 3 floats a point, see JoinedTile \param normals 4 floats a point
/// \param confidences see TileShare
void faceSensors(const std::vector<float>& toward, std::vector<float>& normals,
                 const std::vector<float>& confidences);

}  // namespace segorient
