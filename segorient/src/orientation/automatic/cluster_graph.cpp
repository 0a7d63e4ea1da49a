// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/automatic/cluster_graph.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "common/at.h"

namespace segorient {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

}  // namespace

struct ClusterGraph::Candidate {
  float key;
  float weight;  // as it was when pushed: another one since means outdated
  std::uint32_t edge;
  bool operator<(const Candidate& o) const { return key != o.key ? key < o.key : edge > o.edge; }
};

ClusterGraph::Edge::Edge(const BorderVote& vote)
    : Evidence(vote), a(vote.a), b(vote.b), sheet(vote.sheet()), wall(vote.wall) {}

void ClusterGraph::Edge::decide() {
  static_cast<Evidence&>(*this) = sheet;
  if (sheet.letsCount(wall)) Evidence::add(wall);
}

void ClusterGraph::Edge::add(const Edge& o, float sign) {
  sheet.add(o.sheet, sign);
  wall.add(o.wall, sign);
  decide();
}

ClusterGraph::ClusterGraph(const std::vector<std::uint32_t>& sizes,
                           const std::vector<BorderVote>& votes)
    : incident_(sizes.size()), sizes_(sizes), parent_(sizes.size()), parity_(sizes.size(), 1) {
  std::iota(parent_.begin(), parent_.end(), 0);
  edges_.reserve(votes.size());
  for (const BorderVote& v : votes) {
    incident_[at(v.a)].push_back(static_cast<std::uint32_t>(edges_.size()));
    incident_[at(v.b)].push_back(static_cast<std::uint32_t>(edges_.size()));
    edges_.emplace_back(v);
  }
}

std::int32_t ClusterGraph::find(std::int32_t segment, int& sign) const {
  // Without path compression: what has fewer borders joins what has more, so paths are short.
  sign = 1;
  while (parent_[at(segment)] != segment) {
    sign *= parity_[at(segment)];
    segment = parent_[at(segment)];
  }
  return segment;
}

std::uint32_t ClusterGraph::edgeBetween(std::int32_t a, std::int32_t b) const {
  if (incident_[at(a)].size() > incident_[at(b)].size()) std::swap(a, b);
  for (const std::uint32_t e : incident_[at(a)]) {
    if (edges_[e].alive && other(e, a) == b) return e;
  }
  return kNone;
}

bool ClusterGraph::allowed(const Edge& e, const Rule& rule) const {
  const float w = std::fabs(e.weight);
  return w > 0.F && w >= rule.weight && e.unanimity() >= rule.unanimity &&
         e.reliable >= rule.reliable * e.absolute &&
         std::min(sizes_[at(e.a)], sizes_[at(e.b)]) <= rule.both_larger;
}

bool ClusterGraph::allowed(const Edge& e, const std::vector<Rule>& rules) const {
  return std::any_of(rules.begin(), rules.end(),
                     [&](const Rule& rule) { return allowed(e, rule); });
}

void ClusterGraph::push(std::vector<Candidate>& heap, std::uint32_t edge,
                        const std::vector<Rule>& rules) const {
  const Edge& e = edges_[edge];
  if (!allowed(e, rules)) return;
  heap.push_back({std::fabs(e.weight) * e.unanimity(), e.weight, edge});
  std::push_heap(heap.begin(), heap.end());
}

void ClusterGraph::merge(std::int32_t keep, std::int32_t gone, int sign,
                         const std::vector<Rule>& rules, std::vector<Candidate>& heap) {
  parent_[at(gone)] = keep;
  parity_[at(gone)] = static_cast<std::int8_t>(sign);
  sizes_[at(keep)] += sizes_[at(gone)];
  sizes_[at(gone)] = 0;
  std::vector<std::uint32_t> theirs;
  theirs.swap(incident_[at(gone)]);
  for (const std::uint32_t e : theirs) {
    Edge& edge = edges_[e];
    if (!edge.alive) continue;
    const std::int32_t third = other(e, gone);
    if (third == keep) {
      edge.alive = false;
      continue;
    }
    const std::uint32_t twin = edgeBetween(keep, third);
    if (twin != kNone) {
      edges_[twin].add(edge, static_cast<float>(sign));
      edge.alive = false;
      push(heap, twin, rules);
    } else {
      (edge.a == gone ? edge.a : edge.b) = keep;
      for (Evidence* part : {static_cast<Evidence*>(&edge), &edge.sheet, &edge.wall}) {
        part->weight *= static_cast<float>(sign);
      }
      incident_[at(keep)].push_back(e);
      push(heap, e, rules);
    }
  }
}

void ClusterGraph::contract(const std::vector<Rule>& rules) {
  std::vector<Candidate> heap;
  for (std::uint32_t e = 0; e < edges_.size(); ++e) {
    if (edges_[e].alive) push(heap, e, rules);
  }
  while (!heap.empty()) {
    std::pop_heap(heap.begin(), heap.end());
    const Candidate c = heap.back();
    heap.pop_back();
    const Edge& e = edges_[c.edge];
    if (!e.alive || e.weight != c.weight || !allowed(e, rules)) continue;
    const int sign = e.weight > 0.F ? 1 : -1;
    const bool keep_a = incident_[at(e.a)].size() >= incident_[at(e.b)].size();
    merge(keep_a ? e.a : e.b, keep_a ? e.b : e.a, sign, rules, heap);
  }
}

std::vector<ClusterGraph::Edge> ClusterGraph::edges() const {
  std::vector<Edge> out;
  for (const Edge& e : edges_) {
    if (e.alive) out.push_back(e);
  }
  return out;
}

std::vector<std::int32_t> ClusterGraph::clusters() const {
  std::vector<std::int32_t> out;
  for (std::size_t i = 0; i < parent_.size(); ++i) {
    if (parent_[i] == static_cast<std::int32_t>(i)) out.push_back(static_cast<std::int32_t>(i));
  }
  return out;
}

}  // namespace segorient
