// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "layout.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace segorient::search {
namespace {

constexpr std::size_t kBins = 1024;
// Fewer points than this are a task of their own no longer.
constexpr std::size_t kTaskSize = 20000;

Box boxOf(const BuildPoint* points, std::size_t count) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  float lo[3] = {kInfinity, kInfinity, kInfinity};
  float hi[3] = {-kInfinity, -kInfinity, -kInfinity};
  for (std::size_t i = 0; i < count; ++i) {
    for (int a = 0; a < 3; ++a) {
      const float v = points[i].xyz[a];
      lo[a] = v < lo[a] ? v : lo[a];
      hi[a] = v > hi[a] ? v : hi[a];
    }
  }
  return {{lo[0], lo[1], lo[2]}, {hi[0], hi[1], hi[2]}};
}

int longestAxis(const Box& box) {
  int axis = 0;
  for (int a = 1; a < 3; ++a) {
    // Halves, since the extent itself may overflow.
    if (box.hi[a] / 2 - box.lo[a] / 2 > box.hi[axis] / 2 - box.lo[axis] / 2) axis = a;
  }
  return axis;
}

// Bins of equal width over an interval; halved, since its length may overflow.
class Binning {
 public:
  Binning(float lo, float hi)
      : lo_(0.5F * lo), scale_(0.5F * static_cast<float>(kBins) / length(lo, hi)) {}
  std::size_t operator()(float v) const {
    const float bin = 2.0F * (0.5F * v - lo_) * scale_;
    return static_cast<std::size_t>(std::min(std::max(bin, 0.0F), static_cast<float>(kBins - 1)));
  }

 private:
  static float length(float lo, float hi) { return std::max(0.5F * hi - 0.5F * lo, 1e-30F); }
  float lo_;
  float scale_;
};

// The coordinate of the element of rank `rank`, and how many of those equal to it belong to the
// first `rank` elements. A histogram leaves a small part of the points to select from.
struct Median {
  float value;
  std::size_t equal_on_left;
};

Median findMedian(const BuildPoint* points, std::size_t count, std::size_t rank, int axis,
                  const Binning& bin, std::vector<float>& scratch) {
  std::array<std::array<std::uint32_t, kBins>, 2> histogram{};  // two: no waiting for a store
  for (std::size_t i = 0; i < count; ++i) ++histogram[i & 1][bin(points[i].xyz[axis])];
  std::size_t below = 0;
  std::size_t b = 0;
  for (;; ++b) {
    const std::size_t in_bin = histogram[0][b] + histogram[1][b];
    if (below + in_bin > rank) break;
    below += in_bin;
  }
  scratch.clear();
  for (std::size_t i = 0; i < count; ++i) {
    const float v = points[i].xyz[axis];
    if (bin(v) == b) scratch.push_back(v);
  }
  const auto nth = scratch.begin() + static_cast<std::ptrdiff_t>(rank - below);
  std::nth_element(scratch.begin(), nth, scratch.end());
  const auto less = static_cast<std::size_t>(
      std::count_if(scratch.begin(), nth, [&](float v) { return v < *nth; }));
  return {*nth, rank - below - less};
}

// Copies to `to`, the first `rank` points by coordinate in front, in the order they had; the others
// in reverse order, so that no branch depends on the data.
void partition(const BuildPoint* from, std::size_t count, BuildPoint* to, int axis,
               const Median& median) {
  std::size_t left = 0;
  std::size_t right = count;
  std::size_t equal_left = median.equal_on_left;
  for (std::size_t i = 0; i < count; ++i) {
    const BuildPoint p = from[i];
    const float v = p.xyz[axis];
    const bool equal = v == median.value && equal_left > 0;
    const bool goes_left = v < median.value || equal;
    equal_left -= equal ? 1 : 0;
    to[left] = p;
    to[right - 1] = p;
    left += goes_left ? 1 : 0;
    right -= goes_left ? 0 : 1;
  }
}

class Subdivision {
 public:
  Subdivision(std::vector<BuildPoint>& points, std::size_t levels, Layout& layout)
      : points_(points), other_(points.size()), levels_(levels), layout_(layout) {
    layout.boxes.resize(std::size_t{2} << levels);
    layout.splits.resize(std::size_t{1} << levels);
    layout.regions.resize(std::size_t{1} << levels);
  }

