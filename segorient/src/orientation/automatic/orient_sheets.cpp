// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/automatic/orient_sheets.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

#include "orientation/automatic/loose_parts.h"
#include "orientation/automatic/segment_clusters.h"
#include "orientation/automatic/sensor_signs.h"
#include "orientation/sensors/hint_votes.h"
#include "orientation/sensors/viewpoint_fit.h"
#include "orientation/winding/winding_components.h"

namespace segorient {
namespace {

using detail::Ballot;
using detail::HintVotes;

// Residuals of the winding number: clean closed clouds have .00 to .03, with noise of half a
// spacing up to .08.
constexpr float kClosedResidual = 0.03F;
constexpr float kOpenResidual = 0.1F;
constexpr float kClearly = 0.6F;  // four of five votes
// Agreement of borders, as votes for less votes against: what is known of single points, and what
// patches show as a whole, outweighs all that are not as firm as the first, and what could merely
// have been seen those that are not as sure as the second (three of four).
constexpr float kFirmBorders = 0.9F;
constexpr float kSureBorders = 0.5F;

std::size_t at(std::int32_t i) {
  return static_cast<std::size_t>(i);
}

// The hint that decides a component, if any: three votes of four at least.
const Ballot* decisive(const HintVotes& hints, bool open) {
  constexpr float kMost = 0.5F;  // .75 for less .25 against
  for (const Ballot* ballot : {&hints.seeds, &hints.directions}) {
    if (ballot->total > 0.F && std::fabs(ballot->share()) >= kMost) return ballot;
  }
  return open && hints.view.balance != 0.F ? &hints.view : nullptr;
}

class Orienter {
 public:
  Orienter(const PointView& points, const Neighborhoods& nb, const SheetField& field,
           const Segmentation& segmentation, std::vector<BorderVote> votes, std::size_t count,
           const AutomaticOptions& options, const PointHints& hints, int threads)
      : points_(points),
        count_(count),
        field_(field),
        segmentation_(segmentation),
        options_(options),
        hints_(hints),
        threads_(threads),
        sensors_(detail::findKnownSensors(points, nb, field.spacing, hints, threads)),
        votes_(std::move(votes)),
        clusters_(segmentation, votes_, {options.contract_certain, options.flip_clusters, count}) {}

  AutoOrientation run() {
    numberComponents();
    turnComponentsOut();
    followHints();
    if (!sensors_.none()) {
      followSensors();
    } else if (options_.infer_viewpoint) {
      followViewpoint();
    }
    judge();
    believeSensors();
    return std::move(out_);
  }

 private:
  void numberComponents();
  void windComponents();
  bool turnLooseParts(const std::vector<std::int32_t>& part_of, const std::vector<bool>& looked_at,
                      const TurnRule& rule);
  void turnLooseParts();
  void turnComponentsOut();
  std::vector<std::int8_t> conventionalSigns() const;
  bool isClosed(std::size_t component, float residual) const;
  std::vector<bool> outvoted(const std::vector<Ballot>& ballots, float sure_borders) const;
  void turnClusters(const std::vector<bool>& chosen);
  void keepWhatWindsRight(const std::vector<std::int32_t>& part_of,
                          std::vector<bool>& chosen) const;
  void followHints();
  void followSensors();
  void keepClosedFromSensors(const std::vector<detail::Ballot>& ballots);
  void believeSensors();
  void followViewpoint();
  std::vector<Ballot> facingOf(const Viewpoint& from) const;
  void turnSegmentsTo(const ViewpointFit& fit);
  void judge();
  void listClusters();
  void findContradictions();

  float pointSign(std::size_t i) const {
    const std::int32_t s = segmentation_.labels[i];
    return s < 0 ? 0.F : static_cast<float>(segmentation_.signs[i] * signs_[at(s)]);
  }
  std::vector<float> orientedNormals(bool dipoles) const;
  std::vector<std::int32_t> clusterOf() const;
  std::vector<std::int32_t> ofPoints(const std::vector<std::int32_t>& of_segments) const;

