// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/export.h>

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace segorient {

/// Where a moving sensor was, by time.
class SEGORIENT_ORIENTATION_EXPORT Trajectory {
 public:
  struct Pose {
    double time = 0.0;
    std::array<double, 3> position{0.0, 0.0, 0.0};
  };

  Trajectory() = default;
  /// \param poses in any order; those with NaN or infinite numbers are left out, and of several at
  ///        one time the first stays
  explicit Trajectory(std::vector<Pose> poses);

  std::size_t size() const { return poses_.size(); }
  const std::vector<Pose>& poses() const { return poses_; }  ///< by time, strictly ascending
  double begin() const { return poses_.empty() ? 0.0 : poses_.front().time; }
  double end() const { return poses_.empty() ? 0.0 : poses_.back().time; }

  /// The position at a time, linear between the poses around it; false, and nothing written, before
  /// the first and after the last one.
  bool at(double time, std::array<double, 3>& position) const;

 private:
  std::vector<Pose> poses_;
};

/// Where each point of a cloud was seen from, by the time at which it was measured.
struct TrajectoryJoin {
  std::vector<double> viewpoints;  ///< 3 a point; NaN outside of the trajectory's time span
  std::size_t joined = 0;          ///< points that have a viewpoint
  std::size_t outside = 0;       ///< points measured before the trajectory begins or after its end
  std::size_t without_time = 0;  ///< points whose time is NaN or infinite
  double first_time = 0.0;       ///< of the points
  double last_time = 0.0;
};

/// \param times one a point, in the trajectory's time base
SEGORIENT_ORIENTATION_EXPORT TrajectoryJoin joinTrajectory(const Trajectory& trajectory,
                                                           const std::vector<double>& times);

/// Why the points and the trajectory share no time, in words: both spans and, where one of the
/// usual ones explains it, the difference of their time bases (GPS standard time and the same less
/// 1e9 as LAS has it, second of the week, Unix time, milli-, micro- and nanoseconds).
SEGORIENT_ORIENTATION_EXPORT std::string explainNoOverlap(const Trajectory& trajectory,
                                                          const TrajectoryJoin& join);

}  // namespace segorient
