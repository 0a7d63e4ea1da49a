// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <algorithm>
#include <cmath>
#include <cstring>
#include <tuple>

#include "io/cloud_stream.h"
#include "io/las_header.h"
#include "io/readers.h"

namespace segorient::program {
namespace {

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
    if ((options & kHasScale) != 0) extra.scale[e] = loadLas<double>(description + 112 + 8 * e);
    if ((options & kHasOffset) != 0) extra.shift[e] = loadLas<double>(description + 136 + 8 * e);
  }
  extra.scaled = (options & (kHasScale | kHasOffset)) != 0;
  extra.field.type = extra.scaled ? 'F' : extra.type;
  extra.field.size = extra.scaled ? 8 : extra.size;
  offset += std::size_t{extra.size} * extra.field.count;
  return true;
}

std::vector<Extra> readExtras(const InputFile& file, const LasHeader& header, CloudTable& table) {
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
      real = static_cast<float>(loadLas<std::uint16_t>(from));
      break;
    case LasItem::Kind::Rank:
      real = static_cast<float>(loadLas<std::int8_t>(from));
      break;
    case LasItem::Kind::Angle:
      real = 0.006F * static_cast<float>(loadLas<std::int16_t>(from));
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
    const double stored = loadLas<std::int32_t>(record + 4 * a);
    table.setReal(table.fields[a], row, origin.scale[a] * stored + origin.offset[a]);
  }
  for (std::size_t f = 0; f < items.size(); ++f) {
    readItem(items[f], record, table.at(table.fields[3 + f], row));
  }
  for (const Extra& extra : extras) readExtra(extra, record, table.at(extra.field, row));
}

}  // namespace

CloudTable readLas(InputFile& file) {
  LasHeader header = readLasHeader(file);
  const int format = header.origin.point_format;
  CloudTable table;
  const std::vector<LasItem> items = lasItems(format);
  std::vector<Extra> extras = readExtras(file, header, table);
  addFields(items, lasHasColor(format), extras, table);
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
  readLasRecordsBehind(file, header, header.points_begin + header.points * header.record_bytes);
  table.notes.insert(table.notes.end(), header.notes.begin(), header.notes.end());
  if (lasHasColor(format)) packColors(table);
  table.las = std::make_shared<LasOrigin>(std::move(header.origin));
  return table;
}

std::optional<RowFormat> lasRows(InputFile& file) {
  LasHeader header = readLasHeader(file);
  const std::uint64_t points_end = header.points_begin + header.points * header.record_bytes;
  if (points_end - header.points_begin <= file.remaining()) {
    file.seek(points_end);
    readLasRecordsBehind(file, header, points_end);
    file.seek(header.points_begin);
  }
  RowFormat rows;
  rows.layout.notes = header.notes;
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
