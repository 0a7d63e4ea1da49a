// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/tiles/tile_share.h>

#include <cstdint>
#include <string>
#include <vector>

#include "io/input_file.h"
#include "io/output_file.h"

// The files that one tile leaves: rows, what becomes of its own points, for write; share and ties,
// for join; signs, what join says of it.
namespace segorient::program {

/// What is known of one of a tile's own points.
struct RowRecord {
  std::uint32_t row_low = 0;
  std::uint32_t row_high = 0;
  float normal[4] = {0.F, 0.F, 0.F, 0.F};  ///< with the curvature
  std::int32_t label = -1;                 ///< of the tile
  std::int32_t followed = -1;              ///< see TileShare

  std::uint64_t row() const { return std::uint64_t{row_high} << 32 | row_low; }
};

/// A point that several tiles know, as one of them sees it.
struct TieRecord {
  std::uint64_t row = 0;
  std::int32_t piece = -1;
  std::int32_t label = -1;
  float normal[3] = {0.F, 0.F, 0.F};
  std::uint32_t unused = 0;
};

/// The part of a file of ties that is about one tile's points.
struct TieSlice {
  std::uint32_t owner = 0;
  std::uint32_t unused = 0;
  std::uint64_t first = 0;  ///< record
  std::uint64_t count = 0;
  std::uint64_t checksum = 0;
};

/// The file of shares: all but ties.
struct ShareFile {
  std::vector<std::uint32_t> piece_sizes;
  std::vector<std::int8_t> piece_signs;
  std::vector<std::uint32_t> segment_sizes;
  std::vector<TileVote> votes;
  std::vector<TilePatch> patches;
  std::vector<float> viewpoints;  ///< 3 a patch, relative to the plan's origin; or empty
  std::vector<TieSlice> slices;   ///< ascending by owner
};

void saveShare(const ShareFile& share, const std::string& path, std::uint64_t run,
               std::uint32_t tile);
ShareFile loadShare(const std::string& path, std::uint64_t run, std::uint32_t tile);

/// The records of one slice; throws FileError where they are not what was written.
std::vector<TieRecord> loadTies(const std::string& path, std::uint64_t run, std::uint32_t tile,
                                const TieSlice& slice);

void saveSigns(const TileSigns& signs, const std::string& path, std::uint64_t run,
               std::uint32_t tile);
TileSigns loadSigns(const std::string& path, std::uint64_t run, std::uint32_t tile);

/// What a tile's second round made: empty where the first one's results stay.
struct FinalFile {
  bool again = false;  ///< whether there are rows and ties of it
  std::vector<std::uint32_t> segment_sizes;
  std::vector<TieSlice> slices;
};

void saveFinal(const FinalFile& made, const std::string& path, std::uint64_t run,
               std::uint32_t tile);
FinalFile loadFinal(const std::string& path, std::uint64_t run, std::uint32_t tile);

/// Labels of the whole cloud, by tile and by its own label.
using LabelFile = std::vector<std::vector<std::uint32_t>>;

void saveLabels(const LabelFile& labels, const std::string& path, std::uint64_t run);
LabelFile loadLabels(const std::string& path, std::uint64_t run, std::size_t tiles);

/// Writes a file of rows, ascending.
void saveRows(const std::vector<RowRecord>& rows, const std::string& path, std::uint64_t run,
              std::uint32_t tile);

/// Reads a file of rows from any of them on, a block at a time.
class RowReader {
 public:
  /// \param first_row the first that is wanted
  RowReader(std::string path, std::uint64_t run, std::uint32_t tile, std::uint64_t first_row);
  bool done() const { return at_ >= block_.size(); }
  const RowRecord& row() const { return block_[at_]; }
  void next() {
    if (++at_ >= block_.size()) load(block_number_ + 1);
  }

 private:
  void load(std::uint64_t number);

  std::string path_;
  std::uint64_t run_;
  std::uint32_t tile_;
  std::uint64_t count_ = 0;
  std::uint64_t block_number_ = 0;
  std::vector<RowRecord> block_;
  std::size_t at_ = 0;
};

}  // namespace segorient::program
