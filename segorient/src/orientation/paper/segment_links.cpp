// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/paper/segment_links.h"

#include <algorithm>
#include <tuple>

#include "common/at.h"
#include "segmentation/segment_graph.h"

namespace segorient {
namespace {

// For each point the point of a regular segment that it is nearest to in steps, -1 where none is
// reached. Points of regular segments are their own source.
std::vector<pcl::index_t> nearestRegularPoints(const Segmentation& segmentation,
                                               const Neighborhoods& neighborhoods) {
  const std::size_t n = segmentation.labels.size();
  std::vector<pcl::index_t> source(n, -1);
  std::vector<pcl::index_t> front;
  std::vector<pcl::index_t> next;
  for (std::size_t i = 0; i < n; ++i) {
    if (isRegular(segmentation, segmentation.labels[i])) source[i] = static_cast<pcl::index_t>(i);
  }
  // The first step looks from the strip's points, so that all regular points need not be visited.
  for (std::size_t i = 0; i < n; ++i) {
    if (source[i] >= 0) continue;
    const pcl::index_t* row = neighborhoods.indices(i);
    for (int j = 1; j < neighborhoods.count(i); ++j) {
      if (isRegular(segmentation, segmentation.labels[at(row[j])])) {
        source[i] = row[j];
        front.push_back(static_cast<pcl::index_t>(i));
        break;
      }
    }
  }
  while (!front.empty()) {
    next.clear();
    for (const pcl::index_t p : front) {
      const pcl::index_t* row = neighborhoods.indices(at(p));
      for (int j = 1; j < neighborhoods.count(at(p)); ++j) {
        if (source[at(row[j])] >= 0) continue;
        source[at(row[j])] = source[at(p)];
        next.push_back(row[j]);
      }
    }
    front.swap(next);
  }
  return source;
}

// Pairs of regular points that face each other across points of small segments.
std::vector<LabelledPair> bridgingPairs(const Segmentation& segmentation,
                                        const Neighborhoods& neighborhoods) {
  const std::vector<pcl::index_t> source = nearestRegularPoints(segmentation, neighborhoods);
  std::vector<LabelledPair> pairs;
  for (std::size_t i = 0; i < source.size(); ++i) {
    if (source[i] < 0 || source[i] == static_cast<pcl::index_t>(i)) continue;
    const pcl::index_t* row = neighborhoods.indices(i);
    const std::int32_t label = segmentation.labels[at(source[i])];
    for (int j = 1; j < neighborhoods.count(i); ++j) {
      const pcl::index_t other = source[at(row[j])];
      if (other < 0 || segmentation.labels[at(other)] == label) continue;
      pairs.push_back(labelled(label, source[i], segmentation.labels[at(other)], other));
    }
  }
  const auto inOrder = [](const LabelledPair& l, const LabelledPair& r) {
    return std::tie(l.a, l.b, l.pair.in_a, l.pair.in_b) <
           std::tie(r.a, r.b, r.pair.in_a, r.pair.in_b);
  };
  std::sort(pairs.begin(), pairs.end(), inOrder);
  return pairs;
}

std::vector<LabelledPair> directPairs(const Segmentation& segmentation, const SegmentGraph& graph) {
  std::vector<LabelledPair> pairs;
  for (const SegmentBorder& border : graph.borders) {
    if (!isRegular(segmentation, border.a) || !isRegular(segmentation, border.b)) continue;
    for (std::uint32_t i = border.first; i < border.first + border.size; ++i) {
      pairs.push_back({border.a, border.b, graph.pairs[i]});
    }
  }
  return pairs;
}

template <typename Labelled>
bool before(const SegmentBorder& l, const Labelled& r) {
  return std::tie(l.a, l.b) < std::tie(r.a, r.b);
}

}  // namespace

bool isRegular(const Segmentation& segmentation, std::int32_t label) {
  if (label < 0) return false;
  const Segment& segment = segmentation.segments[at(label)];
  return segment.kind == SegmentKind::REGULAR && segment.size > 0;
}

SegmentGraph linkRegularSegments(const Segmentation& segmentation, const SegmentGraph& graph,
                                 const Neighborhoods& neighborhoods) {
  SegmentGraph out;
  appendBorders(directPairs(segmentation, graph), out);
  std::vector<LabelledPair> bridges = bridgingPairs(segmentation, neighborhoods);
  const auto isDirect = [&](const LabelledPair& p) {
    const auto at_least =
        std::lower_bound(out.borders.begin(), out.borders.end(), p, before<LabelledPair>);
    return at_least != out.borders.end() && at_least->a == p.a && at_least->b == p.b;
  };
  bridges.erase(std::remove_if(bridges.begin(), bridges.end(), isDirect), bridges.end());
  appendBorders(bridges, out);
  std::sort(out.borders.begin(), out.borders.end(), before<SegmentBorder>);
  listIncident(segmentation.segments.size(), out);
  for (std::size_t s = 0; s < segmentation.segments.size(); ++s) {
    const auto sizeOfOther = [&](std::uint32_t link) {
      const std::int32_t other = otherOf(out.borders[link], static_cast<std::int32_t>(s));
      return segmentation.segments[at(other)].size;
    };
    std::stable_sort(
        out.incident.begin() + out.offsets[s], out.incident.begin() + out.offsets[s + 1],
        [&](std::uint32_t l, std::uint32_t r) { return sizeOfOther(l) > sizeOfOther(r); });
  }
  return out;
}

}  // namespace segorient
