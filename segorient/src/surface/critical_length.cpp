// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <algorithm>

#include "surface/triangle_selection.h"

namespace segorient::surface {
namespace {

/// Bins of a quarter of the median: longer edges than this many bins are not looked at.
constexpr std::size_t kMostBins = 1U << 16U;

}  // namespace

float criticalLength(const std::vector<float>& lengths, float typical,
                     const TriangulationOptions& options) {
  const auto [shortest, longest] = std::minmax_element(lengths.begin(), lengths.end());
  const float low = *shortest;
  const float range = *longest - low;
  if (!(range > 0.F)) return options.critical_factor * low;
  float width = 0.25F * typical;
  std::size_t bins = 1;
  if (options.bins > 0) {
    bins = std::min(static_cast<std::size_t>(options.bins), kMostBins);
    width = range / static_cast<float>(bins);
  } else {
    const float wanted = range / width;  // NaN where both are infinite
    bins =
        (wanted < static_cast<float>(kMostBins) ? static_cast<std::size_t>(wanted) : kMostBins) + 1;
  }
  std::vector<std::uint32_t> counts(bins, 0);
  for (const float length : lengths) {
    const float at = (length - low) / width;
    if (at < static_cast<float>(bins)) {
      ++counts[static_cast<std::size_t>(at)];
    } else if (options.bins > 0) {
      ++counts.back();  // the longest edge, by rounding
    }
  }
  const auto most = static_cast<float>(*std::max_element(counts.begin(), counts.end()));
  std::size_t last = bins - 1;
  while (last > 0 && static_cast<float>(counts[last]) <= options.kappa1 * most) --last;
  return options.critical_factor * (low + static_cast<float>(last + 1) * width);
}

}  // namespace segorient::surface
