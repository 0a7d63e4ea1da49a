// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "render/page/page.h"

#include <segorient/search/median_hash_index.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "page_files.h"
#include "render/page/disc_radii.h"
#include "render/page/thinning.h"
#include "support/colors.h"
#include "support/json.h"

namespace segorient::program {
namespace {

constexpr int kAround = 16;  // neighbours, as in pictures
constexpr double kSteps = 65535.0;

using Bytes = std::vector<std::uint8_t>;

void append(Bytes& bytes, std::uint32_t value, std::size_t size) {
  for (std::size_t i = 0; i < size; ++i) bytes.push_back(static_cast<std::uint8_t>(value >> 8 * i));
}

// Four bytes as five letters, the first the most significant, from ( to ~ without < and \: nothing
// that HTML or JavaScript would read as more than a letter, and shorter than base 64.
std::string base85(Bytes bytes) {
  while (bytes.size() % 4 != 0) bytes.push_back(0);
  std::string text(bytes.size() / 4 * 5, ' ');
  for (std::size_t i = 0, at = 0; i < bytes.size(); i += 4, at += 5) {
    std::uint32_t word = 0;
    for (std::size_t b = 0; b < 4; ++b) word |= std::uint32_t{bytes[i + b]} << 8 * b;
    for (std::size_t c = 5; c-- > 0; word /= 85) {
      auto letter = static_cast<char>('(' + word % 85);
      if (letter >= '<') ++letter;
      if (letter >= '\\') ++letter;
      text[at + c] = letter;
    }
  }
  return text;
}

// Two bytes: the direction on an octahedron that is folded flat; 0x8080 has no normal.
std::uint32_t packedNormal(const float* n) {
  const float sum = std::abs(n[0]) + std::abs(n[1]) + std::abs(n[2]);
  if (!(sum > 0.F) || !std::isfinite(sum)) return 0x8080U;
  float u = n[0] / sum;
  float v = n[1] / sum;
  if (n[2] < 0.F) {
    const float folded = (1.F - std::abs(v)) * (u < 0.F ? -1.F : 1.F);
    v = (1.F - std::abs(u)) * (v < 0.F ? -1.F : 1.F);
    u = folded;
  }
  const auto byte = [](float t) {
    return static_cast<std::uint32_t>(static_cast<std::uint8_t>(std::lround(127.F * t)));
  };
  return byte(u) | byte(v) << 8;
}

// The cube that holds the points.
struct Cube {
  std::array<double, 3> low{};
  double extent = 0.0;
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

// What the points shown tell of each other: the size of discs, and sides.
struct Surroundings {
  double radius = 0.0;
  std::vector<Side> sides;  // empty without normals

  Surroundings(const PageCloud& cloud, const std::vector<std::uint32_t>& rows, int threads) {
    std::vector<float> shown;
    std::vector<float> normals;
    shown.reserve(3 * rows.size());
    for (const std::uint32_t row : rows) {
      shown.insert(shown.end(), cloud.points[row], cloud.points[row] + 3);
      if (cloud.normals.empty()) continue;
      const float* n = &cloud.normals[3 * std::size_t{row}];
      const float length = std::hypot(n[0], n[1], n[2]);
      for (int a = 0; a < 3; ++a) normals.push_back(n[a] / length);
    }
    PointView view;
    view.data = shown.data();
    view.stride = 3;
    view.size = rows.size();
    search::MedianHashIndex index;
    search::MedianHashIndex::Options options;
    options.threads = threads;
    index.build(view, nullptr, options);
    Neighborhoods neighborhoods;
    index.nearestKAll(kAround + 1, neighborhoods);
    float middle = 0.F;
    const std::vector<float> radii = discRadii(neighborhoods, middle);
    radius = static_cast<double>(middle);
    if (normals.empty()) return;
    sides = findSides(view, normals, neighborhoods, radii, middle, threads);
    for (std::size_t i = 0; i < sides.size() && !cloud.sides.empty(); ++i) {
      const Side told = cloud.sides[rows[i]];
      if (told != Side::Open) sides[i] = told;
    }
  }
};

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
  std::size_t bytes() const {
    if (places_.empty()) return 0;
    return places_.size() <= 0x100 ? 1 : places_.size() <= 0x10000 ? 2 : 4;
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
        rows_(blueNoiseOrder(cloud.points, options.points)),
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
    json.field("labelBytes", labels_.bytes());
    json.field("scanBytes", scans_.bytes());
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
    write(sink, "positions", 6, [&](std::uint32_t row, Bytes& out) {
      for (std::size_t a = 0; a < 3; ++a) {
        const double offset = static_cast<double>(cloud_.points[row][a]) - cube_.low[a];
        append(out, static_cast<std::uint32_t>(std::lround(kSteps * offset / cube_.extent)), 2);
      }
    });
    if (!cloud_.normals.empty()) {
      write(sink, "normals", 2, [&](std::uint32_t row, Bytes& out) {
        append(out, packedNormal(cloud_.normals.data() + 3 * std::size_t{row}), 2);
      });
    }
    if (!cloud_.labels.empty()) {
      writeNumbers(sink, "labels", cloud_.labels, labels_);
    }
    if (!cloud_.scans.empty()) writeNumbers(sink, "scans", cloud_.scans, scans_);
    if (!around_.sides.empty()) {
      std::size_t next = 0;
      write(sink, "sides", 1, [&](std::uint32_t, Bytes& out) {
        append(out, static_cast<std::uint32_t>(around_.sides[next++]), 1);
      });
    }
    if (!cloud_.confidences.empty()) {
      write(sink, "confidences", 1, [&](std::uint32_t row, Bytes& out) {
        const float value = cloud_.confidences[row];  // 255: not known
        const float share = std::isfinite(value) ? std::clamp(value, 0.F, 1.F) * 254.F : 255.F;
        append(out, static_cast<std::uint32_t>(std::lround(share)), 1);
      });
    }
    if (!cloud_.colors.empty()) {
      write(sink, "colors", 2, [&](std::uint32_t row, Bytes& out) {
        const std::uint32_t c = cloud_.colors[row];
        append(out, (c >> 8 & 0xf800U) | (c >> 5 & 0x7e0U) | (c >> 3 & 0x1fU), 2);
      });
    }
  }

 private:
  template <typename Row>
  void write(const PageSink& sink, const char* name, std::size_t size, const Row& row) const {
    Bytes bytes;
    bytes.reserve(size * rows_.size() + 3);
    for (const std::uint32_t r : rows_) row(r, bytes);
    sink(std::string("<script type=\"text/plain\" id=\"") + name + "\">");
    sink(base85(std::move(bytes)));
    sink("</script>\n");
  }
  void writeNumbers(const PageSink& sink, const char* name,
                    const std::vector<std::uint32_t>& numbers, const Numbering& table) const {
    write(sink, name, table.bytes(), [&](std::uint32_t row, Bytes& out) {
      append(out, table.at(numbers[row]), table.bytes());
    });
  }
  void writeTable(JsonWriter& json, const char* name, const Numbering& table, bool facts) const {
    json.beginArray(name);
    for (const auto& [number, place] : table.all()) {
      json.beginItem();
      if (number != kNoSegment) json.field("label", number);
      json.field("color", segmentColor(number));
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
  writeUpTo("@HEAD@");
  sink(writer.head());
  writeUpTo("@DATA@");
  writer.writeData(sink);
  writeUpTo("@SCRIPT@");
  for (const char* script : kPageScripts) sink(script);
  sink(html);
  return writer.points();
}

}  // namespace segorient::program
