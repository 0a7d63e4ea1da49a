// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "render/scene.h"

#include <segorient/search/median_hash_index.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "io/errors.h"
#include "support/colors.h"

namespace segorient::program {
namespace {

constexpr std::uint32_t kFront = 0xe6e2d8U;     // the side that normals point to
constexpr std::uint32_t kBack = 0xd03020U;      // the other
constexpr std::uint32_t kNoNormal = 0x3060c0U;  // has no normal
constexpr std::uint32_t kPlain = 0xb8c4d0U;     // nothing is known
constexpr std::uint32_t kHard = 0x8040e0U;      // hard segments, front
constexpr std::uint32_t kHardBack = 0x401060U;  // and back
// With eight neighbours within its radius, three in ten thousand spots of a randomly sampled
// surface stay open.
constexpr int kCover = 8;
constexpr float kLargestSplat = 3.F;  // times the median: stray points stay small
constexpr float kCutCosine = 0.82F;   // normals 35 degrees apart: an edge
constexpr float kCutSlack = 0.05F;    // of the radius; closes the gap along the edge
constexpr std::uint32_t kMostCuts = 4;

std::uint32_t readU32(const CloudTable& table, const Field& field, std::size_t row) {
  std::uint32_t v = 0;
  std::memcpy(&v, table.at(field, row), std::min<std::size_t>(sizeof(v), field.size));
  return v;
}

// One part of a colour and three of the front's: segments differ, and none looks like a back.
std::uint32_t tinted(std::uint32_t color) {
  std::uint32_t out = 0;
  for (const unsigned shift : {0U, 8U, 16U}) {
    const std::uint32_t own = color >> shift & 255U;
    const std::uint32_t front = kFront >> shift & 255U;
    out |= (own + 3 * front) / 4 << shift;
  }
  return out;
}

// Colours of both sides of a point's splat.
class Palette {
 public:
  Palette(const CloudTable& table, Coloring coloring, const std::vector<std::uint32_t>& hard)
      : table_(table), coloring_(coloring), hard_(hard) {
    if (coloring == Coloring::Segment || coloring == Coloring::Orientation) {
      field_ = table.find("label");
    }
    if (coloring == Coloring::Rgb) field_ = table.find("rgb");
  }
  void set(std::size_t row, bool has_normal, std::uint32_t& front, std::uint32_t& back) const {
    if (coloring_ == Coloring::Normal) {
      front = has_normal ? kFront : kNoNormal;
      back = has_normal ? kBack : kNoNormal;
      return;
    }
    if (coloring_ == Coloring::Orientation) {
      const bool hard = std::binary_search(hard_.begin(), hard_.end(), label(row));
      front = hard ? kHard : tinted(segmentColor(label(row)));
      back = hard ? kHardBack : kBack;
      if (!has_normal) front = back = kNoNormal;
      return;
    }
    front = kPlain;
    if (field_ != nullptr && coloring_ == Coloring::Rgb) {
      front = readU32(table_, *field_, row) & 0xffffffU;
    } else if (field_ != nullptr) {
      front = segmentColor(label(row));
    }
    back = front;
  }

 private:
  std::uint32_t label(std::size_t row) const {
    const double value = table_.value(*field_, row);
    const bool none = !(value >= 0.0) || value >= kNoSegment;
    return none ? kNoSegment : static_cast<std::uint32_t>(value);
  }

  const CloudTable& table_;
  Coloring coloring_;
  const std::vector<std::uint32_t>& hard_;
  const Field* field_ = nullptr;
};

// Unit normals of a table or of an array; NaN where there is none.
class NormalSource {
 public:
  NormalSource(const CloudTable& table, const float* normals) : table_(table), normals_(normals) {}
  bool any() const { return normals_ != nullptr || table_.hasNormals(); }
  std::array<float, 3> at(std::size_t row) const {
    if (!any()) return {NAN, NAN, NAN};
    std::array<double, 3> n{};
    if (normals_ == nullptr) {
      n = table_.triple(table_.normals(), row);
    } else {
      std::copy_n(normals_ + 4 * row, 3, n.begin());
    }
    const double length = std::hypot(n[0], n[1], n[2]);
    return {static_cast<float>(n[0] / length), static_cast<float>(n[1] / length),
            static_cast<float>(n[2] / length)};
  }

