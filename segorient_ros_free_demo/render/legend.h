// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "render/picture.h"

namespace segorient::program {

/// What the colours of a picture mean: a bar of rampColor() from `low` to `high` where these are
/// given, and single colours.
struct Legend {
  std::string title;
  std::string low;
  std::string high;
  std::vector<std::pair<std::uint32_t, std::string>> keys;  ///< packed rgb
};

/// Draws it into the lower left corner, as far as there is room.
void drawLegend(const Legend& legend, Picture& picture);

/// Writes what is shown into the upper left corner.
void drawTitle(const std::string& title, Picture& picture);

}  // namespace segorient::program
