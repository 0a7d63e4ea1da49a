// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "render/palette.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <set>
#include <utility>

#include "io/errors.h"
#include "support/colors.h"

namespace segorient::program {
namespace {

constexpr std::uint32_t kBehind = 0x94836cU;    // the other, where it is known to be that
constexpr std::uint32_t kNoNormal = 0x3060c0U;  // has no normal
constexpr std::uint32_t kPlain = 0xb8c4d0U;     // nothing is known
constexpr std::uint32_t kHard = 0x8040e0U;      // hard segments, front
constexpr std::uint32_t kHardBack = 0x401060U;  // and back
// Sine of 3 degrees: a normal this far from square to the line of sight may be off by as much.
constexpr double kGrazing = 0.05;
constexpr std::size_t kMostSensors = 200;  // marks of a path; more would cover the picture
constexpr std::size_t kMostKeys = 8;       // scans that a legend lists

bool known(const Facts& facts) {
  return std::any_of(facts.segments.begin(), facts.segments.end(),
                     [](const SegmentFact& s) { return s.confidence >= 0.F; });
}

std::vector<std::array<double, 3>> someOf(const std::set<std::array<double, 3>>& places) {
  std::vector<std::array<double, 3>> out;
  const std::size_t step = places.size() / kMostSensors + 1;
  std::size_t i = 0;
  for (const auto& p : places) {
    if (i++ % step == 0) out.push_back(p);
  }
  return out;
}

std::string shortNumber(double value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.4g", value);
  return text;
}

// What a coloring needs, and whether the cloud has it.
struct Need {
  const char* name;
  Coloring coloring;
  bool there;
  const char* lack;
};

}  // namespace

const Field* scanField(const CloudTable& table) {
  for (const char* name : {"scan", "scan_id", "scan_index", "point_source_id"}) {
    if (const Field* field = table.find(name)) return field;
  }
  return nullptr;
}

std::uint32_t packedColor(const CloudTable& table, const Field& field, std::size_t row) {
  std::uint32_t v = 0;
  std::memcpy(&v, table.at(field, row), std::min<std::size_t>(sizeof(v), field.size));
  return v & 0xffffffU;
}

std::uint32_t labelOf(const CloudTable& table, const Field* field, std::size_t row) {
  if (field == nullptr) return kNoSegment;
  const double value = table.value(*field, row);
  const bool none = !(value >= 0.0) || value >= kNoSegment;
  return none ? kNoSegment : static_cast<std::uint32_t>(value);
}

PointSensors::PointSensors(const CloudTable& table, const Facts& facts) : table_(table) {
  fields_ = {table.find("vp_x"), table.find("vp_y"), table.find("vp_z")};
  if (std::find(fields_.begin(), fields_.end(), nullptr) != fields_.end()) fields_ = {};
  if (facts.saw_all) told_ = someOf({facts.sensors.begin(), facts.sensors.end()});
}

bool PointSensors::at(std::size_t row, std::array<double, 3>& place) const {
  if (fields_[2] == nullptr) return false;
  place = table_.triple(fields_, row);
  return std::isfinite(place[0]) && std::isfinite(place[1]) && std::isfinite(place[2]);
}

Side PointSensors::side(std::size_t row, const std::array<float, 3>& normal, Side side) const {
  if (!any() || !std::isfinite(normal[0])) return side;
  const std::array<double, 3> from = table_.position(row);
  // Nearest first: distance, and cosine of the normal.
  std::pair<double, double> nearest{std::numeric_limits<double>::infinity(), 0.0};
  double most = -1.0;
  const auto look = [&](const std::array<double, 3>& sensor) {
    const std::array<double, 3> to{sensor[0] - from[0], sensor[1] - from[1], sensor[2] - from[2]};
    const double distance = std::hypot(to[0], to[1], to[2]);
    double facing = 0.0;
    for (std::size_t a = 0; a < 3; ++a) facing += to[a] * static_cast<double>(normal[a]);
    const double cosine = distance > 0.0 ? facing / distance : 0.0;
    nearest = std::min(nearest, {distance, cosine});
    most = std::max(most, cosine);
  };
  std::array<double, 3> own{};
  if (at(row, own)) {
    look(own);
  } else {
    std::for_each(told_.begin(), told_.end(), look);
  }
  if (!std::isfinite(nearest.first)) return side;
  if (nearest.second >= -kGrazing) return Side::Outer;
  return most < -kGrazing ? Side::Contrary : side;
}

std::vector<std::array<double, 3>> sensorsOfPoints(const CloudTable& table) {
  const PointSensors sensors(table);
  std::set<std::array<double, 3>> places;
  std::array<double, 3> place{};
  for (std::size_t i = 0; i < table.size && sensors.any(); ++i) {
    if (sensors.at(i, place)) places.insert(place);
  }
  return someOf(places);
}

Coloring parseColoring(const std::string& name, const CloudTable& table, const std::string& path,
                       const Facts& facts) {
  const bool labels = table.find("label") != nullptr;
  const bool rgb = table.find("rgb") != nullptr;
  const bool normals = table.hasNormals() || !table.triangles.empty();
  const bool confidences = table.find("confidence") != nullptr || (labels && known(facts));
  const std::array<Need, 8> needs{
      {{"normal", Coloring::Normal, normals, "has no normals"},
       {"segment", Coloring::Segment, labels, "has no field label"},
       {"orientation", Coloring::Orientation, normals, "has no normals"},
       {"orientation", Coloring::Orientation, labels, "has no field label"},
       {"rgb", Coloring::Rgb, rgb, "has no field rgb"},
       {"confidence", Coloring::Confidence, confidences,
        "has no field confidence, and no --report tells those of its segments"},
       {"height", Coloring::Height, true, ""},
       {"scan", Coloring::Scan, scanField(table) != nullptr, "has no field scan"}}};
  const Need* found = nullptr;
  for (const Need& need : needs) {
    if (name != need.name) continue;
    if (!need.there) throw FileError(path, need.lack);
    found = &need;
  }
  if (found != nullptr) return found->coloring;
  if (name != "auto") {
    throw UsageError(
        "--color is one of auto normal orientation segment confidence height scan rgb");
  }
  if (table.hasNormals()) return Coloring::Normal;
  if (labels) return Coloring::Segment;
  return normals && !rgb ? Coloring::Normal : Coloring::Rgb;
}

Palette::Palette(const CloudTable& table, Coloring coloring, const Facts& facts)
    : table_(table),
      coloring_(coloring),
      facts_(facts),
      sensors_(table, facts),
      label_(table.find("label")) {
  if (coloring == Coloring::Rgb) field_ = table.find("rgb");
  if (coloring == Coloring::Confidence) field_ = table.find("confidence");
  if (coloring == Coloring::Scan) field_ = scanField(table);
  if (coloring != Coloring::Height) return;
  field_ = table.find("z");
  low_ = std::numeric_limits<double>::max();
  high_ = std::numeric_limits<double>::lowest();
  for (std::size_t i = 0; i < table.size; ++i) {
    const double z = height(i);
    if (!std::isfinite(z)) continue;
    low_ = std::min(low_, z);
    high_ = std::max(high_, z);
  }
}

double Palette::height(std::size_t row) const {
  return field_ == nullptr ? NAN : table_.value(*field_, row);
}

double Palette::confidence(std::size_t row) const {
  if (field_ != nullptr) return table_.value(*field_, row);
  const std::uint32_t label = labelOf(table_, label_, row);
  if (label >= facts_.segments.size()) return NAN;
  const float value = facts_.segments[label].confidence;
  return value < 0.F ? NAN : static_cast<double>(value);
}

void Palette::setSides(std::size_t row, Side side, std::uint32_t& front,
                       std::uint32_t& back) const {
  front = kFrontColor;
  back = kBehind;
  std::uint32_t wrong = kWrongSide;
  if (coloring_ == Coloring::Orientation) {
    const std::uint32_t label = labelOf(table_, label_, row);
    const bool hard = label < facts_.segments.size() && facts_.segments[label].hard;
    front = hard ? kHard : tinted(segmentColor(label));
    if (hard) back = wrong = kHardBack;
  }
  if (isWrong(side)) front = back = wrong;
}

std::uint32_t Palette::plain(std::size_t row) const {
  if (coloring_ == Coloring::Height) return rampColor((height(row) - low_) / (high_ - low_));
  if (coloring_ == Coloring::Confidence) return rampColor(confidence(row));
  if (coloring_ == Coloring::Segment) {
    return label_ == nullptr ? kPlain : segmentColor(labelOf(table_, label_, row));
  }
  if (field_ == nullptr) return kPlain;
  if (coloring_ == Coloring::Scan) return segmentColor(labelOf(table_, field_, row));
  return packedColor(table_, *field_, row);
}

Side Palette::set(std::size_t row, const std::array<float, 3>& normal, Side side,
                  std::uint32_t& front, std::uint32_t& back) const {
  const bool none = !std::isfinite(normal[0]);
  side = sensors_.side(row, normal, side);
  if (coloring_ != Coloring::Normal && coloring_ != Coloring::Orientation) {
    front = back = plain(row);
  } else if (none) {
    front = back = kNoNormal;
  } else {
    setSides(row, side, front, back);
  }
  return side;
}

void Palette::setTriangle(std::size_t row, const std::array<float, 3>& normal, std::uint32_t& front,
                          std::uint32_t& back) const {
  const Side side = set(row, normal, Side::Open, front, back);
  if (side == Side::Open && back == kBehind) back = kWrongSide;
}

Legend Palette::legend(const ShownSides& shown) const {
  Legend legend;
  if (coloring_ == Coloring::Height && low_ <= high_) {
    legend = {"height (z)", shortNumber(low_), shortNumber(high_), {}};
  } else if (coloring_ == Coloring::Confidence) {
    legend = {"confidence", "0", "1", {}};
  } else if (coloring_ == Coloring::Scan && field_ != nullptr) {
    legend.title = "scan";
    std::vector<std::uint32_t> scans;
    for (std::size_t i = 0; i < table_.size && scans.size() <= kMostKeys; ++i) {
      const std::uint32_t scan = labelOf(table_, field_, i);
      const auto at = std::lower_bound(scans.begin(), scans.end(), scan);
      if (at == scans.end() || *at != scan) scans.insert(at, scan);
    }
    for (std::size_t i = 0; i < std::min(scans.size(), kMostKeys); ++i) {
      legend.keys.emplace_back(segmentColor(scans[i]),
                               scans[i] == kNoSegment ? "none" : std::to_string(scans[i]));
    }
    if (scans.size() > kMostKeys) legend.keys.emplace_back(0xffffffU, "...");
  } else if (coloring_ == Coloring::Normal || coloring_ == Coloring::Orientation) {
    if (!table_.hasNormals() || !table_.triangles.empty()) return legend;
    legend.keys.emplace_back(kFrontColor, sensors_.any() ? "faces its sensor" : "true side");
    if (shown.backs) legend.keys.emplace_back(kBehind, "from behind");
    if (shown.wrong) legend.keys.emplace_back(kWrongSide, "wrong side");
    if (shown.none) legend.keys.emplace_back(kNoNormal, "no normal");
    const bool hard = std::any_of(facts_.segments.begin(), facts_.segments.end(),
                                  [](const SegmentFact& s) { return s.hard; });
    if (hard && coloring_ == Coloring::Orientation) legend.keys.emplace_back(kHard, "not decided");
  }
  return legend;
}

}  // namespace segorient::program
