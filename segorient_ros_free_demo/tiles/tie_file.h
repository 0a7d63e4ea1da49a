// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <string>
#include <vector>

#include "tiles/tile_points.h"
#include "tiles/tile_records.h"

namespace segorient::program {

/// Writes what a tile says of the points that others have as well.
/// \param share its ties, and the sizes and borders of its segments
void saveTies(const std::vector<SharedPoints>& shared, const TileShare& share,
              const std::string& path, std::uint64_t run, std::uint32_t tile);

/// Reads it in parts.
class TieReader {
 public:
  TieReader(const std::string& path, std::uint64_t run, std::uint32_t tile);
  /// What is said of the points that this tile and another one have and that `owner` owns; empty
  /// where there are none. One entry for each, without piece and label where nothing is known.
  std::vector<TileTie> about(std::uint32_t other, std::uint32_t owner) const;
  const std::vector<TieSlice>& slices() const { return slices_; }
  const std::vector<std::uint32_t>& segmentSizes() const { return segment_sizes_; }
  const std::vector<LabelBorder>& segmentBorders() const { return segment_borders_; }
  [[noreturn]] void fail() const { file_.fail(); }

 private:
  PartsReader file_;
  std::vector<TieSlice> slices_;
  std::vector<std::uint32_t> segment_sizes_;
  std::vector<LabelBorder> segment_borders_;
};

}  // namespace segorient::program
