// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "io/las_summary.h"

#include <cmath>
#include <limits>
#include <utility>

#include "io/cloud_writer.h"

namespace segorient::program {

void LasSummary::add(const OutputCloud& block) {
  const std::array<const Column*, 3> xyz{block.find("x"), block.find("y"), block.find("z")};
  const Column* number = block.find("return_number");
  for (std::size_t i = 0; i < block.size; ++i) {
    const std::array<double, 3> p{numberOf(*xyz[0], i), numberOf(*xyz[1], i), numberOf(*xyz[2], i)};
    if (!hasPlace(p)) {
      ++skipped_;
      continue;
    }
    ++points_;
    for (std::size_t a = 0; a < 3; ++a) range_[a].add(p[a]);
    const double r = number == nullptr ? 1.0 : numberOf(*number, i);
    if (r >= 1.0 && r <= 15.0) ++returns_[static_cast<std::size_t>(r)];
  }
  constexpr std::array<std::pair<const char*, double>, 5> kMost{{{"return_number", 7.0},
                                                                 {"number_of_returns", 7.0},
                                                                 {"classification", 31.0},
                                                                 {"classification_flags", 7.0},
                                                                 {"scanner_channel", 0.0}}};
  for (const auto& [name, most] : kMost) {
    const Column* c = block.find(name);
    for (std::size_t i = 0; c != nullptr && i < block.size; ++i) {
      wide_ = wide_ || numberOf(*c, i) > most;
    }
  }
  wide_ = wide_ || points_ > std::numeric_limits<std::uint32_t>::max();
  const Column* intensity = block.find("intensity");
  for (std::size_t i = 0; intensity != nullptr && i < block.size; ++i) {
    const double v = numberOf(*intensity, i);
    intensity_.add(v);
    whole_intensities_ =
        whole_intensities_ && (std::isnan(v) || (v >= 0.0 && v <= 65535.0 && v == std::floor(v)));
  }
}

}  // namespace segorient::program
