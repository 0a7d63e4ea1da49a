// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/disjoint_sets.h"
#include "features/point_set.h"
#include "segmentation/growth_state.h"
#include "segmentation/small_adjacency.h"

namespace segorient::segmentation {

/// Marks the clusters that have no inside: rows of points along sharp edges, where the normals lean
/// over both faces and agree with each other. However long they are, they are no faces.
void findStrips(const SegmentationOptions& options, GrowthState& state);

/// Regular or isolated, by size.
void setKinds(const SegmentationOptions& options, GrowthState& state);

/// The clean-up passes of section 2.3, in this order. Small segments are lists of points, so that
/// joining them is cheap.
class CleanUp {
 public:
  /// \param state after growing, and after findStrips() where strips are no faces
  CleanUp(const SegmentationOptions& options, GrowthState& state);

  /// Pass 1: whole small segments join a neighbouring one. \return how many did
  std::size_t absorbSmall();
  /// Pass 2: points of small segments go over to faces one by one, until nothing moves. \return how
  /// many did
  std::size_t extractEdges();
  /// Pass 3: small segments that touch become connected ones. After setKinds().
  void connectSmall();

 private:
  /// Points around a small segment that lie in its surface, by their segment.
  struct Count {
    std::int32_t label;
    std::uint32_t points;
  };
  struct Room {
    detail::PointSet seen;      ///< all points around
    detail::PointSet admitted;  ///< that lie in the surface of one of the segment's points
  };
  struct Hosts {
    std::vector<Count> counts;
    std::uint32_t total = 0;  ///< points around, in its surface or not
  };

  bool isSmall(std::int32_t label) const {
    return state_.clusters[static_cast<std::size_t>(label)].size < small_size_;
  }
  bool isFace(std::int32_t label) const { return state_.isFace(label, small_size_); }
  static void add(std::int32_t label, std::uint32_t points, std::vector<Count>& counts);
  void listHosts(std::int32_t label, Room& room, Hosts& hosts) const;
  std::int32_t bestHost(std::int32_t label, const Hosts& hosts);
  void join(std::int32_t from, std::int32_t into);
  bool tryExtract(std::uint32_t slot);

  const SegmentationOptions& options_;
  GrowthState& state_;
  std::uint32_t small_size_;
  SmallAdjacency adjacency_;
  float cos_join_;
  float cos_alpha_;
  detail::DisjointSets joined_to_{0};  ///< the root of a segment: where its points are
  std::vector<Count> counts_;
};

/// The three passes, and between them, with `settle_edges`, what goes beyond the paper; sets the
/// kinds.
/// \param report counts what was done; may be null
void cleanUp(const SegmentationOptions& options, GrowthState& state,
             SegmentationReport* report = nullptr);

}  // namespace segorient::segmentation
