// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "render/page/page.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "page_files.h"
#include "render/page/packing.h"
#include "render/page/surroundings.h"
#include "render/page/thinning.h"
#include "support/colors.h"
#include "support/json.h"

namespace segorient::program {
namespace {

constexpr double kSteps = 65535.0;
constexpr float kSizes = 32.F;               // of a disc of middle size
constexpr float kDistances = 255.F;          // is the rim of a disc
constexpr float kMostConfidence = 254.F;     // is 1; one more: not known
constexpr std::uint32_t kColorBits = 0xfcU;  // of a channel: more are not seen

// The direction on an octahedron that is folded flat, -1 to 1 as 1 to 255; 0 twice has no normal.
std::array<std::uint32_t, 2> packedNormal(const float* n) {
  const float sum = std::abs(n[0]) + std::abs(n[1]) + std::abs(n[2]);
  if (!(sum > 0.F) || !std::isfinite(sum)) return {0, 0};
  float u = n[0] / sum;
  float v = n[1] / sum;
  if (n[2] < 0.F) {
    const float folded = (1.F - std::abs(v)) * (u < 0.F ? -1.F : 1.F);
    v = (1.F - std::abs(u)) * (v < 0.F ? -1.F : 1.F);
    u = folded;
  }
  const auto byte = [](float t) {
    return static_cast<std::uint32_t>(128 + std::lround(127.F * t));
  };
  return {byte(u), byte(v)};
}

// The cube that holds the points.
struct Cube {
  std::array<double, 3> low{};
  double extent = 0.0;

  std::array<std::uint32_t, 3> place(const float* p) const {
    std::array<std::uint32_t, 3> out{};
    for (std::size_t a = 0; a < 3; ++a) {
      const double offset = static_cast<double>(p[a]) - low[a];
      out[a] = static_cast<std::uint32_t>(std::lround(kSteps * offset / extent));
    }
    return out;
  }
};

Cube cubeOf(const PointView& points, const std::vector<std::uint32_t>& rows) {
  Cube cube;
  for (std::size_t a = 0; a < 3 && !rows.empty(); ++a) {
    double low = std::numeric_limits<double>::max();
    double high = std::numeric_limits<double>::lowest();
    for (const std::uint32_t row : rows) {
      low = std::min(low, static_cast<double>(points[row][a]));
      high = std::max(high, static_cast<double>(points[row][a]));
    }
    cube.low[a] = low;
    cube.extent = std::max(cube.extent, high - low);
  }
  if (!(cube.extent > 0.0)) cube.extent = 1.0;
  return cube;
}

using Numbers = std::vector<std::uint32_t>;

// Numbers that points have, each once, and where it stands in the table of them.
class Numbering {
 public:
  Numbering(const std::vector<std::uint32_t>& numbers, const std::vector<std::uint32_t>& rows) {
    for (const std::uint32_t row : rows) {
      if (!numbers.empty()) places_.emplace(numbers[row], 0U);
    }
    std::uint32_t next = 0;
    for (auto& [number, place] : places_) place = next++;
  }
  std::uint32_t at(std::uint32_t number) const { return places_.at(number); }
  const std::map<std::uint32_t, std::uint32_t>& all() const { return places_; }

 private:
  std::map<std::uint32_t, std::uint32_t> places_;
};

class PageWriter {
 public:
  PageWriter(const PageCloud& cloud, const PageOptions& options)
      : cloud_(cloud),
        rows_(blueNoiseOrder(cloud.points, std::min<std::size_t>(options.points, kPackedEnd))),
        levels_(sortLevels(cloud.points, rows_, options.threads)),
        cube_(cubeOf(cloud.points, rows_)),
        around_(cloud, rows_, options.threads),
        labels_(cloud.labels, rows_),
        scans_(cloud.scans, rows_) {}
  std::size_t points() const { return rows_.size(); }

  std::string head() {
    JsonWriter json;
    json.field("title", cloud_.title);
    json.field("points", rows_.size());
    json.field("all", cloud_.points.size);
    json.beginArray("low");
    for (std::size_t a = 0; a < 3; ++a) json.item(cube_.low[a] + cloud_.origin[a]);
    json.endArray();
    json.field("extent", cube_.extent);
    json.field("radius", around_.radius / cube_.extent);
    json.beginArray("levels");
    for (const std::size_t end : levels_) json.item(end);
    json.endArray();
    json.beginArray("ramp");
    for (int i = 0; i < 256; ++i) json.item(rampColor(i / 255.0));
    json.endArray();
    writeTable(json, "segments", labels_, true);
    writeTable(json, "scans", scans_, false);
    writePlaces(json, "sensors", cloud_.sensors);
    writePlaces(json, "contradictions", cloud_.contradictions);
    std::string text = json.finish();
    for (std::size_t at = 0; (at = text.find('<', at)) != std::string::npos;) {
      text.replace(at, 1, "\\u003c");
    }
    return text;
  }

