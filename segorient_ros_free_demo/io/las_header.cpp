// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "io/las_header.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace segorient::program {
namespace {

constexpr std::size_t kHeader12 = 227;  // bytes of the header of LAS 1.0 to 1.2
constexpr std::size_t kHeader14 = 375;

[[noreturn]] void failCompressed(const InputFile& file) {
  file.fail(
      "is compressed (LAZ), which is not read; unpack it first: 'laszip -i IN.laz -o OUT.las' "
      "(LAStools) or 'pdal translate IN.laz OUT.las'");
}

void checkScales(const InputFile& file, const LasOrigin& origin) {
  for (std::size_t a = 0; a < 3; ++a) {
    if (!std::isfinite(origin.scale[a]) || origin.scale[a] == 0.0 ||
        !std::isfinite(origin.offset[a])) {
      file.fail("has a scale or an offset of coordinates that is no number, or 0");
    }
  }
}

// The part of the header that all versions have, then what the version adds.
LasHeader readFixedPart(InputFile& file) {
  std::array<std::uint8_t, kHeader14> h{};
  file.read(h.data(), kHeader12);
  if (std::memcmp(h.data(), "LASF", 4) != 0) file.fail("is not a LAS file");
  LasHeader out;
  LasOrigin& o = out.origin;
  o.source_id = loadLas<std::uint16_t>(&h[4]);
  o.global_encoding = loadLas<std::uint16_t>(&h[6]);
  std::copy_n(h.begin() + 8, 16, o.project_id.begin());
  o.minor_version = h[25];
  if (h[24] != 1 || o.minor_version > 4) {
    file.fail("is of a version of LAS that is not known: " + std::to_string(h[24]) + "." +
              std::to_string(h[25]));
  }
  std::memcpy(o.system_id.data(), &h[26], 32);
  o.creation_day = loadLas<std::uint16_t>(&h[90]);
  o.creation_year = loadLas<std::uint16_t>(&h[92]);
  out.header_bytes = loadLas<std::uint16_t>(&h[94]);
  out.points_begin = loadLas<std::uint32_t>(&h[96]);
  out.records = loadLas<std::uint32_t>(&h[100]);
  constexpr unsigned kCompressed = 0xc0;  // LASzip marks the format
  if ((h[104] & kCompressed) != 0) failCompressed(file);
  o.point_format = h[104];
  if (o.point_format > 10) {
    file.fail("has points of a format that is not known: " + std::to_string(o.point_format));
  }
  out.record_bytes = loadLas<std::uint16_t>(&h[105]);
  if (out.record_bytes < kLasPointBytes[static_cast<std::size_t>(o.point_format)]) {
    file.fail("has records too short for its point format");
  }
  out.points = loadLas<std::uint32_t>(&h[107]);
  std::memcpy(o.scale.data(), &h[131], 24);
  std::memcpy(o.offset.data(), &h[155], 24);
  checkScales(file, o);
  if (out.header_bytes < kHeader12 || out.points_begin < out.header_bytes) {
    file.fail("has a header that contradicts itself: no room for it before the points");
  }
  std::size_t read = kHeader12;
  if (o.minor_version == 4) {
    if (out.header_bytes < kHeader14) file.fail("has a header too short for LAS 1.4");
    file.read(h.data() + read, kHeader14 - read);
    read = kHeader14;
    out.extended_begin = loadLas<std::uint64_t>(&h[235]);
    out.extended_records = loadLas<std::uint32_t>(&h[243]);
    const auto points = loadLas<std::uint64_t>(&h[247]);
    if (points != 0) out.points = points;
  }
  file.skip(out.header_bytes - read);
  return out;
}

// Records that the points' new layout makes wrong, or that belong to what is not kept.
bool isAboutLayout(const std::string& user, std::uint16_t id) {
  const bool waveforms = (id > 99 && id < 355) || id == 65535;
  if (user == kLasSpecUser) return id == kLasExtraBytesId || waveforms;
  return user == "laszip encoded" || user == "copc";
}

std::string userOf(const std::uint8_t* record) {
  const char* text = reinterpret_cast<const char*>(record + 2);
  return {text, strnlen(text, 16)};
}

// Everything between header and points; the records in it, as far as they are whole.
void readRecords(InputFile& file, LasHeader& header, std::uint64_t bytes) {
  if (bytes > file.remaining()) file.fail("is cut short: it ends before its points");
  std::vector<std::uint8_t> area(static_cast<std::size_t>(bytes));
  if (!area.empty()) file.read(area.data(), area.size());
  std::size_t at = 0;
  for (std::uint32_t r = 0; r < header.records; ++r) {
    if (area.size() - at < kLasRecordHeader) {
      file.fail("says that it has more variable length records than there is room for");
    }
    const std::size_t length = loadLas<std::uint16_t>(&area[at + 20]);
    if (area.size() - at - kLasRecordHeader < length) {
      file.fail("has a variable length record that reaches into its points");
    }
    const auto first = area.begin() + static_cast<std::ptrdiff_t>(at);
    const auto last = first + static_cast<std::ptrdiff_t>(kLasRecordHeader + length);
    const std::string user = userOf(&area[at]);
    const auto id = loadLas<std::uint16_t>(&area[at + 18]);
    if (user == "laszip encoded") failCompressed(file);
    if (user == kLasSpecUser && id == kLasExtraBytesId) {
      header.extra.assign(first + kLasRecordHeader, last);
    } else if (!isAboutLayout(user, id)) {
      header.origin.records.emplace_back(first, last);
    }
    at += kLasRecordHeader + length;
  }
}

}  // namespace

LasHeader readLasHeader(InputFile& file) {
  LasHeader header = readFixedPart(file);
  readRecords(file, header, header.points_begin - header.header_bytes);
  return header;
}

void readLasRecordsBehind(InputFile& file, LasHeader& header, std::uint64_t position) {
  const std::uint64_t end = position + file.remaining();
  const bool inside = header.extended_records > 0 && header.extended_begin >= position &&
                      header.extended_begin <= end;
  if (header.extended_records > 0 && !inside) {
    header.notes.emplace_back("the records behind its points are left out: they are not there");
  }
  const bool waveforms = lasHasWaveform(header.origin.point_format);  // they may be behind, too
  if (waveforms) {
    header.notes.emplace_back("the waveforms of its points are left out");
  }
  const std::uint64_t more =
      ((inside ? header.extended_begin : end) - position) / header.record_bytes;
  if (more > 0 && !waveforms) {
    header.notes.push_back("there is room for " + std::to_string(more) +
                           " more points than its header counts: they are not read");
  }
  if (!inside) return;
  file.skip(header.extended_begin - position);
  for (std::uint32_t r = 0; r < header.extended_records; ++r) {
    if (file.remaining() < kLasExtendedRecordHeader) return;
    std::vector<std::uint8_t> record(kLasExtendedRecordHeader);
    file.read(record.data(), record.size());
    const auto length = loadLas<std::uint64_t>(&record[20]);
    if (length > file.remaining()) return;
    if (isAboutLayout(userOf(record.data()), loadLas<std::uint16_t>(&record[18]))) {
      file.skip(length);
      continue;
    }
    record.resize(kLasExtendedRecordHeader + static_cast<std::size_t>(length));
    if (length > 0) {
      file.read(record.data() + kLasExtendedRecordHeader, static_cast<std::size_t>(length));
    }
    header.origin.extended_records.push_back(std::move(record));
  }
}

}  // namespace segorient::program
