// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "layout.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>

namespace segorient::search {
namespace {

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

Box merged(const Box& a, const Box& b) {
  Box box;
  for (int i = 0; i < 3; ++i) {
    box.lo[i] = std::min(a.lo[i], b.lo[i]);
    box.hi[i] = std::max(a.hi[i], b.hi[i]);
  }
  return box;
}

// What a sample tells: along which axis to divide, and an interval that the median is most likely
// in.
struct Estimate {
  int axis;
  float lo, hi;
};

Estimate estimate(const BuildPoint* points, std::size_t count, FastVector<BuildPoint>& sample) {
  const std::size_t size =
      std::min(std::max<std::size_t>(count / 8, 64), std::min<std::size_t>(count, 1024));
  sample.resize(size);
  for (std::size_t i = 0; i < size; ++i) sample[i] = points[i * count / size];
  const int axis = longestAxis(boxOf(sample.data(), size));
  const auto less = [axis](const BuildPoint& p, const BuildPoint& q) {
    return p.xyz[axis] < q.xyz[axis];
  };
  // 2.5 standard deviations of the rank, which is that of a fair coin.
  const auto deviation = static_cast<std::size_t>(1.25 * std::sqrt(static_cast<double>(size))) + 1;
  const std::size_t middle = size / 2;
  const auto low =
      sample.begin() + static_cast<std::ptrdiff_t>(middle - std::min(deviation, middle));
  const auto high =
      sample.begin() + static_cast<std::ptrdiff_t>(std::min(middle + deviation, size - 1));
  std::nth_element(sample.begin(), low, sample.end(), less);
  std::nth_element(low, high, sample.end(), less);
  return {axis, low->xyz[axis], high->xyz[axis]};
}

// Copies to `to`, the `half` points of the least coordinates in front. What is below or above the
// estimated interval is in place after one pass without a branch; the rest is selected from.
// \return the least coordinate of the second half
float divideInTwo(const BuildPoint* from, std::size_t count, BuildPoint* to, std::size_t half,
                  const Estimate& guess, FastVector<BuildPoint>& between) {
  const int axis = guess.axis;
  between.resize(count + 1);
  BuildPoint* const inside = between.data();
  std::size_t left = 0;
  std::size_t right = count;
  std::size_t middle = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const BuildPoint p = from[i];
    const float v = p.xyz[axis];
    const bool below = v < guess.lo;
    const bool above = v > guess.hi;
    to[left] = p;
    to[right - 1] = p;
    inside[middle] = p;
    left += below ? 1 : 0;
    right -= above ? 1 : 0;
    middle += below || above ? 0 : 1;
  }
  const auto less = [axis](const BuildPoint& p, const BuildPoint& q) {
    return p.xyz[axis] < q.xyz[axis];
  };
  if (left > half || left + middle <= half) {  // the estimate was wrong
    std::copy(inside, inside + middle, to + left);
    std::nth_element(to, to + half, to + count, less);
    return to[half].xyz[axis];
  }
  std::nth_element(inside, inside + (half - left), inside + middle, less);
  std::copy(inside, inside + middle, to + left);
  return to[half].xyz[axis];
}

class Subdivision {
 public:
  Subdivision(BuildPoint* points, BuildPoint* other, std::size_t levels, Layout& layout)
      : points_(points), other_(other), levels_(levels), layout_(layout) {
    layout.boxes.resize(std::size_t{2} << levels);
    layout.splits.resize(std::size_t{1} << levels);
    layout.regions.resize(std::size_t{1} << levels);
  }

  // \return the points region by region, in one of the two arrays
  BuildPoint* run(std::size_t count, int threads) {
#pragma omp parallel num_threads(threads) if (threads > 1)
#pragma omp single
    divide(1, 0, 0, count);
    for (std::size_t node = layout_.regions.size() - 1; node > 0; --node) {
      layout_.boxes[node] = merged(layout_.boxes[2 * node], layout_.boxes[2 * node + 1]);
    }
    return levels_ % 2 == 0 ? points_ : other_;
  }

