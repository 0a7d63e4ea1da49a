// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "common/by_size.h"
#include "orientation/automatic/loose_parts.h"
#include "orientation/automatic/sheet_stages.h"

namespace segorient::detail {
namespace {

// What borders, and what is known of single points, say against each component.
void addTerms(SheetSigns& sheets) {
  std::vector<ComponentOrientationResult>& components = sheets.found.result.components;
  std::vector<Ballot> borders(components.size());
  std::vector<Ballot> known(components.size());
  for (const BorderVote& v : sheets.votes) {
    const std::size_t c = at(sheets.component_of[at(v.a)]);
    if (c != at(sheets.component_of[at(v.b)])) continue;
    borders[c].add({v.weight, v.absolute}, sheets.signs[at(v.a)] * sheets.signs[at(v.b)]);
  }
  for (std::size_t s = 0; s < sheets.signs.size(); ++s) {
    const std::size_t c = at(sheets.component_of[s]);
    known[c].add(sheets.hint_votes[s].seeds, sheets.signs[s]);
    known[c].add(sheets.hint_votes[s].directions, sheets.signs[s]);
  }
  const auto against = [](const Ballot& b) {
    return b.total > 0.F ? 0.5F - 0.5F * b.share() : 0.F;
  };
  for (std::size_t c = 0; c < components.size(); ++c) {
    components[c].contradiction = against(borders[c]);
    components[c].against_known = against(known[c]);
  }
}

void findContradictions(SheetSigns& sheets) {
  // Unanimous borders about as long as the object is wide: noise does not produce those.
  const auto long_enough = static_cast<std::uint32_t>(
      std::max(20.0, 0.5 * std::sqrt(static_cast<double>(sheets.cloud_points))));
  for (const BorderVote& v : sheets.votes) {
    // Walls face apart in a plate, but not in a roll.
    if (v.by_planes || v.wall_counts || v.unanimity() < 0.9F || v.count < long_enough ||
        v.reliable < 0.8F * v.absolute) {
      continue;
    }
    const float agreed =
        v.weight * static_cast<float>(sheets.signs[at(v.a)] * sheets.signs[at(v.b)]);
    if (agreed >= 0.F) continue;
    const float* p = sheets.points[static_cast<std::size_t>(v.where)];
    sheets.found.contradictions.push_back({v.a, v.b, -agreed, {p[0], p[1], p[2]}});
  }
  std::stable_sort(
      sheets.found.contradictions.begin(), sheets.found.contradictions.end(),
      [](const Contradiction& x, const Contradiction& y) { return x.weight > y.weight; });
}

void listClusters(SheetSigns& sheets) {
  std::vector<ClusterOrientationResult> all(sheets.clusters.size());
  const std::vector<float> agreement =
      agreementOf(sheets.clusters.of(), sheets.votes, sheets.signs, 1.F);
  for (std::size_t s = 0; s < sheets.clusters.size(); ++s) {
    ClusterOrientationResult& cluster = all[at(sheets.clusters.of(s))];
    cluster.points += sheets.segmentation.segments[s].size;
    cluster.component = sheets.component_of[s];
    cluster.confidence = std::clamp(agreement[at(sheets.clusters.of(s))], 0.F, 1.F);
  }
  BySize(all.size(), [&](std::size_t c) { return all[c].points; }).sort(all);
  while (!all.empty() && all.back().points == 0) all.pop_back();
  sheets.found.clusters = std::move(all);
}

}  // namespace

void judge(SheetSigns& sheets) {
  OrientationResult& result = sheets.found.result;
  const std::size_t n = sheets.signs.size();
  std::vector<std::int32_t> itself(n);
  std::iota(itself.begin(), itself.end(), 0);
  constexpr float kNone = 2.F;  // without borders
  const std::vector<float> agreement = agreementOf(itself, sheets.votes, sheets.signs, kNone);
  result.segments.resize(n);
  for (std::size_t s = 0; s < n; ++s) {
    SegmentOrientationResult& r = result.segments[s];
    r.sign = sheets.signs[s];
    r.by = DecidedBy::GLOBAL;
    r.component = sheets.component_of[s];
    const float known = agreement[s] == kNone
                            ? result.components[at(sheets.component_of[s])].confidence
                            : agreement[s];
    r.confidence = std::clamp(known, 0.F, 1.F);
    r.hard = known <= 0.F;
  }
  addTerms(sheets);
  findContradictions(sheets);
  listClusters(sheets);
  result.point_signs.assign(sheets.points.size, 0);
  result.point_confidences.assign(sheets.points.size, 0.F);
  result.point_components.assign(sheets.points.size, -1);
  for (std::size_t i = 0; i < sheets.points.size; ++i) {
    const std::int32_t s = sheets.segmentation.labels[i];
    if (s < 0) continue;
    result.point_signs[i] =
        static_cast<std::int8_t>(sheets.segmentation.signs[i] * sheets.signs[at(s)]);
    result.point_confidences[i] = result.segments[at(s)].confidence;
    result.point_components[i] = sheets.component_of[at(s)];
  }
}

}  // namespace segorient::detail
