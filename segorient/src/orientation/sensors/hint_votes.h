// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/point_view.h>
#include <segorient/segmentation/segmentation.h>

#include <vector>

#include "orientation/sensors/point_hints.h"
#include "segmentation/sheet_segmentation.h"

namespace segorient::detail {

/// Votes for and against the sign that something has.
struct Ballot {
  float balance = 0.F;
  float total = 0.F;

  void add(const Ballot& other, int sign) {
    balance += static_cast<float>(sign) * other.balance;
    total += other.total;
  }
  float share() const { return total > 0.F ? balance / total : 0.F; }  ///< -1 to 1
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
