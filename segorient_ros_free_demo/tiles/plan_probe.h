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
    const std::size_t parts = std::min(tree_.tiles(), kParts);
    for (std::size_t p = 0; p < parts; ++p) chosen_[p * tree_.tiles() / parts] = 1;
  }
  /// \param seen_from relative to the origin; null where no point carries that
  void add(const Place& place, const float* seen_from) {
    double reach = 0.0;
    bool wanted = chosen_[tree_.owner(place, reach)] != 0;
    if (!wanted)
      tree_.forEachWithin(place, reach, [&](auto t, double) { wanted |= chosen_[t] != 0; });
    if (!wanted) return;
    const std::array<float, 3> p = near(place, origin_);
    points_.insert(points_.end(), p.begin(), p.end());
    if (seen_from != nullptr) viewpoints_.insert(viewpoints_.end(), seen_from, seen_from + 3);
  }
  PointView points() const { return {points_.data(), 3, points_.size() / 3}; }
  const std::vector<float>& viewpoints() const { return viewpoints_; }

 private:
  // Together half a million points: traits are medians and shares, and their surroundings are
  // known.
  static constexpr double kPart = 20000.0;
  static constexpr std::size_t kParts = 26;
  TileTree tree_;
  Place origin_;
  std::vector<std::uint8_t> chosen_;
  std::vector<float> points_;
  std::vector<float> viewpoints_;
};

}  // namespace segorient::program