  // Leaves the points region by region in the vector that it returns.
  std::vector<BuildPoint>& run(int threads) {
#pragma omp parallel num_threads(threads) if (threads > 1)
#pragma omp single
    divide(1, 0, 0, points_.size());
    return levels_ % 2 == 0 ? points_ : other_;
  }

 private:
  void divide(std::size_t node, std::size_t level, std::size_t begin, std::size_t end) {
    BuildPoint* from = (level % 2 == 0 ? points_ : other_).data() + begin;
    BuildPoint* to = (level % 2 == 0 ? other_ : points_).data() + begin;
    const std::size_t count = end - begin;
    const Box box = boxOf(from, count);
    layout_.boxes[node] = box;
    if (level == levels_) {
      Region& region = layout_.regions[node - layout_.regions.size()];
      region.begin = static_cast<std::uint32_t>(begin);
      region.end = static_cast<std::uint32_t>(end);
      return;
    }
    const std::size_t half = count / 2;
    const int axis = longestAxis(box);
    {
      std::vector<float> scratch;
      const Median median =
          findMedian(from, count, half, axis, Binning(box.lo[axis], box.hi[axis]), scratch);
      layout_.splits[node] = {median.value, static_cast<std::uint32_t>(axis)};
      partition(from, count, to, axis, median);
    }
    const std::size_t middle = begin + half;
#pragma omp task if (count > kTaskSize)
    divide(2 * node, level + 1, begin, middle);
#pragma omp task if (count > kTaskSize)
    divide(2 * node + 1, level + 1, middle, end);
#pragma omp taskwait
  }

  std::vector<BuildPoint>& points_;
  std::vector<BuildPoint> other_;
  std::size_t levels_;
  Layout& layout_;
};

float squaredDistance(const BuildPoint& p, const BuildPoint& q) {
  const float dx = p.xyz[0] - q.xyz[0];
  const float dy = p.xyz[1] - q.xyz[1];
  const float dz = p.xyz[2] - q.xyz[2];
  return dx * dx + dy * dy + dz * dz;
}

// Median over three points of the squared distance to the 16th neighbour inside the region.
float typicalSpacing(const BuildPoint* points, std::size_t count, std::vector<float>& scratch) {
  if (count < 2) return 0.0F;
  const std::size_t rank = std::min<std::size_t>(16, count - 1);
  std::array<float, 3> found{};
  for (std::size_t s = 0; s < 3; ++s) {
    const BuildPoint& sample = points[(2 * s + 1) * count / 6];
    scratch.resize(count);
    for (std::size_t i = 0; i < count; ++i) scratch[i] = squaredDistance(sample, points[i]);
    const auto nth = scratch.begin() + static_cast<std::ptrdiff_t>(rank);
    std::nth_element(scratch.begin(), nth, scratch.end());
    found[s] = *nth;
  }
  std::sort(found.begin(), found.end());
  return found[1];
}

// Chooses the grid of a region; the cells are wide enough that k nearest neighbours lie in few of
// them and narrow enough that they hold few other points.
void chooseGrid(const Box& box, std::size_t count, float spacing16, Region& region) {
  region.spacing16 = spacing16;
  double edge = 1.6 * std::sqrt(static_cast<double>(spacing16));
  double extent[3];
  double longest = 0.0;
  for (int a = 0; a < 3; ++a) {
    extent[a] = static_cast<double>(box.hi[a]) - static_cast<double>(box.lo[a]);
    longest = std::max(longest, extent[a]);
  }
  // Neither more than 4 cells a point in all nor more along an axis than 16 bits can count.
  const double most = std::min(4.0 * static_cast<double>(count), 60000.0);
  edge = std::max({edge, longest / most, 1e-30});
  const auto cells = [&](int a) { return std::floor(extent[a] / edge) + 1.0; };
  while (cells(0) * cells(1) * cells(2) > most) edge *= 1.25;
  for (int a = 0; a < 3; ++a) region.counts[a] = static_cast<std::uint16_t>(cells(a));
  region.inverse_edge = static_cast<float>(1.0 / edge);
}

