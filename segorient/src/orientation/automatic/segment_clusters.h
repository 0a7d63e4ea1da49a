// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/segmentation/segmentation.h>

#include <cstddef>
#include <cstdint>
#include <vector>

#include "orientation/automatic/border_votes.h"
#include "orientation/automatic/cluster_graph.h"

namespace segorient::detail {

/// Segments joined over the borders that are certain, and the signs of these clusters by all their
/// borders together. A cluster is named by one of its segments.
class SegmentClusters {
 public:
  /// \param contract_certain see AutomaticOptions
  /// \param points of the whole cloud
  SegmentClusters(const Segmentation& segmentation, const std::vector<BorderVote>& votes,
                  bool contract_certain, std::size_t points);

  /// One more than the largest name: the number of segments.
  std::size_t size() const { return of_.size(); }
  std::int32_t of(std::size_t segment) const { return of_[segment]; }
  const std::vector<std::int32_t>& of() const { return of_; }  ///< by segment
  /// The cluster that stands for all that borders connect with this one.
  std::int32_t root(std::int32_t cluster) const { return root_[static_cast<std::size_t>(cluster)]; }
  /// The sign of a segment, relative to others of the same root.
  std::int8_t sign(std::size_t segment) const {
    return static_cast<std::int8_t>(inside_[segment] *
                                    sign_[static_cast<std::size_t>(of_[segment])]);
  }

 private:
  std::vector<std::int32_t> of_;
  std::vector<std::int8_t> inside_;  // sign of each segment within its cluster
  std::vector<std::int8_t> sign_;    // by cluster
  std::vector<std::int32_t> root_;
};

}  // namespace segorient::detail
