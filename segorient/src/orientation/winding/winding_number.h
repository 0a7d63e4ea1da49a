// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/point_view.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <vector>

namespace segorient {

/// The part of all directions that a unit of solid angle is.
constexpr float kOneOver4Pi = 0.07957747F;

/// Dipoles as separate arrays: places, and area-weighted normals. They are as long as they ever
/// were, and a block longer than the list; the first size() count.
class DipoleList {
 public:
  /// Most dipoles that are appended at once.
  static constexpr std::size_t kBlock = 16;

  std::vector<float> x, y, z;
  std::vector<float> mx, my, mz;

  std::size_t size() const { return size_; }
  void clear() { size_ = 0; }
  void add(const float* place, const float* moment) {
    if (size_ + kBlock >= x.size()) grow();
    x[size_] = place[0];
    y[size_] = place[1];
    z[size_] = place[2];
    mx[size_] = moment[0];
    my[size_] = moment[1];
    mz[size_] = moment[2];
    ++size_;
  }
  /// Whole blocks are copied, of which what is too much counts for nothing.
  /// \param count at most kBlock
  void append(const DipoleList& from, std::size_t first, std::size_t count) {
    if (size_ + kBlock >= x.size()) grow();
    const auto copy = [&](const std::vector<float>& source, std::vector<float>& target) {
      std::memcpy(target.data() + size_, source.data() + first, kBlock * sizeof(float));
    };
    copy(from.x, x);
    copy(from.y, y);
    copy(from.z, z);
    copy(from.mx, mx);
    copy(from.my, my);
    copy(from.mz, mz);
    size_ += count;
  }

 private:
  void grow();

  std::size_t size_ = 0;
};

/// Where the winding number of dipoles that are smeared over a radius falls fastest, which is
/// outward on a surface: minus its gradient, sum (m - 3 (m.d) d / s) / (4 pi s^(3/2)) with
/// d = p - x and s = d^2 + r^2.
/// (evaluate() smears otherwise: max(d, r) for the root of s.)
/// \param x where \param radius at least about a spacing, above 0
/// \param descent 3 floats, 1 / length; 0 without dipoles
void steepestDescent(const DipoleList& dipoles, const float* x, float radius, float* descent);

/// The winding number of dipoles that are smeared as above, sum m.d / (4 pi s^(3/2)).
float windingNumberOf(const DipoleList& dipoles, const float* x, float radius);

/// sum mx (x - p) / (4 pi s^(3/2)): what adds to a sum of winding numbers at the dipoles' places,
/// each times its mx, if a dipole at x grows. \param pull 3 floats
void windingPull(const DipoleList& dipoles, const float* x, float radius, float* pull);

/// Winding number of oriented points (Barill et al. 2018, "Fast winding numbers for soups and
/// clouds"): w(x) = sum a n.(p - x) / (4 pi max(|p - x|, r)^3): 1 inside a closed outward cloud, 0
/// outside, 1/2 on it.
///
/// A tree over runs of points that are near each other in memory; a node far enough away counts as
/// one dipole. Building is linear, evaluating logarithmic.
class WindingNumber {
 public:
  /// \param points all points, near ones side by side (CompactCloud's order)
  /// \param dipoles 4 floats a point: area-weighted normal, area
  /// \param rows points to use, ascending; empty = all. All three must outlive this object's use
  void build(const PointView& points, const std::vector<float>& dipoles,
             const std::vector<std::uint32_t>& rows);

  /// \param x where \param radius below which points are smoothed, usually the spacing
  float evaluate(const float* x, float radius) const;

  /// Appends dipoles that stand for all points when seen from a ball: points near it themselves,
  /// others together.
  /// \param center of the ball \param reach its radius
  /// \param points all that this was built from, in the order of its rows
  void listDipoles(const float* center, float reach, const DipoleList& points,
                   DipoleList& out) const;

  bool empty() const { return nodes_.empty(); }

 private:
  static constexpr float kHuge = std::numeric_limits<float>::max();
  struct Node {
    float center[3];
    float radius;
    float dipole[3];
    std::uint32_t skip;   // next node when this one is used or done
    std::uint32_t first;  // leaf: first point
    std::uint32_t size;   // leaf: points, 0 for inner nodes
  };
  struct Extent {
    double area = 0.0;
    float low[3] = {kHuge, kHuge, kHuge};
    float high[3] = {-kHuge, -kHuge, -kHuge};
  };
  Extent buildNode(std::uint32_t first, std::uint32_t last);
  Extent sumLeaf(Node& node) const;
  static Extent sumHalves(const Node& a, const Extent& in_a, const Node& b, const Extent& in_b,
                          Node& node);
  std::size_t row(std::uint32_t i) const { return rows_ != nullptr ? rows_[i] : i; }

  PointView points_;
  const float* dipoles_ = nullptr;
  const std::uint32_t* rows_ = nullptr;
  std::vector<Node> nodes_;
};

}  // namespace segorient
