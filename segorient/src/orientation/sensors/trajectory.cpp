// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <segorient/orientation/trajectory.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace segorient {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();  // no place
constexpr double kWeek = 604800.0;                                 // seconds
constexpr double kGpsEpoch = 315964800.0;                          // 1980-01-06 in Unix time
constexpr double kLasShift = 1e9;  // LAS: "adjusted standard GPS time"

bool isFinite(const Trajectory::Pose& p) {
  return std::isfinite(p.time) && std::isfinite(p.position[0]) && std::isfinite(p.position[1]) &&
         std::isfinite(p.position[2]);
}

// Whether the trajectory would cover at least half of the points' time if that were scaled and
// shifted; less is no explanation, as long spans meet many others.
bool meet(const Trajectory& trajectory, const TrajectoryJoin& join, double factor, double shift) {
  const double first = factor * join.first_time + shift;
  const double last = factor * join.last_time + shift;
  const double common = std::min(last, trajectory.end()) - std::max(first, trajectory.begin());
  return common >= 0.5 * (last - first) && common >= 0.0;
}

// One of the known differences between time bases, or nothing.
std::string knownDifference(const Trajectory& trajectory, const TrajectoryJoin& join) {
  struct Difference {
    double factor;
    double shift;
    const char* text;
  };
  static constexpr Difference kKnown[] = {
      {1.0, kLasShift,
       "the points' times are GPS time less 1e9 (as in LAS), the trajectory's are not"},
      {1.0, -kLasShift,
       "the trajectory's times are GPS time less 1e9 (as in LAS), the points' are not"},
      {1.0, kGpsEpoch, "the points' times are GPS time, the trajectory's Unix time"},
      {1.0, -kGpsEpoch, "the trajectory's times are GPS time, the points' Unix time"},
      {1.0, kGpsEpoch + kLasShift,
       "the points' times are GPS time less 1e9 (as in LAS), the trajectory's Unix time"},
      {1.0, -kGpsEpoch - kLasShift,
       "the trajectory's times are GPS time less 1e9 (as in LAS), the points' Unix time"},
      {1e-3, 0.0, "the points' times are milliseconds, the trajectory's seconds"},
      {1e-6, 0.0, "the points' times are microseconds, the trajectory's seconds"},
      {1e-9, 0.0, "the points' times are nanoseconds, the trajectory's seconds"},
      {1e3, 0.0, "the trajectory's times are milliseconds, the points' seconds"},
      {1e6, 0.0, "the trajectory's times are microseconds, the points' seconds"},
      {1e9, 0.0, "the trajectory's times are nanoseconds, the points' seconds"}};
  for (const Difference& d : kKnown) {
    if (meet(trajectory, join, d.factor, d.shift)) return d.text;
  }
  // Seconds of the week on one side only; a survey within one week.
  for (const double shift : {0.0, kLasShift}) {
    const double weeks = kWeek * std::floor((trajectory.begin() - shift) / kWeek);
    if (weeks > 0.0 && join.last_time < kWeek && meet(trajectory, join, 1.0, weeks + shift)) {
      return "the points' times are seconds of the GPS week, the trajectory's are not";
    }
    const double own = kWeek * std::floor((join.first_time + shift) / kWeek);
    if (own > 0.0 && trajectory.end() < kWeek && meet(trajectory, join, 1.0, shift - own)) {
      return "the trajectory's times are seconds of the GPS week, the points' are not";
    }
  }
  return {};
}

}  // namespace

Trajectory::Trajectory(std::vector<Pose> poses) : poses_(std::move(poses)) {
  poses_.erase(
      std::remove_if(poses_.begin(), poses_.end(), [](const Pose& p) { return !isFinite(p); }),
      poses_.end());
  std::stable_sort(poses_.begin(), poses_.end(),
                   [](const Pose& a, const Pose& b) { return a.time < b.time; });
  poses_.erase(std::unique(poses_.begin(), poses_.end(),
                           [](const Pose& a, const Pose& b) { return a.time == b.time; }),
               poses_.end());
}

bool Trajectory::at(double time, std::array<double, 3>& position) const {
  if (poses_.empty() || !(time >= begin() && time <= end())) return false;
  const auto after = std::lower_bound(poses_.begin(), poses_.end(), time,
                                      [](const Pose& p, double t) { return p.time < t; });
  if (after->time == time) {
    position = after->position;
    return true;
  }
  const Pose& before = *(after - 1);
  const double share = (time - before.time) / (after->time - before.time);
  for (std::size_t a = 0; a < 3; ++a) {
    position[a] = before.position[a] + share * (after->position[a] - before.position[a]);
  }
  return true;
}

TrajectoryJoin joinTrajectory(const Trajectory& trajectory, const std::vector<double>& times) {
  TrajectoryJoin out;
  out.viewpoints.assign(3 * times.size(), kNaN);
  bool any = false;
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (!std::isfinite(times[i])) {
      ++out.without_time;
      continue;
    }
    out.first_time = any ? std::min(out.first_time, times[i]) : times[i];
    out.last_time = any ? std::max(out.last_time, times[i]) : times[i];
    any = true;
    std::array<double, 3> position{};
    if (!trajectory.at(times[i], position)) {
      ++out.outside;
      continue;
    }
    std::copy(position.begin(), position.end(),
              out.viewpoints.begin() + static_cast<std::ptrdiff_t>(3 * i));
    ++out.joined;
  }
  return out;
}

std::string explainNoOverlap(const Trajectory& trajectory, const TrajectoryJoin& join) {
  std::ostringstream text;
  text.precision(15);
  text << "no point was measured within the trajectory's time: points " << join.first_time << " to "
       << join.last_time << ", trajectory " << trajectory.begin() << " to " << trajectory.end();
  const std::string difference = knownDifference(trajectory, join);
  if (!difference.empty()) text << "; it looks as if " << difference;
  return text.str();
}

}  // namespace segorient
