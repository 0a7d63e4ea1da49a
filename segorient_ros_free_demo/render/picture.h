// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "io/output_file.h"

namespace segorient::program {

/// Rows of red, green, blue, from the top left.
struct Picture {
  std::size_t width = 0;
  std::size_t height = 0;
  std::vector<std::uint8_t> rgb;

  Picture() = default;
  Picture(std::size_t w, std::size_t h) : width(w), height(h), rgb(3 * w * h, 255) {}
};

/// Pictures of equal height side by side.
Picture beside(const std::vector<Picture>& pictures);

/// Half the size, each pixel the mean of four.
Picture halved(const Picture& picture);

/// Writes a PNG; does not commit.
void writePng(const Picture& picture, OutputFile& file);

}  // namespace segorient::program
