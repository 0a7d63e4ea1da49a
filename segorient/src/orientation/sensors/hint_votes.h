// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/point_view.h>
#include <segorient/segmentation/segmentation.h>

#include <cmath>
#include <vector>

#include "orientation/sensors/point_hints.h"
#include "segmentation/sheet_segmentation.h"

namespace segorient::detail {

/// Votes for and against the sign that something has.
struct Ballot {
  double balance = 0.0;
  double total = 0.0;

  void add(float vote) {
    balance += static_cast<double>(vote);
    total += static_cast<double>(std::fabs(vote));
  }
  void add(const Ballot& other, int sign) {
    balance += sign * other.balance;
    total += other.total;
  }
  /// -1 to 1
  float share() const { return total > 0.0 ? static_cast<float>(balance / total) : 0.F; }
};

/// What hints say of a segment, a cluster or a component.
struct HintVotes {
  Ballot seeds;
  Ballot directions;  ///< of single points
  Ballot view;        ///< of the common viewpoint

  void add(const HintVotes& other, int sign) {
    seeds.add(other.seeds, sign);
    directions.add(other.directions, sign);
    view.add(other.view, sign);
  }
};

/// By segment, for the sign that its points share (Segmentation::signs).
std::vector<HintVotes> hintVotes(const PointView& points, const SheetField& field,
                                 const Segmentation& segmentation, const PointHints& hints);

}  // namespace segorient::detail
