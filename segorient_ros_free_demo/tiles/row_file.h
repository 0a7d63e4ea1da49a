// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tiles/tile_records.h"

namespace segorient::program {

/// Writes what is known of a tile's points, all of them in the order of its points' file: normals
/// and curvatures as packed_values.h has them, labels and pieces as the number of their pair.
void saveRows(const std::vector<RowRecord>& rows, const std::vector<OutputStart>& starts,
              const std::string& path, std::uint64_t run, std::uint32_t tile);

/// Reads such a file from an output's first point on, a block at a time; it is not kept open.
class RowReader {
 public:
  RowReader(const std::string& path, std::uint64_t run, std::uint32_t tile, std::uint32_t output);
  bool done() const { return at_ >= rows_.size(); }
  const RowRecord& row() const { return rows_[at_]; }
  void next() {
    if (++at_ >= rows_.size()) load(block_ + 1);
  }
  /// Goes on by so many rows.
  void skip(std::uint64_t rows);

 private:
  void load(std::size_t block);

  PartsReader file_;
  std::vector<std::uint64_t> pairs_;  // of labels and pieces
  std::vector<FilePart> blocks_;
  std::uint64_t count_ = 0;
  std::size_t block_ = 0;
  std::vector<RowRecord> rows_;  // of the block
  std::size_t at_ = 0;
};

}  // namespace segorient::program
