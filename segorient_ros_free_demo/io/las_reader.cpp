// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <algorithm>
#include <cmath>
#include <cstring>
#include <tuple>

#include "io/cloud_stream.h"
#include "io/las_format.h"
#include "io/readers.h"

namespace segorient::program {
namespace {

constexpr std::size_t kHeader12 = 227;  // bytes of the header of LAS 1.0 to 1.2
constexpr std::size_t kHeader14 = 375;

template <typename T>
T load(const std::uint8_t* from) {
  T v;
  std::memcpy(&v, from, sizeof(T));
  return v;
}

// An extra dimension: a field of the table, and how its numbers are stored.
struct Extra {
  Field field;
  std::size_t offset = 0;  // bytes into the record
  char type = 'U';
  std::uint32_t size = 1;
  std::array<double, 3> scale{1.0, 1.0, 1.0};
  std::array<double, 3> shift{0.0, 0.0, 0.0};
  bool scaled = false;
};

struct Header {
  LasOrigin origin;
  std::size_t record_bytes = 0;
  std::uint64_t points = 0;
  std::uint64_t header_bytes = 0;
  std::uint64_t points_begin = 0;
  std::uint64_t extended_begin = 0;
  std::uint32_t records = 0;
  std::uint32_t extended_records = 0;
  std::vector<std::uint8_t> extra;  // contents of the record about extra bytes
};

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
Header readHeader(InputFile& file) {
  std::array<std::uint8_t, kHeader14> h{};
  file.read(h.data(), kHeader12);
  if (std::memcmp(h.data(), "LASF", 4) != 0) file.fail("is not a LAS file");
  Header out;
  LasOrigin& o = out.origin;
  o.source_id = load<std::uint16_t>(&h[4]);
  o.global_encoding = load<std::uint16_t>(&h[6]);
  std::copy_n(h.begin() + 8, 16, o.project_id.begin());
  o.minor_version = h[25];
  if (h[24] != 1 || o.minor_version > 4) {
    file.fail("is of a version of LAS that is not known: " + std::to_string(h[24]) + "." +
              std::to_string(h[25]));
  }
  std::memcpy(o.system_id.data(), &h[26], 32);
  o.creation_day = load<std::uint16_t>(&h[90]);
  o.creation_year = load<std::uint16_t>(&h[92]);
  out.header_bytes = load<std::uint16_t>(&h[94]);
  out.points_begin = load<std::uint32_t>(&h[96]);
  out.records = load<std::uint32_t>(&h[100]);
  constexpr unsigned kCompressed = 0xc0;  // LASzip marks the format
  if ((h[104] & kCompressed) != 0) failCompressed(file);
  o.point_format = h[104];
  if (o.point_format > 10) {
    file.fail("has points of a format that is not known: " + std::to_string(o.point_format));
  }
  out.record_bytes = load<std::uint16_t>(&h[105]);
  if (out.record_bytes < kLasPointBytes[static_cast<std::size_t>(o.point_format)]) {
    file.fail("has records too short for its point format");
  }
  out.points = load<std::uint32_t>(&h[107]);
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
    out.extended_begin = load<std::uint64_t>(&h[235]);
    out.extended_records = load<std::uint32_t>(&h[243]);
    const auto points = load<std::uint64_t>(&h[247]);
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
void readRecords(InputFile& file, Header& header, std::uint64_t bytes) {
  if (bytes > file.remaining()) file.fail("is cut short: it ends before its points");
  std::vector<std::uint8_t> area(static_cast<std::size_t>(bytes));
  if (!area.empty()) file.read(area.data(), area.size());
  std::size_t at = 0;
  for (std::uint32_t r = 0; r < header.records; ++r) {
    if (area.size() - at < kLasRecordHeader) {
      file.fail("says that it has more variable length records than there is room for");
    }
    const std::size_t length = load<std::uint16_t>(&area[at + 20]);
    if (area.size() - at - kLasRecordHeader < length) {
      file.fail("has a variable length record that reaches into its points");
    }
    const auto first = area.begin() + static_cast<std::ptrdiff_t>(at);
    const auto last = first + static_cast<std::ptrdiff_t>(kLasRecordHeader + length);
    const std::string user = userOf(&area[at]);
    const auto id = load<std::uint16_t>(&area[at + 18]);
    if (user == "laszip encoded") failCompressed(file);
    if (user == kLasSpecUser && id == kLasExtraBytesId) {
      header.extra.assign(first + kLasRecordHeader, last);
    } else if (!isAboutLayout(user, id)) {
      header.origin.records.emplace_back(first, last);
    }
    at += kLasRecordHeader + length;
  }
}

// The records behind the points. Nothing of the cloud depends on them: what is not whole is left
// out.
void readExtendedRecords(InputFile& file, Header& header, std::uint64_t position) {
  if (header.extended_records == 0 || header.extended_begin < position ||
      header.extended_begin - position > file.remaining()) {
    return;
  }
  file.skip(header.extended_begin - position);
  for (std::uint32_t r = 0; r < header.extended_records; ++r) {
    if (file.remaining() < kLasExtendedRecordHeader) return;
    std::vector<std::uint8_t> record(kLasExtendedRecordHeader);
    file.read(record.data(), record.size());
    const auto length = load<std::uint64_t>(&record[20]);
    if (length > file.remaining()) return;
    if (isAboutLayout(userOf(record.data()), load<std::uint16_t>(&record[18]))) {
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

// One description of 192 bytes. Types 1 to 10 are numbers, 11 to 30 pairs and triples of them, 0 is
// bytes without a meaning.
bool describe(const std::uint8_t* description, std::size_t number, std::size_t& offset,
              Extra& extra) {
  static constexpr std::array<std::pair<char, std::uint32_t>, 10> kTypes{{{'U', 1},
                                                                          {'I', 1},
                                                                          {'U', 2},
                                                                          {'I', 2},
                                                                          {'U', 4},
                                                                          {'I', 4},
                                                                          {'U', 8},
                                                                          {'I', 8},
                                                                          {'F', 4},
                                                                          {'F', 8}}};
  const unsigned type = description[2];
  const unsigned options = description[3];
  if (type == 0 || type > 30) {
    offset += type == 0 ? options : 0;
    return false;
  }
  const auto* text = reinterpret_cast<const char*>(description + 4);
  extra.field.name = fieldNameOfLas({text, strnlen(text, 32)});
  if (extra.field.name.empty()) extra.field.name = "extra_" + std::to_string(number);
  std::tie(extra.type, extra.size) = kTypes[(type - 1) % 10];
  extra.field.count = (type - 1) / 10 + 1;
  extra.offset = offset;
  constexpr unsigned kHasScale = 8;
  constexpr unsigned kHasOffset = 16;
  for (std::size_t e = 0; e < 3; ++e) {
    if ((options & kHasScale) != 0) extra.scale[e] = load<double>(description + 112 + 8 * e);
    if ((options & kHasOffset) != 0) extra.shift[e] = load<double>(description + 136 + 8 * e);
  }
  extra.scaled = (options & (kHasScale | kHasOffset)) != 0;
  extra.field.type = extra.scaled ? 'F' : extra.type;
  extra.field.size = extra.scaled ? 8 : extra.size;
  offset += std::size_t{extra.size} * extra.field.count;
  return true;
}

std::vector<Extra> readExtras(const InputFile& file, const Header& header, CloudTable& table) {
  std::vector<Extra> extras;
  std::size_t offset = kLasPointBytes[static_cast<std::size_t>(header.origin.point_format)];
  for (std::size_t at = 0; at + kLasExtraBytes <= header.extra.size(); at += kLasExtraBytes) {
    Extra extra;
    if (describe(&header.extra[at], extras.size(), offset, extra)) extras.push_back(extra);
  }
  if (offset > header.record_bytes) {
    file.fail("describes more extra bytes than its points have");
  }
  if (offset < header.record_bytes) {
    table.notes.push_back(std::to_string(header.record_bytes - offset) +
                          " extra bytes of each point are left out: they are not described");
  }
  return extras;
}

void addFields(const std::vector<LasItem>& items, bool colors, std::vector<Extra>& extras,
               CloudTable& table) {
  for (const char* name : {"x", "y", "z"}) table.addField(name, 'F', 8);
  for (const LasItem& item : items) table.addField(item.name, item.type, item.size);
  if (colors) table.addField("rgb", 'F', 4);
  for (Extra& extra : extras) {
    while (table.find(extra.field.name) != nullptr) extra.field.name += "_extra";
    table.addField(extra.field.name, extra.field.type, extra.field.size, extra.field.count);
    extra.field = table.fields.back();
  }
}

void readItem(const LasItem& item, const std::uint8_t* record, std::uint8_t* to) {
  const std::uint8_t* from = record + item.offset;
  float real = 0.F;
  switch (item.kind) {
    case LasItem::Kind::Number:
      std::memcpy(to, from, item.size);
      return;
    case LasItem::Kind::Bits:
      *to = static_cast<std::uint8_t>(static_cast<unsigned>(*from) >> item.shift & item.mask);
      return;
    case LasItem::Kind::Intensity:
      real = static_cast<float>(load<std::uint16_t>(from));
      break;
    case LasItem::Kind::Rank:
      real = static_cast<float>(load<std::int8_t>(from));
      break;
    case LasItem::Kind::Angle:
      real = 0.006F * static_cast<float>(load<std::int16_t>(from));
      break;
  }
  std::memcpy(to, &real, sizeof(real));
}

void readExtra(const Extra& extra, const std::uint8_t* record, std::uint8_t* to) {
  const std::uint8_t* from = record + extra.offset;
  if (!extra.scaled) {
    std::memcpy(to, from, extra.field.bytes());
    return;
  }
  for (std::size_t e = 0; e < extra.field.count; ++e) {
    const double v =
        extra.scale[e] * loadNumber(from + e * extra.size, extra.type, extra.size) + extra.shift[e];
    std::memcpy(to + 8 * e, &v, sizeof(v));
  }
}

// Colours of 8 bits, as PCL has them: the upper halves, unless the file has lower ones only.
void packColors(CloudTable& table) {
  const std::array<const Field*, 3> from{table.find("red16"), table.find("green16"),
                                         table.find("blue16")};
  double largest = 0.0;
  for (std::size_t i = 0; i < table.size; ++i) {
    for (const double v : table.triple(from, i)) largest = std::max(largest, v);
  }
  if (largest == 0.0) {  // room for colours, but none in it
    const std::vector<std::string> empty{"rgb", "red16", "green16", "blue16"};
    table.fields.erase(std::remove_if(table.fields.begin(), table.fields.end(),
                                      [&](const Field& f) {
                                        return std::find(empty.begin(), empty.end(), f.name) !=
                                               empty.end();
                                      }),
                       table.fields.end());
    return;
  }
  const unsigned shift = largest > 255.0 ? 8 : 0;
  const Field& rgb = *table.find("rgb");
  for (std::size_t i = 0; i < table.size; ++i) {
    std::uint32_t packed = 0;
    for (const double v : table.triple(from, i)) {
      packed = packed << 8 | static_cast<std::uint32_t>(v) >> shift;
    }
    std::memcpy(table.at(rgb, i), &packed, sizeof(packed));
  }
}

// All but packed colours.
void readRecord(const LasOrigin& origin, const std::vector<LasItem>& items,
                const std::vector<Extra>& extras, const std::uint8_t* record, std::size_t row,
                CloudTable& table) {
  for (std::size_t a = 0; a < 3; ++a) {
    const double stored = load<std::int32_t>(record + 4 * a);
    table.setReal(table.fields[a], row, origin.scale[a] * stored + origin.offset[a]);
  }
  for (std::size_t f = 0; f < items.size(); ++f) {
    readItem(items[f], record, table.at(table.fields[3 + f], row));
  }
  for (const Extra& extra : extras) readExtra(extra, record, table.at(extra.field, row));
}

}  // namespace

CloudTable readLas(InputFile& file) {
  Header header = readHeader(file);
  readRecords(file, header, header.points_begin - header.header_bytes);
  const int format = header.origin.point_format;
  CloudTable table;
  const std::vector<LasItem> items = lasItems(format);
  std::vector<Extra> extras = readExtras(file, header, table);
  addFields(items, lasHasColor(format), extras, table);
  if (lasHasWaveform(format)) table.notes.emplace_back("the waveforms of its points are left out");
  allocateRows(file, table, header.points, header.record_bytes);
  table.width = table.size;

  constexpr std::size_t kRowsAtOnce = 4096;
  std::vector<std::uint8_t> records(kRowsAtOnce * header.record_bytes);
  for (std::size_t first = 0; first < table.size; first += kRowsAtOnce) {
    const std::size_t count = std::min(kRowsAtOnce, table.size - first);
    file.read(records.data(), count * header.record_bytes);
    for (std::size_t i = 0; i < count; ++i) {
      readRecord(header.origin, items, extras, records.data() + i * header.record_bytes, first + i,
                 table);
    }
  }
  readExtendedRecords(file, header, header.points_begin + header.points * header.record_bytes);
  if (lasHasColor(format)) packColors(table);
  table.las = std::make_shared<LasOrigin>(std::move(header.origin));
  return table;
}

std::optional<RowFormat> lasRows(InputFile& file) {
  Header header = readHeader(file);
  readRecords(file, header, header.points_begin - header.header_bytes);
  const std::uint64_t points_end = header.points_begin + header.points * header.record_bytes;
  if (header.extended_records > 0 && points_end - header.points_begin <= file.remaining()) {
    file.seek(points_end);
    readExtendedRecords(file, header, points_end);
    file.seek(header.points_begin);
  }
  RowFormat rows;
  const std::vector<LasItem> items = lasItems(header.origin.point_format);
  std::vector<Extra> extras = readExtras(file, header, rows.layout);
  addFields(items, false, extras, rows.layout);
  rows.size = header.points;
  rows.file_bytes = header.record_bytes;
  const auto origin = std::make_shared<const LasOrigin>(std::move(header.origin));
  rows.layout.las = origin;
  rows.convert = [origin, items, extras, bytes = header.record_bytes](const std::uint8_t* from,
                                                                      CloudTable& block) {
    for (std::size_t i = 0; i < block.size; ++i) {
      readRecord(*origin, items, extras, from + i * bytes, i, block);
    }
  };
  return rows;
}

}  // namespace segorient::program
