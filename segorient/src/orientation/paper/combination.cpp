// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/paper/combination.h"

#include <algorithm>
#include <utility>

#include "orientation/paper/spanning_tree.h"

namespace segorient {
namespace {

using Results = std::vector<SegmentOrientationResult>;

// Until every segment that has a link to an oriented one is oriented.
void finish(SegmentSpread& spread) {
  do {
    spread.spread();
  } while (spread.guessOne());
}

// From the largest segment of each component in turn.
Results finishFromSeeds(SegmentSpread spread) {
  finish(spread);
  for (const std::int32_t segment : spread.bySize()) {
    if (!spread.isOpen(segment)) continue;
    spread.orient(segment, 1, DecidedBy::SEED, 1.F);
    finish(spread);
  }
  return spread.results();
}

float weight(const ExtremalEvidence& evidence) {
  return static_cast<float>(evidence.votes * evidence.sign) * evidence.agreement;
}

// Segments that nothing decided so far take the sign that their extremal points ask for, seen
// relative to what the extremal points say about the rest of their component.
void askExtremalPoints(const SegmentEvidence& evidence, const OrientationSettings& options,
                       SegmentSpread& spread) {
  const std::size_t segments = spread.results().size();
  std::vector<float> component_balance(segments, 0.F);
  for (std::size_t s = 0; s < segments; ++s) {
    const SegmentOrientationResult& result = spread.results()[s];
    if (result.sign == 0) continue;
    component_balance[static_cast<std::size_t>(result.component)] +=
        static_cast<float>(result.sign) * weight(evidence.extremal[s]);
  }
  for (std::size_t s = 0; s < segments; ++s) {
    const auto segment = static_cast<std::int32_t>(s);
    const ExtremalEvidence& extremal = evidence.extremal[s];
    if (!spread.isOpen(segment) || extremal.sign == 0) continue;
    if (extremal.agreement < options.min_margin) continue;
    const float rest = component_balance[static_cast<std::size_t>(spread.results()[s].component)];
    if (rest == 0.F) continue;
    spread.orient(segment, rest > 0.F ? extremal.sign : -extremal.sign, DecidedBy::EXTREMAL,
                  extremal.agreement);
  }
}

}  // namespace

Results propagateOrientation(const SegmentEvidence& evidence, const OrientationSettings& options) {
  return finishFromSeeds(SegmentSpread(evidence, options, SegmentSpread::Rule::ANGLE));
}

Results orientByBoundaries(const SegmentEvidence& evidence, const OrientationSettings& options) {
  return finishFromSeeds(SegmentSpread(evidence, options, SegmentSpread::Rule::BOUNDARY));
}

Results orientCombined(const SegmentEvidence& evidence, const OrientationSettings& options) {
  SegmentSpread spread(evidence, options, SegmentSpread::Rule::ANGLE_THEN_BOUNDARY);
  std::vector<bool> seeded(spread.results().size(), false);
  for (const std::int32_t segment : spread.bySize()) {
    const std::int32_t component = spread.results()[static_cast<std::size_t>(segment)].component;
    if (component < 0 || seeded[static_cast<std::size_t>(component)]) continue;
    seeded[static_cast<std::size_t>(component)] = true;
    spread.orient(segment, 1, DecidedBy::SEED, 1.F);
  }
  spread.spread();
  askExtremalPoints(evidence, options, spread);
  return finishFromSeeds(std::move(spread));
}

Results orientByExtremalPoints(const SegmentEvidence& evidence,
                               const OrientationSettings& options) {
  SegmentSpread spread(evidence, options, SegmentSpread::Rule::ANGLE_THEN_BOUNDARY);
  for (std::size_t s = 0; s < spread.results().size(); ++s) {
    const ExtremalEvidence& extremal = evidence.extremal[s];
    if (extremal.sign == 0) continue;
    spread.orient(static_cast<std::int32_t>(s), extremal.sign, DecidedBy::EXTREMAL,
                  std::max(0.F, extremal.agreement));
  }
  return finishFromSeeds(std::move(spread));
}

}  // namespace segorient
