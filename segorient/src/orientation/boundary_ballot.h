// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/orientation/segment_relations.h>
#include <segorient/segmentation/segmentation.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace segorient {

// This many undecided pairs are added to every border, so that a chance contact of few points never
// counts as much as a long border.
constexpr float kUndecidedPairs = 2.F;

/// The votes of one border's pairs.
class BoundaryBallot {
 public:
  /// \param vote in [-1, 1], positive where the two segments are consistent
  void add(const BorderPair& pair, float vote) {
    balance_ += vote;
    total_ += std::abs(vote);
    in_a_.push_back(pair.in_a);
    in_b_.push_back(pair.in_b);
  }

  BoundaryVote count() {
    BoundaryVote out;
    out.margin = balance_ / (total_ + kUndecidedPairs);
    out.points = std::min(distinct(in_a_), distinct(in_b_));
    return out;
  }

 private:
  static std::uint32_t distinct(std::vector<pcl::index_t>& rows) {
    std::sort(rows.begin(), rows.end());
    return static_cast<std::uint32_t>(std::unique(rows.begin(), rows.end()) - rows.begin());
  }

  float balance_ = 0.F;
  float total_ = 0.F;
  std::vector<pcl::index_t> in_a_;
  std::vector<pcl::index_t> in_b_;
};

}  // namespace segorient
