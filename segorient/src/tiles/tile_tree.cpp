// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "tiles/tile_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace segorient {
namespace {

// The final normal of a point depends on those of its 32 neighbours, about 3.3 spacings around it;
// these on theirs, twice by the filter and once by the plane, and wide votes look 8 spacings far.
// That is 14; the spacing of a place is known to a third only.
constexpr double kHaloSpacings = 20.0;
// A tile's coordinates are floats near its own origin: in wider ones they would be rounded by more
// than a sixty-fourth of a spacing.
constexpr double kWidestInSpacings = 262144.0;  // 2^18
// Two bodies that far apart are not to be in one tile: it is cut between them, where nothing is.
constexpr double kGap = 0.25;             // of the width
constexpr std::size_t kLeastApart = 100;  // sampled places of either
// Sampled places in a cell that its spacing is told from.
constexpr std::size_t kCellSample = 32;

}  // namespace

struct TileTree::Builder {
  std::vector<Place>& sample;
  double points_each;
  double most_points;
  TileTree& tree;

  struct Range {
    std::size_t first;
    std::size_t last;
    std::size_t size() const { return last - first; }
  };

  std::array<double, 3> sides(const Range& r) const {
    std::array<double, 3> out{0.0, 0.0, 0.0};
    for (std::size_t a = 0; a < 3; ++a) {
      double low = std::numeric_limits<double>::max();
      double high = std::numeric_limits<double>::lowest();
      for (std::size_t i = r.first; i < r.last; ++i) {
        low = std::min(low, sample[i][a]);
        high = std::max(high, sample[i][a]);
      }
      out[a] = r.size() == 0 ? 0.0 : high - low;
    }
    return out;
  }

  // Points on a surface whose four nearest are .82 away in the mean have a density of 1 over the
  // square of 1; those on a grid of 1 have them at 1. The median over the cell does not see that it
  // may hold parts of several bodies.
  double reachOf(const Range& r) const {
    constexpr std::size_t kNearest = 4;
    std::vector<double> means;
    std::vector<double> squares;
    for (std::size_t i = r.first; i < std::min(r.last, r.first + kCellSample); ++i) {
      squares.clear();
      for (std::size_t j = r.first; j < r.last; ++j) {
        double square = 0.0;
        for (std::size_t a = 0; a < 3; ++a) {
          square += (sample[i][a] - sample[j][a]) * (sample[i][a] - sample[j][a]);
        }
        if (square > 0.0) squares.push_back(square);
      }
      const std::size_t n = std::min(kNearest, squares.size());
      std::partial_sort(squares.begin(), squares.begin() + static_cast<std::ptrdiff_t>(n),
                        squares.end());
      double sum = 0.0;
      for (std::size_t j = 0; j < n; ++j) sum += std::sqrt(squares[j]);
      if (n > 0) means.push_back(sum / static_cast<double>(n));
    }
    if (means.empty()) return 0.0;
    const auto middle = means.begin() + static_cast<std::ptrdiff_t>(means.size() / 2);
    std::nth_element(means.begin(), middle, means.end());
    return kHaloSpacings * 1.1 * *middle / std::sqrt(points_each);
  }

  // \return the first place that is not below
  std::size_t partition(const Range& r, std::size_t axis, double split) {
    const auto begin = sample.begin() + static_cast<std::ptrdiff_t>(r.first);
    const auto end = sample.begin() + static_cast<std::ptrdiff_t>(r.last);
    const auto below = [&](const Place& p) { return p[axis] < split; };
    return r.first + static_cast<std::size_t>(std::partition(begin, end, below) - begin);
  }

