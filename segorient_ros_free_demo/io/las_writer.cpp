// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>

#include "io/cloud_writer.h"
#include "io/las_format.h"
#include "io/value_range.h"
#include "support/command_line.h"

namespace segorient::program {
namespace {

constexpr double kMostInt = 2147483647.0;

double valueOf(const Column& c, std::size_t row, std::uint32_t element = 0) {
  return loadNumber(c.data + row * c.stride + std::size_t{element} * c.field.size, c.field.type,
                    c.field.size);
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

// A number of a column that is stored as a dimension of its own.
struct Extra {
  const Column* column = nullptr;
  std::uint32_t element = 0;
  std::string name;
};

struct Standard {
  LasItem item;
  const Column* column = nullptr;
};

// How a cloud becomes a LAS file.
class Layout {
 public:
  explicit Layout(const OutputCloud& cloud);

  bool extended() const { return lasIsExtended(format_); }
  int format() const { return format_; }
  int minorVersion() const { return minor_version_; }
  std::uint64_t points() const { return points_; }
  std::uint64_t skipped() const { return cloud_.size - points_; }
  std::size_t recordBytes() const { return record_bytes_; }
  const std::vector<Extra>& extras() const { return extras_; }
  const std::array<double, 3>& scale() const { return scale_; }
  const std::array<double, 3>& offset() const { return offset_; }
  /// As they are stored: smallest and largest coordinate of an axis.
  double low(std::size_t a) const { return points_ == 0 ? 0.0 : stored(a, range_[a].low()); }
  double high(std::size_t a) const { return points_ == 0 ? 0.0 : stored(a, range_[a].high()); }
  std::uint64_t returns(std::size_t number) const { return returns_[number]; }
  const LasOrigin& origin() const { return origin_; }

  /// False where coordinates are not finite, or of a stray so far away that the grid of coordinates
  /// would make the others one place.
  bool hasPlace(std::size_t row) const { return !bulk_.isBeyondFloats(position(row)); }
  void makeRecord(std::size_t row, std::uint8_t* to) const;

 private:
  std::array<double, 3> position(std::size_t row) const {
    return {valueOf(*xyz_[0], row), valueOf(*xyz_[1], row), valueOf(*xyz_[2], row)};
  }
  double ticks(std::size_t a, double v) const { return std::round((v - offset_[a]) / scale_[a]); }
  double stored(std::size_t a, double v) const { return scale_[a] * ticks(a, v) + offset_[a]; }
  double largest(const char* name) const;
  void measure();
  void chooseFormat();
  void chooseScale();
  void assignColumns();

  const OutputCloud& cloud_;
  LasOrigin origin_;
  std::array<const Column*, 3> xyz_;
  Bounds bulk_;
  std::array<ValueRange, 3> range_;
  std::array<std::uint64_t, 16> returns_{};
  std::uint64_t points_ = 0;
  int format_ = 0;
  int minor_version_ = 2;
  std::array<double, 3> scale_{};
  std::array<double, 3> offset_{};
  std::vector<Standard> standard_;
  const Column* packed_colors_ = nullptr;
  double intensity_factor_ = 1.0;
  std::vector<Extra> extras_;
  std::size_t record_bytes_ = 0;
};

Layout::Layout(const OutputCloud& cloud)
    : cloud_(cloud), xyz_{cloud.find("x"), cloud.find("y"), cloud.find("z")} {
  bulk_ = bulkBounds(cloud.size, [this](std::size_t row) { return position(row); });
  if (cloud.las) origin_ = *cloud.las;
  measure();
  chooseFormat();
  chooseScale();
  assignColumns();
}

double Layout::largest(const char* name) const {
  ValueRange range;
  const Column* c = cloud_.find(name);
  for (std::size_t i = 0; c != nullptr && i < cloud_.size; ++i) range.add(valueOf(*c, i));
  return range.empty() ? 0.0 : range.high();
}

void Layout::measure() {
  const Column* number = cloud_.find("return_number");
  for (std::size_t i = 0; i < cloud_.size; ++i) {
    if (!hasPlace(i)) continue;
    ++points_;
    for (std::size_t a = 0; a < 3; ++a) range_[a].add(valueOf(*xyz_[a], i));
    const double r = number == nullptr ? 1.0 : valueOf(*number, i);
    if (r >= 1.0 && r <= 15.0) ++returns_[static_cast<std::size_t>(r)];
  }
}

// The oldest format that has room for everything, but no older one than the input's: old programs
// read old formats.
void Layout::chooseFormat() {
  const bool colors = cloud_.find("rgb") != nullptr || cloud_.find("red16") != nullptr;
  const bool infrared = cloud_.find("infrared") != nullptr;
  const bool time = cloud_.find("gps_time") != nullptr;
  const bool wide = largest("return_number") > 7.0 || largest("number_of_returns") > 7.0 ||
                    largest("classification") > 31.0 || largest("classification_flags") > 7.0 ||
                    largest("scanner_channel") > 0.0 ||
                    points_ > std::numeric_limits<std::uint32_t>::max();
  if (lasIsExtended(origin_.point_format) || wide || infrared) {
    format_ = infrared ? 8 : (colors ? 7 : 6);
    minor_version_ = 4;
    return;
  }
  format_ = (time ? 1 : 0) + (colors ? 2 : 0);
  minor_version_ = std::max(2, origin_.minor_version);
}

// The input's own grid of coordinates if it holds all points; else the finest power of ten that
// does.
void Layout::chooseScale() {
  scale_ = origin_.scale;
  offset_ = origin_.offset;
  bool fits = points_ > 0;
  for (std::size_t a = 0; a < 3; ++a) {
    fits = fits && scale_[a] != 0.0 && std::abs(ticks(a, range_[a].low())) <= kMostInt &&
           std::abs(ticks(a, range_[a].high())) <= kMostInt;
  }
  if (fits) return;
  // Halves: the whole may be more than a double holds.
  double half = 0.0;
  for (const ValueRange& r : range_) {
    if (!r.empty()) half = std::max(half, 0.5 * r.high() - 0.5 * r.low());
  }
  constexpr double kUsed = 1e9;  // steps to either side, of the 2^31 that there are
  const double step = half > 0.0 ? std::pow(10.0, std::ceil(std::log10(half / kUsed))) : 1e-9;
  for (std::size_t a = 0; a < 3; ++a) {
    // Near the least number there is no power of ten is left to divide by.
    scale_[a] = std::max(step, std::numeric_limits<double>::min());
    const double middle = range_[a].empty() ? 0.0 : 0.5 * range_[a].low() + 0.5 * range_[a].high();
    const double whole = std::floor(middle);
    offset_[a] = std::abs(whole - middle) <= half ? whole : middle;
  }
}

void Layout::assignColumns() {
  std::vector<const Column*> used(xyz_.begin(), xyz_.end());
  for (const LasItem& item : lasItems(format_)) {
    const Column* c = cloud_.find(item.name);
    if (c == nullptr || c->field.count != 1) continue;
    standard_.push_back({item, c});
    used.push_back(c);
  }
  const Column* intensity = cloud_.find("intensity");
  if (intensity != nullptr) {
    bool whole = true;
    for (std::size_t i = 0; i < cloud_.size && whole; ++i) {
      const double v = valueOf(*intensity, i);
      whole = std::isnan(v) || (v >= 0.0 && v <= 65535.0 && v == std::floor(v));
    }
    if (!whole) {  // shares of 1 have all 16 bits; as it is, it is kept in extra bytes
      intensity_factor_ = largest("intensity") <= 1.0 ? 65535.0 : 1.0;
      used.erase(std::find(used.begin(), used.end(), intensity));
    }
  }
  if (const Column* packed = cloud_.find("rgb")) {
    used.push_back(packed);
    if (cloud_.find("red16") == nullptr) packed_colors_ = packed;
  }
  record_bytes_ = kLasPointBytes[static_cast<std::size_t>(format_)];
  for (const Column& c : cloud_.columns) {
    if (std::find(used.begin(), used.end(), &c) != used.end()) continue;
    for (std::uint32_t e = 0; e < c.field.count; ++e) {
      const std::string suffix = c.field.count > 1 ? "_" + std::to_string(e) : "";
      const std::size_t bytes = record_bytes_ + c.field.size;
      constexpr std::size_t kMostExtras = 65535 / kLasExtraBytes;  // of a variable length record
      if (bytes > 65535 || extras_.size() == kMostExtras) {
        warn("field " + c.field.name + " is left out: LAS has no more room");
        break;
      }
      extras_.push_back({&c, e, lasName(c.field.name) + suffix});
      record_bytes_ = bytes;
    }
  }
}

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

void Layout::makeRecord(std::size_t row, std::uint8_t* to) const {
  std::memset(to, 0, record_bytes_);
  for (std::size_t a = 0; a < 3; ++a) {
    store(static_cast<std::int32_t>(ticks(a, valueOf(*xyz_[a], row))), to + 4 * a);
  }
  if (cloud_.find("return_number") == nullptr) to[14] = extended() ? 0x11 : 0x09;  // 1 of 1
  for (const Standard& s : standard_) {
    const double v = valueOf(*s.column, row);
    makeItem(s.item, s.item.kind == LasItem::Kind::Intensity ? intensity_factor_ * v : v, to);
  }
  if (packed_colors_ != nullptr) {
    const std::uint8_t* from = packed_colors_->data + row * packed_colors_->stride;
    for (std::size_t c = 0; c < 3; ++c) {  // 255 of 8 bits is 65535 of 16
      store(static_cast<std::uint16_t>(257U * from[2 - c]), to + lasColorOffset(format_) + 2 * c);
    }
  }
  std::uint8_t* extra = to + kLasPointBytes[static_cast<std::size_t>(format_)];
  for (const Extra& e : extras_) {
    const std::uint32_t size = e.column->field.size;
    std::memcpy(extra, e.column->data + row * e.column->stride + std::size_t{e.element} * size,
                size);
    extra += size;
  }
}

// The number of a type in descriptions of extra bytes.
std::uint8_t lasType(const Field& f) {
  if (f.type == 'F') return f.size == 8 ? 10 : 9;
  const unsigned first = f.size == 1 ? 1 : (f.size == 2 ? 3 : (f.size == 4 ? 5 : 7));
  return static_cast<std::uint8_t>(first + (f.type == 'I' ? 1 : 0));
}

void putText(const std::string& text, std::size_t most, std::uint8_t* to) {
  std::memcpy(to, text.data(), std::min(text.size(), most));
}

std::vector<std::uint8_t> describeExtras(const std::vector<Extra>& extras) {
  std::vector<std::uint8_t> record(kLasRecordHeader + kLasExtraBytes * extras.size(), 0);
  putText(kLasSpecUser, 16, &record[2]);
  store(kLasExtraBytesId, &record[18]);
  store(static_cast<std::uint16_t>(kLasExtraBytes * extras.size()), &record[20]);
  for (std::size_t i = 0; i < extras.size(); ++i) {
    std::uint8_t* to = &record[kLasRecordHeader + kLasExtraBytes * i];
    to[2] = lasType(extras[i].column->field);
    putText(extras[i].name, 32, to + 4);
  }
  return record;
}

std::vector<std::uint8_t> makeHeader(const Layout& layout, std::uint32_t records,
                                     std::uint64_t points_begin) {
  const LasOrigin& origin = layout.origin();
  const int version = layout.minorVersion();
  const std::size_t bytes = version == 4 ? 375 : (version == 3 ? 235 : 227);
  std::vector<std::uint8_t> h(bytes, 0);
  putText("LASF", 4, &h[0]);
  store(origin.source_id, &h[4]);
  constexpr unsigned kWaveforms = 6;  // bits about them, which are not written
  constexpr unsigned kWkt = 16;       // asked for by formats from 6 on
  store(static_cast<std::uint16_t>((origin.global_encoding & ~kWaveforms) |
                                   (layout.extended() ? kWkt : 0U)),
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
  h[104] = static_cast<std::uint8_t>(layout.format());
  store(static_cast<std::uint16_t>(layout.recordBytes()), &h[105]);
  const bool legacy = !layout.extended();
  store(static_cast<std::uint32_t>(legacy ? layout.points() : 0), &h[107]);
  for (std::size_t r = 0; r < 5 && legacy; ++r) {
    store(static_cast<std::uint32_t>(layout.returns(r + 1)), &h[111 + 4 * r]);
  }
  for (std::size_t a = 0; a < 3; ++a) {
    store(layout.scale()[a], &h[131 + 8 * a]);
    store(layout.offset()[a], &h[155 + 8 * a]);
    store(layout.high(a), &h[179 + 16 * a]);
    store(layout.low(a), &h[187 + 16 * a]);
  }
  if (version < 4) return h;
  if (!origin.extended_records.empty()) {
    store(points_begin + layout.points() * layout.recordBytes(), &h[235]);
    store(static_cast<std::uint32_t>(origin.extended_records.size()), &h[243]);
  }
  store(layout.points(), &h[247]);
  for (std::size_t r = 0; r < 15; ++r) store(layout.returns(r + 1), &h[255 + 8 * r]);
  return h;
}

}  // namespace

void writeLas(const OutputCloud& cloud, OutputFile& file) {
  const Layout layout(cloud);
  if (layout.skipped() > 0) {
    warn(file.path() + ": " + std::to_string(layout.skipped()) +
         " points without coordinates, or too far away from the others, are left out: LAS has no "
         "such points");
  }
  std::vector<std::vector<std::uint8_t>> records = layout.origin().records;
  if (!layout.extras().empty()) records.push_back(describeExtras(layout.extras()));
  const int version = layout.minorVersion();
  std::uint64_t begin = version == 4 ? 375 : (version == 3 ? 235 : 227);
  for (const auto& r : records) begin += r.size();
  const auto header = makeHeader(layout, static_cast<std::uint32_t>(records.size()), begin);
  file.write(header.data(), header.size());
  for (const auto& r : records) file.write(r.data(), r.size());
  constexpr std::size_t kRowsAtOnce = 4096;
  std::vector<std::uint8_t> block(kRowsAtOnce * layout.recordBytes());
  std::size_t filled = 0;
  for (std::size_t row = 0; row < cloud.size; ++row) {
    if (!layout.hasPlace(row)) continue;
    layout.makeRecord(row, block.data() + filled * layout.recordBytes());
    if (++filled < kRowsAtOnce) continue;
    file.write(block.data(), block.size());
    filled = 0;
  }
  file.write(block.data(), filled * layout.recordBytes());
  if (version < 4) return;
  for (const auto& r : layout.origin().extended_records) file.write(r.data(), r.size());
}

}  // namespace segorient::program
