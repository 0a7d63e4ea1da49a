// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "render/picture.h"

namespace segorient::program {

constexpr std::array<std::uint8_t, 3> kSensorColor{20, 90, 220};
constexpr std::array<std::uint8_t, 3> kWrongColor{190, 0, 150};

/// A picture with the depth of each pixel; larger is nearer.
class Canvas {
 public:
  Canvas(std::size_t width, std::size_t height)
      : picture_(width, height),
        depth_(width * height, std::numeric_limits<float>::lowest()),
        width_(static_cast<int>(width)),
        height_(static_cast<int>(height)) {}

  /// A range of pixels, cut to the picture.
  struct Range {
    int begin;
    int end;
  };
  Range columns(float from, float to) const { return cut(from, to, width_); }
  Range rows(float from, float to) const { return cut(from, to, height_); }
  int width() const { return width_; }
  int height() const { return height_; }

  /// Where nothing nearer is; of equal depth, the first stays.
  void put(int x, int y, float depth, const std::array<std::uint8_t, 3>& color) {
    const std::size_t pixel = at(x, y);
    if (depth <= depth_[pixel]) return;
    depth_[pixel] = depth;
    set(pixel, color);
  }
  /// Over whatever is there.
  void cover(int x, int y, const std::array<std::uint8_t, 3>& color) { set(at(x, y), color); }
  const Picture& picture() const { return picture_; }

 private:
  static Range cut(float from, float to, int end) {
    const auto limit = static_cast<float>(end);
    return {static_cast<int>(std::clamp(std::floor(from), 0.F, limit)),
            static_cast<int>(std::clamp(std::ceil(to) + 1.F, 0.F, limit))};
  }
  std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>(x);
  }
  void set(std::size_t pixel, const std::array<std::uint8_t, 3>& color) {
    std::copy(color.begin(), color.end(),
              picture_.rgb.begin() + static_cast<std::ptrdiff_t>(3 * pixel));
  }

  Picture picture_;
  std::vector<float> depth_;
  int width_;
  int height_;
};

}  // namespace segorient::program
