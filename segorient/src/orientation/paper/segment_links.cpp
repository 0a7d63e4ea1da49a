// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/paper/segment_links.h"

#include <algorithm>
#include <tuple>

namespace segorient {
namespace {

int rowEnd(const Neighborhoods& neighborhoods, std::size_t row, int k) {
  const int count = neighborhoods.count(row);
  return k > 0 ? std::min(count - 1, k) + 1 : count;
}

// For each point the point of a regular segment that it is nearest to in steps, -1 where none is
// reached. Points of regular segments are their own source.
std::vector<pcl::index_t> nearestRegularPoints(const Segmentation& segmentation,
                                               const Neighborhoods& neighborhoods, int k) {
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
    for (int j = 1; j < rowEnd(neighborhoods, i, k); ++j) {
      if (isRegular(segmentation, segmentation.labels[static_cast<std::size_t>(row[j])])) {
        source[i] = row[j];
        front.push_back(static_cast<pcl::index_t>(i));
        break;
      }
    }
  }
  while (!front.empty()) {
    next.clear();
    for (const pcl::index_t p : front) {
      const auto i = static_cast<std::size_t>(p);
      const pcl::index_t* row = neighborhoods.indices(i);
      for (int j = 1; j < rowEnd(neighborhoods, i, k); ++j) {
        const auto q = static_cast<std::size_t>(row[j]);
        if (source[q] >= 0) continue;
        source[q] = source[i];
        next.push_back(row[j]);
      }
    }
    front.swap(next);
  }
  return source;
}

struct LabelledPair {
  std::int32_t a;
  std::int32_t b;
  BorderPair pair;
};

bool operator<(const LabelledPair& l, const LabelledPair& r) {
  return std::tie(l.a, l.b, l.pair.in_a, l.pair.in_b) <
         std::tie(r.a, r.b, r.pair.in_a, r.pair.in_b);
}

// Pairs of regular points that face each other across points of small segments.
std::vector<LabelledPair> bridgingPairs(const Segmentation& segmentation,
                                        const Neighborhoods& neighborhoods, int k) {
  const std::vector<pcl::index_t> source = nearestRegularPoints(segmentation, neighborhoods, k);
  std::vector<LabelledPair> pairs;
  for (std::size_t i = 0; i < source.size(); ++i) {
    if (source[i] < 0 || source[i] == static_cast<pcl::index_t>(i)) continue;
    const pcl::index_t* row = neighborhoods.indices(i);
    const std::int32_t label = segmentation.labels[static_cast<std::size_t>(source[i])];
    for (int j = 1; j < rowEnd(neighborhoods, i, k); ++j) {
      const pcl::index_t other = source[static_cast<std::size_t>(row[j])];
      if (other < 0) continue;
      const std::int32_t other_label = segmentation.labels[static_cast<std::size_t>(other)];
      if (other_label == label) continue;
      if (label < other_label) pairs.push_back({label, other_label, {source[i], other}});
      if (label > other_label) pairs.push_back({other_label, label, {other, source[i]}});
    }
  }
  std::sort(pairs.begin(), pairs.end());
  const auto same = [](const LabelledPair& l, const LabelledPair& r) {
    return l.pair.in_a == r.pair.in_a && l.pair.in_b == r.pair.in_b;
  };
  pairs.erase(std::unique(pairs.begin(), pairs.end(), same), pairs.end());
  return pairs;
}

void appendDirectLinks(const Segmentation& segmentation, const SegmentGraph& graph,
                       SegmentLinks& out) {
  for (const SegmentBorder& border : graph.borders) {
    if (!isRegular(segmentation, border.a) || !isRegular(segmentation, border.b)) continue;
    out.links.push_back(
        {border.a, border.b, static_cast<std::uint32_t>(out.pairs.size()), border.size, false});
    const auto begin = graph.pairs.begin() + border.first;
    out.pairs.insert(out.pairs.end(), begin, begin + border.size);
  }
}

void appendBridgedLinks(const std::vector<LabelledPair>& pairs, SegmentLinks& out) {
  const std::size_t direct = out.links.size();
  const auto before = [](const SegmentLink& l, const SegmentLink& r) {
    return std::tie(l.a, l.b) < std::tie(r.a, r.b);
  };
  for (std::size_t i = 0; i < pairs.size();) {
    std::size_t j = i;
    while (j < pairs.size() && pairs[j].a == pairs[i].a && pairs[j].b == pairs[i].b) ++j;
    SegmentLink link{pairs[i].a, pairs[i].b, static_cast<std::uint32_t>(out.pairs.size()),
                     static_cast<std::uint32_t>(j - i), true};
    const auto end = out.links.begin() + static_cast<std::ptrdiff_t>(direct);
    if (!std::binary_search(out.links.begin(), end, link, before)) {
      for (std::size_t t = i; t < j; ++t) out.pairs.push_back(pairs[t].pair);
      out.links.push_back(link);
    }
    i = j;
  }
  std::sort(out.links.begin(), out.links.end(), before);
}

void indexBySegment(const Segmentation& segmentation, SegmentLinks& out) {
  const std::size_t segments = segmentation.segments.size();
  out.offsets.assign(segments + 1, 0);
  for (const SegmentLink& link : out.links) {
    ++out.offsets[static_cast<std::size_t>(link.a) + 1];
    ++out.offsets[static_cast<std::size_t>(link.b) + 1];
  }
  for (std::size_t s = 0; s < segments; ++s) out.offsets[s + 1] += out.offsets[s];
  std::vector<std::uint32_t> cursor(out.offsets.begin(), out.offsets.end() - 1);
  out.incident.resize(2 * out.links.size());
  for (std::size_t i = 0; i < out.links.size(); ++i) {
    out.incident[cursor[static_cast<std::size_t>(out.links[i].a)]++] =
        static_cast<std::uint32_t>(i);
    out.incident[cursor[static_cast<std::size_t>(out.links[i].b)]++] =
        static_cast<std::uint32_t>(i);
  }
  const auto sizeOf = [&](std::size_t segment, std::uint32_t link) {
    const std::int32_t other = out.links[link].other(static_cast<std::int32_t>(segment));
    return segmentation.segments[static_cast<std::size_t>(other)].size;
  };
  for (std::size_t s = 0; s < segments; ++s) {
    std::stable_sort(out.incident.begin() + out.offsets[s],
                     out.incident.begin() + out.offsets[s + 1],
                     [&](std::uint32_t l, std::uint32_t r) { return sizeOf(s, l) > sizeOf(s, r); });
  }
}

}  // namespace

bool isRegular(const Segmentation& segmentation, std::int32_t label) {
  if (label < 0) return false;
  const Segment& segment = segmentation.segments[static_cast<std::size_t>(label)];
  return segment.kind == SegmentKind::REGULAR && segment.size > 0;
}

SegmentLinks linkRegularSegments(const Segmentation& segmentation, const SegmentGraph& graph,
                                 const Neighborhoods& neighborhoods, int k) {
  SegmentLinks out;
  appendDirectLinks(segmentation, graph, out);
  appendBridgedLinks(bridgingPairs(segmentation, neighborhoods, k), out);
  indexBySegment(segmentation, out);
  return out;
}

}  // namespace segorient
