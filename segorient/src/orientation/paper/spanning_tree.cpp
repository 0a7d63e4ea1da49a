// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/paper/spanning_tree.h"

#include <algorithm>
#include <cmath>

#include "common/at.h"
#include "common/by_size.h"
#include "common/disjoint_sets.h"
#include "orientation/paper/segment_links.h"

namespace segorient {
namespace {

// A guess is told from a decision by its confidence alone where the flag is not looked at.
constexpr float kGuessConfidence = 0.25F;

// Angle between the two lines, in [0, pi/2].
float lineAngle(float cosine) {
  return std::acos(std::min(1.F, std::abs(cosine)));
}

int signOfValue(float value) {
  return value < 0.F ? -1 : 1;
}

}  // namespace

SegmentSpread::SegmentSpread(const SegmentEvidence& evidence, const OrientationSettings& options,
                             Rule rule)
    : evidence_(evidence), options_(options), rule_(rule) {
  results_.resize(evidence.segmentation.segments.size());
  sortBySize();
  labelComponents();
}

void SegmentSpread::sortBySize() {
  const std::vector<Segment>& segments = evidence_.segmentation.segments;
  const BySize sorted(results_.size(), [&](std::size_t s) { return segments[s].size; });
  for (const std::size_t s : sorted.order()) by_size_.push_back(static_cast<std::int32_t>(s));
}

void SegmentSpread::labelComponents() {
  detail::DisjointSets sets(results_.size());
  for (const SegmentBorder& link : evidence_.links.borders) sets.join(link.a, link.b);
  std::int32_t components = 0;
  for (std::size_t s = 0; s < results_.size(); ++s) {
    const auto segment = static_cast<std::int32_t>(s);
    if (!isRegular(evidence_.segmentation, segment)) continue;
    const std::int32_t root = sets.find(segment);
    results_[s].component = root == segment ? components++ : results_[at(root)].component;
  }
}

bool SegmentSpread::isOpen(std::int32_t segment) const {
  return isRegular(evidence_.segmentation, segment) && signOf(segment) == 0;
}

float SegmentSpread::cost(std::uint32_t link) const {
  if (rule_ == Rule::BOUNDARY) return 1.F - std::abs(evidence_.boundary[link].margin);
  return lineAngle(evidence_.cosines[link]);
}

void SegmentSpread::orient(std::int32_t segment, int sign, DecidedBy by, float confidence,
                           bool hard) {
  SegmentOrientationResult& result = results_[at(segment)];
  result.sign = static_cast<std::int8_t>(sign);
  result.by = by;
  result.confidence = confidence;
  result.hard = hard;
  const SegmentGraph& links = evidence_.links;
  for (const std::uint32_t link : LinksOf(links, segment)) {
    const std::int32_t other = otherOf(links.borders[link], segment);
    if (isOpen(other)) front_.push({cost(link), link, other});
  }
}

// Whether angle and boundary both decide, and not the same.
bool SegmentSpread::contradictory(std::uint32_t link) const {
  if (!options_.check_borders) return false;
  const float cosine = evidence_.cosines[link];
  const BoundaryVote& vote = evidence_.boundary[link];
  return lineAngle(cosine) <= options_.gamma && vote.decides(options_.min_margin) &&
         signOfValue(cosine) != signOfValue(vote.margin);
}

bool SegmentSpread::decideByAngle(const Step& step) {
  const float cosine = evidence_.cosines[step.link];
  const float angle = lineAngle(cosine);
  const bool unreliable = angle > options_.gamma;
  if (rule_ == Rule::ANGLE_THEN_BOUNDARY && (unreliable || contradictory(step.link))) return false;
  const std::int32_t from = otherOf(evidence_.links.borders[step.link], step.target);
  orient(step.target, signOf(from) * signOfValue(cosine), DecidedBy::PROPAGATION,
         (unreliable ? kGuessConfidence : 1.F) * std::abs(cosine), unreliable);
  return true;
}

// The largest neighbour first, see linkRegularSegments().
bool SegmentSpread::decideByBoundary(std::int32_t segment) {
  const SegmentGraph& links = evidence_.links;
  for (const std::uint32_t link : LinksOf(links, segment)) {
    const std::int32_t other = otherOf(links.borders[link], segment);
    const BoundaryVote& vote = evidence_.boundary[link];
    if (signOf(other) == 0 || !vote.decides(options_.min_margin)) continue;
    if (rule_ == Rule::ANGLE_THEN_BOUNDARY && contradictory(link)) continue;
    orient(segment, signOf(other) * signOfValue(vote.margin), DecidedBy::BOUNDARY,
           std::abs(vote.margin));
    return true;
  }
  return false;
}

// Signed evidence of all oriented neighbours, in border points.
float SegmentSpread::balance(std::int32_t segment) const {
  const SegmentGraph& links = evidence_.links;
  float sum = 0.F;
  for (const std::uint32_t link : LinksOf(links, segment)) {
    const float vote =
        rule_ == Rule::ANGLE ? evidence_.cosines[link] : evidence_.boundary[link].margin;
    sum += static_cast<float>(signOf(otherOf(links.borders[link], segment))) * vote *
           static_cast<float>(std::max(1U, evidence_.boundary[link].points));
  }
  return sum;
}

void SegmentSpread::visit(const Step& step) {
  if (!isOpen(step.target)) return;
  if (rule_ != Rule::BOUNDARY && decideByAngle(step)) return;
  if (rule_ != Rule::ANGLE && decideByBoundary(step.target)) return;
  guesses_.push({std::abs(balance(step.target)), step.target});
}

// A segment stays in the front once for each oriented neighbour, so a hard one is tried again
// whenever another of its neighbours has been oriented.
void SegmentSpread::spread() {
  while (!front_.empty()) {
    const Step step = front_.top();
    front_.pop();
    visit(step);
  }
}

bool SegmentSpread::guessOne() {
  while (!guesses_.empty()) {
    const Guess guess = guesses_.top();
    guesses_.pop();
    if (!isOpen(guess.target)) continue;
    const float sum = balance(guess.target);
    const auto by = rule_ == Rule::ANGLE ? DecidedBy::PROPAGATION : DecidedBy::BOUNDARY;
    const float share = std::abs(sum) / (std::abs(sum) + 1.F);
    orient(guess.target, signOfValue(sum), sum != 0.F ? by : DecidedBy::NOTHING,
           kGuessConfidence * share, true);
    return true;
  }
  return false;
}

}  // namespace segorient
