// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/segmentation/segmentation.h>

#include <cstddef>
#include <cstdint>
#include <vector>

#include "orientation/automatic/border_votes.h"

namespace segorient::detail {

/// How far the borders of each part to others agree with the signs of the segments, -1 to 1.
/// \param part_of one a segment: the name of what is turned with it, a segment's number
/// \param without of parts that have none
std::vector<float> agreementOf(const std::vector<std::int32_t>& part_of,
                               const std::vector<BorderVote>& votes,
                               const std::vector<std::int8_t>& signs, float without);

/// Components of a surface with their loose parts apart: parts whose borders hardly tell how they
/// are turned, such as the walls of a bore that uneven sampling has cut lengthwise, or shells that
/// noise has brought together.
struct LooseParts {
  std::vector<std::int32_t> of;  ///< by segment: its component, or from `components` on its part
  std::size_t components = 0;
  std::size_t count = 0;  ///< components and loose parts

  bool none() const { return count == components; }
};

/// \param signs of the segments, as they are turned now
/// \param component of the segments
/// \param part_of as above
/// \param looked_at by component, whether its parts may be loose
LooseParts findLooseParts(const Segmentation& segmentation, const std::vector<BorderVote>& votes,
                          const std::vector<std::int8_t>& signs,
                          const std::vector<std::int32_t>& component,
                          const std::vector<std::int32_t>& part_of,
                          const std::vector<bool>& looked_at);

}  // namespace segorient::detail
