// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/point_view.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "tiles/tile_tree.h"

namespace segorient::program {

/// A place relative to another one.
inline std::array<float, 3> near(const TileTree::Place& p, const TileTree::Place& origin) {
  std::array<float, 3> out{};
  for (std::size_t a = 0; a < 3; ++a) out[a] = static_cast<float>(p[a] - origin[a]);
  return out;
}

/// Small parts all over the cloud, with their surroundings, as dense as they are; a small cloud as
/// a whole.
class Probe {
 public:
  using Place = TileTree::Place;

  Probe(const std::vector<Place>& sample, double points_each, const Place& origin)
      : tree_(sample, points_each, kPart), origin_(origin), chosen_(tree_.tiles(), 0) {
    const std::vector<TileTree::Box> tiles = tree_.tileBoxes();
    std::vector<TileTree::Box> parts;
    for (std::size_t p = 0; p < std::min(tiles.size(), kParts); ++p) {
      parts.push_back(tiles[p * tiles.size() / std::min(tiles.size(), kParts)]);
      chosen_[parts.back().tile] = 1;
    }
    const std::vector<TileTree::Node>& nodes = tree_.nodes();
    is_near_.assign(nodes.size(), 0);
    for (const TileTree::Box& cell : tree_.cells()) {
      const auto isNear = [&](const TileTree::Box& part) {
        return part.tile == cell.tile || cell.isWithin(part, nodes[cell.node].reach);
      };
      is_near_[cell.node] = std::any_of(parts.begin(), parts.end(), isNear) ? 1 : 0;
    }
    for (std::size_t n = nodes.size(); n-- > 0;) {  // halves come behind their node
      if (nodes[n].axis >= 0) is_near_[n] = is_near_[n + 1] | is_near_[nodes[n].upper];
    }
  }
  /// Whether a point is of a part, or of what surrounds it.
  bool wants(const Place& place) const {
    std::uint32_t n = 0;
    while (is_near_[n] != 0 && tree_.nodes()[n].axis >= 0) n = tree_.halfOf(n, place);
    if (is_near_[n] == 0) return false;
    bool wanted = false;
    tree_.forEachWithin(place, tree_.nodes()[n].reach,
                        [&](auto t, double) { wanted |= chosen_[t] != 0; });
    return wanted;
  }
  /// \param seen_from relative to the origin; null where no point carries that
  /// \param normal the same, see Plan::hasNormals()
  void add(const Place& place, const float* seen_from, const float* normal) {
    const std::array<float, 3> p = near(place, origin_);
    points_.insert(points_.end(), p.begin(), p.end());
    if (seen_from != nullptr) viewpoints_.insert(viewpoints_.end(), seen_from, seen_from + 3);
    if (normal != nullptr) normals_.insert(normals_.end(), normal, normal + 3);
  }
  PointView points() const { return {points_.data(), 3, points_.size() / 3}; }
  const std::vector<float>& viewpoints() const { return viewpoints_; }
  const std::vector<float>& normals() const { return normals_; }

 private:
  // Together half a million points: traits are medians and shares, and their surroundings are
  // known.
  static constexpr double kPart = 20000.0;
  static constexpr std::size_t kParts = 26;
  TileTree tree_;
  Place origin_;
  std::vector<std::uint8_t> chosen_;   // by tile of the tree
  std::vector<std::uint8_t> is_near_;  // by node: whether some of it may be of a part
  std::vector<float> points_;
  std::vector<float> viewpoints_;
  std::vector<float> normals_;
};

}  // namespace segorient::program
