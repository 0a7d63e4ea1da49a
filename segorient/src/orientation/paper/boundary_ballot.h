// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <pcl/types.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "orientation/paper/segment_relations.h"

namespace segorient {

// This many undecided pairs are added to every border, so that a chance contact of few points never
// counts as much as a long border.
constexpr float kUndecidedPairs = 2.F;

/// The votes of one border's pairs.
class BoundaryBallot {
 public:
  /// \param vote in [-1, 1], positive where the two segments are consistent
  void add(float vote) {
    balance_ += vote;
    total_ += std::abs(vote);
  }

  /// \param points distinct border points that voted, on the side that has fewer of them
  BoundaryVote count(std::size_t points) const {
    BoundaryVote out;
    out.margin = balance_ / (total_ + kUndecidedPairs);
    out.points = static_cast<std::uint32_t>(points);
    return out;
  }

 private:
  float balance_ = 0.F;
  float total_ = 0.F;
};

/// Sorts the rows and drops repeated ones.
inline void keepDistinct(std::vector<pcl::index_t>& rows) {
  std::sort(rows.begin(), rows.end());
  rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
}

}  // namespace segorient
