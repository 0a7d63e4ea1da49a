// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "render/legend.h"

#include <algorithm>
#include <array>

#include "render/vtk/vtk_module.h"
#include "support/colors.h"

namespace segorient::program {
namespace {

constexpr std::uint32_t kInk = 0x23262bU;
constexpr std::uint32_t kFrame = 0xa8a8a8U;  // around colours, so that light ones are seen
constexpr int kLetters = 34;                 // font sizes in the height of a picture
constexpr int kSmallest = 11;                // pixels: letters that can still be read

// Draws into a picture; what is outside is left out.
class Pen {
 public:
  explicit Pen(Picture& picture)
      : picture_(picture),
        size_(std::max(kSmallest, static_cast<int>(picture.height) / kLetters)) {}

  int size() const { return size_; }
  int height() const { return static_cast<int>(picture_.height); }
  void fill(int left, int top, int width, int height, std::uint32_t rgb) {
    for (int y = top; y < top + height; ++y) {
      for (int x = left; x < left + width; ++x) blend(x, y, rgb, 255);
    }
  }
  void box(int left, int top, int width, int height) {
    const int line = std::max(1, size_ / 16);
    fill(left, top, width, height, kFrame);
    fill(left + line, top + line, width - 2 * line, height - 2 * line, 0xffffffU);
  }
  // A line of text whose middle is at a height; returns where it ends.
  int text(int left, int middle, const std::string& text) {
    const TextLine line = vtkModule().text_line(text, size_);
    for (int y = 0; y < line.height; ++y) {
      for (int x = 0; x < line.width; ++x) {
        const auto at = static_cast<std::size_t>(y) * static_cast<std::size_t>(line.width) +
                        static_cast<std::size_t>(x);
        blend(left + x, middle - line.height / 2 + y, kInk, line.ink[at]);
      }
    }
    return left + line.width;
  }

 private:
  void blend(int x, int y, std::uint32_t rgb, unsigned ink) {
    const auto width = static_cast<int>(picture_.width);
    if (x < 0 || y < 0 || x >= width || y >= height()) return;
    std::uint8_t* at = picture_.rgb.data() + 3 * (static_cast<std::size_t>(y) * picture_.width +
                                                  static_cast<std::size_t>(x));
    for (std::size_t c = 0; c < 3; ++c) {
      const unsigned color = rgb >> (16 - 8 * c) & 255U;
      at[c] = static_cast<std::uint8_t>((ink * color + (255U - ink) * at[c] + 127U) / 255U);
    }
  }

  Picture& picture_;
  int size_;
};

}  // namespace

void drawLegend(const Legend& legend, Picture& picture) {
  Pen pen(picture);
  const int size = pen.size();
  const int line = size * 3 / 2;
  const int left = size;
  const int swatch = size * 4 / 5;
  const bool bar = !legend.low.empty();
  const int lines =
      static_cast<int>(legend.keys.size()) + (legend.title.empty() ? 0 : 1) + (bar ? 1 : 0);
  int middle = pen.height() - size / 2 - line * lines + line / 2;
  if (!legend.title.empty()) {
    pen.text(left, middle, legend.title);
    middle += line;
  }
  if (bar) {
    const int width = 8 * size;
    const int from = pen.text(left, middle, legend.low) + size / 2;
    pen.box(from - 1, middle - swatch / 2 - 1, width + 2, swatch + 2);
    for (int x = 0; x < width; ++x) {
      pen.fill(from + x, middle - swatch / 2, 1, swatch, rampColor((x + 0.5) / width));
    }
    pen.text(from + width + size / 2, middle, legend.high);
    middle += line;
  }
  for (const auto& [color, text] : legend.keys) {
    pen.box(left - 1, middle - swatch / 2 - 1, swatch + 2, swatch + 2);
    pen.fill(left, middle - swatch / 2, swatch, swatch, color);
    pen.text(left + swatch + size / 2, middle, text);
    middle += line;
  }
}

void drawTitle(const std::string& title, Picture& picture) {
  Pen pen(picture);
  pen.text(pen.size(), 3 * pen.size() / 2, title);
}

}  // namespace segorient::program
