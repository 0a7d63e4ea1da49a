// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <algorithm>

#include "orientation/automatic/loose_parts.h"
#include "orientation/automatic/sheet_stages.h"
#include "orientation/sensors/viewpoint_fit.h"

namespace segorient::detail {
namespace {

// How far the points of each segment face a viewpoint.
std::vector<Ballot> facingOf(const SheetSigns& sheets, const Viewpoint& from) {
  PointHints inferred;
  inferred.has_viewpoint = true;
  inferred.viewpoint = from.position;
  const std::vector<HintVotes> votes =
      hintVotes(sheets.points, sheets.field, sheets.segmentation, inferred);
  std::vector<Ballot> facing(sheets.signs.size());
  for (std::size_t s = 0; s < sheets.signs.size(); ++s) {
    facing[s].add(votes[s].view, sheets.signs[s] * from.facing);
  }
  return facing;
}

// Nothing that a sensor saw turns its back to it. Segments that do are turned over, those that meet
// and agree together; but not where next to all of their borders with others know better, nor if
// the sensor may as well have been at a place that they do not turn their backs to.
void turnSegmentsTo(SheetSigns& sheets, const ViewpointFit& fit) {
  const std::vector<Ballot> facing = facingOf(sheets, fit);
  // That all was seen from there is a guess from the largest cluster, and a wrong one if much of
  // the rest speaks against it: two walls of a corner look to many places behind the third.
  constexpr float kMostAgainst = 0.1F;
  std::vector<bool> turned_away(sheets.signs.size());
  float points = 0.F;
  for (std::size_t s = 0; s < sheets.signs.size(); ++s) {
    turned_away[s] = !sheets.hinted[at(sheets.clusters.of(s))] && facing[s].share() < -kClearly;
    if (turned_away[s]) points += static_cast<float>(sheets.segmentation.segments[s].size);
  }
  const std::vector<std::int32_t> group = agreeingGroups(sheets.votes, sheets.signs, turned_away);
  const std::vector<float> agreement = agreementOf(group, sheets.votes, sheets.signs, 0.F);
  std::vector<std::size_t> against;
  for (std::size_t s = 0; s < sheets.signs.size(); ++s) {
    if (turned_away[s] && agreement[at(group[s])] <= kFirmBorders) against.push_back(s);
  }
  if (against.empty() || points > kMostAgainst * static_cast<float>(sheets.cloud_points)) return;
  std::vector<bool> sure(sheets.signs.size());  // by group
  for (const std::size_t s : against) sure[at(group[s])] = true;
  for (const Viewpoint& other : fit.others) {
    const std::vector<Ballot> seen = facingOf(sheets, other);
    std::vector<Ballot> of_group(sheets.signs.size());
    for (const std::size_t s : against) of_group[at(group[s])].add(seen[s], 1);
    for (const std::size_t s : against) {
      if (of_group[at(group[s])].share() >= -kClearly) sure[at(group[s])] = false;
    }
  }
  sheets.keepWhatWindsRight(group, sure);
  for (const std::size_t s : against) {
    if (sure[at(group[s])]) sheets.signs[s] = static_cast<std::int8_t>(-sheets.signs[s]);
  }
}

// The largest cluster, or -1 where it is less than half of the cloud: that shows too little of what
// the sensor saw.
std::int32_t largestCluster(const SheetSigns& sheets) {
  std::vector<std::uint32_t> size(sheets.clusters.size(), 0);
  for (std::size_t s = 0; s < sheets.clusters.size(); ++s) {
    size[at(sheets.clusters.of(s))] += sheets.segmentation.segments[s].size;
  }
  const auto largest = std::max_element(size.begin(), size.end());
  if (2 * static_cast<std::size_t>(*largest) < sheets.cloud_points) return -1;
  return static_cast<std::int32_t>(largest - size.begin());
}

std::vector<std::uint32_t> reliablePointsOf(const SheetSigns& sheets, std::int32_t cluster) {
  std::vector<std::uint32_t> rows;
  for (std::size_t i = 0; i < sheets.points.size; ++i) {
    const std::int32_t s = sheets.segmentation.labels[i];
    if (s >= 0 && sheets.clusters.of(at(s)) == cluster && sheets.field.reliable[i] != 0) {
      rows.push_back(static_cast<std::uint32_t>(i));
    }
  }
  return rows;
}

}  // namespace

void followViewpoint(SheetSigns& sheets) {
  // Shares of the largest cluster that face the place: nearly all, but for what noise turns.
  constexpr float kOnePlace = 0.97F;
  constexpr float kNearlySure = 0.98F;
  if (sheets.windings.empty() || sheets.hints.has_viewpoint || sheets.isClosed(0, kClosedResidual))
    return;
  const std::int32_t largest = largestCluster(sheets);
  if (largest < 0) return;
  const ViewpointFit fit = fitViewpoint(sheets.points, sheets.orientedNormals(false),
                                        reliablePointsOf(sheets, largest), sheets.threads);
  sheets.found.viewpoint_agreement = fit.agreement;
  if (fit.agreement < kOnePlace) return;
  const std::vector<Ballot> seen = facingOf(sheets, fit);
  std::vector<Ballot> facing(sheets.clusters.size());
  for (std::size_t s = 0; s < sheets.clusters.size(); ++s) {
    const std::size_t c = at(sheets.clusters.of(s));
    if (!sheets.hinted[c]) facing[c].add(seen[s], 1);
  }
  std::vector<bool> turned_away = sheets.outvoted(facing, kSureBorders);
  sheets.keepWhatWindsRight(sheets.clusterOf(), turned_away);
  sheets.turnClusters(turned_away);
  if (fit.agreement >= kNearlySure) turnSegmentsTo(sheets, fit);
}

}  // namespace segorient::detail