 private:
  void divide(std::size_t node, std::size_t level, std::size_t begin, std::size_t end) {
    const BuildPoint* from = (level % 2 == 0 ? points_ : other_) + begin;
    const std::size_t count = end - begin;
    if (level == levels_) {
      layout_.boxes[node] = boxOf(from, count);
      Region& region = layout_.regions[node - layout_.regions.size()];
      region.begin = static_cast<std::uint32_t>(begin);
      region.end = static_cast<std::uint32_t>(end);
      return;
    }
    const std::size_t half = count / 2;
    {
      thread_local FastVector<BuildPoint> scratch;
      const Estimate guess = estimate(from, count, scratch);
      BuildPoint* to = (level % 2 == 0 ? other_ : points_) + begin;
      const float value = divideInTwo(from, count, to, half, guess, scratch);
      layout_.splits[node] = {value, static_cast<std::uint32_t>(guess.axis)};
    }
    const std::size_t middle = begin + half;
#pragma omp task if (count > kTaskSize)
    divide(2 * node, level + 1, begin, middle);
#pragma omp task if (count > kTaskSize)
    divide(2 * node + 1, level + 1, middle, end);
#pragma omp taskwait
  }

  BuildPoint* points_;
  BuildPoint* other_;
  std::size_t levels_;
  Layout& layout_;
};

float squaredDistance(const BuildPoint& p, const BuildPoint& q) {
  const float dx = p.xyz[0] - q.xyz[0];
  const float dy = p.xyz[1] - q.xyz[1];
  const float dz = p.xyz[2] - q.xyz[2];
  return dx * dx + dy * dy + dz * dz;
}

// Squared distance from a point to its 16th neighbour, or to the farthest of fewer.
float squaredSpacing(const BuildPoint& point, const BuildPoint* points, std::size_t count) {
  constexpr std::size_t kRank = 16;
  std::array<float, kRank + 1> nearest;  // the point itself among them, ascending
  std::size_t found = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const float d = squaredDistance(point, points[i]);
    if (found > kRank && !(d < nearest[kRank])) continue;
    std::size_t at = found > kRank ? kRank : found++;
    for (; at > 0 && d < nearest[at - 1]; --at) nearest[at] = nearest[at - 1];
    nearest[at] = d;
  }
  return nearest[found - 1];
}

// The median over three points.
float typicalSpacing(const BuildPoint* points, std::size_t count) {
  std::array<float, 3> found{};
  for (std::size_t s = 0; s < 3; ++s) {
    found[s] = squaredSpacing(points[(2 * s + 1) * count / 6], points, count);
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
    // The last one also where the difference overflows and a cell has no end: that is no number.
    const auto last = static_cast<float>(region.counts[a] - 1);
    c[a] = static_cast<std::size_t>(cell < last ? cell : last);
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

void hashRegions(BuildPoint* points, Layout& layout, int threads) {
  const auto regions = static_cast<std::ptrdiff_t>(layout.regions.size());
#pragma omp parallel for num_threads(threads) schedule(dynamic, 8) if (threads > 1)
  for (std::ptrdiff_t i = 0; i < regions; ++i) {
    const auto r = static_cast<std::size_t>(i);
    Region& region = layout.regions[r];
    const Box& box = layout.boxes[layout.regions.size() + r];
    const std::size_t count = region.end - region.begin;
    region.identical = box.lo[0] == box.hi[0] && box.lo[1] == box.hi[1] && box.lo[2] == box.hi[2];
    chooseGrid(box, count, typicalSpacing(points + region.begin, count), region);
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
      sortIntoCells(points + region.begin, layout.boxes[layout.regions.size() + r], region, layout,
                    cell);
    }
  }
}

}  // namespace

Layout buildLayout(BuildPoint* points, std::size_t count, std::size_t region_size, int threads) {
  Layout layout;
  if (count == 0) return layout;
  std::size_t levels = 0;
  while ((count >> levels) + 1 > region_size && (count >> levels) > 1) ++levels;
  const std::unique_ptr<BuildPoint[]> other(new BuildPoint[count]);
  BuildPoint* const sorted = Subdivision(points, other.get(), levels, layout).run(count, threads);
  const std::size_t padded = count + Layout::kPadding;
  for (auto* array : {&layout.x, &layout.y, &layout.z}) {
    array->resize(padded);
    std::fill(array->end() - Layout::kPadding, array->end(), 0.0F);
  }
  layout.id.resize(padded);
  std::fill(layout.id.end() - Layout::kPadding, layout.id.end(), 0U);
  hashRegions(sorted, layout, threads);
  return layout;
}

}  // namespace segorient::search
