// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <cstdint>
#include <vector>

namespace segorient::program {

/// A line of text: how much ink each pixel has, 0 to 255, row by row from the top. Lines of the
/// same size are equally high, whatever their letters.
struct TextLine {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> ink;
};

}  // namespace segorient::program
