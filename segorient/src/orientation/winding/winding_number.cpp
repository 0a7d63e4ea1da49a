// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/winding/winding_number.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "common/compiler.h"
#include "common/parallel_for.h"
#include "common/vectors.h"
#include "common/widest.h"

namespace segorient {
namespace {

// Dipoles that are summed up one by one: as long as opening one more node takes.
constexpr std::uint32_t kLeaf = 16;
// A node counts as one dipole beyond this many of its radii (half diagonals of its box, about):
// errors of some hundredths of the sum of absolute terms.
constexpr float kFar = 4.F;
// Points whose nodes one thread builds at once.
constexpr std::uint32_t kPart = 4096;
constexpr double kPointTime = 15.0;  // nanoseconds, of building
// Of one block: as many as the widest registers hold.
constexpr std::size_t kPlaces = 16;

struct PlaceBlock {
  std::array<float, kPlaces> x;
  std::array<float, kPlaces> y;
  std::array<float, kPlaces> z;
  std::array<float, kPlaces> radius;

  // The last block is filled up with its last place.
  PlaceBlock(const PointView& at, const std::vector<float>& radii, std::size_t first) {
    for (std::size_t l = 0; l < kPlaces; ++l) {
      const std::size_t i = std::min(first + l, at.size - 1);
      x[l] = at[i][0];
      y[l] = at[i][1];
      z[l] = at[i][2];
      radius[l] = radii[i];
    }
  }
};

// Nodes of a tree over so many points, by halving these until kLeaf are left.
std::uint32_t nodesOver(std::uint32_t points) {
  // Halved l times, they make 2^l runs of which some are longer than others, by one point.
  std::uint32_t levels = 0;
  while ((points - 1) >> levels >= kLeaf) ++levels;
  if (levels == 0) return 1;
  const std::uint32_t runs = 1U << (levels - 1);
  const std::uint32_t divided = points / runs > kLeaf ? runs : points % runs;
  return 2 * runs - 1 + 2 * divided;
}

struct WindingTree {
  const WindingNode* nodes;
  std::uint32_t count;
  PointView points;
  const float* dipoles;
  const std::uint32_t* rows;
};

}  // namespace

#define SEGORIENT_KERNELS "orientation/winding/winding_lanes.inl"
#include "common/each_width.inl"
#undef SEGORIENT_KERNELS

void WindingNumber::build(const PointView& points, const float* dipoles,
                          const std::vector<std::uint32_t>& rows, int threads) {
  points_ = points;
  dipoles_ = dipoles;
  rows_ = rows.empty() ? nullptr : rows.data();
  const std::size_t count = rows.empty() ? points.size : rows.size();
  nodes_.clear();
  if (count == 0) return;
  const auto last = static_cast<std::uint32_t>(count);
  nodes_.resize(nodesOver(last));
  const auto leaf = [this](std::uint32_t first, std::uint32_t end, std::uint32_t index) {
    return buildLeaf(first, end, index);
  };
  std::vector<Part> parts;
  listParts(0, last, 0, parts);
  parallelFor(parts.size(), threads, timeOfEach(parts.size(), count, kPointTime),
              [&](std::size_t i) {
                Part& part = parts[i];
                part.extent = buildDownTo(kLeaf, part.first, part.last, part.index, leaf);
              });
  std::size_t next = 0;
  buildDownTo(kPart, 0, last, 0,
              [&](std::uint32_t, std::uint32_t, std::uint32_t) { return parts[next++].extent; });
}

void WindingNumber::listParts(std::uint32_t first, std::uint32_t last, std::uint32_t index,
                              std::vector<Part>& parts) {
  if (last - first <= kPart) {
    parts.push_back({first, last, index, {}});
    return;
  }
  const std::uint32_t middle = first + (last - first) / 2;
  listParts(first, middle, index + 1, parts);
  listParts(middle, last, index + 1 + nodesOver(middle - first), parts);
}

// Sums of the points themselves.
WindingNumber::Extent WindingNumber::sumLeaf(Node& node) const {
  double center[3] = {0, 0, 0};
  double dipole[3] = {0, 0, 0};
  Extent extent;
  for (std::uint32_t i = node.first; i < node.first + node.size; ++i) {
    const float* p = points_[row(i)];
    const float* d = dipoles_ + 4 * row(i);
    const double a = static_cast<double>(d[3]) + 1e-30;
    extent.area += a;
    extent.box.add(p);
    for (int k = 0; k < 3; ++k) {
      center[k] += a * static_cast<double>(p[k]);
      dipole[k] += static_cast<double>(d[k]);
    }
  }
  for (int k = 0; k < 3; ++k) {
    node.center[k] = static_cast<float>(center[k] / extent.area);
    node.dipole[k] = static_cast<float>(dipole[k]);
  }
  return extent;
}

WindingNumber::Extent WindingNumber::sumHalves(const Node& a, const Extent& in_a, const Node& b,
                                               const Extent& in_b, Node& node) {
  Extent extent = in_a;
  extent.area += in_b.area;
  extent.box.add(in_b.box.low.data());
  extent.box.add(in_b.box.high.data());
  const auto share = static_cast<float>(in_b.area / extent.area);
  for (int k = 0; k < 3; ++k) {
    node.center[k] = a.center[k] + share * (b.center[k] - a.center[k]);
    node.dipole[k] = a.dipole[k] + b.dipole[k];
  }
  return extent;
}

template <typename Bottom>
WindingNumber::Extent WindingNumber::buildDownTo(std::uint32_t most, std::uint32_t first,
                                                 std::uint32_t last, std::uint32_t index,
                                                 const Bottom& bottom) {
  if (last - first <= most) return bottom(first, last, index);
  const std::uint32_t middle = first + (last - first) / 2;
  const std::uint32_t left = index + 1;
  const Extent in_left = buildDownTo(most, first, middle, left, bottom);
  const std::uint32_t right = nodes_[left].skip;
  const Extent in_right = buildDownTo(most, middle, last, right, bottom);
  nodes_[index].first = first;
  const Extent extent = sumHalves(nodes_[left], in_left, nodes_[right], in_right, nodes_[index]);
  finish(index, nodes_[right].skip, extent);
  return extent;
}

WindingNumber::Extent WindingNumber::buildLeaf(std::uint32_t first, std::uint32_t last,
                                               std::uint32_t index) {
  nodes_[index].first = first;
  nodes_[index].size = last - first;
  const Extent extent = sumLeaf(nodes_[index]);
  finish(index, index + 1, extent);
  return extent;
}

void WindingNumber::finish(std::uint32_t index, std::uint32_t end, const Extent& extent) {
  Node& node = nodes_[index];
  float r2 = 0.F;  // to the farthest corner of the box
  for (std::size_t k = 0; k < 3; ++k) {
    const float reach =
        std::max(extent.box.high[k] - node.center[k], node.center[k] - extent.box.low[k]);
    r2 += reach * reach;
  }
  node.radius = std::sqrt(r2);
  node.skip = end;
}

float WindingNumber::evaluate(const float* x, float radius) const {
  const float r2 = radius * radius;
  double sum = 0.0;
  for (std::uint32_t i = 0; i < nodes_.size();) {
    const Node& node = nodes_[i];
    const float d[3] = {node.center[0] - x[0], node.center[1] - x[1], node.center[2] - x[2]};
    const float s = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
    if (s > kFar * kFar * node.radius * node.radius && s > 4.F * r2) {
      sum += static_cast<double>(
          (node.dipole[0] * d[0] + node.dipole[1] * d[1] + node.dipole[2] * d[2]) /
          (s * std::sqrt(s)));
      i = node.skip;
      continue;
    }
    for (std::uint32_t j = 0; j < node.size; ++j) {
      const float* q = points_[row(node.first + j)];
      const float* m = dipoles_ + 4 * row(node.first + j);
      const float e[3] = {q[0] - x[0], q[1] - x[1], q[2] - x[2]};
      const float t = std::max(e[0] * e[0] + e[1] * e[1] + e[2] * e[2], r2);
      sum += static_cast<double>((m[0] * e[0] + m[1] * e[1] + m[2] * e[2]) / (t * std::sqrt(t)));
    }
    ++i;
  }
  return static_cast<float>(sum) * kOneOver4Pi;
}

std::vector<float> WindingNumber::evaluate(const PointView& at, const std::vector<float>& radii,
                                           int threads) const {
  const auto kernel = SEGORIENT_WIDEST(evaluateBlock);
  const WindingTree tree{nodes_.data(), static_cast<std::uint32_t>(nodes_.size()), points_,
                         dipoles_, rows_};
  // Nanoseconds of a block and a level of the tree, of which some nodes are opened.
  constexpr double kLevel = 8000.0;
  const double time = kLevel * std::log2(static_cast<double>(nodes_.size()) + 2.0);
  std::vector<float> out(at.size);
  parallelFor((at.size + kPlaces - 1) / kPlaces, threads, time, [&](std::size_t block) {
    const std::size_t first = block * kPlaces;
    std::array<float, kPlaces> sums{};
    kernel(tree, PlaceBlock(at, radii, first), sums.data());
    for (std::size_t i = first; i < std::min(first + kPlaces, at.size); ++i) {
      out[i] = sums[i - first] * kOneOver4Pi;
    }
  });
  return out;
}

void WindingNumber::listDipoles(const float* center, float reach, const DipoleList& points,
                                DipoleList& out) const {
  static_assert(kLeaf <= DipoleList::kBlock, "a leaf is appended at once");
  // A node has another distance from each of its points then, by a half at most; 3 takes a seventh
  // longer for the same signs.
  constexpr float kFarFromBall = 2.F;
  for (std::uint32_t i = 0; i < nodes_.size();) {
    const Node& node = nodes_[i];
    const float d[3] = {node.center[0] - center[0], node.center[1] - center[1],
                        node.center[2] - center[2]};
    const float far = kFarFromBall * node.radius + reach;
    if (d[0] * d[0] + d[1] * d[1] + d[2] * d[2] > far * far) {
      out.add(node.center, node.dipole);
      i = node.skip;
      continue;
    }
    if (node.size > 0) out.append(points, node.first, node.size);
    ++i;
  }
  out.fillBlock();
}

}  // namespace segorient