std::size_t cellOf(const BuildPoint& p, const Box& box, const Region& region) {
  std::size_t c[3];
  for (int a = 0; a < 3; ++a) {
    const float cell = (p.xyz[a] - box.lo[a]) * region.inverse_edge;
    c[a] = static_cast<std::size_t>(std::min(cell, static_cast<float>(region.counts[a] - 1)));
  }
  return c[0] + region.counts[0] * (c[1] + region.counts[1] * c[2]);
}

std::size_t cellCount(const Region& region) {
  return std::size_t{region.counts[0]} * region.counts[1] * region.counts[2];
}

// Counting sort of a region's points into its cells.
void sortIntoCells(BuildPoint* points, const Box& box, const Region& region, Layout& layout,
                   std::vector<std::uint32_t>& cell) {
  const std::size_t count = region.end - region.begin;
  std::uint16_t* starts = layout.starts.data() + region.first_start;
  const std::size_t cells = cellCount(region);
  if (region.identical != 0) {
    std::sort(points, points + count,
              [](const BuildPoint& a, const BuildPoint& b) { return a.row < b.row; });
  }
  cell.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    cell[i] = static_cast<std::uint32_t>(cellOf(points[i], box, region));
    ++starts[cell[i] + 1];
  }
  for (std::size_t c = 0; c < cells; ++c) {
    starts[c + 1] = static_cast<std::uint16_t>(starts[c + 1] + starts[c]);
  }
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t at = region.begin + starts[cell[i]]++;
    layout.x[at] = points[i].xyz[0];
    layout.y[at] = points[i].xyz[1];
    layout.z[at] = points[i].xyz[2];
    layout.id[at] = points[i].row;
  }
  // Every start has moved to the next one.
  for (std::size_t c = cells; c > 0; --c) starts[c] = starts[c - 1];
  starts[0] = 0;
}

void hashRegions(std::vector<BuildPoint>& points, Layout& layout, int threads) {
  const auto regions = static_cast<std::ptrdiff_t>(layout.regions.size());
#pragma omp parallel num_threads(threads) if (threads > 1)
  {
    std::vector<float> scratch;
#pragma omp for schedule(dynamic, 8)
    for (std::ptrdiff_t i = 0; i < regions; ++i) {
      const auto r = static_cast<std::size_t>(i);
      Region& region = layout.regions[r];
      const Box& box = layout.boxes[layout.regions.size() + r];
      const std::size_t count = region.end - region.begin;
      region.identical = box.lo[0] == box.hi[0] && box.lo[1] == box.hi[1] && box.lo[2] == box.hi[2];
      chooseGrid(box, count, typicalSpacing(points.data() + region.begin, count, scratch), region);
    }
  }
  std::size_t starts = 0;
  for (Region& region : layout.regions) {
    region.first_start = static_cast<std::uint32_t>(starts);
    starts += cellCount(region) + 1;
  }
  layout.starts.assign(starts, 0);
#pragma omp parallel num_threads(threads) if (threads > 1)
  {
    std::vector<std::uint32_t> cell;
#pragma omp for schedule(dynamic, 8)
    for (std::ptrdiff_t i = 0; i < regions; ++i) {
      const auto r = static_cast<std::size_t>(i);
      const Region& region = layout.regions[r];
      sortIntoCells(points.data() + region.begin, layout.boxes[layout.regions.size() + r], region,
                    layout, cell);
    }
  }
}

}  // namespace

Layout buildLayout(std::vector<BuildPoint> points, std::size_t region_size, int threads) {
  Layout layout;
  if (points.empty()) return layout;
  std::size_t levels = 0;
  while ((points.size() >> levels) + 1 > region_size && (points.size() >> levels) > 1) ++levels;
  Subdivision subdivision(points, levels, layout);
  std::vector<BuildPoint>& sorted = subdivision.run(threads);
  const std::size_t padded = points.size() + Layout::kPadding;
  for (auto* array : {&layout.x, &layout.y, &layout.z}) array->resize(padded);
  layout.id.resize(padded);
  hashRegions(sorted, layout, threads);
  return layout;
}

}  // namespace segorient::search
