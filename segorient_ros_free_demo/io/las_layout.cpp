// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "io/las_layout.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "support/command_line.h"

namespace segorient::program {
namespace {

constexpr double kMostInt = 2147483647.0;
constexpr std::size_t kNoColumn = std::numeric_limits<std::size_t>::max();

std::size_t columnOf(const OutputCloud& cloud, const std::string& name) {
  const Column* c = cloud.find(name);
  return c == nullptr ? kNoColumn : static_cast<std::size_t>(c - cloud.columns.data());
}

// A whole number within limits, as an unsigned one; NaN becomes 0.
template <typename T>
T rounded(double v) {
  if (std::isnan(v)) return 0;
  return static_cast<T>(
      std::lround(std::clamp(v, static_cast<double>(std::numeric_limits<T>::lowest()),
                             static_cast<double>(std::numeric_limits<T>::max()))));
}

template <typename T>
void store(T value, std::uint8_t* to) {
  std::memcpy(to, &value, sizeof(T));
}

}  // namespace

LasLayout::LasLayout(const OutputCloud& block, const LasSummary& summary)
    : summary_(summary), xyz_{columnOf(block, "x"), columnOf(block, "y"), columnOf(block, "z")} {
  if (block.las) origin_ = *block.las;
  chooseFormat(block);
  chooseScale();
  assignColumns(block);
}

double LasLayout::ticks(std::size_t a, double v) const {
  return std::round((v - offset_[a]) / scale_[a]);
}

// The oldest format that has room for everything, but no older one than the input's: old programs
// read old formats.
void LasLayout::chooseFormat(const OutputCloud& block) {
  const bool colors = block.has("rgb") || block.has("red16");
  const bool infrared = block.has("infrared");
  if (lasIsExtended(origin_.point_format) || summary_.isWide() || infrared) {
    format_ = infrared ? 8 : (colors ? 7 : 6);
    minor_version_ = 4;
    return;
  }
  format_ = (block.has("gps_time") ? 1 : 0) + (colors ? 2 : 0);
  minor_version_ = std::max(2, origin_.minor_version);
}

// The input's own grid of coordinates if it holds all points; else the finest power of ten that
// does.
void LasLayout::chooseScale() {
  scale_ = origin_.scale;
  offset_ = origin_.offset;
  bool fits = true;
  for (std::size_t a = 0; a < 3; ++a) {
    const ValueRange& r = summary_.range(a);
    fits = fits && scale_[a] != 0.0;
    if (summary_.points() == 0) continue;  // of nothing any grid will do
    fits =
        fits && std::abs(ticks(a, r.low())) <= kMostInt && std::abs(ticks(a, r.high())) <= kMostInt;
  }
  if (fits) return;
  // Halves: the whole may be more than a double holds.
  double half = 0.0;
  for (std::size_t a = 0; a < 3; ++a) {
    const ValueRange& r = summary_.range(a);
    if (!r.empty()) half = std::max(half, 0.5 * r.high() - 0.5 * r.low());
  }
  constexpr double kUsed = 1e9;  // steps to either side, of the 2^31 that there are
  const double step = half > 0.0 ? std::pow(10.0, std::ceil(std::log10(half / kUsed))) : 1e-9;
  for (std::size_t a = 0; a < 3; ++a) {
    const ValueRange& r = summary_.range(a);
    // Near the least number there is no power of ten left to divide by.
    scale_[a] = std::max(step, std::numeric_limits<double>::min());
    const double middle = r.empty() ? 0.0 : 0.5 * r.low() + 0.5 * r.high();
    const double whole = std::floor(middle);
    offset_[a] = std::abs(whole - middle) <= half ? whole : middle;
  }
}

void LasLayout::assignColumns(const OutputCloud& block) {
  std::vector<std::size_t> used(xyz_.begin(), xyz_.end());
  has_returns_ = block.has("return_number");
  for (const LasItem& item : lasItems(format_)) {
    const std::size_t c = columnOf(block, item.name);
    if (c == kNoColumn || block.columns[c].field.count != 1) continue;
    standard_.push_back({item, c});
    used.push_back(c);
  }
  const std::size_t intensity = columnOf(block, "intensity");
  if (intensity != kNoColumn && !summary_.hasWholeIntensities()) {
    // Shares of 1 have all 16 bits; as it is, it is kept in extra bytes.
    intensity_factor_ = summary_.largestIntensity() <= 1.0 ? 65535.0 : 1.0;
    used.erase(std::remove(used.begin(), used.end(), intensity), used.end());
  }
  const std::size_t packed = columnOf(block, "rgb");
  if (packed != kNoColumn) {
    used.push_back(packed);
    has_packed_colors_ = !block.has("red16");
    packed_colors_ = packed;
  }
  listExtras(block, used);
}

void LasLayout::listExtras(const OutputCloud& block, const std::vector<std::size_t>& used) {
  record_bytes_ = kLasPointBytes[static_cast<std::size_t>(format_)];
  for (std::size_t c = 0; c < block.columns.size(); ++c) {
    if (std::find(used.begin(), used.end(), c) != used.end()) continue;
    const Field& field = block.columns[c].field;
    for (std::uint32_t e = 0; e < field.count; ++e) {
      const std::string suffix = field.count > 1 ? "_" + std::to_string(e) : "";
      const std::size_t bytes = record_bytes_ + field.size;
      constexpr std::size_t kMostExtras = 65535 / kLasExtraBytes;  // of a variable length record
      if (bytes > 65535 || extras_.size() == kMostExtras) {
        warn("field " + field.name + " is left out: LAS has no more room");
        break;
      }
      extras_.push_back({c, e, lasName(field.name) + suffix});
      extra_fields_.push_back(field);
      record_bytes_ = bytes;
    }
  }
}

namespace {

void makeItem(const LasItem& item, double v, std::uint8_t* record) {
  std::uint8_t* to = record + item.offset;
  switch (item.kind) {
    case LasItem::Kind::Number:
      if (item.size == 8) return store(v, to);
      if (item.size == 2) return store(rounded<std::uint16_t>(v), to);
      return store(rounded<std::uint8_t>(v), to);
    case LasItem::Kind::Bits: {
      const unsigned bits = std::min<unsigned>(rounded<std::uint8_t>(v), item.mask);
      *to = static_cast<std::uint8_t>(*to | bits << item.shift);
      return;
    }
    case LasItem::Kind::Intensity:
      return store(rounded<std::uint16_t>(v), to);
    case LasItem::Kind::Rank:
      return store(rounded<std::int8_t>(v), to);
    case LasItem::Kind::Angle:
      return store(rounded<std::int16_t>(v / 0.006), to);
  }
}

}  // namespace

bool LasLayout::makeRecord(const OutputCloud& block, std::size_t row, std::uint8_t* to) const {
  const std::array<double, 3> p{numberOf(block.columns[xyz_[0]], row),
                                numberOf(block.columns[xyz_[1]], row),
                                numberOf(block.columns[xyz_[2]], row)};
  if (!summary_.hasPlace(p)) return false;
  std::memset(to, 0, record_bytes_);
  for (std::size_t a = 0; a < 3; ++a) {
    store(static_cast<std::int32_t>(ticks(a, p[a])), to + 4 * a);
  }
  if (!has_returns_) to[14] = extended() ? 0x11 : 0x09;  // 1 of 1
  for (const Standard& s : standard_) {
    const double v = numberOf(block.columns[s.column], row);
    makeItem(s.item, s.item.kind == LasItem::Kind::Intensity ? intensity_factor_ * v : v, to);
  }
  if (has_packed_colors_) {
    const Column& colors = block.columns[packed_colors_];
    const std::uint8_t* from = colors.data + row * colors.stride;
    for (std::size_t c = 0; c < 3; ++c) {  // 255 of 8 bits is 65535 of 16
      store(static_cast<std::uint16_t>(257U * from[2 - c]), to + lasColorOffset(format_) + 2 * c);
    }
  }
  std::uint8_t* extra = to + kLasPointBytes[static_cast<std::size_t>(format_)];
  for (const Extra& e : extras_) {
    const Column& c = block.columns[e.column];
    std::memcpy(extra, c.data + row * c.stride + std::size_t{e.element} * c.field.size,
                c.field.size);
    extra += c.field.size;
  }
  return true;
}

namespace {

// The number of a type in descriptions of extra bytes.
std::uint8_t lasType(const Field& f) {
  if (f.type == 'F') return f.size == 8 ? 10 : 9;
  const unsigned first = f.size == 1 ? 1 : (f.size == 2 ? 3 : (f.size == 4 ? 5 : 7));
  return static_cast<std::uint8_t>(first + (f.type == 'I' ? 1 : 0));
}

void putText(const std::string& text, std::size_t most, std::uint8_t* to) {
  std::copy_n(text.data(), std::min(text.size(), most), to);
}

}  // namespace

std::vector<std::uint8_t> LasLayout::describeExtras() const {
  std::vector<std::uint8_t> record(kLasRecordHeader + kLasExtraBytes * extras_.size(), 0);
  putText(kLasSpecUser, 16, &record[2]);
  store(kLasExtraBytesId, &record[18]);
  store(static_cast<std::uint16_t>(kLasExtraBytes * extras_.size()), &record[20]);
  for (std::size_t i = 0; i < extras_.size(); ++i) {
    std::uint8_t* to = &record[kLasRecordHeader + kLasExtraBytes * i];
    to[2] = lasType(extra_fields_[i]);
    putText(extras_[i].name, 32, to + 4);
  }
  return record;
}

std::vector<std::uint8_t> LasLayout::header(std::uint32_t records,
                                            std::uint64_t points_begin) const {
  const LasOrigin& origin = origin_;
  const int version = minor_version_;
  const std::size_t bytes = version == 4 ? 375 : (version == 3 ? 235 : 227);
  std::vector<std::uint8_t> h(bytes, 0);
  putText("LASF", 4, &h[0]);
  store(origin.source_id, &h[4]);
  constexpr unsigned kWaveforms = 6;  // bits about them, which are not written
  constexpr unsigned kWkt = 16;       // asked for by formats from 6 on
  store(
      static_cast<std::uint16_t>((origin.global_encoding & ~kWaveforms) | (extended() ? kWkt : 0U)),
      &h[6]);
  std::copy(origin.project_id.begin(), origin.project_id.end(), h.begin() + 8);
  h[24] = 1;
  h[25] = static_cast<std::uint8_t>(version);
  std::memcpy(&h[26], origin.system_id.data(), 32);
  putText("segorient", 32, &h[58]);
  store(origin.creation_day, &h[90]);
  store(origin.creation_year, &h[92]);
  store(static_cast<std::uint16_t>(bytes), &h[94]);
  store(static_cast<std::uint32_t>(points_begin), &h[96]);
  store(records, &h[100]);
  h[104] = static_cast<std::uint8_t>(format_);
  store(static_cast<std::uint16_t>(record_bytes_), &h[105]);
  const bool legacy = !extended();
  store(static_cast<std::uint32_t>(legacy ? summary_.points() : 0), &h[107]);
  for (std::size_t r = 0; r < 5 && legacy; ++r) {
    store(static_cast<std::uint32_t>(summary_.returns(r + 1)), &h[111 + 4 * r]);
  }
  for (std::size_t a = 0; a < 3; ++a) {
    store(scale_[a], &h[131 + 8 * a]);
    store(offset_[a], &h[155 + 8 * a]);
    const ValueRange& range = summary_.range(a);  // as they are stored
    store(range.empty() ? 0.0 : stored(a, range.high()), &h[179 + 16 * a]);
    store(range.empty() ? 0.0 : stored(a, range.low()), &h[187 + 16 * a]);
  }
  if (version < 4) return h;
  if (!origin.extended_records.empty()) {
    store(points_begin + summary_.points() * record_bytes_, &h[235]);
    store(static_cast<std::uint32_t>(origin.extended_records.size()), &h[243]);
  }
  store(summary_.points(), &h[247]);
  for (std::size_t r = 0; r < 15; ++r) store(summary_.returns(r + 1), &h[255 + 8 * r]);
  return h;
}

std::vector<std::uint8_t> LasLayout::head() const {
  std::vector<std::vector<std::uint8_t>> records = origin_.records;
  if (!extras_.empty()) records.push_back(describeExtras());
  std::uint64_t begin = minor_version_ == 4 ? 375 : (minor_version_ == 3 ? 235 : 227);
  for (const auto& r : records) begin += r.size();
  std::vector<std::uint8_t> out = header(static_cast<std::uint32_t>(records.size()), begin);
  for (const auto& r : records) out.insert(out.end(), r.begin(), r.end());
  return out;
}

std::vector<std::uint8_t> LasLayout::tail() const {
  std::vector<std::uint8_t> out;
  if (minor_version_ < 4) return out;
  for (const auto& r : origin_.extended_records) out.insert(out.end(), r.begin(), r.end());
  return out;
}

}  // namespace segorient::program
