// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/checks/fault_patches.h"

#include <array>
#include <cmath>
#include <map>

#include "common/at.h"
#include "common/disjoint_sets.h"
#include "common/dot.h"

namespace segorient {
namespace {

// Surfaces within 45 degrees of each other are one piece, on which a change of side can be seen.
constexpr float kSmooth = 0.70710678F;
// Along the border of a patch that is turned over, the surface goes on smoothly but for some
// strays.
constexpr double kMostlySmooth = 2.0 / 3.0;

struct Patch {
  std::array<std::size_t, 4> faults{};  // points by NormalFault
  std::size_t points = 0;
  double confidence = 0.0;  // sums over its points
  double seen = 0.0;
  bool core = false;
  std::size_t border = 0;
  std::size_t smooth = 0;  // pairs across the border whose own sides agree in our orientation

  std::size_t of(NormalFault fault) const { return faults[static_cast<std::size_t>(fault)]; }
  NormalFault fault() const {
    if (2 * of(NormalFault::SENSOR) >= points) return NormalFault::SENSOR;
    return 2 * of(NormalFault::INSIDE_OUT) >= points ? NormalFault::INSIDE_OUT
                                                     : NormalFault::SURFACE;
  }
  // Whether it is more than noise, and our own orientation is worth more than the normals' there.
  bool provesSomething() const {
    if (!core) return false;
    if (fault() == NormalFault::SENSOR) return true;
    const bool confident =
        confidence >= static_cast<double>(kConfident) * static_cast<double>(points);
    const bool goes_on = static_cast<double>(smooth) >= kMostlySmooth * static_cast<double>(border);
    // Seen at grazing angles, but all in all from the front: sensors know better than the surface.
    const bool seen_in_front = seen > 0.0;
    return confident && goes_on && !seen_in_front;
  }
};

class Patches {
 public:
  Patches(const PreparedCloud& cloud, const std::vector<Judgement>& judgements,
          const OrientedCloud& ours)
      : cloud_(cloud),
        table_(cloud.neighborhoods()),
        judgements_(judgements),
        ours_(ours),
        sets_(cloud.size()) {}

  FaultPatches run() {
    unite();
    for (std::size_t i = 0; i < cloud_.size(); ++i) {
      if (isAtFault(i)) add(i, patches_[firstOf(i)]);
    }
    return results();
  }

 private:
  bool isAtFault(std::size_t i) const { return judgements_[i].fault != NormalFault::NONE; }
  std::size_t neighbor(std::size_t i, int j) const { return at(table_.indices(i)[j]); }
  std::int32_t firstOf(std::size_t i) { return sets_.find(static_cast<std::int32_t>(i)); }
  const float* ourNormal(std::size_t i) const { return &ours_.normals[4 * cloud_.rowOf(i)]; }

  void unite() {
    for (std::size_t i = 0; i < cloud_.size(); ++i) {
      for (int j = 1; isAtFault(i) && j < table_.count(i); ++j) {
        if (isAtFault(neighbor(i, j))) {
          sets_.join(static_cast<std::int32_t>(i), table_.indices(i)[j]);
        }
      }
    }
  }

  // Whether all neighbours that can be judged are at fault, too, and most can.
  bool isCore(std::size_t i) const {
    int judged = 0;
    for (int j = 1; j < table_.count(i); ++j) {
      if (judgements_[neighbor(i, j)].sign == 0) continue;
      if (!isAtFault(neighbor(i, j))) return false;
      ++judged;
    }
    return 2 * judged > kCheckNeighbors;
  }

  void add(std::size_t i, Patch& patch) const {
    ++patch.faults[static_cast<std::size_t>(judgements_[i].fault)];
    ++patch.points;
    patch.confidence += static_cast<double>(ours_.confidences[cloud_.rowOf(i)]);
    patch.seen += static_cast<double>(judgements_[i].seen);
    patch.core = patch.core || isCore(i);
    for (int j = 1; j < table_.count(i); ++j) {
      const std::size_t other = neighbor(i, j);
      if (isAtFault(other) || judgements_[other].sign == 0) continue;
      const float along = dot(ourNormal(i), ourNormal(other));
      if (std::fabs(along) < kSmooth) continue;
      ++patch.border;
      if (along > 0.F) ++patch.smooth;
    }
  }

  FaultPatches results() {
    FaultPatches out;
    std::map<std::int32_t, std::int32_t> number;
    for (const auto& [root, patch] : patches_) {
      if (!patch.provesSomething()) continue;
      FaultyPlace place;
      place.fault = patch.fault();
      place.confidence = static_cast<float>(patch.confidence / static_cast<double>(patch.points));
      number[root] = static_cast<std::int32_t>(out.places.size());
      out.places.push_back(place);
    }
    out.of_points.assign(cloud_.size(), -1);
    for (std::size_t i = 0; i < cloud_.size(); ++i) {
      if (!isAtFault(i)) continue;
      const auto known = number.find(firstOf(i));
      if (known != number.end()) out.of_points[i] = known->second;
    }
    return out;
  }

  const PreparedCloud& cloud_;
  const Neighborhoods& table_;
  const std::vector<Judgement>& judgements_;
  const OrientedCloud& ours_;
  detail::DisjointSets sets_;              // of points that hang together
  std::map<std::int32_t, Patch> patches_;  // by the set's first point
};

}  // namespace

FaultPatches findFaultPatches(const PreparedCloud& cloud, const std::vector<Judgement>& judgements,
                              const OrientedCloud& ours) {
  return Patches(cloud, judgements, ours).run();
}

}  // namespace segorient
