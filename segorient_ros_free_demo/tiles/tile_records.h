// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tiles/tile_parts.h"
#include "tiles/tile_share.h"

// The files that one tile leaves: rows, what becomes of its own points, for write; share and ties,
// for join; signs, what join says of it; and what it leaves when it is finished.
namespace segorient::program {

/// Where the points of one output begin among those of a tile.
struct OutputStart {
  std::uint64_t number = 0;
  std::uint32_t output = 0;
  std::uint32_t unused = 0;  ///< no hidden bytes: they are stored as they are
};

/// What is known of one of a tile's own points.
struct RowRecord {
  float normal[4] = {0.F, 0.F, 0.F, 0.F};  ///< with the curvature; NaN where there is none
  std::int32_t label = -1;                 ///< of the tile
  std::int32_t followed = -1;              ///< see TileShare
};

/// What one tile says of the points that it and another one have, see SharedPoints.
struct TieSlice {
  std::uint32_t other = 0;
  std::uint32_t owner = 0;
  std::uint64_t count = 0;
  FilePart part;
};

/// What a tile shares with the others, but for ties and patches.
struct ShareFile {
  std::vector<std::uint32_t> piece_sizes;
  std::vector<std::int8_t> piece_signs;
  std::vector<TileVote> votes;
};

/// Its part of the far field.
struct PatchFile {
  std::vector<TilePatch> patches;
  std::vector<FieldPoint> field_points;  ///< or empty
  std::vector<float> viewpoints;         ///< 3 a patch, relative to the plan's origin; or empty
  std::vector<float> normals;            ///< 3 a patch, known beforehand, 0 = none; or empty
};

void savePatches(const PatchFile& file, const std::string& path, std::uint64_t run,
                 std::uint32_t tile);
PatchFile loadPatches(const std::string& path, std::uint64_t run, std::uint32_t tile);

void saveShare(const ShareFile& share, const std::string& path, std::uint64_t run,
               std::uint32_t tile);
ShareFile loadShare(const std::string& path, std::uint64_t run, std::uint32_t tile);

/// What join says of a tile.
struct SignsFile {
  TileSigns signs;
  bool again = false;  ///< whether the tile has to be worked on again
  bool field = false;  ///< whether there is a file of the field, for that
};

void saveSigns(const SignsFile& file, const std::string& path, std::uint64_t run,
               std::uint32_t tile);
SignsFile loadSigns(const std::string& path, std::uint64_t run, std::uint32_t tile);

/// The field of all points, relative to the plan's origin.
void saveField(const CloudField& field, const std::string& path, std::uint64_t run);
CloudField loadField(const std::string& path, std::uint64_t run);

/// Labels of the whole cloud, by tile and by its own label.
using LabelFile = std::vector<std::vector<std::uint32_t>>;

void saveLabels(const LabelFile& labels, const std::string& path, std::uint64_t run);
LabelFile loadLabels(const std::string& path, std::uint64_t run, std::size_t tiles);

}  // namespace segorient::program
