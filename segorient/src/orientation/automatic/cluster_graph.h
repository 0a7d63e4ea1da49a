// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "orientation/automatic/border_votes.h"

namespace segorient {

/// Signed graph of segments that is contracted border by border, the surest first.
///
/// Where two clusters are joined, one is turned over if the evidence says so, and the borders that
/// both have with a third add up with their signs: contradictions cancel and show as low unanimity,
/// so that no single weak border decides anything. So do votes across walls, apart: two clusters
/// that somewhere meet on one sheet need not listen to those of the walls between them elsewhere,
/// as of a sheet that is rolled up.
class ClusterGraph {
 public:
  /// Evidence between two clusters.
  struct Edge : Evidence {
    std::int32_t a = 0;
    std::int32_t b = 0;
    bool alive = true;
    Evidence sheet;  ///< votes on one sheet
    Evidence wall;   ///< votes across walls

    Edge() = default;
    explicit Edge(const BorderVote& vote);
    void decide();                        ///< which of the votes count
    void add(const Edge& o, float sign);  ///< another edge between the same two
  };

  /// What may be joined.
  struct Rule {
    float unanimity = 0.F;  ///< least |weight| / absolute
    float weight = 0.F;     ///< least |weight|
    float reliable = 0.F;   ///< least share of reliable evidence
    /// Two clusters that both have more points than this are not joined.
    std::uint32_t both_larger = std::numeric_limits<std::uint32_t>::max();
  };

  /// \param sizes points of each segment
  ClusterGraph(const std::vector<std::uint32_t>& sizes, const std::vector<BorderVote>& votes);

  /// Joins all that one of the rules allows, by |weight| * unanimity; nothing without rules.
  void contract(const std::vector<Rule>& rules);

  /// The cluster that a segment belongs to: one of its segments stands for it.
  /// \param sign +1 or -1: what turns the segment to agree with the cluster
  std::int32_t find(std::int32_t segment, int& sign) const;

  std::vector<Edge> edges() const;             ///< between the present clusters
  std::vector<std::int32_t> clusters() const;  ///< present clusters, ascending

 private:
  struct Candidate;

  std::int32_t other(std::uint32_t edge, std::int32_t cluster) const {
    return edges_[edge].a == cluster ? edges_[edge].b : edges_[edge].a;
  }
  std::uint32_t edgeBetween(std::int32_t a, std::int32_t b) const;
  bool allowed(const Edge& e, const Rule& rule) const;
  bool allowed(const Edge& e, const std::vector<Rule>& rules) const;
  void push(std::vector<Candidate>& heap, std::uint32_t edge, const std::vector<Rule>& rules) const;
  void merge(std::int32_t keep, std::int32_t gone, int sign, const std::vector<Rule>& rules,
             std::vector<Candidate>& heap);

  std::vector<Edge> edges_;
  std::vector<std::vector<std::uint32_t>> incident_;  // a cluster's edges, dead ones included
  std::vector<std::uint32_t> sizes_;
  std::vector<std::int32_t> parent_;
  std::vector<std::int8_t> parity_;
};

}  // namespace segorient
