// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <algorithm>

#include "orientation/automatic/sheet_stages.h"
#include "orientation/sensors/viewpoint_fit.h"

namespace segorient::detail {
namespace {

// How far the points of each segment face a viewpoint.
std::vector<Ballot> facingOf(const SheetSigns& sheets, const ViewpointFit& from) {
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
  // Share of the largest cluster that faces the place: nearly all, but for what noise turns.
  constexpr float kOnePlace = 0.97F;
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
  sheets.turnClusters(sheets.outvoted(facing, kSureBorders));
}

}  // namespace segorient::detail
