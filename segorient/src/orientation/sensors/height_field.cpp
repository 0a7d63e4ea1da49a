// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/sensors/height_field.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "common/dot.h"
#include "common/every_nth.h"
#include "common/median.h"

namespace segorient::detail {
namespace {

// Of columns .97 to 1 are filled where all was seen from above, of what scanners on the ground
// leave .4 to .8.
constexpr std::size_t kFilled = 3;
constexpr float kMostlyFilled = 0.9F;
// Of a strip six columns wide two of three have others on all sides, and of a square of eleven.
// What is narrower is no land, and has sides that slope away before a second layer shows: rods,
// rings, stars.
constexpr float kMostlyInner = 2.F / 3.F;
// Layers: as far apart as a column and a half. What is under something else fills squares of two
// by two columns, edges of roofs and walls only lines: aircraft up to .06 of the columns, solids,
// rooms and woods .2 and more.
constexpr float kApart = 1.5F;
constexpr float kFewLayered = 0.1F;
// What is seen from above has much the same number of points in each column, however steep: woods
// have .1 of them in columns of more than so many times the median, evenly sampled solids on the
// ground up to .3, streets and rooms between their walls .5 and more.
constexpr float kCrowded = 6.F;
constexpr float kFewUpright = 0.4F;
// Columns of two spacings hold four points of a surface above: one in fifty is empty.
constexpr float kOver = 2.F;
// Layers in the neighbourhood of a flat piece, kBehind its plane and more: plates have them at .6
// of the pieces and more, aircraft see them at .22, or at .42 where houses are as small as the
// spacing.
constexpr int kAround = 256;
constexpr float kBehind = 1.F;    // spacings
constexpr float kOnPlane = 0.5F;  // spacings: noise that leaves a piece flat
constexpr float kShareBehind = 0.2F;
constexpr float kFewBacked = 0.5F;
// Points that the extent is taken from.
constexpr std::size_t kSample = 20000;

constexpr float kMostColumns = 4e9F;  // along a side
// Columns are numbered by x in the upper half of the bits, y in the lower.
constexpr std::uint64_t columnAt(float x, float y) {
  return (static_cast<std::uint64_t>(x) << 32U) | static_cast<std::uint64_t>(y);
}

// Where the next column begins. \param entries a column and something of it each, sorted
template <typename Entry>
std::size_t endOfColumn(const std::vector<Entry>& entries, std::size_t begin) {
  std::size_t end = begin + 1;
  while (end < entries.size() && entries[end].first == entries[begin].first) ++end;
  return end;
}

// How many of these, in rising order, are the first of a square of two by two.
std::size_t countSquares(const std::vector<std::uint64_t>& columns) {
  constexpr std::uint64_t kNextX = columnAt(1.F, 0.F);  // from a column to the next
  constexpr std::uint64_t kNextY = columnAt(0.F, 1.F);
  const auto has = [&](std::uint64_t column) {
    return std::binary_search(columns.begin(), columns.end(), column);
  };
  return static_cast<std::size_t>(
      std::count_if(columns.begin(), columns.end(), [&](std::uint64_t c) {
        return has(c + kNextY) && has(c + kNextX) && has(c + kNextX + kNextY);
      }));
}

// Which share of these, in rising order, have all eight beside them.
float shareInner(const std::vector<std::uint64_t>& columns) {
  constexpr std::uint64_t kNextX = columnAt(1.F, 0.F);  // from a column to the next
  const auto hasThree = [&](std::uint64_t middle) {
    const auto at = std::lower_bound(columns.begin(), columns.end(), middle - 1);
    return columns.end() - at >= 3 && at[0] == middle - 1 && at[1] == middle && at[2] == middle + 1;
  };
  const auto inner = std::count_if(columns.begin(), columns.end(), [&](std::uint64_t c) {
    return hasThree(c) && hasThree(c - kNextX) && hasThree(c + kNextX);
  });
  return static_cast<float>(inner) / static_cast<float>(columns.size());
}

// Share of the points in columns that hold many times what the median does.
float shareCrowded(const std::vector<float>& sizes) {
  const float most = kCrowded * median(sizes);
  double all = 0.0;
  double crowded = 0.0;
  for (const float size : sizes) {
    all += static_cast<double>(size);
    if (size > most) crowded += static_cast<double>(size);
  }
  return static_cast<float>(crowded / all);
}

bool isOver(const Box& ground, const float* point) {
  return point[0] >= ground.low[0] && point[0] <= ground.high[0] && point[1] >= ground.low[1] &&
         point[1] <= ground.high[1];
}

// \param point over the ground
std::uint64_t columnOf(const float* point, const Box& ground, float side) {
  const float x = std::min(kMostColumns, (point[0] - ground.low[0]) / side);
  const float y = std::min(kMostColumns, (point[1] - ground.low[1]) / side);
  return columnAt(x, y);
}

// Columns over a rectangle, and the heights of the points in each, sorted.
using ColumnHeights = std::vector<std::pair<std::uint64_t, float>>;
ColumnHeights columnsOf(const PointView& points, const Box& ground, float side) {
  ColumnHeights heights;
  for (std::size_t i = 0; i < points.size; ++i) {
    if (!isOver(ground, points[i])) continue;
    heights.emplace_back(columnOf(points[i], ground, side), points[i][2]);
  }
  std::sort(heights.begin(), heights.end());
  return heights;
}

// Where there is anything at all.
void measureArea(const ColumnHeights& heights, HeightField& out) {
  std::vector<std::uint64_t> columns;
  std::size_t filled = 0;
  for (std::size_t begin = 0; begin < heights.size();) {
    const std::size_t end = endOfColumn(heights, begin);
    columns.push_back(heights[begin].first);
    filled += end - begin >= kFilled ? 1 : 0;
    begin = end;
  }
  if (filled == 0) return;
  out.filled = static_cast<float>(filled) / static_cast<float>(columns.size());
  out.inner = shareInner(columns);
}

void measureLayers(const ColumnHeights& heights, float side, HeightField& out) {
  std::vector<float> filled;  // how many points they hold
  std::vector<std::uint64_t> layered;
  for (std::size_t begin = 0; begin < heights.size();) {
    const std::size_t end = endOfColumn(heights, begin);
    float gap = 0.F;
    for (std::size_t i = begin + 1; i < end; ++i) {
      gap = std::max(gap, heights[i].second - heights[i - 1].second);
    }
    if (end - begin >= kFilled) {
      filled.push_back(static_cast<float>(end - begin));
      if (gap > kApart * side) layered.push_back(heights[begin].first);
    }
    begin = end;
  }
  if (filled.empty()) return;
  out.layered = static_cast<float>(countSquares(layered)) / static_cast<float>(filled.size());
  out.upright = shareCrowded(filled);
}

// Of a point from the middle of a flat piece: along its plane, and across it.
struct Offset {
  std::array<float, 3> along{};
  float across = 0.F;
};

Offset offsetFrom(const float* center, const float* normal, const float* point) {
  Offset out;
  for (std::size_t a = 0; a < 3; ++a) out.along[a] = point[a] - center[a];
  out.across = dot(out.along.data(), normal);
  for (std::size_t a = 0; a < 3; ++a) out.along[a] -= out.across * normal[a];
  return out;
}

// Points off the plane that have others on it before them. Beside a step of height there are none.
std::size_t countBehind(const Offset* offsets, std::size_t count, float spacing) {
  const auto onPlane = [&](const Offset& o) { return std::fabs(o.across) < kOnPlane * spacing; };
  std::size_t behind = 0;
  for (std::size_t j = 0; j < count; ++j) {
    if (!(std::fabs(offsets[j].across) > kBehind * spacing)) continue;
    const Offset* const last = offsets + count;
    const bool covered = std::any_of(offsets, last, [&](const Offset& o) {
      if (!onPlane(o)) return false;
      float square = 0.F;
      for (std::size_t a = 0; a < 3; ++a) {
        square += (o.along[a] - offsets[j].along[a]) * (o.along[a] - offsets[j].along[a]);
      }
      return square < spacing * spacing;
    });
    behind += covered ? 1 : 0;
  }
  return behind;
}

float shareBacked(const PointView& points, const search::MedianHashIndex& index,
                  const DensityPatches& patches) {
  // A share of so many is known to a thirtieth, of the least to a twentieth.
  constexpr std::size_t kPieces = 300;
  constexpr std::size_t kLeastPieces = 100;
  if (patches.size() < kLeastPieces) return 1.F;
  const DensityPatches some = patches.thinned(kPieces);
  std::array<pcl::index_t, kAround> rows{};
  std::array<float, kAround> squared{};
  std::array<Offset, kAround> offsets{};
  std::size_t backed = 0;
  for (std::size_t i = 0; i < some.size(); ++i) {
    const float center[3] = {some.x[i], some.y[i], some.z[i]};
    const float normal[3] = {some.nx[i], some.ny[i], some.nz[i]};
    const int found = index.nearestK(center, kAround, rows.data(), squared.data());
    for (int j = 0; j < found; ++j) {
      const auto at = static_cast<std::size_t>(j);
      offsets[at] = offsetFrom(center, normal, points[static_cast<std::size_t>(rows[at])]);
    }
    const auto behind = countBehind(offsets.data(), static_cast<std::size_t>(found), some.spacing);
    backed += static_cast<float>(behind) > kShareBehind * static_cast<float>(found) ? 1 : 0;
  }
  return static_cast<float>(backed) / static_cast<float>(some.size());
}

}  // namespace

bool HeightField::sure() const {
  return relief <= kMostRelief && filled >= kMostlyFilled && inner >= kMostlyInner &&
         layered <= kFewLayered && upright <= kFewUpright && backed <= kFewBacked;
}

bool looksUpAt(const std::array<float, 3>& place, const std::array<float, 3>& middle) {
  return std::hypot(middle[0] - place[0], middle[1] - place[1]) < middle[2] - place[2];
}

std::vector<std::uint8_t> openToTheSky(const PointView& points, float spacing) {
  std::vector<std::uint8_t> open(points.size, 1);
  Box all;
  for (std::size_t i = 0; i < points.size; ++i) all.add(points[i]);
  const float side = kOver * spacing;
  if (!(side > 0.F)) return open;
  std::vector<std::pair<std::uint64_t, std::uint32_t>> columns(points.size);
  for (std::size_t i = 0; i < points.size; ++i) {
    columns[i] = {columnOf(points[i], all, side), static_cast<std::uint32_t>(i)};
  }
  std::sort(columns.begin(), columns.end());
  for (std::size_t begin = 0; begin < columns.size();) {
    const std::size_t end = endOfColumn(columns, begin);
    float top = points[columns[begin].second][2];
    for (std::size_t i = begin + 1; i < end; ++i) {
      top = std::max(top, points[columns[i].second][2]);
    }
    for (; begin < end; ++begin) {
      const std::uint32_t i = columns[begin].second;
      open[i] = top - points[i][2] > kApart * side ? 0 : 1;
    }
  }
  return open;
}

std::vector<float> heightsOver(const PointView& ground, const PointView& points, float side) {
  Box box;
  for (std::size_t i = 0; i < ground.size; ++i) box.add(ground[i]);
  const ColumnHeights columns = columnsOf(ground, box, side);
  ColumnHeights middles;  // one a column
  for (std::size_t begin = 0; begin < columns.size();) {
    const std::size_t end = endOfColumn(columns, begin);
    middles.push_back(columns[begin + (end - begin) / 2]);
    begin = end;
  }
  std::vector<float> heights;
  for (std::size_t i = 0; i < points.size; ++i) {
    if (!isOver(box, points[i])) continue;
    const std::uint64_t column = columnOf(points[i], box, side);
    const auto at = std::lower_bound(
        middles.begin(), middles.end(), column,
        [](const auto& middle, std::uint64_t value) { return middle.first < value; });
    if (at != middles.end() && at->first == column) heights.push_back(points[i][2] - at->second);
  }
  return heights;
}

HeightField measureHeightField(const PointView& points, const search::MedianHashIndex& index,
                               const DensityPatches& patches, const PointView& all) {
  HeightField out;
  if (!(patches.spacing > 0.F)) return out;
  const Box ground = boxWithout(50, points, kSample);
  const float width = std::hypot(ground.high[0] - ground.low[0], ground.high[1] - ground.low[1]);
  out.relief = width > 0.F ? (ground.high[2] - ground.low[2]) / width : 1e30F;
  // Cheap things first: most clouds end here.
  if (out.relief > kMostRelief) return out;
  const float side = kColumn * patches.spacing;
  const ColumnHeights heights = columnsOf(points, ground, side);
  measureLayers(heights, side, out);
  const bool are_same = all.data == points.data && all.size == points.size;
  measureArea(are_same ? heights : columnsOf(all, ground, side), out);
  if (out.layered <= kFewLayered && out.upright <= kFewUpright && out.inner >= kMostlyInner) {
    out.backed = shareBacked(points, index, patches);
  }
  return out;
}

}  // namespace segorient::detail
