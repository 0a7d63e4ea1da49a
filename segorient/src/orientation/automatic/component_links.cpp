// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/automatic/component_links.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

#include "common/at.h"
#include "common/dot.h"
#include "common/every_nth.h"
#include "common/parallel_for.h"
#include "orientation/automatic/border_votes.h"
#include "orientation/automatic/cluster_graph.h"
#include "orientation/mirrored_agreement.h"
#include "search/index_of.h"

namespace segorient::detail {
namespace {

constexpr std::size_t kAsked = 32;  // points of a component: a share of them is known to a tenth
constexpr std::size_t kVotes = 8;   // as many as are around a point, for each
// Neighbours that are looked at for those: a row of some hundred points, from its middle.
constexpr int kFirstLook = 64;
constexpr int kLastLook = 1024;

// One node for all components that are decided, one for each other one.
class Links {
 public:
  Links(const SheetSigns& sheets, const std::vector<bool>& known,
        const std::vector<ComponentOrientationResult>& components)
      : sheets_(sheets), components_(components), node_(components.size(), -1) {
    const std::vector<std::size_t> sizes = sheets.componentSizes();
    for (std::size_t c = 0; c < components.size(); ++c) {
      if (sizes[c] < kLeastSamples) continue;
      const bool land = sheets.ground[c] && !sheets.looksClosed(c, kOpenResidual);
      const bool open = components[c].by == DecidedBy::NOTHING && !known[c] && !land;
      node_[c] = open ? static_cast<std::int32_t>(open_.size() + 1) : 0;
      if (open) open_.push_back(c);
    }
  }

  bool none() const { return open_.empty(); }

  void follow(std::vector<ComponentOrientationResult>& components) const {
    // The sizes do not count.
    ClusterGraph graph(std::vector<std::uint32_t>(open_.size() + 1, 1), castVotes());
    ClusterGraph::Rule clear;
    clear.unanimity = kClearly;
    graph.contract({clear});
    int decided = 1;
    const std::int32_t root = graph.find(0, decided);
    std::vector<std::int8_t> turn(open_.size() + 1, 0);  // by cluster, what its largest asks for
    turn[at(root)] = static_cast<std::int8_t>(decided);
    for (std::size_t i = 0; i < open_.size(); ++i) {
      int sign = 1;
      const std::int32_t cluster = graph.find(static_cast<std::int32_t>(i + 1), sign);
      ComponentOrientationResult& c = components[open_[i]];
      if (turn[at(cluster)] == 0) {
        turn[at(cluster)] = static_cast<std::int8_t>(sign * c.sign);
        continue;
      }
      c.sign = static_cast<std::int8_t>(sign * turn[at(cluster)]);
      c.by = DecidedBy::SURROUNDINGS;
    }
  }

 private:
  using Votes = std::vector<std::pair<std::int32_t, float>>;

  std::int32_t nodeOf(std::size_t i) const {
    const std::int32_t c = sheets_.componentOf(i);
    return c < 0 ? -1 : node_[at(c)];
  }

  // The sign of a point's normal, within an open component relative to that.
  float signOf(std::size_t i, std::int32_t node) const {
    const float sign = sheets_.pointSign(i);
    return node > 0 ? sign
                    : sign * static_cast<float>(components_[at(sheets_.componentOf(i))].sign);
  }

  // How two points agree, 0 where one lies rather before or behind the other than beside it.
  float compare(std::size_t p, std::size_t q) const {
    const float* n = sheets_.field.normals + 4 * p;
    const float* m = sheets_.field.normals + 4 * q;
    std::array<float, 3> chord{};
    for (std::size_t a = 0; a < 3; ++a) chord[a] = sheets_.points[q][a] - sheets_.points[p][a];
    const float square = dot(chord.data(), chord.data());
    const float above = std::max(std::fabs(dot(n, chord.data())), std::fabs(dot(m, chord.data())));
    if (!(square > 0.F && 2.F * above * above <= square)) return 0.F;
    return mirroredAgreement(n, m, chord.data(), square);
  }

  void vote(const search::MedianHashIndex& index, std::size_t p, Votes& out) const {
    const std::int32_t own = nodeOf(p);
    std::vector<pcl::index_t> rows;
    std::vector<float> squared;
    std::vector<std::size_t> others;
    for (int k = kFirstLook; k <= kLastLook && others.size() < kVotes; k *= 2) {
      rows.resize(at(k));
      squared.resize(at(k));
      const int found = index.nearestK(sheets_.points[p], k, rows.data(), squared.data());
      others.clear();
      for (std::size_t j = 0; j < at(found) && others.size() < kVotes; ++j) {
        const std::int32_t node = nodeOf(at(rows[j]));
        if (node >= 0 && node != own) others.push_back(at(rows[j]));
      }
      if (found < k) break;
    }
    for (const std::size_t q : others) {
      const std::int32_t node = nodeOf(q);
      out.emplace_back(node, signOf(p, own) * signOf(q, node) * compare(p, q));
    }
  }

  std::vector<BorderVote> castVotes() const {
    std::vector<std::vector<std::uint32_t>> members(open_.size());
    for (std::size_t i = 0; i < sheets_.points.size; ++i) {
      const std::int32_t node = nodeOf(i);
      if (node > 0) members[at(node - 1)].push_back(static_cast<std::uint32_t>(i));
    }
    const search::MedianHashIndex index = search::indexOf(sheets_.points, sheets_.threads);
    std::vector<Votes> votes(open_.size());
    constexpr double kTime = 1e5;  // ns for a point, see resolveThreads()
    parallelFor(open_.size(), sheets_.threads, kTime * static_cast<double>(kAsked),
                [&](std::size_t c) {
                  for (const std::size_t i : EveryNth(members[c].size(), kAsked)) {
                    vote(index, members[c][i], votes[c]);
                  }
                });
    return tally(votes);
  }

  static std::vector<BorderVote> tally(const std::vector<Votes>& votes) {
    std::map<std::pair<std::int32_t, std::int32_t>, Evidence> borders;
    for (std::size_t c = 0; c < votes.size(); ++c) {
      for (const auto& [node, value] : votes[c]) {
        // Edges across a gap are no edges for sure: their cosines are small.
        borders[std::minmax(static_cast<std::int32_t>(c + 1), node)].add({value, 1.F, 1.F});
      }
    }
    std::vector<BorderVote> out;
    for (const auto& [nodes, evidence] : borders) {
      BorderVote& border = out.emplace_back();
      static_cast<Evidence&>(border) = evidence;
      std::tie(border.a, border.b) = nodes;
    }
    return out;
  }

  const SheetSigns& sheets_;
  const std::vector<ComponentOrientationResult>& components_;
  std::vector<std::int32_t> node_;  // by component, -1 for those of a few points
  std::vector<std::size_t> open_;   // components, the largest first
};

}  // namespace

void followNearest(const SheetSigns& sheets, const std::vector<bool>& known,
                   std::vector<ComponentOrientationResult>& components) {
  const Links links(sheets, known, components);
  if (!links.none()) links.follow(components);
}

}  // namespace segorient::detail
