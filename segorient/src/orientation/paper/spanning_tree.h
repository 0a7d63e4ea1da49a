// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <cstdint>
#include <queue>
#include <vector>

#include "orientation/paper/combination.h"

namespace segorient {

/// Orientation spreading over the graph of regular segments, surest link first (Prim). The methods
/// differ in what a link costs and in how a reached segment is decided.
class SegmentSpread {
 public:
  /// How the front visits a segment: by the angle of the link that reached it, or by the
  /// boundaries.
  enum class Rule { ANGLE, BOUNDARY, ANGLE_THEN_BOUNDARY };

  SegmentSpread(const SegmentEvidence& evidence, const OrientationSettings& options, Rule rule);

  const std::vector<SegmentOrientationResult>& results() const { return results_; }
  bool isOpen(std::int32_t segment) const;  ///< regular and not oriented yet
  /// All labels by descending size, equal sizes by label.
  const std::vector<std::int32_t>& bySize() const { return by_size_; }
  void orient(std::int32_t segment, int sign, DecidedBy by, float confidence, bool hard = false);

  /// Orients whatever the rule decides, from what is oriented so far.
  void spread();
  /// Orients the one hard segment with the strongest evidence by the balance of its oriented
  /// neighbours; false if no open segment has an oriented neighbour.
  bool guessOne();

 private:
  struct Step {
    float cost;
    std::uint32_t link;
    std::int32_t target;
    bool operator<(const Step& other) const {  // the cheapest on top of a priority queue
      return cost != other.cost ? cost > other.cost : link > other.link;
    }
  };
  struct Guess {
    float strength;
    std::int32_t target;
    bool operator<(const Guess& other) const {
      return strength != other.strength ? strength < other.strength : target > other.target;
    }
  };

  void sortBySize();
  void labelComponents();
  float cost(std::uint32_t link) const;
  bool contradictory(std::uint32_t link) const;
  void visit(const Step& step);
  bool decideByAngle(const Step& step);
  bool decideByBoundary(std::int32_t segment);
  float balance(std::int32_t segment) const;
  int signOf(std::int32_t segment) const {
    return results_[static_cast<std::size_t>(segment)].sign;
  }

  const SegmentEvidence& evidence_;
  const OrientationSettings& options_;
  Rule rule_;
  std::vector<SegmentOrientationResult> results_;
  std::vector<std::int32_t> by_size_;
  std::priority_queue<Step> front_;
  std::priority_queue<Guess> guesses_;
};

}  // namespace segorient