  // One after the other, so that only one is in memory.
  void writeData(const PageSink& sink) const {
    write(sink, "positions", 3, [&](std::size_t i, Numbers& out) {
      const auto place = cube_.place(cloud_.points[rows_[i]]);
      out.insert(out.end(), place.begin(), place.end());
    });
    write(sink, "radii", 1, [&](std::size_t i, Numbers& out) {
      out.push_back(static_cast<std::uint32_t>(std::lround(kSizes * around_.sizes[i])));
    });
    if (anyEnds()) {
      write(sink, "cuts", 3 * Surroundings::kEnds, [&](std::size_t i, Numbers& out) {
        for (const DiscEnd& end : around_.ends[i]) {
          const auto n = packedNormal(end.direction.data());
          out.insert(out.end(), n.begin(), n.end());
          out.push_back(static_cast<std::uint32_t>(std::lround(kDistances * end.distance)));
        }
      });
    }
    if (!cloud_.normals.empty()) {
      write(sink, "normals", 2, [&](std::size_t i, Numbers& out) {
        const auto n = packedNormal(cloud_.normals.data() + 3 * std::size_t{rows_[i]});
        out.insert(out.end(), n.begin(), n.end());
      });
    }
    if (!around_.sides.empty()) {
      write(sink, "sides", 1, [&](std::size_t i, Numbers& out) {
        out.push_back(static_cast<std::uint32_t>(around_.sides[i]));
      });
    }
    writeNumbers(sink, "labels", cloud_.labels, labels_);
    writeNumbers(sink, "scans", cloud_.scans, scans_);
    if (!cloud_.confidences.empty()) {
      write(sink, "confidences", 1, [&](std::size_t i, Numbers& out) {
        const float confidence = cloud_.confidences[rows_[i]];
        const float share = std::isfinite(confidence)
                                ? kMostConfidence * std::clamp(confidence, 0.F, 1.F)
                                : kMostConfidence + 1.F;
        out.push_back(static_cast<std::uint32_t>(std::lround(share)));
      });
    }
    if (!cloud_.colors.empty()) {
      write(sink, "colors", 3, [&](std::size_t i, Numbers& out) {
        const std::uint32_t c = cloud_.colors[rows_[i]];
        for (const unsigned shift : {16U, 8U, 0U}) out.push_back(c >> shift & kColorBits);
      });
    }
  }

 private:
  bool anyEnds() const {
    return std::any_of(around_.ends.begin(), around_.ends.end(),
                       [](const auto& ends) { return ends[0].distance > 0.F; });
  }
  template <typename Row>
  void write(const PageSink& sink, const char* name, std::size_t columns, const Row& row) const {
    Numbers numbers;
    numbers.reserve(columns * rows_.size());
    for (std::size_t i = 0; i < rows_.size(); ++i) row(i, numbers);
    sink(std::string("<script type=\"text/plain\" id=\"") + name + "\">");
    sink(packNumbers(numbers, columns));
    sink("</script>\n");
  }
  void writeNumbers(const PageSink& sink, const char* name,
                    const std::vector<std::uint32_t>& numbers, const Numbering& table) const {
    if (numbers.empty()) return;
    write(sink, name, 1,
          [&](std::size_t i, Numbers& out) { out.push_back(table.at(numbers[rows_[i]])); });
  }
  void writeTable(JsonWriter& json, const char* name, const Numbering& table, bool facts) const {
    json.beginArray(name);
    for (const auto& [number, place] : table.all()) {
      json.beginItem();
      if (number != kNoSegment) json.field("label", number);
      json.field("color", segmentColor(number));
      if (facts) json.field("tint", tinted(segmentColor(number)));
      if (facts && number < cloud_.segments.size()) {
        const PageSegment& s = cloud_.segments[number];
        if (s.confidence >= 0.F) json.field("confidence", s.confidence);
        if (!s.text.empty()) json.field("text", s.text);
      }
      json.endObject();
    }
    json.endArray();
  }
  void writePlaces(JsonWriter& json, const char* name,
                   const std::vector<std::array<double, 3>>& places) const {
    json.beginArray(name);
    for (const auto& place : places) {
      json.beginItem();
      for (std::size_t a = 0; a < 3; ++a) {
        json.field(std::string(1, static_cast<char>('x' + a)),
                   (place[a] - cloud_.origin[a] - cube_.low[a]) / cube_.extent);
      }
      json.endObject();
    }
    json.endArray();
  }

  const PageCloud& cloud_;
  std::vector<std::uint32_t> rows_;
  std::vector<std::size_t> levels_;
  Cube cube_;
  Surroundings around_;
  Numbering labels_;
  Numbering scans_;
};

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '&') {
      out += "&amp;";
    } else if (c == '<') {
      out += "&lt;";
    } else {
      out += c;
    }
  }
  return out;
}

}  // namespace

std::size_t writePage(const PageCloud& cloud, const PageOptions& options, const PageSink& sink) {
  PageWriter writer(cloud, options);
  std::string_view html = kPageHtml;
  // Up to the next place where something goes in.
  const auto writeUpTo = [&](std::string_view mark) {
    const std::size_t at = html.find(mark);
    sink(html.substr(0, at));
    html.remove_prefix(at + mark.size());
  };
  writeUpTo("@TITLE@");
  sink(escaped(cloud.title));
  writeUpTo("@STYLE@");
  sink(kPageCss);
  writeUpTo("@TITLE@");
  sink(escaped(cloud.title));
  writeUpTo("@HEAD@");
  sink(writer.head());
  writeUpTo("@SHADERS@");
  sink(kPageShaders);
  writeUpTo("@DATA@");
  writer.writeData(sink);
  writeUpTo("@SCRIPT@");
  for (const char* script : kPageScripts) sink(script);
  sink(html);
  return writer.points();
}

}  // namespace segorient::program
