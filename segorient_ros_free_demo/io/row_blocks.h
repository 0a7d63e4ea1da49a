// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "common/parts.h"
#include "io/output_file.h"

namespace segorient::program {

/// Writes rows in blocks; `makeRow (row, to)` fills row_bytes bytes, of several rows at once where
/// there are threads for it.
template <typename MakeRow>
void writeRows(std::size_t size, std::size_t row_bytes, OutputFile& file, const MakeRow& make_row,
               int threads = 1) {
  constexpr std::size_t kRowsOfThread = 4096;
  constexpr double kRowTime = 20.0;  // nanoseconds
  const Parts all(size, threads, kRowTime);
  const std::size_t at_once = kRowsOfThread * all.count();
  std::vector<std::uint8_t> block(std::min(at_once, size) * row_bytes);
  for (std::size_t first = 0; first < size; first += at_once) {
    const std::size_t count = std::min(at_once, size - first);
    const Parts parts(count, static_cast<int>(all.count()), kRowTime);
    parts.forEach([&](std::size_t part) {
      for (std::size_t i = parts.begin(part); i < parts.end(part); ++i) {
        make_row(first + i, block.data() + i * row_bytes);
      }
    });
    file.write(block.data(), count * row_bytes);
  }
}

}  // namespace segorient::program