  // Halves of about as many, and no equal places on both sides. \return false if all are in one
  bool halve(const Range& r, std::size_t& axis, double& split, std::size_t& middle) {
    const std::array<double, 3> s = sides(r);
    axis = static_cast<std::size_t>(std::max_element(s.begin(), s.end()) - s.begin());
    if (!(s[axis] > 0.0)) return false;
    const auto begin = sample.begin() + static_cast<std::ptrdiff_t>(r.first);
    const auto end = sample.begin() + static_cast<std::ptrdiff_t>(r.last);
    const auto half = begin + static_cast<std::ptrdiff_t>(r.size() / 2);
    std::nth_element(begin, half, end,
                     [&](const Place& p, const Place& q) { return p[axis] < q[axis]; });
    split = (*half)[axis];
    const auto below = [&](const Place& p) { return p[axis] < split; };
    if (std::none_of(begin, end, below)) {  // the median is the least: what is above it
      double next = std::numeric_limits<double>::max();
      for (auto p = begin; p != end; ++p) {
        if ((*p)[axis] > split) next = std::min(next, (*p)[axis]);
      }
      split = next;
    }
    middle = partition(r, axis, split);
    return true;
  }

  // By an even part of its places, and the distances of those from others that floats can tell from
  // them there.
  bool isTooWide(const Range& r) const {
    constexpr std::size_t kAsked = 32;
    if (r.size() < 2 * kLeastApart) return false;
    const std::array<double, 3> s = sides(r);
    const double width = *std::max_element(s.begin(), s.end());
    const double least = std::pow(std::ldexp(width, -22), 2.0);
    std::vector<double> nearest;
    for (std::size_t i = 0; i < kAsked; ++i) {
      const Place& p = sample[r.first + i * r.size() / kAsked];
      double square = std::numeric_limits<double>::max();
      for (std::size_t j = r.first; j < r.last; ++j) {
        double d = 0.0;
        for (std::size_t a = 0; a < 3; ++a) d += (p[a] - sample[j][a]) * (p[a] - sample[j][a]);
        if (d > least) square = std::min(square, d);
      }
      nearest.push_back(std::sqrt(square / points_each));
    }
    const auto middle = nearest.begin() + static_cast<std::ptrdiff_t>(nearest.size() / 2);
    std::nth_element(nearest.begin(), middle, nearest.end());
    return width > kWidestInSpacings * *middle;
  }

  // At the widest gap along the longest side. \return false if there is none worth it
  bool cutAtGap(const Range& r, std::size_t& axis, double& split, std::size_t& middle) {
    const std::array<double, 3> s = sides(r);
    axis = static_cast<std::size_t>(std::max_element(s.begin(), s.end()) - s.begin());
    std::vector<double> along;
    for (std::size_t i = r.first; i < r.last; ++i) along.push_back(sample[i][axis]);
    std::sort(along.begin(), along.end());
    double widest = 0.0;
    for (std::size_t i = 1; i < along.size(); ++i) {
      const double gap = along[i] - along[i - 1];
      if (!(gap > widest)) continue;
      widest = gap;
      split = along[i - 1] + 0.5 * gap;
    }
    if (!(widest > kGap * s[axis])) return false;
    middle = partition(r, axis, split);
    return middle >= r.first + kLeastApart && r.last >= middle + kLeastApart;
  }

  void build(const Range& r, bool in_tile) {
    const std::size_t n = tree.nodes_.size();
    tree.nodes_.emplace_back();
    const double points = points_each * static_cast<double>(r.size());
    std::size_t axis = 0;
    double split = 0.0;
    std::size_t middle = 0;
    const bool fits = points <= most_points;
    const bool apart = !in_tile && fits && isTooWide(r) && cutAtGap(r, axis, split, middle);
    const bool small = fits && !apart;
    const bool cell = (in_tile || small) && r.size() <= kCellSample;
    const bool halved = apart || (!cell && halve(r, axis, split, middle));
    if (!in_tile && (small || !halved)) {
      tree.nodes_[n].tile = static_cast<std::int32_t>(tree.tiles_++);
      in_tile = true;
    }
    if (!halved) {
      tree.nodes_[n].reach = reachOf(r);
      return;
    }
    tree.nodes_[n].axis = static_cast<std::int32_t>(axis);
    tree.nodes_[n].split = split;
    build({r.first, middle}, in_tile);
    tree.nodes_[n].upper = static_cast<std::uint32_t>(tree.nodes_.size());
    build({middle, r.last}, in_tile);
  }
};

TileTree::TileTree(std::vector<Place> sample, double points_each, double most_points) {
  Builder{sample, points_each, most_points, *this}.build({0, sample.size()}, false);
}

