// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/automatic/loose_parts.h"

#include <algorithm>
#include <map>
#include <utility>

#include "common/at.h"
#include "orientation/automatic/cluster_graph.h"
#include "orientation/winding/winding_components.h"

namespace segorient::detail {
namespace {

// Parts that three of four votes or more agree with are not loose.
constexpr float kLoose = 0.5F;

}  // namespace

std::vector<float> agreementOf(const std::vector<std::int32_t>& part_of,
                               const std::vector<BorderVote>& votes,
                               const std::vector<std::int8_t>& signs, float without) {
  // As between clusters, walls have their say where two parts do not meet on one sheet as well.
  std::map<std::pair<std::int32_t, std::int32_t>, ClusterGraph::Edge> borders;
  for (const BorderVote& v : votes) {
    const std::int32_t a = part_of[at(v.a)];
    const std::int32_t b = part_of[at(v.b)];
    if (a == b) continue;
    const auto sign = static_cast<float>(signs[at(v.a)] * signs[at(v.b)]);
    borders[std::minmax(a, b)].add(ClusterGraph::Edge(v), sign);
  }
  std::vector<Evidence> all(part_of.size());
  for (const auto& [parts, border] : borders) {
    all[at(parts.first)].add(border);
    all[at(parts.second)].add(border);
  }
  std::vector<float> agreed(part_of.size(), without);
  for (std::size_t p = 0; p < agreed.size(); ++p) {
    if (all[p].absolute > 0.F) agreed[p] = all[p].weight / all[p].absolute;
  }
  return agreed;
}

LooseParts findLooseParts(const Segmentation& segmentation, const std::vector<BorderVote>& votes,
                          const std::vector<std::int8_t>& signs,
                          const std::vector<std::int32_t>& component,
                          const std::vector<std::int32_t>& part_of,
                          const std::vector<bool>& looked_at) {
  const std::size_t n = part_of.size();
  std::vector<std::uint32_t> size(n, 0);
  for (std::size_t s = 0; s < n; ++s) size[at(part_of[s])] += segmentation.segments[s].size;
  const std::vector<float> agreement = agreementOf(part_of, votes, signs, 1.F);
  LooseParts out;
  out.components = out.count = looked_at.size();
  std::vector<std::int32_t> number(n, -1);
  for (std::size_t s = 0; s < n; ++s) {
    const std::int32_t part = part_of[s];
    if (number[at(part)] < 0) {
      // The largest, too: it may be the only one that is turned wrongly.
      const bool loose = looked_at[at(component[s])] && size[at(part)] >= kLeastSamples &&
                         agreement[at(part)] < kLoose;
      number[at(part)] = loose ? static_cast<std::int32_t>(out.count++) : component[s];
    }
    out.of.push_back(number[at(part)]);
  }
  return out;
}

}  // namespace segorient::detail
