// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "segmentation/segment_graph.h"
#include "segmentation_support.h"

namespace segorient::test {
namespace {

using Pairs = std::set<std::pair<pcl::index_t, pcl::index_t>>;

TEST(SegmentGraph, EqualsBruteForce) {
  const Prepared in(sample("bracket", bracket(), 5000, 21, 0.2));
  const Segmentation s = in.segment();
  for (const int k : {0, 4, 12, 100}) {
    const int used = k > 0 ? std::min(k + 1, in.table.k()) : in.table.k();
    std::map<std::pair<std::int32_t, std::int32_t>, Pairs> expected;
    for (std::size_t p = 0; p < in.cloud.size(); ++p) {
      for (int j = 1; j < std::min(used, in.table.count(p)); ++j) {
        const pcl::index_t q = in.table.indices(p)[j];
        const std::int32_t a = s.labels[p];
        const std::int32_t b = s.labels[static_cast<std::size_t>(q)];
        if (a < 0 || b < 0 || a == b) continue;
        const auto index = static_cast<pcl::index_t>(p);
        if (a < b) {
          expected[{a, b}].insert({index, q});
        } else {
          expected[{b, a}].insert({q, index});
        }
      }
    }
    const SegmentGraph graph = buildSegmentGraph(s, in.table, k);
    ASSERT_EQ(graph.borders.size(), expected.size());
    std::size_t at = 0;
    for (const auto& [labels, pairs] : expected) {
      const SegmentBorder& border = graph.borders[at++];
      EXPECT_EQ(border.a, labels.first);
      EXPECT_EQ(border.b, labels.second);
      ASSERT_EQ(border.size, pairs.size());
      std::size_t i = border.first;
      for (const auto& [in_a, in_b] : pairs) {
        EXPECT_EQ(graph.pairs[i].in_a, in_a);
        EXPECT_EQ(graph.pairs[i].in_b, in_b);
        ++i;
      }
    }
    ASSERT_EQ(graph.offsets.size(), s.segments.size() + 1);
    EXPECT_EQ(graph.incident.size(), 2 * graph.borders.size());
    for (std::size_t segment = 0; segment < s.segments.size(); ++segment) {
      std::set<std::uint32_t> of_segment;
      for (std::uint32_t i = 0; i < graph.borders.size(); ++i) {
        const auto label = static_cast<std::int32_t>(segment);
        if (graph.borders[i].a == label || graph.borders[i].b == label) of_segment.insert(i);
      }
      const std::set<std::uint32_t> listed(graph.incident.begin() + graph.offsets[segment],
                                           graph.incident.begin() + graph.offsets[segment + 1]);
      EXPECT_EQ(listed, of_segment);
    }
  }
}

TEST(SegmentGraph, EmptyOrForeign) {
  const SegmentGraph none = buildSegmentGraph({}, {});
  EXPECT_TRUE(none.borders.empty());
  const Prepared in(sample("cube", cube(), 500, 1));
  const SegmentGraph foreign = buildSegmentGraph(in.segment(), {});
  EXPECT_TRUE(foreign.borders.empty());
  EXPECT_FALSE(foreign.offsets.empty());
}

}  // namespace
}  // namespace segorient::test