bool TileTree::restore(std::vector<Node> nodes, TileTree& tree) {
  tree = TileTree();
  std::int32_t next_tile = 0;
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    const Node& node = nodes[n];
    const bool halved = node.axis >= 0;
    if (node.axis > 2 || (halved && (node.upper <= n + 1 || node.upper >= nodes.size()))) {
      return false;
    }
    if (node.tile >= 0 && node.tile != next_tile++) return false;
    if (!halved && n + 1 == nodes.size() && next_tile == 0) return false;
  }
  if (nodes.empty()) return false;
  tree.nodes_ = std::move(nodes);
  tree.tiles_ = static_cast<std::size_t>(next_tile);
  return true;
}

double TileTree::leastReach(std::uint32_t n, const Place& p, double radius) const {
  while (nodes_[n].axis >= 0) {
    const Node& node = nodes_[n];
    const double x = p[static_cast<std::size_t>(node.axis)];
    const bool lower = x - radius < node.split;
    const bool upper = x + radius >= node.split;
    if (lower && upper) {
      return std::min(leastReach(n + 1, p, radius), leastReach(node.upper, p, radius));
    }
    n = lower ? n + 1 : node.upper;
  }
  return nodes_[n].reach;
}

double TileTree::wholeRadius(const Place& p, double reach, double distance) const {
  const double looked_at = 0.5 * reach;  // many times as far as the neighbours of most points are
  return std::min(looked_at, leastReach(0, p, looked_at) - distance);
}

void TileTree::findCells(const Place* places, std::size_t count, std::uint32_t* cells) const {
  std::fill_n(cells, count, 0U);
  for (bool descends = count > 0; descends;) {
    descends = false;
    for (std::size_t i = 0; i < count; ++i) {
      const Node& node = nodes_[cells[i]];
      if (node.axis < 0) continue;
      cells[i] = halfOf(cells[i], places[i]);
      descends = true;
    }
  }
}

std::uint32_t TileTree::owner(const Place& p, double& reach) const {
  std::uint32_t n = 0;
  std::uint32_t tile = 0;
  for (;;) {
    const Node& node = nodes_[n];
    if (node.tile >= 0) tile = static_cast<std::uint32_t>(node.tile);
    if (node.axis < 0) {
      reach = node.reach;
      return tile;
    }
    n = halfOf(n, p);
  }
}

namespace {

// Calls visit(box, whether it is the tile itself) for all tiles and cells, each tile before its
// cells. Halves come behind their node, so the list needs no recursion.
template <typename Visit>
void forEachBox(const std::vector<TileTree::Node>& nodes, const Visit& visit) {
  constexpr double kEnd = std::numeric_limits<double>::infinity();
  std::vector<TileTree::Box> open(1);
  open[0].low = {-kEnd, -kEnd, -kEnd};
  open[0].high = {kEnd, kEnd, kEnd};
  while (!open.empty() && !nodes.empty()) {
    TileTree::Box box = open.back();
    open.pop_back();
    const TileTree::Node& node = nodes[box.node];
    if (node.tile >= 0) {
      box.tile = static_cast<std::uint32_t>(node.tile);
      visit(box, true);
    }
    if (node.axis < 0) {
      visit(box, false);
      continue;
    }
    const auto axis = static_cast<std::size_t>(node.axis);
    TileTree::Box upper = box;
    upper.node = node.upper;
    upper.low[axis] = node.split;
    open.push_back(upper);
    ++box.node;
    box.high[axis] = node.split;
    open.push_back(box);
  }
}

}  // namespace

std::vector<TileTree::Box> TileTree::cells() const {
  std::vector<Box> out;
  forEachBox(nodes_, [&](const Box& box, bool is_tile) {
    if (!is_tile) out.push_back(box);
  });
  return out;
}

std::vector<TileTree::Box> TileTree::tileBoxes() const {
  std::vector<Box> out;
  forEachBox(nodes_, [&](const Box& box, bool is_tile) {
    if (is_tile) out.push_back(box);
  });
  return out;
}

}  // namespace segorient
