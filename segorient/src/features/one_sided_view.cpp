// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "features/one_sided_view.h"

#include <algorithm>
#include <cmath>

#include "features/sheet_fit.h"

namespace segorient::detail {
namespace {

// One surface through everything around must fit this much worse than one side's surface: by more
// than such estimates of the same noise from some forty points differ.
constexpr double kWorse = 1.2;
// Standard deviations that a point may lie off the surface that it joins.
constexpr double kFarthestOff = 3.0;
// Beyond this a surface's height at the point is extrapolated guesswork.
constexpr double kLargestLeverage = 30.0;

double logNormalCdf(double x) {
  return std::log(std::max(0.5 * std::erfc(-x * M_SQRT1_2), 1e-30));
}

// As the surface would pass without the point itself, which is among those it was fitted to.
void leaveOut(SurfaceView& view) {
  const double rest = std::max(1.0 - view.leverage, 1e-3);
  view.height /= rest;
  view.leverage /= rest;
}

}  // namespace

OneSidedView::OneSidedView(const RecomputationScene& scene, const RecomputationOptions& options,
                           OneSidedNormal which)
    : scene_(scene),
      patch_(scene),
      which_(which),
      edge_cosine_(std::cos(static_cast<double>(options.edge_angle))) {}

double OneSidedView::cosine(const SeenSide& a, const SeenSide& b) {
  double c = 0;
  for (int i = 0; i < 3; ++i) c += a.view.normal[i] * b.view.normal[i];
  return std::abs(c);
}

void OneSidedView::buildPatch(std::size_t middle) {
  middle_ = middle;
  patch_.build(middle);
}

void OneSidedView::propose(std::size_t i, Proposal& proposal) {
  proposal.borders.clear();
  lookAtSides(i);
  const SeenSide* best = mostLikelySide();
  if (!best) return;
  const bool edge = std::any_of(sides_.begin(), sides_.end(),
                                [&](const SeenSide& s) { return cosine(*best, s) < edge_cosine_; });
  proposal.off = std::abs(best->view.height);
  proposal.result.accepted =
      edge && proposal.off <= kFarthestOff * best->sigma && oneSurfaceFitsWorse(best->side->fit);
  noteBorders(*best, proposal);
  if (edge && which_ == OneSidedNormal::EXPECTED) {
    const float spacing = meanDistance(scene_.points, scene_.neighborhoods, i, kFirstRing);
    proposal.to_other_face = distanceToOtherFace(*best) / static_cast<double>(spacing);
  }
  if (!proposal.result.accepted) return;
  proposal.result.label = best->side->label;
  if (which_ == OneSidedNormal::EXPECTED) {
    setExpected(proposal.result.normal);
    return;
  }
  for (int a = 0; a < 3; ++a) {
    proposal.result.normal[a] = static_cast<float>(best->view.normal[a]);
  }
}

bool OneSidedView::touches(std::size_t i, std::int32_t label) const {
  for (int j = 0; j < scene_.count(i); ++j) {
    if (scene_.labels[scene_.neighbor(i, j)] == label) return true;
  }
  return false;
}

void OneSidedView::lookAtSides(std::size_t i) {
  sides_.clear();
  double offset[3];
  for (std::size_t a = 0; a < 3; ++a) {
    offset[a] =
        static_cast<double>(scene_.points[i][a]) - static_cast<double>(scene_.points[middle_][a]);
  }
  for (const Side& side : patch_.sides()) {
    if (!side.fit.valid() || !touches(i, side.label)) continue;
    SeenSide seen{};
    seen.side = &side;
    seen.view = side.fit.at(offset);
    if (side.label == scene_.labels[i]) leaveOut(seen.view);
    if (seen.view.leverage > kLargestLeverage) continue;
    seen.sigma = side.fit.rms() * std::sqrt(1.0 + seen.view.leverage) + 1e-3 * side.fit.reach();
    for (int a = 0; a < 3; ++a) seen.center[a] = side.fit.center()[a] - offset[a];
    sides_.push_back(seen);
  }
}

bool OneSidedView::oneSurfaceFitsWorse(const OneSidedFit& best) {
  const OneSidedFit& whole = patch_.whole();
  return !whole.valid() || whole.rms() >= kWorse * best.rms();
}

const OneSidedView::SeenSide* OneSidedView::mostLikelySide() const {
  const SeenSide* best = nullptr;
  double best_score = std::numeric_limits<double>::infinity();
  for (const SeenSide& side : sides_) {
    const double score = unlikelihood(side);
    if (score >= best_score) continue;
    best_score = score;
    best = &side;
  }
  return best;
}

double OneSidedView::unlikelihood(const SeenSide& side) const {
  const double off = side.view.height / side.sigma;
  double sum = 0.5 * off * off + std::log(side.sigma);
  for (const SeenSide& other : sides_) {
    if (&other == &side || cosine(side, other) > edge_cosine_) continue;
    double height = -other.view.height;
    for (int a = 0; a < 3; ++a) height += side.center[a] * other.view.normal[a];
    const double inside = height < 0.0 ? other.view.height : -other.view.height;
    sum -= logNormalCdf(inside / other.sigma);
  }
  return sum;
}

void OneSidedView::setExpected(float* normal) const {
  std::vector<double> scores;
  for (const SeenSide& side : sides_) scores.push_back(unlikelihood(side));
  const double least = *std::min_element(scores.begin(), scores.end());
  double sum[3] = {0, 0, 0};
  for (std::size_t s = 0; s < sides_.size(); ++s) {
    const SeenSide& side = sides_[s];
    double along = 0;
    for (int a = 0; a < 3; ++a) along += side.side->toward[a] * side.view.normal[a];
    const double weight = std::copysign(std::exp(least - scores[s]), along);
    for (int a = 0; a < 3; ++a) sum[a] += weight * side.view.normal[a];
  }
  const double length = std::sqrt(sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]);
  for (int a = 0; a < 3; ++a) normal[a] = static_cast<float>(sum[a] / length);
}

double OneSidedView::distanceToOtherFace(const SeenSide& own) const {
  double least = std::numeric_limits<double>::infinity();
  for (const SeenSide& side : sides_) {
    if (cosine(own, side) < edge_cosine_) least = std::min(least, std::abs(side.view.height));
  }
  return least;
}

void OneSidedView::noteBorders(const SeenSide& best, Proposal& proposal) const {
  for (const SeenSide& a : sides_) {
    for (const SeenSide& b : sides_) {
      if (!(a.side->label < b.side->label)) continue;
      const bool concerns = &a == &best || &b == &best;
      proposal.borders.push_back(
          {{a.side->label, b.side->label},
           concerns && proposal.result.accepted && cosine(a, b) < edge_cosine_});
    }
  }
}

}  // namespace segorient::detail
