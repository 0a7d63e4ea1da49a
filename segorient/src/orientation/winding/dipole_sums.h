// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <cstddef>
#include <cstring>
#include <vector>

namespace segorient {

/// The part of all directions that a unit of solid angle is.
constexpr float kOneOver4Pi = 0.07957747F;

/// Dipoles as separate arrays: places, and area-weighted normals. They are as long as they ever
/// were, and a block longer than the list; the first size() count. Sums are taken by whole blocks:
/// fillBlock() first.
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
    if (size_ + 2 * kBlock > x.size()) grow();
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

  /// Sets what follows the last dipole to 0, as far as a block.
  void fillBlock();

 private:
  void grow();

  std::size_t size_ = 0;
};

/// Where the winding number of dipoles that are smeared over a radius falls fastest, which is
/// outward on a surface: minus its gradient, sum (m - 3 (m.d) d / s) / (4 pi s^(3/2)) with
/// d = p - x and s = d^2 + r^2.
/// (WindingNumber smears otherwise: max(d, r) for the root of s.)
/// \param x where \param radius at least about a spacing, above 0
/// \param descent 3 floats, 1 / length; 0 without dipoles
void steepestDescent(const DipoleList& dipoles, const float* x, float radius, float* descent);

/// The winding number of dipoles that are smeared as above, sum m.d / (4 pi s^(3/2)).
float windingNumberOf(const DipoleList& dipoles, const float* x, float radius);

/// sum mx (x - p) / (4 pi s^(3/2)): what adds to a sum of winding numbers at the dipoles' places,
/// each times its mx, if a dipole at x grows. \param pull 3 floats
void windingPull(const DipoleList& dipoles, const float* x, float radius, float* pull);

}  // namespace segorient
