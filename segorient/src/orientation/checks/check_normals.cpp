// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <segorient/orientation/check_normals.h>

#include <cmath>
#include <map>

#include "common/at.h"
#include "common/box.h"
#include "common/by_size.h"
#include "common/dot.h"
#include "common/in_double.h"
#include "common/unit_vector.h"
#include "orientation/checks/fault_patches.h"

namespace segorient {
namespace {

// A line 60 degrees off is another surface's, at an edge or behind a thin wall.
constexpr float kSameLine = 0.5F;
// Normals of noisy scans are wrong by some degrees, rarely by 15: seen at less than that from edge
// on, either side may be the right one.
constexpr float kClearlySeen = 0.2588190F;
// Residual of the winding number: closed surfaces stay below it even with noise.
constexpr float kClosedResidual = 0.1F;

class Check {
 public:
  Check(const PointView& points, const std::vector<float>& normals, const OrientedCloud& ours,
        const OrientationHints& hints, int threads)
      : points_(points),
        normals_(normals),
        ours_(ours),
        hints_(hints),
        cloud_(points, nullptr, threads),
        judgements_(cloud_.size()) {
    cloud_.findNeighbors(kCheckNeighbors, false);
  }

  NormalCheck run() {
    judge();
    findFaults();
    FaultPatches patches = findFaultPatches(cloud_, judgements_, ours_);
    out_.places = std::move(patches.places);
    place_of_ = std::move(patches.of_points);
    return report();
  }

 private:
  std::size_t row(std::size_t i) const { return cloud_.rowOf(i); }
  const float* ourNormal(std::size_t i) const { return &ours_.normals[4 * row(i)]; }
  std::int32_t component(std::size_t i) const { return ours_.components[row(i)]; }

  bool isClosed(std::size_t component) const;
  bool knowsOutside(std::size_t component) const;
  bool toSensor(std::size_t i, float* direction) const;
  void judge();
  std::vector<std::int8_t> referenceSigns(std::vector<bool>& inside_out) const;
  void findFaults();
  std::int32_t scanOf(std::size_t row) const {
    return row < hints_.scans.size() ? hints_.scans[row] : -1;
  }
  void countForScan(std::size_t row, const Judgement& judgement, bool same);
  void measurePlaces();
  void sortPlaces();
  NormalCheck report();

