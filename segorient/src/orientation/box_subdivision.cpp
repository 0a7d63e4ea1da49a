// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <segorient/orientation/box_subdivision.h>

#include <algorithm>
#include <limits>

namespace segorient {
namespace {

constexpr std::uint32_t kCells = 1U << 20;
// An edge is halved if it is longer than this part of the longest one: boxes keep within 1 : 1.5.
constexpr double kLongEdge = 0.71;

}  // namespace

BoxSubdivision::BoxSubdivision(const PointView& points, std::vector<pcl::index_t> rows,
                               std::size_t max_points)
    : rows_(std::move(rows)) {
  if (rows_.empty()) return;
  measure(points);
  Box root;
  for (std::size_t a = 0; a < 3; ++a) root.high[a] = extent_[a] > 0.0 ? kCells : 1;
  root.size = static_cast<std::uint32_t>(rows_.size());
  boxes_.push_back(root);
  for (std::size_t b = 0; b < boxes_.size(); ++b)
    split(points, b, std::max<std::size_t>(1, max_points));
  removeExterior();
}

void BoxSubdivision::measure(const PointView& points) {
  std::array<double, 3> high{};
  for (std::size_t a = 0; a < 3; ++a) {
    origin_[a] = std::numeric_limits<double>::max();
    high[a] = std::numeric_limits<double>::lowest();
  }
  for (const pcl::index_t row : rows_) {
    const float* p = points[static_cast<std::size_t>(row)];
    for (std::size_t a = 0; a < 3; ++a) {
      origin_[a] = std::min(origin_[a], static_cast<double>(p[a]));
      high[a] = std::max(high[a], static_cast<double>(p[a]));
    }
  }
  for (std::size_t a = 0; a < 3; ++a) extent_[a] = high[a] - origin_[a];
}

std::uint32_t BoxSubdivision::cell(const float* point, std::size_t axis) const {
  if (!(extent_[axis] > 0.0)) return 0;
  const double t = (static_cast<double>(point[axis]) - origin_[axis]) / extent_[axis];
  return std::min(kCells - 1, static_cast<std::uint32_t>(t * kCells));
}

void BoxSubdivision::split(const PointView& points, std::size_t box, std::size_t max_points) {
  const Box parent = boxes_[box];
  if (parent.size <= max_points) return;
  std::array<double, 3> edge{};
  for (std::size_t a = 0; a < 3; ++a) {
    const std::uint32_t cells = parent.high[a] - parent.low[a];
    edge[a] = cells > 1 ? extent_[a] * cells / kCells : 0.0;
  }
  const double longest = *std::max_element(edge.begin(), edge.end());
  if (!(longest > 0.0)) return;

  std::vector<Box> parts{parent};
  for (std::size_t a = 0; a < 3; ++a) {
    if (edge[a] < kLongEdge * longest) continue;
    const std::uint32_t middle = parent.low[a] + (parent.high[a] - parent.low[a]) / 2;
    std::vector<Box> halves;
    for (const Box& part : parts) {
      const auto begin = rows_.begin() + part.first;
      const auto below = std::partition(begin, begin + part.size, [&](pcl::index_t row) {
        return cell(points[static_cast<std::size_t>(row)], a) < middle;
      });
      Box low = part;
      Box high = part;
      low.high[a] = middle;
      low.size = static_cast<std::uint32_t>(below - begin);
      high.low[a] = middle;
      high.first = low.first + low.size;
      high.size = part.size - low.size;
      halves.push_back(low);
      halves.push_back(high);
    }
    parts.swap(halves);
  }
  boxes_[box].first_child = static_cast<std::uint32_t>(boxes_.size());
  boxes_[box].children = static_cast<std::uint8_t>(parts.size());
  boxes_.insert(boxes_.end(), parts.begin(), parts.end());
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
  std::vector<std::uint32_t> stack{0};
  while (!stack.empty()) {
    const std::uint32_t b = stack.back();
    stack.pop_back();
    const Box& box = boxes_[b];
    bool overlaps = true;
    for (std::size_t a = 0; a < 3; ++a) {
      overlaps = overlaps && box.low[a] < high[a] && low[a] < box.high[a];
    }
    if (!overlaps) continue;
    if (box.children == 0) visit(b);
    for (std::uint32_t c = 0; c < box.children; ++c) stack.push_back(box.first_child + c);
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
