// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "segmentation/segment_order.h"

#include <algorithm>

namespace segorient::segmentation {

std::vector<std::size_t> rankLabels(const std::vector<std::uint32_t>& sizes,
                                    std::vector<std::int32_t>& labels) {
  std::vector<std::size_t> smallest(sizes.size(), labels.size());
  for (std::size_t p = labels.size(); p-- > 0;) {
    if (labels[p] >= 0) smallest[static_cast<std::size_t>(labels[p])] = p;
  }
  std::vector<std::size_t> order;
  for (std::size_t s = 0; s < sizes.size(); ++s) {
    if (sizes[s] > 0) order.push_back(s);
  }
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return sizes[a] != sizes[b] ? sizes[a] > sizes[b] : smallest[a] < smallest[b];
  });
  std::vector<std::int32_t> rank(sizes.size(), -1);
  for (std::size_t r = 0; r < order.size(); ++r) rank[order[r]] = static_cast<std::int32_t>(r);
  for (std::int32_t& label : labels) {
    if (label >= 0) label = rank[static_cast<std::size_t>(label)];
  }
  return order;
}

}  // namespace segorient::segmentation
