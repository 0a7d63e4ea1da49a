// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "segmentation/segment_graph.h"

#include <algorithm>

namespace segorient {
namespace {

// Pairs of neighbours with different labels, in both directions of the table; some twice.
std::vector<LabelledPair> collectPairs(const std::vector<std::int32_t>& labels,
                                       const Neighborhoods& neighborhoods, int row_size) {
  std::vector<LabelledPair> pairs;
  for (std::size_t p = 0; p < labels.size(); ++p) {
    const std::int32_t own = labels[p];
    if (own < 0) continue;
    const pcl::index_t* row = neighborhoods.indices(p);
    const int count = std::min(neighborhoods.count(p), row_size);
    for (int j = 1; j < count; ++j) {
      const std::int32_t other = labels[static_cast<std::size_t>(row[j])];
      if (other == own || other < 0) continue;
      pairs.push_back(labelled(own, static_cast<pcl::index_t>(p), other, row[j]));
    }
  }
  return pairs;
}

// One stable pass of a counting sort.
template <typename Key>
void countingSort(std::vector<LabelledPair>& pairs, std::vector<LabelledPair>& other,
                  std::size_t keys, Key key) {
  std::vector<std::size_t> next(keys + 1, 0);
  for (const LabelledPair& p : pairs) ++next[key(p) + 1];
  for (std::size_t k = 0; k < keys; ++k) next[k + 1] += next[k];
  other.resize(pairs.size());
  for (const LabelledPair& p : pairs) other[next[key(p)]++] = p;
  pairs.swap(other);
}

// By (a, b, in_a, in_b): least significant key first, so it stays linear.
void sort(std::vector<LabelledPair>& pairs, std::size_t points, std::size_t segments) {
  std::vector<LabelledPair> other;
  countingSort(pairs, other, points,
               [](const LabelledPair& p) { return static_cast<std::size_t>(p.pair.in_b); });
  countingSort(pairs, other, points,
               [](const LabelledPair& p) { return static_cast<std::size_t>(p.pair.in_a); });
  countingSort(pairs, other, segments,
               [](const LabelledPair& p) { return static_cast<std::size_t>(p.b); });
  countingSort(pairs, other, segments,
               [](const LabelledPair& p) { return static_cast<std::size_t>(p.a); });
}

}  // namespace

void appendBorders(const std::vector<LabelledPair>& pairs, SegmentGraph& graph) {
  for (const LabelledPair& p : pairs) {
    if (graph.borders.empty() || graph.borders.back().a != p.a || graph.borders.back().b != p.b) {
      graph.borders.push_back({p.a, p.b, static_cast<std::uint32_t>(graph.pairs.size()), 0});
    } else if (graph.pairs.back().in_a == p.pair.in_a && graph.pairs.back().in_b == p.pair.in_b) {
      continue;
    }
    graph.pairs.push_back(p.pair);
    ++graph.borders.back().size;
  }
}

void listIncident(std::size_t segments, SegmentGraph& graph) {
  graph.offsets.assign(segments + 1, 0);
  for (const SegmentBorder& border : graph.borders) {
    ++graph.offsets[static_cast<std::size_t>(border.a) + 1];
    ++graph.offsets[static_cast<std::size_t>(border.b) + 1];
  }
  for (std::size_t s = 0; s < segments; ++s) graph.offsets[s + 1] += graph.offsets[s];
  graph.incident.resize(2 * graph.borders.size());
  std::vector<std::uint32_t> next(graph.offsets.begin(), graph.offsets.end() - 1);
  for (std::size_t i = 0; i < graph.borders.size(); ++i) {
    for (const std::int32_t s : {graph.borders[i].a, graph.borders[i].b}) {
      graph.incident[next[static_cast<std::size_t>(s)]++] = static_cast<std::uint32_t>(i);
    }
  }
}

SegmentGraph buildSegmentGraph(const Segmentation& segmentation, const Neighborhoods& neighborhoods,
                               int k) {
  SegmentGraph graph;
  const std::size_t segments = segmentation.segments.size();
  graph.offsets.assign(segments + 1, 0);
  if (segmentation.labels.size() != neighborhoods.size() || segments == 0) return graph;
  const int row_size = k > 0 && k < neighborhoods.k() ? k + 1 : neighborhoods.k();
  std::vector<LabelledPair> pairs = collectPairs(segmentation.labels, neighborhoods, row_size);
  sort(pairs, segmentation.labels.size(), segments);
  graph.pairs.reserve(pairs.size());
  appendBorders(pairs, graph);
  listIncident(segments, graph);
  return graph;
}

}  // namespace segorient
