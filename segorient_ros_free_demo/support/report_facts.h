// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace segorient::program {

/// What a report of orient says of one segment.
struct SegmentFact {
  float confidence = -1.F;  ///< below 0: not known
  bool hard = false;        ///< no method decided it
  std::string kind;
  std::string oriented_by;
  std::string component_by;  ///< what the side of its connected component rests on
};

/// What is known of a cloud beyond its file.
struct Facts {
  std::vector<SegmentFact> segments;  ///< by label; may be shorter than there are labels
  std::vector<std::array<double, 3>> contradictions;
  std::vector<std::array<double, 3>> sensors;
  bool saw_all = false;  ///< whether it is known that these saw next to all points
};

/// Of `orient --report`. Throws FileError if it is none.
Facts readReport(const std::string& path);

/// Places of sensors: JSON with an array `sensors` whose items have x, y, z or a `position` of
/// three numbers, else a cloud of these places. Throws FileError.
/// \param explained the points that those of them explain that the JSON calls sure are added
std::vector<std::array<double, 3>> readSensors(const std::string& path,
                                               std::size_t* explained = nullptr);

}  // namespace segorient::program
