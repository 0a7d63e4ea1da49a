// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "render/legend.h"

#include <algorithm>

#include "render/letters.h"
#include "support/colors.h"

namespace segorient::program {
namespace {

constexpr std::uint32_t kInk = 0x303030U;
constexpr int kBarWidth = 80;  // in dots of the letters

// Draws in dots, as large as the picture bears; what is outside is left out.
class Pen {
 public:
  explicit Pen(Picture& picture)
      : picture_(picture), dot_(std::max<int>(1, static_cast<int>(picture.height) / 400)) {}

  int height() const { return static_cast<int>(picture_.height) / dot_; }
  void fill(int left, int top, int width, int height, std::uint32_t rgb) {
    for (int y = top * dot_; y < (top + height) * dot_; ++y) {
      for (int x = left * dot_; x < (left + width) * dot_; ++x) pixel(x, y, rgb);
    }
  }
  // Returns where the next letter would be.
  int text(int left, int top, const std::string& text) {
    for (const char c : text) {
      const auto rows = letterRows(c);
      for (int y = 0; y < kLetterHeight; ++y) {
        for (int x = 0; x < kLetterWidth; ++x) {
          if ((rows[static_cast<std::size_t>(y)] >> (kLetterWidth - 1 - x) & 1) != 0) {
            fill(left + x, top + y, 1, 1, kInk);
          }
        }
      }
      left += kLetterWidth + 1;
    }
    return left;
  }

 private:
  void pixel(int x, int y, std::uint32_t rgb) {
    const auto width = static_cast<int>(picture_.width);
    if (x < 0 || y < 0 || x >= width || y >= static_cast<int>(picture_.height)) return;
    std::uint8_t* at = picture_.rgb.data() + 3 * (static_cast<std::size_t>(y) * picture_.width +
                                                  static_cast<std::size_t>(x));
    at[0] = static_cast<std::uint8_t>(rgb >> 16);
    at[1] = static_cast<std::uint8_t>(rgb >> 8);
    at[2] = static_cast<std::uint8_t>(rgb);
  }

  Picture& picture_;
  int dot_;
};

}  // namespace

void drawLegend(const Legend& legend, Picture& picture) {
  if (legend.empty()) return;
  constexpr int kLine = kLetterHeight + 3;
  constexpr int kLeft = 6;
  Pen pen(picture);
  const bool bar = !legend.low.empty();
  const int lines =
      static_cast<int>(legend.keys.size()) + (legend.title.empty() ? 0 : 1) + (bar ? 1 : 0);
  int top = pen.height() - 4 - kLine * lines;
  if (!legend.title.empty()) {
    pen.text(kLeft, top, legend.title);
    top += kLine;
  }
  if (bar) {
    const int left = pen.text(kLeft, top, legend.low) + 2;
    for (int x = 0; x < kBarWidth; ++x) {
      pen.fill(left + x, top, 1, kLetterHeight, rampColor((x + 0.5) / kBarWidth));
    }
    pen.text(left + kBarWidth + 3, top, legend.high);
    top += kLine;
  }
  for (const auto& [color, text] : legend.keys) {
    pen.fill(kLeft, top, kLetterHeight, kLetterHeight, color);
    pen.text(kLeft + kLetterHeight + 3, top, text);
    top += kLine;
  }
}

}  // namespace segorient::program
