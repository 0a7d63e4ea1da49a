// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "search/layout.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "common/parallel_for.h"

namespace segorient::search {
namespace {

// Squared distance from a point to its 16th neighbour, or to the farthest of fewer: that to the 8th
// among every second point, which differs little and takes half the time.
// \param own number of the point, even
float squaredSpacing(const BuildPoint* points, std::size_t count, std::size_t own) {
  constexpr std::size_t kRank = 8;
  constexpr std::size_t kAtOnce = 64;
  std::array<float, kRank + 1> nearest;  // the point itself or a stand-in among them, ascending
  std::array<float, kAtOnce> distance;
  const float* const q = points[own].xyz;
  const std::size_t parts = (count + 2 * kAtOnce - 1) / (2 * kAtOnce);
  std::size_t part =
      own / (2 * kAtOnce);  // first, where neighbours are if the order is that of a curve
  std::size_t found = 0;
  for (std::size_t turn = 0; turn < parts; ++turn, part = part + 1 < parts ? part + 1 : 0) {
    const std::size_t begin = 2 * kAtOnce * part;
    const std::size_t size = std::min(kAtOnce, (count - begin + 1) / 2);
    for (std::size_t i = 0; i < size; ++i) {
      const float* const p = points[begin + 2 * i].xyz;
      const float dx = q[0] - p[0];
      const float dy = q[1] - p[1];
      const float dz = q[2] - p[2];
      distance[i] = dx * dx + dy * dy + dz * dz;
    }
    for (std::size_t i = 0; i < size; ++i) {
      const float d = distance[i];
      if (found > kRank && !(d < nearest[kRank])) continue;
      std::size_t at = found > kRank ? kRank : found++;
      for (; at > 0 && d < nearest[at - 1]; --at) nearest[at] = nearest[at - 1];
      nearest[at] = d;
    }
  }
  return nearest[found - 1];
}

// The median over three points. Where that is 0, since many points are in one place, the others
// count: the largest of the three, else roughly as if the points were spread over a surface across
// the box.
float typicalSpacing(const BuildPoint* points, std::size_t count, const Box& box) {
  std::array<float, 3> found{};
  for (std::size_t s = 0; s < 3; ++s) {
    found[s] = squaredSpacing(points, count, (2 * s + 1) * count / 6 / 2 * 2);
  }
  std::sort(found.begin(), found.end());
  if (found[1] > 0.0F) return found[1];
  if (found[2] > 0.0F && std::isfinite(found[2])) return found[2];
  float squared_diagonal = 0.0F;
  for (int a = 0; a < 3; ++a) {
    squared_diagonal += (box.hi[a] - box.lo[a]) * (box.hi[a] - box.lo[a]);
  }
  const float spread = squared_diagonal * 16.0F / static_cast<float>(count);
  return std::isfinite(spread) ? spread : 0.0F;
}

// Chooses the grid of a region; the cells are wide enough that k nearest neighbours lie in few of
// them and narrow enough that they hold few other points.
void chooseGrid(const Box& box, std::size_t count, float spacing16, Region& region) {
  region.spacing16 = spacing16;
  double extent[3];
  double longest = 0.0;
  for (int a = 0; a < 3; ++a) {
    extent[a] = static_cast<double>(box.hi[a]) - static_cast<double>(box.lo[a]);
    longest = std::max(longest, extent[a]);
  }
  double edge = 1.6 * std::sqrt(static_cast<double>(spacing16));
  if (!std::isfinite(edge)) edge = longest / 16.0;  // squares overflow
  // Neither more than 4 cells a point in all nor more along an axis than 16 bits can count.
  const double most = std::min(4.0 * static_cast<double>(count), 60000.0);
  edge = std::max({edge, longest / most, 1e-30});
  const auto cells = [&](int a) { return std::floor(extent[a] / edge) + 1.0; };
  while (cells(0) * cells(1) * cells(2) > most) edge *= 1.25;
  for (int a = 0; a < 3; ++a) region.counts[a] = static_cast<std::uint16_t>(cells(a));
  region.inverse_edge = static_cast<float>(1.0 / edge);
}

// Copies of what belongs to the region, since anything that is written could otherwise be part of
// it.
void findCells(const BuildPoint* points, Box box, Region region, std::uint32_t* cell) {
  const std::size_t count = region.end - region.begin;
  const float most[3] = {static_cast<float>(region.counts[0] - 1),
                         static_cast<float>(region.counts[1] - 1),
                         static_cast<float>(region.counts[2] - 1)};
  for (std::size_t i = 0; i < count; ++i) {
    int c[3];
    for (int a = 0; a < 3; ++a) {
      c[a] =
          static_cast<int>(std::min((points[i].xyz[a] - box.lo[a]) * region.inverse_edge, most[a]));
    }
    cell[i] =
        static_cast<std::uint32_t>(c[0] + region.counts[0] * (c[1] + region.counts[1] * c[2]));
  }
}

std::size_t cellCount(const Region& region) {
  return std::size_t{region.counts[0]} * region.counts[1] * region.counts[2];
}

// Counting sort of a region's points into its cells.
void sortIntoCells(BuildPoint* points, const Box& box, const Region& region, Layout& layout,
                   std::vector<std::uint32_t>& cell) {
  const std::size_t count = region.end - region.begin;
  std::uint16_t* const starts = layout.starts.data() + region.first_start;
  const std::size_t cells = cellCount(region);
  cell.resize(count);
  findCells(points, box, region, cell.data());
  for (std::size_t i = 0; i < count; ++i) ++starts[cell[i] + 1];
  for (std::size_t c = 0; c < cells; ++c) {
    starts[c + 1] = static_cast<std::uint16_t>(starts[c + 1] + starts[c]);
  }
  float* const x = layout.x.data() + region.begin;
  float* const y = layout.y.data() + region.begin;
  float* const z = layout.z.data() + region.begin;
  std::uint32_t* const id = layout.id.data() + region.begin;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t at = starts[cell[i]]++;
    x[at] = points[i].xyz[0];
    y[at] = points[i].xyz[1];
    z[at] = points[i].xyz[2];
    id[at] = points[i].row;
  }
  // Every start has moved to the next one.
  for (std::size_t c = cells; c > 0; --c) starts[c] = starts[c - 1];
  starts[0] = 0;
}

void hashRegions(BuildPoint* points, Layout& layout, int threads) {
  constexpr double kRegionTime = 1e5;  // ns, see resolveThreads()
  const std::size_t regions = layout.regions.size();
  parallelFor(regions, threads, kRegionTime, [&](std::size_t r) {
    Region& region = layout.regions[r];
    const Box& box = layout.boxes[regions + r];
    const std::size_t count = region.end - region.begin;
    region.flat = 0;
    chooseGrid(box, count, typicalSpacing(points + region.begin, count, box), region);
  });
  std::size_t starts = 0;
  for (Region& region : layout.regions) {
    region.first_start = static_cast<std::uint32_t>(starts);
    starts += cellCount(region) + 1;
  }
  layout.starts.assign(starts, 0);
  parallelFor(
      regions, threads, kRegionTime, [] { return std::vector<std::uint32_t>(); },
      [&](std::size_t r, std::vector<std::uint32_t>& cell) {
        const Region& region = layout.regions[r];
        sortIntoCells(points + region.begin, layout.boxes[regions + r], region, layout, cell);
      });
}

bool isFlat(const Box& box) {
  float sum = 0.0F;
  for (int a = 0; a < 3; ++a) sum += (box.hi[a] - box.lo[a]) * (box.hi[a] - box.lo[a]);
  return sum == 0.0F;
}

// Marks the flat nodes and sorts their ids.
void markFlat(std::size_t node, Layout& layout) {
  const std::size_t regions = layout.regions.size();
  if (!isFlat(layout.boxes[node])) {
    if (node >= regions) return;
    markFlat(2 * node, layout);
    markFlat(2 * node + 1, layout);
    return;
  }
  if (layout.flat.empty()) {
    layout.flat.assign(2 * regions, 0);
    layout.flat_id.resize(layout.size());
  }
  layout.flat[node] = 1;
  std::size_t first = node;
  std::size_t last = node;
  for (; first < regions; first = 2 * first) last = 2 * last + 1;
  for (std::size_t r = first; r <= last; ++r) layout.regions[r - regions].flat = 1;
  const std::uint32_t begin = layout.regions[first - regions].begin;
  const std::uint32_t end = layout.regions[last - regions].end;
  std::copy(layout.id.begin() + begin, layout.id.begin() + end, layout.flat_id.begin() + begin);
  std::sort(layout.flat_id.begin() + begin, layout.flat_id.begin() + end);
}

}  // namespace

Layout buildLayout(BuildPoint* points, std::size_t count, std::size_t region_size,
                   const std::vector<pcl::index_t>* indices, int threads) {
  Layout layout;
  if (count == 0) return layout;
  std::size_t levels = 0;
  while ((count >> levels) + 1 > region_size && (count >> levels) > 1) ++levels;
  const std::unique_ptr<BuildPoint[]> other(new BuildPoint[count]);
  BuildPoint* const sorted = subdivide(points, other.get(), count, levels, threads, layout);
  const std::size_t padded = count + Layout::kPadding;
  for (auto* array : {&layout.x, &layout.y, &layout.z}) {
    array->resize(padded);
    std::fill(array->end() - Layout::kPadding, array->end(), 0.0F);
  }
  layout.id.resize(padded);
  std::fill(layout.id.end() - Layout::kPadding, layout.id.end(), 0U);
  hashRegions(sorted, layout, threads);
  if (indices != nullptr) {
    layout.row = layout.id;
    for (std::size_t i = 0; i < count; ++i) {
      layout.id[i] = static_cast<std::uint32_t>((*indices)[layout.row[i]]);
    }
  }
  markFlat(1, layout);
  return layout;
}

}  // namespace segorient::search
