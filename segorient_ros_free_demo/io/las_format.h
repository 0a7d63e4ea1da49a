// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "io/cloud_table.h"

// The LAS format as reader and writer need it, after the specifications 1.2 to 1.4 of the ASPRS.
// Numbers are stored the little end first, as in memory.
namespace segorient::program {

/// What a LAS file says beyond its points, so that it can be written back.
struct LasOrigin {
  int minor_version = 2;
  int point_format = 0;
  std::uint16_t source_id = 0;
  std::uint16_t global_encoding = 0;
  std::array<std::uint8_t, 16> project_id{};
  std::array<char, 32> system_id{};
  std::uint16_t creation_day = 0;
  std::uint16_t creation_year = 0;
  std::array<double, 3> scale{0.0, 0.0, 0.0};  ///< 0: to be chosen
  std::array<double, 3> offset{0.0, 0.0, 0.0};
  /// Variable length records, whole, but for those about extra bytes, waveforms and compression.
  std::vector<std::vector<std::uint8_t>> records;
  std::vector<std::vector<std::uint8_t>> extended_records;
};

constexpr std::size_t kLasRecordHeader = 54;
constexpr std::size_t kLasExtendedRecordHeader = 60;
constexpr std::size_t kLasExtraBytes = 192;  ///< bytes that describe one extra dimension
constexpr std::uint16_t kLasExtraBytesId = 4;
constexpr const char* kLasSpecUser = "LASF_Spec";

/// Bytes of a point's record without extra bytes, by point format 0 to 10.
constexpr std::array<std::uint16_t, 11> kLasPointBytes{20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};

constexpr bool lasHasTime(int format) {
  return format == 1 || format >= 3;
}
constexpr bool lasHasColor(int format) {
  return format == 2 || format == 3 || format == 5 || format == 7 || format == 8 || format == 10;
}
constexpr bool lasHasInfrared(int format) {
  return format == 8 || format == 10;
}
constexpr bool lasHasWaveform(int format) {
  return format == 4 || format == 5 || format == 9 || format == 10;
}
constexpr bool lasIsExtended(int format) {
  return format >= 6;
}

/// A field of a table that is part of a point's record in the point format.
struct LasItem {
  enum class Kind : std::uint8_t {
    Number,     ///< as it is in the record
    Bits,       ///< some bits of a byte
    Intensity,  ///< 16 bits; in the table a float, as PCL has it
    Rank,       ///< scan angle in degrees, 8 bits
    Angle       ///< scan angle in units of 0.006 degrees, 16 bits
  };
  const char* name = "";
  Kind kind = Kind::Number;
  std::size_t offset = 0;  ///< bytes into the record
  char type = 'U';         ///< of the table's field
  std::uint32_t size = 1;
  unsigned shift = 0;
  unsigned mask = 255;
};

/// All items but coordinates, packed colours and waveforms.
std::vector<LasItem> lasItems(int format);

/// Offset of red, green and blue in the record; 0 where there are none.
std::size_t lasColorOffset(int format);

/// The name that a field has as an extra dimension, NormalX for normal_x, and the other way round.
std::string lasName(const std::string& field_name);
std::string fieldNameOfLas(const std::string& las_name);

}  // namespace segorient::program
