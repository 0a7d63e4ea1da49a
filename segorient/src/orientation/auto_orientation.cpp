// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <segorient/orientation/auto_orientation.h>
#include <segorient/orientation/auto_viewpoint.h>
#include <segorient/orientation/border_votes.h>
#include <segorient/orientation/cluster_graph.h>
#include <segorient/orientation/winding_components.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

#include "hint_votes.h"

namespace segorient {
namespace {

using detail::Ballot;
using detail::HintVotes;

// Residuals of the winding number: clean closed clouds have .00 to .03, with noise of half a
// spacing up to .08.
constexpr float kClosedResidual = 0.03F;
constexpr float kOpenResidual = 0.1F;

std::size_t at(std::int32_t i) {
  return static_cast<std::size_t>(i);
}

// The hint that decides a component, if any: three votes of four at least.
const Ballot* decisive(const HintVotes& hints, bool open) {
  constexpr float kClearly = 0.5F;
  for (const Ballot* ballot : {&hints.seeds, &hints.directions}) {
    if (ballot->total > 0.F && std::fabs(ballot->share()) >= kClearly) return ballot;
  }
  return open && hints.view.balance != 0.F ? &hints.view : nullptr;
}

class Orienter {
 public:
  Orienter(const PointView& points, const Neighborhoods& nb, const SheetField& field,
           const Segmentation& segmentation, const AutoOrientationOptions& options,
           const PointHints& hints)
      : points_(points),
        field_(field),
        segmentation_(segmentation),
        options_(options),
        hints_(hints),
        votes_(borderVotes(points, nb, field, segmentation, options.threads)) {}

  AutoOrientation run() {
    formClusters();
    if (options_.flip_clusters) flipClusters();
    numberComponents();
    turnComponentsOut();
    followHints();
    if (options_.infer_viewpoint) followViewpoint();
    judge();
    return std::move(out_);
  }

 private:
  void formClusters();
  void flipClusters();
  void numberComponents();
  void turnComponentsOut();
  std::vector<std::int8_t> conventionalSigns() const;
  bool isClosed(std::size_t component, float residual) const;
  std::vector<float> clusterAgreement() const;
  void turnClusters(const std::vector<Ballot>& ballots, float sure_borders);
  void followHints();
  void followViewpoint();
  void judge();
  void findContradictions();

  float pointSign(std::size_t i) const {
    const std::int32_t s = segmentation_.labels[i];
    return s < 0 ? 0.F : static_cast<float>(segmentation_.signs[i] * signs_[at(s)]);
  }
  std::vector<float> orientedNormals(bool dipoles) const;

