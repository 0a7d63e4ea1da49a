// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "io/output_file.h"

namespace segorient::program {

/// Writes rows in blocks; `makeRow (row, to)` fills row_bytes bytes.
template <typename MakeRow>
void writeRows(std::size_t size, std::size_t row_bytes, OutputFile& file, const MakeRow& make_row) {
  constexpr std::size_t kRowsAtOnce = 4096;
  std::vector<std::uint8_t> block(kRowsAtOnce * row_bytes);
  for (std::size_t first = 0; first < size; first += kRowsAtOnce) {
    const std::size_t count = std::min(kRowsAtOnce, size - first);
    for (std::size_t i = 0; i < count; ++i) make_row(first + i, block.data() + i * row_bytes);
    file.write(block.data(), count * row_bytes);
  }
}

}  // namespace segorient::program