  const PointView& points_;
  const std::vector<float>& normals_;
  const OrientedCloud& ours_;
  const OrientationHints& hints_;
  PreparedCloud cloud_;
  std::vector<Judgement> judgements_;
  std::vector<std::int32_t> place_of_;
  std::map<std::int32_t, ScanCheck> scans_;
  NormalCheck out_;
};

bool Check::isClosed(std::size_t component) const {
  if (hints_.surface != SurfaceKind::UNKNOWN) return hints_.surface == SurfaceKind::CLOSED;
  return ours_.report.components[component].residual <= kClosedResidual;
}

// Whether our sign of the whole component is more than a convention.
bool Check::knowsOutside(std::size_t component) const {
  const ComponentOrientationResult& c = ours_.report.components[component];
  if (c.confidence < kConfident) return false;
  return c.by == DecidedBy::HINTS || (c.by == DecidedBy::GLOBAL && isClosed(component));
}

// One viewpoint for all points says nothing of closed parts: nothing closed is seen whole from
// there.
bool Check::toSensor(std::size_t i, float* direction) const {
  const std::size_t r = row(i);
  const std::array<double, 3> p = inDouble(points_[r]);
  const auto towards = [&](const float* place) {
    return unitVector({static_cast<double>(place[0]) - p[0], static_cast<double>(place[1]) - p[1],
                       static_cast<double>(place[2]) - p[2]},
                      direction);
  };
  if (3 * r + 2 < hints_.viewpoints.size() && towards(&hints_.viewpoints[3 * r])) return true;
  if (hints_.has_direction) return unitVector(inDouble(hints_.direction.data()), direction);
  return hints_.has_viewpoint && component(i) >= 0 && !isClosed(at(component(i))) &&
         towards(hints_.viewpoint.data());
}

void Check::judge() {
  for (std::size_t i = 0; i < cloud_.size(); ++i) {
    float normal[3];
    if (!unitVector(inDouble(&normals_[3 * row(i)]), normal)) continue;
    const float agree = dot(normal, ourNormal(i));
    if (!(std::fabs(agree) >= kSameLine)) continue;
    judgements_[i].sign = agree > 0.F ? 1 : -1;
    float sensor[3];
    if (!toSensor(i, sensor)) continue;
    const float seen = dot(normal, sensor);
    judgements_[i].seen = seen;
    if (std::fabs(seen) > kClearlySeen) judgements_[i].facing = seen > 0.F ? 1 : -1;
  }
}

// By component, the sign that its normals are expected to have; most of them have it where our own
// sign means nothing.
std::vector<std::int8_t> Check::referenceSigns(std::vector<bool>& inside_out) const {
  const std::size_t count = ours_.report.components.size();
  std::vector<std::int64_t> balance(count, 0);
  for (std::size_t i = 0; i < cloud_.size(); ++i) {
    if (component(i) >= 0) balance[at(component(i))] += judgements_[i].sign;
  }
  std::vector<std::int8_t> reference(count, 1);
  inside_out.assign(count, false);
  for (std::size_t c = 0; c < count; ++c) {
    if (balance[c] >= 0) continue;
    if (knowsOutside(c)) {
      inside_out[c] = isClosed(c);
    } else {
      reference[c] = -1;
    }
  }
  return reference;
}

void Check::findFaults() {
  std::vector<bool> inside_out;
  const std::vector<std::int8_t> reference = referenceSigns(inside_out);
  for (std::size_t i = 0; i < cloud_.size(); ++i) {
    Judgement& j = judgements_[i];
    if (j.sign == 0 || component(i) < 0) continue;
    const std::size_t c = at(component(i));
    if (j.facing < 0) {
      j.fault = NormalFault::SENSOR;
    } else if (j.facing == 0 && j.sign != reference[c]) {  // what was seen from the front is right
      j.fault = inside_out[c] ? NormalFault::INSIDE_OUT : NormalFault::SURFACE;
    }
  }
}

// From distinct points to rows. A row that repeats another's place has a normal of its own.
NormalCheck Check::report() {
  const std::size_t rows = cloud_.rows();
  out_.faults.assign(rows, NormalFault::NONE);
  out_.place_of.assign(rows, -1);
  for (std::size_t r = 0; r < rows; ++r) {
    float normal[3];
    if (cloud_.pointOf(r) < 0 || !unitVector(inDouble(&normals_[3 * r]), normal)) {
      ++out_.without_normal;
      continue;
    }
    const std::size_t i = at(cloud_.pointOf(r));
    const float agree = dot(normal, ourNormal(i));
    if (!(std::fabs(agree) >= kSameLine) || judgements_[i].sign == 0) {
      ++out_.unlike;
      continue;
    }
    ++out_.judged;
    const bool same = (agree > 0.F ? 1 : -1) == judgements_[i].sign;
    countForScan(r, judgements_[i], same);
    if (place_of_[i] < 0 || !same) continue;
    out_.faults[r] = judgements_[i].fault;
    out_.place_of[r] = place_of_[i];
    ++out_.at_fault;
  }
  for (const auto& [number, scan] : scans_) out_.scans.push_back(scan);
  measurePlaces();
  sortPlaces();
  return std::move(out_);
}

void Check::countForScan(std::size_t r, const Judgement& judgement, bool same) {
  if (judgement.facing == 0 || scanOf(r) < 0) return;
  ScanCheck& scan = scans_[scanOf(r)];
  scan.scan = scanOf(r);
  ++scan.judged;
  if (same == (judgement.facing < 0)) ++scan.against_sensor;
}

// Number, middle, size and scan of each place.
void Check::measurePlaces() {
  struct Around {
    std::array<double, 3> sum{0.0, 0.0, 0.0};
    Box box;
    std::map<std::int32_t, std::size_t> scans;
  };
  std::vector<Around> around(out_.places.size());
  for (std::size_t r = 0; r < out_.place_of.size(); ++r) {
    if (out_.place_of[r] < 0) continue;
    Around& place = around[at(out_.place_of[r])];
    ++out_.places[at(out_.place_of[r])].points;
    for (std::size_t a = 0; a < 3; ++a) place.sum[a] += static_cast<double>(points_[r][a]);
    place.box.add(points_[r]);
    if (scanOf(r) >= 0) ++place.scans[scanOf(r)];
  }
  for (std::size_t p = 0; p < around.size(); ++p) {
    FaultyPlace& place = out_.places[p];
    for (std::size_t a = 0; a < 3; ++a) {
      place.center[a] = static_cast<float>(around[p].sum[a] / static_cast<double>(place.points));
    }
    place.size = around[p].box.longestSide();
    for (const auto& [scan, count] : around[p].scans) {
      if (2 * count > place.points) place.scan = scan;
    }
  }
}

void Check::sortPlaces() {
  const BySize by_size(out_.places.size(), [&](std::size_t p) { return out_.places[p].points; });
  by_size.sort(out_.places);
  by_size.renumber(out_.place_of);
}

}  // namespace

NormalCheck checkNormals(const PointView& points, const std::vector<float>& normals,
                         const OrientedCloud& ours, const OrientationHints& hints, int threads) {
  if (normals.size() != 3 * points.size || ours.normals.size() != 4 * points.size ||
      ours.confidences.size() != points.size || ours.components.size() != points.size) {
    return {};
  }
  return Check(points, normals, ours, hints, threads).run();
}

}  // namespace segorient
