// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <cstdint>
#include <vector>

#include "orientation/automatic/border_groups.h"
#include "orientation/automatic/border_votes.h"

namespace segorient::detail {

/// Lets the points of a border vote again, each by the planes of what lies within some steps from
/// neighbour to neighbour around it in either segment. Where noise reaches across a sharp crease,
/// the nearest points contradict each other, while the means of more lie apart by more than the
/// noise. Consistent normals have either plane behind the other one, or either before it, or, where
/// the planes are parallel, both point to the same side.
class WideVoter {
 public:
  WideVoter(const PointView& points, const Neighborhoods& neighborhoods, const SheetField& field,
            const Segmentation& segmentation);

  /// \param border points of segments a and b that have neighbours in the other one
  /// \return above 0 where the two agree as they are, -1 to 1 by how far the points agree with each
  ///         other; 0 where the segments are bent or one above the other, or too few points could
  ///         vote
  float vote(const std::vector<pcl::index_t>& border, std::int32_t a, std::int32_t b);

 private:
  SheetGroup gather(std::size_t from, std::int32_t label, std::vector<std::uint32_t>& front);
  bool hasOther(const std::vector<std::uint32_t>& rows, const Vec3& normal, float height,
                float h) const;
  float compareTerraces(const SheetGroup& a, const SheetGroup& b, float h) const;

  const PointView& points_;
  const Neighborhoods& nb_;
  const SheetField& field_;
  const Segmentation& segmentation_;
  std::vector<std::uint32_t>
      seen_;  // by point, empty before the first vote: the number of the gathering that saw it last
  std::uint32_t gatherings_ = 0;
  std::vector<std::uint32_t> first_;  // rows of the groups that were gathered last
  std::vector<std::uint32_t> second_;
};

}  // namespace segorient::detail
