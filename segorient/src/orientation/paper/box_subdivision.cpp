// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/paper/box_subdivision.h"

#include <algorithm>

#include "common/box.h"
#include "common/in_double.h"

namespace segorient {
namespace {

constexpr std::uint32_t kCells = 1U << 20;
// An edge is halved if it is longer than this part of the longest one: boxes keep within 1 : 1.5.
constexpr double kLongEdge = 0.71;
// Boxes that wait in a descent through the tree: 20 halvings an axis, so at most 60 generations,
// and each leaves at most 7 siblings waiting.
constexpr std::size_t kMostOpen = 60 * 7 + 1;

}  // namespace

BoxSubdivision::BoxSubdivision(const PointView& points, const std::vector<pcl::index_t>& rows,
                               std::size_t max_points) {
  if (rows.empty()) return;
  std::vector<Placed> placed = place(points, rows);
  Box root;
  for (std::size_t a = 0; a < 3; ++a) root.high[a] = extent_[a] > 0.0 ? kCells : 1;
  root.size = static_cast<std::uint32_t>(rows.size());
  boxes_.push_back(root);
  for (std::size_t b = 0; b < boxes_.size(); ++b) {
    split(placed, b, std::max<std::size_t>(1, max_points));
  }
  rows_.reserve(rows.size());
  for (const Placed& p : placed) rows_.push_back(p.row);
  removeExterior();
}

// Puts the grid over the bounding box and the rows onto the grid.
std::vector<BoxSubdivision::Placed> BoxSubdivision::place(const PointView& points,
                                                          const std::vector<pcl::index_t>& rows) {
  segorient::Box around;
  for (const pcl::index_t row : rows) around.add(points[static_cast<std::size_t>(row)]);
  const std::array<double, 3> low = inDouble(around.low.data());
  std::array<double, 3> cells_per_unit{};
  for (std::size_t a = 0; a < 3; ++a) {
    extent_[a] = static_cast<double>(around.high[a]) - low[a];
    if (extent_[a] > 0.0) cells_per_unit[a] = kCells / extent_[a];
  }
  std::vector<Placed> placed;
  placed.reserve(rows.size());
  for (const pcl::index_t row : rows) {
    const float* p = points[static_cast<std::size_t>(row)];
    Placed entry{{}, row};
    for (std::size_t a = 0; a < 3; ++a) {
      const double cell = (static_cast<double>(p[a]) - low[a]) * cells_per_unit[a];
      entry.cell[a] = static_cast<std::uint32_t>(std::min(cell, kCells - 1.0));
    }
    placed.push_back(entry);
  }
  return placed;
}

void BoxSubdivision::split(std::vector<Placed>& placed, std::size_t box, std::size_t max_points) {
  const Box parent = boxes_[box];
  if (parent.size <= max_points) return;
  std::array<double, 3> edge{};
  for (std::size_t a = 0; a < 3; ++a) {
    const std::uint32_t cells = parent.high[a] - parent.low[a];
    edge[a] = cells > 1 ? extent_[a] * cells / kCells : 0.0;
  }
  const double longest = *std::max_element(edge.begin(), edge.end());
  if (!(longest > 0.0)) return;

  std::array<Box, 8> parts;
  parts[0] = parent;
  std::size_t count = 1;
  for (std::size_t a = 0; a < 3; ++a) {
    if (edge[a] < kLongEdge * longest) continue;
    const std::uint32_t middle = parent.low[a] + (parent.high[a] - parent.low[a]) / 2;
    for (std::size_t i = 0; i < count; ++i) {
      Box& low = parts[i];
      Box& high = parts[count + i];
      high = low;
      const auto begin = placed.begin() + low.first;
      const auto below = std::partition(begin, begin + low.size,
                                        [&](const Placed& p) { return p.cell[a] < middle; });
      low.high[a] = middle;
      low.size = static_cast<std::uint32_t>(below - begin);
      high.low[a] = middle;
      high.first += low.size;
      high.size -= low.size;
    }
    count *= 2;
  }
  boxes_[box].first_child = static_cast<std::uint32_t>(boxes_.size());
  boxes_[box].children = static_cast<std::uint8_t>(count);
  boxes_.insert(boxes_.end(), parts.begin(), parts.begin() + static_cast<std::ptrdiff_t>(count));
}

// Calls visit(box index) for each leaf that shares a part of the face; for none at the border.
template <typename Visitor>
void BoxSubdivision::visitNeighbors(const Box& leaf, Direction direction, Visitor&& visit) const {
  const auto axis = static_cast<std::size_t>(direction.axis);
  std::array<std::uint32_t, 3> low = leaf.low;
  std::array<std::uint32_t, 3> high = leaf.high;
  if (direction.positive) {
    if (leaf.high[axis] >= boxes_[0].high[axis]) return;
    low[axis] = leaf.high[axis];
    high[axis] = leaf.high[axis] + 1;
  } else {
    if (leaf.low[axis] == 0) return;
    low[axis] = leaf.low[axis] - 1;
    high[axis] = leaf.low[axis];
  }
  std::array<std::uint32_t, kMostOpen> stack;
  std::size_t open = 0;
  stack[open++] = 0;
  while (open > 0) {
    const std::uint32_t b = stack[--open];
    const Box& box = boxes_[b];
    bool overlaps = true;
    for (std::size_t a = 0; a < 3; ++a) {
      overlaps = overlaps && box.low[a] < high[a] && low[a] < box.high[a];
    }
    if (!overlaps) continue;
    if (box.children == 0) visit(b);
    for (std::uint32_t c = 0; c < box.children; ++c) stack[open++] = box.first_child + c;
  }
}

bool BoxSubdivision::isFree(const Box& leaf, Direction direction) const {
  bool free = true;
  visitNeighbors(leaf, direction, [&](std::uint32_t b) { free = free && boxes_[b].removed; });
  return free;
}

void BoxSubdivision::removeExterior() {
  std::vector<std::uint32_t> queue;
  for (std::size_t b = 0; b < boxes_.size(); ++b) {
    Box& box = boxes_[b];
    if (box.children != 0 || box.size != 0) continue;
    bool at_border = false;
    for (std::size_t a = 0; a < 3; ++a) {
      at_border = at_border || box.low[a] == 0 || box.high[a] == boxes_[0].high[a];
    }
    if (!at_border) continue;
    box.removed = true;
    queue.push_back(static_cast<std::uint32_t>(b));
  }
  for (std::size_t head = 0; head < queue.size(); ++head) {
    const Box removed = boxes_[queue[head]];
    for (int side = 0; side < 6; ++side) {
      visitNeighbors(removed, {side / 2, side % 2 == 1}, [&](std::uint32_t b) {
        if (boxes_[b].size != 0 || boxes_[b].removed) return;
        boxes_[b].removed = true;
        queue.push_back(b);
      });
    }
  }
}

}  // namespace segorient