  const PointView& points_;
  const SheetField& field_;
  const Segmentation& segmentation_;
  const AutoOrientationOptions& options_;
  const PointHints& hints_;
  std::vector<BorderVote> votes_;
  std::vector<ClusterGraph::Edge> edges_;  // between clusters, signs relative to the clusters
  std::vector<std::int32_t> cluster_;      // of each segment
  std::vector<std::int8_t> in_cluster_;    // sign of each segment within its cluster
  std::vector<std::int8_t> cluster_sign_;  // by the segment that stands for the cluster
  std::vector<std::int32_t> root_;         // of each cluster: its component
  std::vector<std::int8_t> signs_;         // of each segment
  std::vector<std::int32_t> component_;    // of each segment, 0.. by descending size
  std::vector<ComponentWinding> winding_;  // of each component
  std::vector<bool> hinted_;               // clusters with points that hints say something about
  AutoOrientation out_;
};

void Orienter::formClusters() {
  const std::size_t n = segmentation_.segments.size();
  std::vector<std::uint32_t> sizes(n);
  for (std::size_t s = 0; s < n; ++s) sizes[s] = segmentation_.segments[s].size;
  ClusterGraph graph(sizes, votes_);
  if (options_.contract_certain) {
    ClusterGraph::Rule certain;
    certain.unanimity = 0.9F;
    certain.weight = 4.F;  // a border of a few points
    certain.reliable = 0.5F;
    graph.contract(certain);
    // Two large clusters are joined only with all evidence on the table.
    ClusterGraph::Rule likely;
    likely.unanimity = 0.6F;
    likely.both_larger = static_cast<std::uint32_t>(points_.size / 50);
    graph.contract(likely);
  }
  cluster_.resize(n);
  in_cluster_.resize(n);
  for (std::size_t s = 0; s < n; ++s) {
    int sign = 1;
    cluster_[s] = graph.find(static_cast<std::int32_t>(s), sign);
    in_cluster_[s] = static_cast<std::int8_t>(sign);
  }
  edges_ = graph.edges();
  graph.contract(ClusterGraph::Rule{});
  cluster_sign_.assign(n, 1);
  root_.assign(n, -1);
  for (std::size_t s = 0; s < n; ++s) {
    int sign = 1;
    root_[at(cluster_[s])] = graph.find(cluster_[s], sign);
    cluster_sign_[at(cluster_[s])] = static_cast<std::int8_t>(sign);
  }
}

// Greedy contraction leaves single clusters that all their borders together would rather see turned
// over.
void Orienter::flipClusters() {
  const std::size_t n = cluster_.size();
  std::vector<std::uint32_t> offset(n + 1, 0);
  for (const auto& e : edges_) {
    ++offset[at(e.a) + 1];
    ++offset[at(e.b) + 1];
  }
  std::partial_sum(offset.begin(), offset.end(), offset.begin());
  std::vector<std::uint32_t> incident(offset.back());
  std::vector<std::uint32_t> next(offset.begin(), offset.end() - 1);
  for (std::uint32_t e = 0; e < edges_.size(); ++e) {
    incident[next[at(edges_[e].a)]++] = e;
    incident[next[at(edges_[e].b)]++] = e;
  }
  constexpr int kRounds = 50;  // each flip lowers the energy; a few rounds are the rule
  for (int round = 0; round < kRounds; ++round) {
    bool moved = false;
    for (std::size_t c = 0; c < n; ++c) {
      float against = 0.F;
      for (std::uint32_t k = offset[c]; k < offset[c + 1]; ++k) {
        const auto& e = edges_[incident[k]];
        against -= e.weight * static_cast<float>(cluster_sign_[at(e.a)] * cluster_sign_[at(e.b)]);
      }
      if (against > 1e-3F) {
        cluster_sign_[c] = static_cast<std::int8_t>(-cluster_sign_[c]);
        moved = true;
      }
    }
    if (!moved) break;
  }
}

void Orienter::numberComponents() {
  const std::size_t n = cluster_.size();
  std::vector<std::uint32_t> size(n, 0);
  signs_.resize(n);
  for (std::size_t s = 0; s < n; ++s) {
    size[at(root_[at(cluster_[s])])] += segmentation_.segments[s].size;
    signs_[s] = static_cast<std::int8_t>(in_cluster_[s] * cluster_sign_[at(cluster_[s])]);
  }
  std::vector<std::int32_t> order;
  for (std::size_t s = 0; s < n; ++s) {
    if (size[s] > 0) order.push_back(static_cast<std::int32_t>(s));
  }
  std::stable_sort(order.begin(), order.end(),
                   [&](std::int32_t a, std::int32_t b) { return size[at(a)] > size[at(b)]; });
  std::vector<std::int32_t> rank(n, -1);
  for (std::size_t c = 0; c < order.size(); ++c) rank[at(order[c])] = static_cast<std::int32_t>(c);
  component_.resize(n);
  for (std::size_t s = 0; s < n; ++s) component_[s] = rank[at(root_[at(cluster_[s])])];
  winding_.assign(order.size(), ComponentWinding{});
  out_.result.components.resize(order.size());
  for (std::size_t c = 0; c < order.size(); ++c) {
    out_.result.components[c].points = size[at(order[c])];
  }
}

std::vector<float> Orienter::orientedNormals(bool dipoles) const {
  std::vector<float> out(4 * points_.size, 0.F);
  for (std::size_t i = 0; i < points_.size; ++i) {
    const float h = field_.spacing[i];
    // The mean distance to the 6 nearest of points of density 1/a is 0.977 sqrt(a).
    const float area = dipoles ? 1.047F * h * h : 1.F;
    const float sign = pointSign(i);
    if (sign == 0.F) continue;
    for (std::size_t a = 0; a < 3; ++a) out[4 * i + a] = sign * area * field_.normals[4 * i + a];
    out[4 * i + 3] = area;
  }
  return out;
}

void Orienter::turnComponentsOut() {
  const std::size_t count = winding_.size();
  if (options_.wind_components) {
    std::vector<float> spacing(field_.spacing, field_.spacing + points_.size);
    std::vector<std::int32_t> component(points_.size, -1);
    for (std::size_t i = 0; i < points_.size; ++i) {
      if (segmentation_.labels[i] >= 0) component[i] = component_[at(segmentation_.labels[i])];
    }
    winding_ = solveComponents(points_, orientedNormals(true), spacing, component, count,
                               options_.threads);
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

// How far each cluster's borders agree with the signs found, -1 to 1.
std::vector<float> Orienter::clusterAgreement() const {
  std::vector<float> agreed(cluster_.size(), 0.F);
  std::vector<float> absolute(cluster_.size(), 0.F);
  for (const ClusterGraph::Edge& e : edges_) {
    const float w = e.weight * static_cast<float>(cluster_sign_[at(e.a)] * cluster_sign_[at(e.b)]);
    for (const std::int32_t c : {e.a, e.b}) {
      agreed[at(c)] += w;
      absolute[at(c)] += e.absolute;
    }
  }
  for (std::size_t c = 0; c < agreed.size(); ++c) {
    if (absolute[c] > 0.F) agreed[c] /= absolute[c];
  }
  return agreed;
}

// Turns over clusters that nearly all of the ballot is against, unless their borders know better.
void Orienter::turnClusters(const std::vector<Ballot>& ballots, float sure_borders) {
  constexpr float kClearly = 0.6F;  // four of five votes
  const std::vector<float> agreement = clusterAgreement();
  for (std::size_t s = 0; s < signs_.size(); ++s) {
    const std::size_t c = at(cluster_[s]);
    if (agreement[c] > sure_borders || ballots[c].share() >= -kClearly) continue;
    signs_[s] = static_cast<std::int8_t>(-signs_[s]);
  }
}

void Orienter::followHints() {
  constexpr float kFirmBorders = 0.9F;  // what is known of single points
  constexpr float kSureBorders = 0.5F;  // what could have been seen
  const std::vector<HintVotes> votes = detail::hintVotes(points_, field_, segmentation_, hints_);
  std::vector<HintVotes> by_cluster(cluster_.size());
  std::vector<std::int32_t> component_of(cluster_.size(), -1);
  for (std::size_t s = 0; s < cluster_.size(); ++s) {
    by_cluster[at(cluster_[s])].add(votes[s], signs_[s]);
    component_of[at(cluster_[s])] = component_[s];
  }
  hinted_.assign(cluster_.size(), false);
  std::vector<Ballot> seen(cluster_.size());
  std::vector<Ballot> known(cluster_.size());
  for (std::size_t c = 0; c < cluster_.size(); ++c) {
    if (component_of[c] < 0) continue;
    const HintVotes& v = by_cluster[c];
    if (v.seeds.total > 0.F || v.directions.total > 0.F) {
      known[c] = v.seeds.total > 0.F ? v.seeds : v.directions;
      hinted_[c] = true;
    } else if (!isClosed(at(component_of[c]), kClosedResidual)) {
      seen[c] = v.view;
    }
  }
  turnClusters(known, kFirmBorders);
  turnClusters(seen, kSureBorders);
}

// If all that the largest cluster knows was seen from one place, so was the rest: other clusters
// that turn their backs to it are turned over. Closed surfaces are never seen from one place, and
// have the winding number.
void Orienter::followViewpoint() {
  constexpr float kOnePlace = 0.97F;
  constexpr float kSureBorders = 0.5F;  // then the borders know better
  if (winding_.empty() || hints_.has_viewpoint || isClosed(0, kClosedResidual)) return;
  std::vector<std::uint32_t> size(cluster_.size(), 0);
  for (std::size_t s = 0; s < cluster_.size(); ++s) {
    size[at(cluster_[s])] += segmentation_.segments[s].size;
  }
  const auto largest =
      static_cast<std::int32_t>(std::max_element(size.begin(), size.end()) - size.begin());
  // Less than half of the cloud shows too little of what the sensor saw.
  if (2 * static_cast<std::size_t>(size[at(largest)]) < points_.size) return;
  std::vector<std::uint32_t> rows;
  for (std::size_t i = 0; i < points_.size; ++i) {
    const std::int32_t s = segmentation_.labels[i];
    if (s >= 0 && cluster_[at(s)] == largest && field_.reliable[i] != 0) {
      rows.push_back(static_cast<std::uint32_t>(i));
    }
  }
  const ViewpointFit fit = fitViewpoint(points_, orientedNormals(false), rows, options_.threads);
  out_.viewpoint_agreement = fit.agreement;
  if (fit.agreement < kOnePlace) return;
  PointHints inferred;
  inferred.has_viewpoint = true;
  inferred.viewpoint = fit.position;
  const std::vector<HintVotes> votes = detail::hintVotes(points_, field_, segmentation_, inferred);
  std::vector<Ballot> facing(cluster_.size());
  for (std::size_t s = 0; s < cluster_.size(); ++s) {
    const std::size_t c = at(cluster_[s]);
    if (!hinted_[c]) facing[c].add(votes[s].view, signs_[s] * fit.facing);
  }
  turnClusters(facing, kSureBorders);
}

void Orienter::findContradictions() {
  // Unanimous borders about as long as the object is wide: noise does not produce those.
  const auto long_enough = static_cast<std::uint32_t>(
      std::max(20.0, 0.5 * std::sqrt(static_cast<double>(points_.size))));
  for (const BorderVote& v : votes_) {
    if (v.unanimity() < 0.9F || v.count < long_enough || v.reliable < 0.8F * v.absolute) continue;
    const float agreed = v.weight * static_cast<float>(signs_[at(v.a)] * signs_[at(v.b)]);
    if (agreed >= 0.F) continue;
    const float* p = points_[static_cast<std::size_t>(v.where)];
    out_.contradictions.push_back({v.a, v.b, -agreed, {p[0], p[1], p[2]}});
  }
  std::stable_sort(
      out_.contradictions.begin(), out_.contradictions.end(),
      [](const Contradiction& x, const Contradiction& y) { return x.weight > y.weight; });
}

// A segment's confidence: how far its borders agree with the signs that were found.
void Orienter::judge() {
  const std::size_t n = signs_.size();
  std::vector<float> agreed(n, 0.F);
  std::vector<float> absolute(n, 0.F);
  for (const BorderVote& v : votes_) {
    const float w = v.weight * static_cast<float>(signs_[at(v.a)] * signs_[at(v.b)]);
    for (const std::int32_t s : {v.a, v.b}) {
      agreed[at(s)] += w;
      absolute[at(s)] += v.absolute;
    }
  }
  out_.result.segments.resize(n);
  for (std::size_t s = 0; s < n; ++s) {
    SegmentOrientationResult& r = out_.result.segments[s];
    r.sign = signs_[s];
    r.by = DecidedBy::GLOBAL;
    r.component = component_[s];
    const float component_confidence = out_.result.components[at(component_[s])].confidence;
    r.confidence =
        absolute[s] > 0.F ? std::clamp(agreed[s] / absolute[s], 0.F, 1.F) : component_confidence;
    r.hard = absolute[s] > 0.F ? agreed[s] <= 0.F : component_confidence <= 0.F;
  }
  findContradictions();
  out_.clusters = cluster_;
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
                             const AutoOrientationOptions& options, const PointHints& hints) {
  return Orienter(points, neighborhoods, field, segmentation, options, hints).run();
}

}  // namespace segorient