  const PointView& points_;
  const std::size_t count_;  // points of the cloud
  const SheetField& field_;
  const Segmentation& segmentation_;
  const AutomaticOptions& options_;
  const PointHints& hints_;
  const int threads_;
  detail::KnownSensors sensors_;
  std::vector<float> facing_;  // of each point's sensor, see detail::facingOf()
  std::vector<BorderVote> votes_;
  detail::SegmentClusters clusters_;
  std::vector<std::int8_t> signs_;         // of each segment
  std::vector<std::int32_t> component_;    // of each segment, 0.. by descending size
  std::vector<ComponentWinding> winding_;  // of each component
  std::vector<bool> hinted_;               // clusters with points that hints say something about
  AutoOrientation out_;
};

void Orienter::numberComponents() {
  const std::size_t n = clusters_.size();
  std::vector<std::uint32_t> size(n, 0);
  std::vector<bool> is_root(n, false);
  signs_.resize(n);
  for (std::size_t s = 0; s < n; ++s) {
    const std::size_t root = at(clusters_.root(clusters_.of(s)));
    is_root[root] = true;
    size[root] += segmentation_.segments[s].size;
    signs_[s] = clusters_.sign(s);
  }
  // Segments without points are components of their own, too.
  std::vector<std::int32_t> order;
  for (std::size_t s = 0; s < n; ++s) {
    if (is_root[s]) order.push_back(static_cast<std::int32_t>(s));
  }
  std::stable_sort(order.begin(), order.end(),
                   [&](std::int32_t a, std::int32_t b) { return size[at(a)] > size[at(b)]; });
  std::vector<std::int32_t> rank(n, -1);
  for (std::size_t c = 0; c < order.size(); ++c) rank[at(order[c])] = static_cast<std::int32_t>(c);
  component_.resize(n);
  for (std::size_t s = 0; s < n; ++s) component_[s] = rank[at(clusters_.root(clusters_.of(s)))];
  winding_.assign(order.size(), ComponentWinding{});
  out_.result.components.resize(order.size());
  for (std::size_t c = 0; c < order.size(); ++c) {
    out_.result.components[c].points = size[at(order[c])];
  }
}

std::vector<float> Orienter::orientedNormals(bool dipoles) const {
  std::vector<float> out(4 * points_.size, 0.F);
  // The mean distance to the 6 nearest of points of density 1/a is 0.977 sqrt(a). Noise of r
  // spacings takes two points sqrt(2) r apart across the surface, which adds about 2 r^2 to the
  // square.
  const float r = field_.residual;
  const float per_square = 1.047F / (1.F + 2.F * r * r);
  for (std::size_t i = 0; i < points_.size; ++i) {
    const float h = field_.spacing[i];
    const float area = dipoles ? per_square * h * h : 1.F;
    const float sign = pointSign(i);
    if (sign == 0.F) continue;
    for (std::size_t a = 0; a < 3; ++a) out[4 * i + a] = sign * area * field_.normals[4 * i + a];
    out[4 * i + 3] = area;
  }
  return out;
}

// The cluster of each segment.
std::vector<std::int32_t> Orienter::clusterOf() const {
  std::vector<std::int32_t> out;
  for (std::size_t s = 0; s < clusters_.size(); ++s) out.push_back(clusters_.of(s));
  return out;
}

// What is known of segments, one a point; -1 without a segment.
std::vector<std::int32_t> Orienter::ofPoints(const std::vector<std::int32_t>& of_segments) const {
  std::vector<std::int32_t> out(points_.size, -1);
  for (std::size_t i = 0; i < points_.size; ++i) {
    if (segmentation_.labels[i] >= 0) out[i] = of_segments[at(segmentation_.labels[i])];
  }
  return out;
}

void Orienter::windComponents() {
  const std::vector<float> spacing(field_.spacing, field_.spacing + points_.size);
  winding_ = solveComponents(points_, orientedNormals(true), spacing, ofPoints(component_),
                             winding_.size(), threads_);
}

// \return whether a part was turned over
bool Orienter::turnLooseParts(const std::vector<std::int32_t>& part_of,
                              const std::vector<bool>& looked_at, const TurnRule& rule) {
  const detail::LooseParts loose =
      detail::findLooseParts(segmentation_, votes_, signs_, component_, part_of, looked_at);
  if (loose.none()) return false;
  std::vector<float> dipoles = orientedNormals(true);
  for (std::size_t i = 0; i < points_.size; ++i) {
    const std::int32_t s = segmentation_.labels[i];
    const auto sign = static_cast<float>(s < 0 ? 1 : winding_[at(component_[at(s)])].sign);
    for (std::size_t a = 0; a < 3; ++a) dipoles[4 * i + a] *= sign;
  }
  const std::vector<float> spacing(field_.spacing, field_.spacing + points_.size);
  const std::vector<std::int8_t> turn = turnParts(points_, dipoles, spacing, ofPoints(loose.of),
                                                  loose.count, loose.components, rule, threads_);
  for (std::size_t s = 0; s < signs_.size(); ++s) {
    signs_[s] = static_cast<std::int8_t>(signs_[s] * turn[at(loose.of[s])]);
  }
  return std::find(turn.begin(), turn.end(), std::int8_t{-1}) != turn.end();
}

// Clusters first. Where the winding number is that of a clean closed surface nearly everywhere, it
// is to be trusted with single segments, too; noise would mislead it. Of clusters that had to be
// turned, the sum fell by .42 and more, of others in noise and thin walls by .24 at most; where
// less is gained, the part's own points have to tell, see TurnRule.
void Orienter::turnLooseParts() {
  std::vector<std::int32_t> part_of = clusterOf();
  const std::vector<bool> all(winding_.size(), true);
  if (turnLooseParts(part_of, all, {1.0 / 3.0, 0.2})) windComponents();
  std::vector<bool> clean(winding_.size());
  for (std::size_t c = 0; c < clean.size(); ++c) {
    clean[c] = winding_[c].residual <= kClosedResidual;
  }
  std::iota(part_of.begin(), part_of.end(), 0);
  if (turnLooseParts(part_of, clean, {0.1, kClosedResidual})) windComponents();
}

void Orienter::turnComponentsOut() {
  const std::size_t count = winding_.size();
  if (options_.wind_components) {
    windComponents();
    if (options_.turn_loose_parts) turnLooseParts();
  }
  const std::vector<std::int8_t> conventional = conventionalSigns();
  std::vector<HintVotes> hinted(count);
  const std::vector<HintVotes> votes = detail::hintVotes(points_, field_, segmentation_, hints_);
  for (std::size_t s = 0; s < signs_.size(); ++s) {
    hinted[at(component_[s])].add(votes[s], signs_[s]);
  }
  std::vector<std::int8_t> turn(count, 1);
  for (std::size_t c = 0; c < count; ++c) {
    ComponentOrientationResult& result = out_.result.components[c];
    result.by = DecidedBy::GLOBAL;
    result.evidence = winding_[c].evidence;
    result.confidence = winding_[c].evidence;
    if (options_.wind_components) result.residual = winding_[c].residual;
    turn[c] = winding_[c].sign;
    // Nothing to tell in from out: a plane, or an isolated point.
    constexpr float kNoEvidence = 0.01F;
    const bool unknown = winding_[c].evidence < kNoEvidence;
    if (unknown) {
      turn[c] = conventional[c];
      result.by = DecidedBy::NOTHING;
      result.confidence = 0.F;
    }
    if (const Ballot* hint = decisive(hinted[c], unknown || !isClosed(c, kOpenResidual))) {
      turn[c] = hint->balance < 0.F ? std::int8_t{-1} : std::int8_t{1};
      result.by = DecidedBy::HINTS;
      result.confidence = std::fabs(hint->share());
    }
    result.sign = turn[c];
  }
  for (std::size_t s = 0; s < signs_.size(); ++s) {
    signs_[s] = static_cast<std::int8_t>(signs_[s] * turn[at(component_[s])]);
  }
}

// By convention +z, then +y, then +x.
std::vector<std::int8_t> Orienter::conventionalSigns() const {
  const std::size_t count = winding_.size();
  std::vector<std::array<double, 3>> sum(count, {0.0, 0.0, 0.0});
  std::vector<double> points(count, 0.0);
  for (std::size_t i = 0; i < points_.size; ++i) {
    const std::int32_t s = segmentation_.labels[i];
    if (s < 0) continue;
    const std::size_t c = at(component_[at(s)]);
    const auto sign = static_cast<double>(pointSign(i));
    for (std::size_t a = 0; a < 3; ++a) {
      sum[c][a] += sign * static_cast<double>(field_.normals[4 * i + a]);
    }
    points[c] += 1.0;
  }
  std::vector<std::int8_t> signs;
  for (std::size_t c = 0; c < count; ++c) {
    const double least = 1e-6 * points[c];
    double direction = sum[c][2];
    if (std::fabs(direction) <= least) direction = sum[c][1];
    if (std::fabs(direction) <= least) direction = sum[c][0];
    signs.push_back(direction < 0.0 ? -1 : 1);
  }
  return signs;
}

bool Orienter::isClosed(std::size_t component, float residual) const {
  if (hints_.surface != SurfaceKind::UNKNOWN) return hints_.surface == SurfaceKind::CLOSED;
  return winding_[component].residual <= residual;
}

// Clusters that nearly all of the ballot is against, unless their borders know better.
std::vector<bool> Orienter::outvoted(const std::vector<Ballot>& ballots, float sure_borders) const {
  const std::vector<float> agreement = detail::agreementOf(clusterOf(), votes_, signs_, 0.F);
  std::vector<bool> out(clusters_.size());
  for (std::size_t c = 0; c < out.size(); ++c) {
    out[c] = agreement[c] <= sure_borders && ballots[c].share() < -kClearly;
  }
  return out;
}

void Orienter::turnClusters(const std::vector<bool>& chosen) {
  for (std::size_t s = 0; s < signs_.size(); ++s) {
    if (chosen[at(clusters_.of(s))]) signs_[s] = static_cast<std::int8_t>(-signs_[s]);
  }
}

// Takes out what the winding number vouches for: the walls of a cavity turn their backs to all that
// could have seen the body from within. Parts are named by a segment's number.
void Orienter::keepWhatWindsRight(const std::vector<std::int32_t>& part_of,
                                  std::vector<bool>& chosen) const {
  if (!options_.wind_components || hints_.surface == SurfaceKind::OPEN) return;
  // About 1 for a cavity; .6 for a hemisphere and .8 for a box without a lid, which are open.
  constexpr float kRises = 0.8F;
  const std::size_t fixed = winding_.size();
  std::vector<std::int32_t> number(chosen.size(), -1);
  std::vector<std::int32_t> numbered = component_;
  std::size_t count = fixed;
  for (std::size_t s = 0; s < signs_.size(); ++s) {
    const std::size_t part = at(part_of[s]);
    if (!chosen[part]) continue;
    if (number[part] < 0) number[part] = static_cast<std::int32_t>(count++);
    numbered[s] = number[part];
  }
  if (count == fixed) return;
  const std::vector<float> spacing(field_.spacing, field_.spacing + points_.size);
  const std::vector<float> rise = riseIfTurned(points_, orientedNormals(true), spacing,
                                               ofPoints(numbered), count, fixed, threads_);
  for (std::size_t part = 0; part < chosen.size(); ++part) {
    if (number[part] >= 0 && rise[at(number[part])] > kRises) chosen[part] = false;
  }
}

void Orienter::followHints() {
  const std::vector<HintVotes> votes = detail::hintVotes(points_, field_, segmentation_, hints_);
  std::vector<HintVotes> by_cluster(clusters_.size());
  std::vector<std::int32_t> component_of(clusters_.size(), -1);
  for (std::size_t s = 0; s < clusters_.size(); ++s) {
    by_cluster[at(clusters_.of(s))].add(votes[s], signs_[s]);
    component_of[at(clusters_.of(s))] = component_[s];
  }
  hinted_.assign(clusters_.size(), false);
  std::vector<Ballot> seen(clusters_.size());
  std::vector<Ballot> known(clusters_.size());
  for (std::size_t c = 0; c < clusters_.size(); ++c) {
    if (component_of[c] < 0) continue;
    const HintVotes& v = by_cluster[c];
    if (v.seeds.total > 0.F || v.directions.total > 0.F) {
      known[c] = v.seeds.total > 0.F ? v.seeds : v.directions;
      hinted_[c] = true;
    } else if (!isClosed(at(component_of[c]), kClosedResidual)) {
      seen[c] = v.view;
    }
  }
  turnClusters(outvoted(known, kFirmBorders));
  turnClusters(outvoted(seen, kSureBorders));
}

// One place for all points may be wrong as a whole, inside a solid, or have seen one side of it
// only. Unless its density says that all was seen from there, what closes in itself knows better:
// it keeps its outside if that faces the place, and if its points are spread as evenly as no sensor
// spreads them.
void Orienter::keepClosedFromSensors(const std::vector<Ballot>& ballots) {
  const bool told_closed = hints_.surface == SurfaceKind::CLOSED;
  if (!sensors_.one_place || !sensors_.scans[0].used) return;
  if (hints_.surface == SurfaceKind::OPEN) return;
  if (sensors_.scans[0].density < detail::kConfirmed && !told_closed) return;
  std::vector<Ballot> by_component(winding_.size());
  for (std::size_t s = 0; s < signs_.size(); ++s) {
    by_component[at(component_[s])].add(ballots[s], signs_[s]);
  }
  std::vector<bool> own(winding_.size(), false);
  std::size_t believed = 0;
  for (std::size_t c = 0; c < own.size(); ++c) {
    const bool contrary = by_component[c].share() < -kClearly;
    const bool keeps = told_closed || !contrary || sensors_.even;
    own[c] = keeps && isClosed(c, kOpenResidual);
    if (!own[c] || !contrary) believed += out_.result.components[c].points;
  }
  for (std::size_t i = 0; i < points_.size; ++i) {
    const std::int32_t s = segmentation_.labels[i];
    if (s < 0 || !own[at(component_[at(s)])]) continue;
    facing_[i] = 0.F;
    std::fill_n(&sensors_.toward[3 * i], 3, 0.F);
  }
  KnownSensor& report = sensors_.scans[0];
  report.used = 2 * believed > count_;
  if (!report.used) report.seen = 0;
}

// What a sensor saw faces it: whole segments, whatever their borders say, and the segments around
// them as borders say.
void Orienter::followSensors() {
  facing_ = detail::facingOf(field_, points_.size, sensors_);
  keepClosedFromSensors(detail::facingBySegment(facing_, segmentation_));
  const std::vector<Ballot> ballots = detail::facingBySegment(facing_, segmentation_);
  const std::vector<bool> decided =
      detail::turnToSensors(ballots, votes_, segmentation_, clusterOf(), component_, signs_);
  std::vector<Ballot> seen(winding_.size());
  for (std::size_t s = 0; s < signs_.size(); ++s) {
    if (decided[s]) seen[at(component_[s])].add(ballots[s], signs_[s]);
  }
  for (std::size_t c = 0; c < seen.size(); ++c) {
    if (!(seen[c].total > 0.F)) continue;
    out_.result.components[c].by = DecidedBy::HINTS;
    out_.result.components[c].confidence = std::fabs(seen[c].share());
  }
}

// Of segments that mix what was seen from two sides, each point as its sensor says.
void Orienter::believeSensors() {
  if (sensors_.none()) return;
  for (std::size_t i = 0; i < points_.size; ++i) {
    if (!detail::isClear(facing_[i])) continue;
    out_.result.point_signs[i] = facing_[i] < 0.F ? std::int8_t{-1} : std::int8_t{1};
    out_.result.point_confidences[i] = 1.F;
  }
  out_.sensors = std::move(sensors_.scans);
  out_.toward = std::move(sensors_.toward);
}

// If all that the largest cluster knows was seen from one place, so was the rest: other clusters
// that turn their backs to it are turned over where their borders hardly tell, and where that is
// nearly sure, so are single segments. Closed surfaces are never seen from one place, and have the
// winding number.
void Orienter::followViewpoint() {
  // Shares of the largest cluster that face the place: nearly all, but for what noise turns.
  constexpr float kOnePlace = 0.97F;
  constexpr float kNearlySure = 0.98F;
  if (winding_.empty() || hints_.has_viewpoint || isClosed(0, kClosedResidual)) return;
  std::vector<std::uint32_t> size(clusters_.size(), 0);
  for (std::size_t s = 0; s < clusters_.size(); ++s) {
    size[at(clusters_.of(s))] += segmentation_.segments[s].size;
  }
  const auto largest =
      static_cast<std::int32_t>(std::max_element(size.begin(), size.end()) - size.begin());
  // Less than half of the cloud shows too little of what the sensor saw.
  if (2 * static_cast<std::size_t>(size[at(largest)]) < count_) return;
  std::vector<std::uint32_t> rows;
  for (std::size_t i = 0; i < points_.size; ++i) {
    const std::int32_t s = segmentation_.labels[i];
    if (s >= 0 && clusters_.of(at(s)) == largest && field_.reliable[i] != 0) {
      rows.push_back(static_cast<std::uint32_t>(i));
    }
  }
  const ViewpointFit fit = fitViewpoint(points_, orientedNormals(false), rows, threads_);
  out_.viewpoint_agreement = fit.agreement;
  if (fit.agreement < kOnePlace) return;
  const std::vector<Ballot> seen = facingOf(fit);
  std::vector<Ballot> facing(clusters_.size());
  for (std::size_t s = 0; s < clusters_.size(); ++s) {
    const std::size_t c = at(clusters_.of(s));
    if (!hinted_[c]) facing[c].add(seen[s], 1);
  }
  std::vector<bool> turned_away = outvoted(facing, kSureBorders);
  keepWhatWindsRight(clusterOf(), turned_away);
  turnClusters(turned_away);
  if (fit.agreement >= kNearlySure) turnSegmentsTo(fit);
}

// How far the points of each segment face a viewpoint.
std::vector<Ballot> Orienter::facingOf(const Viewpoint& from) const {
  PointHints inferred;
  inferred.has_viewpoint = true;
  inferred.viewpoint = from.position;
  const std::vector<HintVotes> votes = detail::hintVotes(points_, field_, segmentation_, inferred);
  std::vector<Ballot> facing(signs_.size());
  for (std::size_t s = 0; s < signs_.size(); ++s) {
    facing[s].add(votes[s].view, signs_[s] * from.facing);
  }
  return facing;
}

// Nothing that a sensor saw turns its back to it. Segments that do are turned over, those that meet
// and agree together; but not where next to all of their borders with others know better, nor if
// the sensor may as well have been at a place that they do not turn their backs to.
void Orienter::turnSegmentsTo(const ViewpointFit& fit) {
  const std::vector<Ballot> facing = facingOf(fit);
  // That all was seen from there is a guess from the largest cluster, and a wrong one if much of
  // the rest speaks against it: two walls of a corner look to many places behind the third.
  constexpr float kMostAgainst = 0.1F;
  std::vector<bool> turned_away(signs_.size());
  float points = 0.F;
  for (std::size_t s = 0; s < signs_.size(); ++s) {
    turned_away[s] = !hinted_[at(clusters_.of(s))] && facing[s].share() < -kClearly;
    if (turned_away[s]) points += static_cast<float>(segmentation_.segments[s].size);
  }
  const std::vector<std::int32_t> group = detail::agreeingGroups(votes_, signs_, turned_away);
  const std::vector<float> agreement = detail::agreementOf(group, votes_, signs_, 0.F);
  std::vector<std::size_t> against;
  for (std::size_t s = 0; s < signs_.size(); ++s) {
    if (turned_away[s] && agreement[at(group[s])] <= kFirmBorders) against.push_back(s);
  }
  if (against.empty() || points > kMostAgainst * static_cast<float>(count_)) return;
  std::vector<bool> sure(signs_.size());  // by group
  for (const std::size_t s : against) sure[at(group[s])] = true;
  for (const Viewpoint& other : fit.others) {
    const std::vector<Ballot> seen = facingOf(other);
    std::vector<Ballot> of_group(signs_.size());
    for (const std::size_t s : against) of_group[at(group[s])].add(seen[s], 1);
    for (const std::size_t s : against) {
      if (of_group[at(group[s])].share() >= -kClearly) sure[at(group[s])] = false;
    }
  }
  keepWhatWindsRight(group, sure);
  for (const std::size_t s : against) {
    if (sure[at(group[s])]) signs_[s] = static_cast<std::int8_t>(-signs_[s]);
  }
}

void Orienter::findContradictions() {
  // Unanimous borders about as long as the object is wide: noise does not produce those.
  const auto long_enough =
      static_cast<std::uint32_t>(std::max(20.0, 0.5 * std::sqrt(static_cast<double>(count_))));
  for (const BorderVote& v : votes_) {
    // Walls face apart in a plate, but not in a roll.
    if (v.by_planes || v.wall_counts || v.unanimity() < 0.9F || v.count < long_enough ||
        v.reliable < 0.8F * v.absolute) {
      continue;
    }
    const float agreed = v.weight * static_cast<float>(signs_[at(v.a)] * signs_[at(v.b)]);
    if (agreed >= 0.F) continue;
    const float* p = points_[static_cast<std::size_t>(v.where)];
    out_.contradictions.push_back({v.a, v.b, -agreed, {p[0], p[1], p[2]}});
  }
  std::stable_sort(
      out_.contradictions.begin(), out_.contradictions.end(),
      [](const Contradiction& x, const Contradiction& y) { return x.weight > y.weight; });
}

void Orienter::listClusters() {
  std::vector<ClusterOrientationResult> all(clusters_.size());
  const std::vector<float> agreement = detail::agreementOf(clusterOf(), votes_, signs_, 1.F);
  for (std::size_t s = 0; s < clusters_.size(); ++s) {
    ClusterOrientationResult& cluster = all[at(clusters_.of(s))];
    cluster.points += segmentation_.segments[s].size;
    cluster.component = component_[s];
    cluster.confidence = std::clamp(agreement[at(clusters_.of(s))], 0.F, 1.F);
  }
  std::vector<std::int32_t> order;
  for (std::size_t c = 0; c < all.size(); ++c) {
    if (all[c].points > 0) order.push_back(static_cast<std::int32_t>(c));
  }
  std::stable_sort(order.begin(), order.end(), [&](std::int32_t a, std::int32_t b) {
    return all[at(a)].points > all[at(b)].points;
  });
  std::vector<std::int32_t> rank(all.size(), -1);
  for (std::size_t k = 0; k < order.size(); ++k) {
    rank[at(order[k])] = static_cast<std::int32_t>(k);
    out_.clusters.push_back(all[at(order[k])]);
  }
  out_.cluster_of.resize(clusters_.size());
  for (std::size_t s = 0; s < clusters_.size(); ++s) out_.cluster_of[s] = rank[at(clusters_.of(s))];
}

// A segment's confidence: how far its borders agree with the signs that were found.
void Orienter::judge() {
  const std::size_t n = signs_.size();
  std::vector<std::int32_t> itself(n);
  std::iota(itself.begin(), itself.end(), 0);
  constexpr float kNone = 2.F;  // without borders
  const std::vector<float> agreement = detail::agreementOf(itself, votes_, signs_, kNone);
  out_.result.segments.resize(n);
  for (std::size_t s = 0; s < n; ++s) {
    SegmentOrientationResult& r = out_.result.segments[s];
    r.sign = signs_[s];
    r.by = DecidedBy::GLOBAL;
    r.component = component_[s];
    const float known =
        agreement[s] == kNone ? out_.result.components[at(component_[s])].confidence : agreement[s];
    r.confidence = std::clamp(known, 0.F, 1.F);
    r.hard = known <= 0.F;
  }
  findContradictions();
  listClusters();
  out_.result.point_signs.assign(points_.size, 0);
  out_.result.point_confidences.assign(points_.size, 0.F);
  out_.result.point_components.assign(points_.size, -1);
  for (std::size_t i = 0; i < points_.size; ++i) {
    const std::int32_t s = segmentation_.labels[i];
    if (s < 0) continue;
    out_.result.point_signs[i] = static_cast<std::int8_t>(segmentation_.signs[i] * signs_[at(s)]);
    out_.result.point_confidences[i] = out_.result.segments[at(s)].confidence;
    out_.result.point_components[i] = component_[at(s)];
  }
}

}  // namespace

AutoOrientation orientSheets(const PointView& points, const Neighborhoods& neighborhoods,
                             const SheetField& field, const Segmentation& segmentation,
                             const AutomaticOptions& options, const PointHints& hints,
                             int threads) {
  return orientSheets(points, neighborhoods, field, segmentation,
                      borderVotes(points, neighborhoods, field, segmentation, threads), points.size,
                      options, hints, threads);
}

AutoOrientation orientSheets(const PointView& points, const Neighborhoods& neighborhoods,
                             const SheetField& field, const Segmentation& segmentation,
                             std::vector<BorderVote> votes, std::size_t count,
                             const AutomaticOptions& options, const PointHints& hints,
                             int threads) {
  return Orienter(points, neighborhoods, field, segmentation, std::move(votes), count, options,
                  hints, threads)
      .run();
}

}  // namespace segorient
