// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "io/input_file.h"
#include "io/las_format.h"

namespace segorient::program {

template <typename T>
T loadLas(const std::uint8_t* from) {
  T v;
  std::memcpy(&v, from, sizeof(T));
  return v;
}

/// What a LAS file says before its points, and behind them.
struct LasHeader {
  LasOrigin origin;
  std::size_t record_bytes = 0;
  std::uint64_t points = 0;
  std::uint64_t header_bytes = 0;
  std::uint64_t points_begin = 0;
  std::uint64_t extended_begin = 0;
  std::uint32_t records = 0;
  std::uint32_t extended_records = 0;
  std::vector<std::uint8_t> extra;  ///< contents of the record about extra bytes
  std::vector<std::string> notes;   ///< what is left out of the file
};

/// Header and records, up to the first point.
LasHeader readLasHeader(InputFile& file);

/// The records behind the points. Nothing of the cloud depends on them: what is not whole is left
/// out, and so are points that the header does not count, with a note.
void readLasRecordsBehind(InputFile& file, LasHeader& header, std::uint64_t position);

}  // namespace segorient::program
