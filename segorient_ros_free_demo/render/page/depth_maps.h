// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "render/page/vectors.h"

namespace segorient::program {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
constexpr int kAxes = 32;  // looked along both ways: some 17 degrees apart

/// Points and normals, packed, and what belongs to them.
struct Sample {
  std::vector<Vec> points;  ///< from their middle
  std::vector<Vec> normals;
  std::vector<float> radii;
  std::vector<float> noise;  ///< so far before its plane its own surface may lie for that
  /// Of a large cloud not all points are drawn from a direction, nor ask there: they take turns,
  /// whose depends on their places alone.
  std::vector<std::vector<std::uint32_t>> drawn;
  std::vector<std::vector<std::uint32_t>> asking;
  float middle = 0.F;
};

/// The nearest point of each pixel as seen from both ends of an axis.
class DepthMaps {
 public:
  /// Looks at the sample along one of kAxes directions. The sample must outlive this object.
  DepthMaps(const Sample& sample, int axis);

  /// Adds 1 to `front` or `back` of each point whose turn it is to ask, where it is seen from
  /// there.
  void count(std::vector<std::uint8_t>& front, std::vector<std::uint8_t>& back) const;

 private:
  struct Nearest {
    float depth;
    std::uint32_t point;
  };

  const std::vector<std::uint32_t>& turnOf(
      const std::vector<std::vector<std::uint32_t>>& turns) const {
    return turns[static_cast<std::size_t>(axis_) % turns.size()];
  }
  bool isHidden(std::size_t i, std::uint32_t q, float sign) const;
  Vec turned(const Vec& p) const { return {dot(right_, p), dot(up_, p), dot(towards_, p)}; }
  void measure();
  int column(float x) const;
  int row(float y) const;
  std::size_t pixelOf(const Vec& p) const;
  void draw();

  const Sample& sample_;
  int axis_;
  Vec towards_{};
  Vec right_{};
  Vec up_{};
  std::array<float, 2> low_{};
  float pixel_ = 1.F;
  int columns_ = 1;
  int rows_ = 1;
  std::vector<Nearest> near_;
  std::vector<Nearest> far_;
};

}  // namespace segorient::program
