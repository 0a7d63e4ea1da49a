// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "render/picture.h"

#include <algorithm>

#include "render/vtk/vtk_module.h"

namespace segorient::program {

Picture beside(const std::vector<Picture>& pictures) {
  std::size_t width = 0;
  for (const Picture& p : pictures) width += p.width;
  Picture out(width, pictures.empty() ? 0 : pictures.front().height);
  std::size_t left = 0;
  for (const Picture& p : pictures) {
    for (std::size_t y = 0; y < out.height; ++y) {
      std::copy_n(p.rgb.data() + 3 * y * p.width, 3 * p.width,
                  out.rgb.data() + 3 * (y * out.width + left));
    }
    left += p.width;
  }
  return out;
}

Picture halved(const Picture& picture) {
  Picture out(picture.width / 2, picture.height / 2);
  for (std::size_t y = 0; y < out.height; ++y) {
    for (std::size_t x = 0; x < 3 * out.width; ++x) {
      const std::size_t column = 6 * (x / 3) + x % 3;
      const std::uint8_t* from = picture.rgb.data() + 6 * y * picture.width + column;
      const std::uint8_t* below = from + 3 * picture.width;
      const unsigned sum = 2U + from[0] + from[3] + below[0] + below[3];
      out.rgb[3 * y * out.width + x] = static_cast<std::uint8_t>(sum / 4U);
    }
  }
  return out;
}

void writePng(const Picture& picture, OutputFile& file) {
  const std::vector<std::uint8_t> png = vtkModule().png(picture);
  file.write(png.data(), png.size());
}

}  // namespace segorient::program
