// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "search/box_tree.h"

#include <algorithm>
#include <cstring>
#include <limits>

#include "common/box.h"

namespace segorient::search {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

BoxNode emptyNode() {
  BoxNode node;
  for (std::size_t a = 0; a < 3; ++a) {
    std::fill_n(node.lo[a], kBoxFanOut, kInfinity);
    std::fill_n(node.hi[a], kBoxFanOut, -kInfinity);
  }
  return node;
}

void setBox(BoxNode& node, std::size_t lane, const Box& box) {
  for (std::size_t a = 0; a < 3; ++a) {
    node.lo[a][lane] = box.lo[a];
    node.hi[a][lane] = box.hi[a];
  }
}

Box boxOf(const BuildPoint* points, std::size_t count) {
  Box box{{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};
  for (std::size_t i = 0; i < count; ++i) {
    for (int a = 0; a < 3; ++a) {
      box.lo[a] = std::min(box.lo[a], points[i].xyz[a]);
      box.hi[a] = std::max(box.hi[a], points[i].xyz[a]);
    }
  }
  return box;
}

bool isOnePlace(const Box& box) {
  return box.lo[0] == box.hi[0] && box.lo[1] == box.hi[1] && box.lo[2] == box.hi[2];
}

// The topmost node at or above `node` whose points are all in one place; 0 if there is none.
std::size_t placeAbove(const Layout& layout, std::size_t node) {
  for (; !layout.flat.empty() && node > 0; node /= 2) {
    if (layout.flat[node] != 0) return isOnePlace(layout.boxes[node]) ? node : 0;
  }
  return 0;
}

// Whether a node has only points of a place that another node has already: of many points in one
// place, the region that comes first has those with the smallest ids, and the others have none.
bool isRepeated(const Layout& layout, std::size_t node) {
  const std::size_t place = placeAbove(layout, node);
  if (place == 0) return false;
  std::size_t first = place;
  while (first < node) first *= 2;
  return first != node;
}

// The boxes above the regions: the complete binary tree over them, four levels at a time.
std::vector<BoxNode> nodesAbove(const Layout& layout) {
  std::vector<BoxNode> nodes;
  const std::size_t regions = layout.regions.size();
  if (regions < 2) return nodes;
  std::size_t levels = 0;
  while ((std::size_t{1} << levels) < regions) ++levels;
  // Topmost, what the number of levels leaves over. Nodes of the binary tree, and how many levels
  // lie from each to those that its boxes are of.
  std::vector<std::size_t> binary{1};
  std::vector<std::size_t> first_of_row;
  std::size_t depth = levels % 4 == 0 ? 4 : levels % 4;
  std::size_t reached = 0;
  while (reached < levels) {
    first_of_row.push_back(nodes.size());
    std::vector<std::size_t> below;
    for (const std::size_t node : binary) {
      BoxNode made = emptyNode();
      for (std::size_t lane = 0; lane < std::size_t{1} << depth; ++lane) {
        const std::size_t child = (node << depth) + lane;
        if (!isRepeated(layout, child)) setBox(made, lane, layout.boxes[child]);
        below.push_back(child);
      }
      nodes.push_back(made);
    }
    reached += depth;
    depth = 4;
    binary = std::move(below);
  }
  // The addresses are known now.
  first_of_row.push_back(nodes.size());
  for (std::size_t row = 0; row + 1 < first_of_row.size(); ++row) {
    const bool last = row + 2 == first_of_row.size();
    const std::size_t lanes =
        row == 0 && levels % 4 != 0 ? std::size_t{1} << levels % 4 : kBoxFanOut;
    for (std::size_t i = first_of_row[row]; i < first_of_row[row + 1]; ++i) {
      const std::size_t first = (i - first_of_row[row]) * lanes;
      if (last) {
        nodes[i].first_region = static_cast<std::uint32_t>(first);
      } else {
        nodes[i].nodes = nodes.data() + first_of_row[row + 1] + first;
      }
    }
  }
  return nodes;
}

// Makes the boxes of one region.
class RegionBuilder {
 public:
  RegionBuilder(const Layout& layout, std::size_t number) {
    const Region& region = layout.regions[number];
    all_ = region.end - region.begin;
    const std::size_t place = placeAbove(layout, layout.regions.size() + number);
    if (place != 0) {
      listPlace(layout, place, region.begin);
      return;
    }
    points_.resize(all_);
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const std::size_t at = region.begin + i;
      points_[i] = {{layout.x[at], layout.y[at], layout.z[at]}, layout.id[at]};
    }
    if (mayBeCrowded()) thinPlaces();
  }

  std::unique_ptr<RegionBoxes> build() {
    boxes_ = std::make_unique<RegionBoxes>();
    boxes_->thinned = points_.size() < all_;
    addNode(0, points_.size(), levelsFor(points_.size()));
    link();
    return std::move(boxes_);
  }

 private:
  // The smallest ids of a place whose first point is `begin`.
  void listPlace(const Layout& layout, std::size_t place, std::size_t begin) {
    std::size_t last = place;
    while (last < layout.regions.size()) last = 2 * last + 1;
    const std::size_t end = layout.regions[last - layout.regions.size()].end;
    points_.resize(std::min(end - begin, kMostInOnePlace));
    for (std::size_t i = 0; i < points_.size(); ++i) {
      points_[i] = {{layout.x[begin], layout.y[begin], layout.z[begin]}, layout.flat_id[begin + i]};
    }
  }

  // Whether there may be more points in one place than are kept; nearly never wrong.
  bool mayBeCrowded() const {
    constexpr std::size_t kSlots = 8192;
    std::vector<std::uint16_t> counts(kSlots, 0);
    for (const BuildPoint& p : points_) {
      std::uint32_t bits[3];
      std::memcpy(bits, p.xyz, sizeof(bits));
      const std::uint64_t mixed =
          (bits[0] * 0x9e3779b97f4a7c15ULL ^ bits[1]) * 0xc2b2ae3d27d4eb4fULL ^ bits[2];
      if (++counts[(mixed * 0x9e3779b97f4a7c15ULL) >> 51U] > kMostInOnePlace) return true;
    }
    return false;
  }

  // Of points in one place, those with the smallest ids stay.
  void thinPlaces() {
    std::sort(points_.begin(), points_.end(), [](const BuildPoint& p, const BuildPoint& q) {
      for (int a = 0; a < 3; ++a) {
        if (p.xyz[a] != q.xyz[a]) return p.xyz[a] < q.xyz[a];
      }
      return p.row < q.row;
    });
    std::size_t kept = 0;
    for (const BuildPoint p : points_) {
      const bool full = kept >= kMostInOnePlace &&
                        std::equal(p.xyz, p.xyz + 3, points_[kept - kMostInOnePlace].xyz);
      if (!full) points_[kept++] = p;
    }
    points_.resize(kept);
  }

  // Levels of nodes above leaves that hold so many points; at least one.
  static std::size_t levelsFor(std::size_t count) {
    std::size_t levels = 1;
    for (std::size_t most = kBoxFanOut * kBoxFanOut; most < count; most *= kBoxFanOut) ++levels;
    return levels;
  }

  // The numbers of what is below a node, until addresses are known.
  struct Below {
    std::size_t first;
    bool leaves;
  };

  // Children of a node lie side by side: first they all get their places, then their own children.
  void addNode(std::size_t begin, std::size_t count, std::size_t levels) {
    boxes_->nodes.push_back(emptyNode());
    below_.push_back({0, false});
    fillNode(0, begin, count, levels);
  }

  void fillNode(std::size_t node, std::size_t begin, std::size_t count, std::size_t levels) {
    std::size_t most = kBoxFanOut;  // points below one child
    for (std::size_t level = 1; level < levels; ++level) most *= kBoxFanOut;
    const std::size_t parts = (count + most - 1) / most;
    std::size_t ends[kBoxFanOut + 1];
    ends[0] = begin;
    split(begin, count, parts, ends + 1);
    const bool leaves = levels == 1;
    const std::size_t first = leaves ? boxes_->leaves.size() : boxes_->nodes.size();
    below_[node] = {first, leaves};
    for (std::size_t part = 0; part < parts; ++part) {
      const BuildPoint* const from = points_.data() + ends[part];
      const std::size_t size = ends[part + 1] - ends[part];
      setBox(boxes_->nodes[node], part, boxOf(from, size));
      if (leaves) {
        addLeaf(from, size);
      } else {
        boxes_->nodes.push_back(emptyNode());
        below_.push_back({0, false});
      }
    }
    for (std::size_t part = 0; part < parts && !leaves; ++part) {
      fillNode(first + part, ends[part], ends[part + 1] - ends[part], levels - 1);
    }
  }

  // Cuts across the longest side, so that each part gets as many points.
  void split(std::size_t begin, std::size_t count, std::size_t parts, std::size_t* ends) {
    if (parts <= 1) {
      ends[0] = begin + count;
      return;
    }
    const Box box = boxOf(points_.data() + begin, count);
    const std::size_t axis = longestAxis(box.lo, box.hi);
    const std::size_t left_parts = parts / 2;
    const std::size_t left = count * left_parts / parts;
    const auto from = points_.begin() + static_cast<std::ptrdiff_t>(begin);
    std::nth_element(
        from, from + static_cast<std::ptrdiff_t>(left), from + static_cast<std::ptrdiff_t>(count),
        [axis](const BuildPoint& a, const BuildPoint& b) { return a.xyz[axis] < b.xyz[axis]; });
    split(begin, left, left_parts, ends);
    split(begin + left, count - left, parts - left_parts, ends + left_parts);
  }

  void addLeaf(const BuildPoint* points, std::size_t count) {
    PointLeaf leaf;
    for (std::size_t lane = 0; lane < kBoxFanOut; ++lane) {
      for (std::size_t a = 0; a < 3; ++a) {
        leaf.xyz[a][lane] = lane < count ? points[lane].xyz[a] : kInfinity;
      }
      leaf.id[lane] = lane < count ? points[lane].row : 0;
    }
    boxes_->leaves.push_back(leaf);
  }

  void link() {
    for (std::size_t i = 0; i < below_.size(); ++i) {
      BoxNode& node = boxes_->nodes[i];
      if (below_[i].leaves) {
        node.leaves = boxes_->leaves.data() + below_[i].first;
      } else {
        node.nodes = boxes_->nodes.data() + below_[i].first;
      }
    }
  }

  std::size_t all_ = 0;
  std::vector<BuildPoint> points_;
  std::unique_ptr<RegionBoxes> boxes_;
  std::vector<Below> below_;
};

}  // namespace

BoxTree::BoxTree(const Layout& layout)
    : layout_(layout), top_(nodesAbove(layout)), regions_(layout.regions.size()) {
  for (auto& region : regions_) region.store(nullptr, std::memory_order_relaxed);
  thinned_ = !layout.flat.empty();
  memory_ = top_.capacity() * sizeof(BoxNode) + regions_.capacity() * sizeof(regions_[0]);
}

BoxTree::~BoxTree() {
  for (auto& region : regions_) delete region.load();
}

// Two threads may make the same at the same time; the first to be done is kept.
const BoxNode* BoxTree::makeRegion(std::size_t number) {
  std::unique_ptr<RegionBoxes> made = RegionBuilder(layout_, number).build();
  if (made->thinned) thinned_ = true;
  const RegionBoxes* kept = nullptr;
  if (!regions_[number].compare_exchange_strong(kept, made.get(), std::memory_order_acq_rel)) {
    return kept->nodes.data();
  }
  memory_ += made->memory();
  return made.release()->nodes.data();
}

}  // namespace segorient::search