 private:
  const CloudTable& table_;
  const float* normals_;
};

std::array<float, 3> positionOf(const PointView& points, std::size_t i) {
  return {points[i][0], points[i][1], points[i][2]};
}

void addMesh(const CloudTable& table, const PointView& points, const Palette& palette,
             Scene& scene) {
  for (std::size_t i = 0; i < points.size; ++i) scene.vertices.push_back(positionOf(points, i));
  for (const Triangle& t : table.triangles) {
    const bool whole =
        std::all_of(t.begin(), t.end(), [&](std::uint32_t v) { return isFinite(points[v]); });
    if (!whole) continue;
    scene.triangles.push_back(t);
    palette.set(t[0], true, scene.front.emplace_back(), scene.back.emplace_back());
  }
  // Vertices of no triangle are not seen and shall not stretch the picture.
  std::vector<char> used(scene.vertices.size(), 0);
  for (const Triangle& t : scene.triangles) {
    for (const std::uint32_t v : t) used[v] = 1;
  }
  for (std::size_t i = 0; i < used.size() && !scene.triangles.empty(); ++i) {
    if (used[i] == 0) scene.vertices[i] = scene.vertices[scene.triangles[0][0]];
  }
}

// Radius of each point's splat: its last neighbour's distance.
std::vector<float> splatRadii(const Neighborhoods& neighborhoods) {
  std::vector<float> radii(neighborhoods.size(), 0.F);
  std::vector<float> known;
  for (std::size_t i = 0; i < radii.size(); ++i) {
    const int count = neighborhoods.count(i);
    if (count < 2) continue;
    const float radius = std::sqrt(neighborhoods.sqrDistances(i)[count - 1]);
    if (!std::isfinite(radius)) continue;  // its square overflows; a dot does
    radii[i] = radius;
    known.push_back(radius);
  }
  if (known.empty()) return radii;
  const auto middle = known.begin() + static_cast<std::ptrdiff_t>(known.size() / 2);
  std::nth_element(known.begin(), middle, known.end());
  for (float& r : radii) r = std::min(r, kLargestSplat * *middle);
  return radii;
}

float dot(const std::array<float, 3>& a, const std::array<float, 3>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// A neighbour's tangent plane ends the splat if it stands at an angle to the splat's own: that is
// where the edge between the two runs. Signs of normals play no part.
void addCuts(const std::vector<std::int32_t>& splat_of, const pcl::index_t* neighbors, int count,
             std::size_t self, Scene& scene) {
  Splat& s = scene.splats[self];
  s.first_cut = static_cast<std::uint32_t>(scene.cuts.size());
  for (int j = 1; j < count && s.cuts < kMostCuts; ++j) {
    const std::int32_t other = splat_of[static_cast<std::size_t>(neighbors[j])];
    if (other < 0) continue;
    const Splat& o = scene.splats[static_cast<std::size_t>(other)];
    if (!(std::abs(dot(s.normal, o.normal)) < kCutCosine)) continue;
    HalfSpace cut{o.normal, dot(o.normal, o.position)};
    if (dot(cut.normal, s.position) < cut.offset) {
      for (float& v : cut.normal) v = -v;
      cut.offset = -cut.offset;
    }
    cut.offset -= kCutSlack * s.radius;
    scene.cuts.push_back(cut);
    ++s.cuts;
  }
}

void addSplats(const PointView& points, const NormalSource& normals, const Palette& palette,
               int threads, Scene& scene) {
  search::MedianHashIndex index;
  search::MedianHashIndex::Options options;
  options.threads = threads;
  index.build(points, nullptr, options);
  Neighborhoods neighborhoods;
  index.nearestKAll(kCover + 1, neighborhoods);

  const std::vector<float> radii = splatRadii(neighborhoods);
  std::vector<std::int32_t> splat_of(points.size, -1);
  for (std::size_t i = 0; i < points.size; ++i) {
    if (!isFinite(points[i])) continue;
    splat_of[i] = static_cast<std::int32_t>(scene.splats.size());
    Splat s;
    s.position = positionOf(points, i);
    s.normal = normals.at(i);
    s.radius = radii[i];
    palette.set(i, std::isfinite(s.normal[0]), s.front, s.back);
    scene.splats.push_back(s);
  }
  for (std::size_t i = 0; i < points.size && normals.any(); ++i) {
    if (splat_of[i] < 0) continue;
    addCuts(splat_of, neighborhoods.indices(i), neighborhoods.count(i),
            static_cast<std::size_t>(splat_of[i]), scene);
  }
}

}  // namespace

Coloring parseColoring(const std::string& name, const CloudTable& table, const std::string& path) {
  const bool labels = table.find("label") != nullptr;
  const bool rgb = table.find("rgb") != nullptr;
  const bool normals = table.hasNormals() || !table.triangles.empty();
  if (name == "normal") {
    if (!normals) throw FileError(path, "has no normals");
    return Coloring::Normal;
  }
  if (name == "segment") {
    if (!labels) throw FileError(path, "has no field label");
    return Coloring::Segment;
  }
  if (name == "orientation") {
    if (!normals) throw FileError(path, "has no normals");
    if (!labels) throw FileError(path, "has no field label");
    return Coloring::Orientation;
  }
  if (name == "rgb") {
    if (!rgb) throw FileError(path, "has no field rgb");
    return Coloring::Rgb;
  }
  if (name != "auto") throw UsageError("--color is one of auto normal segment orientation rgb");
  if (table.hasNormals()) return Coloring::Normal;
  if (labels) return Coloring::Segment;
  return normals && !rgb ? Coloring::Normal : Coloring::Rgb;
}

Scene makeScene(const CloudTable& table, const LocalPoints& points, const float* normals,
                Coloring coloring, int threads, const std::vector<std::uint32_t>& hard) {
  Scene scene;
  const Palette palette(table, coloring, hard);
  if (!table.triangles.empty()) {
    addMesh(table, points.view(), palette, scene);
  } else {
    addSplats(points.view(), NormalSource(table, normals), palette, threads, scene);
  }
  return scene;
}

Picture drawViews(const Scene& scene, const View& view, bool both) {
  if (!both) return drawScene(scene, view);
  View left = view;
  left.width /= 2;
  View right = left;
  right.azimuth += 180.0;
  right.elevation = -right.elevation;
  return beside({drawScene(scene, left), drawScene(scene, right)});
}

}  // namespace segorient::program
