// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// Votes across borders at all dihedral angles, and the contraction of what they say.
#include <gtest/gtest.h>
#include <array>
#include <random>

#include "orientation/automatic/border_votes.h"
#include "orientation/automatic/cluster_graph.h"
#include "sheet_fixture.h"

namespace segorient::test {
namespace {

// Two half planes that meet in the y axis, the second one turned by `degrees` from the first one's
// continuation; true normals, consistent.
struct Wedge {
  std::vector<float> xyz;
  std::vector<float> normals;
  Segmentation segmentation;
};

Wedge makeWedge(double degrees, unsigned seed) {
  std::mt19937 rng(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  const double t = degrees * M_PI / 180;
  Wedge w;
  for (int i = 0; i < 1200; ++i) {
    const double along = unit(rng);
    const double out = 0.5 * unit(rng);
    if (i % 2 == 0) {
      w.xyz.insert(w.xyz.end(), {static_cast<float>(-out), static_cast<float>(along), 0.F, 0.F});
      w.normals.insert(w.normals.end(), {0.F, 0.F, 1.F, 0.F});
    } else {
      w.xyz.insert(w.xyz.end(), {static_cast<float>(out * std::cos(t)), static_cast<float>(along),
                                 static_cast<float>(out * std::sin(t)), 0.F});
      w.normals.insert(w.normals.end(), {static_cast<float>(-std::sin(t)), 0.F,
                                         static_cast<float>(std::cos(t)), 0.F});
    }
    w.segmentation.labels.push_back(i % 2);
    w.segmentation.signs.push_back(1);
  }
  w.segmentation.segments.resize(2);
  w.segmentation.segments[0].size = w.segmentation.segments[1].size = 600;
  return w;
}

// \param reach how far along its normal a point's own sheet reaches
BorderVote voteOn(const Wedge& w, float reach = std::numeric_limits<float>::infinity(),
                  float h = 0.03F) {
  const Neighborhoods table = neighborsOf(w.xyz);
  const std::size_t n = w.xyz.size() / 4;
  const std::vector<float> spacing(n, h);
  const std::vector<float> below(n, -reach);
  const std::vector<float> above(n, reach);
  const std::vector<std::uint8_t> reliable(n, 1);
  SheetField field;
  field.normals = w.normals.data();
  field.spacing = spacing.data();
  field.below = below.data();
  field.above = above.data();
  field.reliable = reliable.data();
  const std::vector<BorderVote> votes = borderVotes(viewOf(w.xyz), table, field, w.segmentation);
  return votes.size() == 1 ? votes[0] : BorderVote{};
}

class DihedralAngle : public testing::TestWithParam<int> {};

TEST_P(DihedralAngle, ConsistentNormalsGetAPositiveVote) {
  Wedge w = makeWedge(GetParam(), 21);
  const BorderVote agree = voteOn(w);
  EXPECT_GT(agree.weight, 0.F);
  EXPECT_GT(agree.unanimity(), std::abs(GetParam()) < 150 ? 0.6F : 0.99F);
  for (std::size_t i = 1; i < w.segmentation.signs.size(); i += 2) w.segmentation.signs[i] = -1;
  const BorderVote differ = voteOn(w);
  EXPECT_NEAR(differ.weight, -agree.weight, 1e-3F * agree.absolute);
}

// 0 is flat, positive bends up (concave seen from the normals), negative down.
INSTANTIATE_TEST_SUITE_P(BorderVotes, DihedralAngle,
                         testing::Values(-150, -135, -90, -60, -30, 0, 30, 60, 90, 135, 150));

Wedge withNoise(Wedge wedge, float sigma, unsigned seed) {
  std::mt19937 rng(seed);
  std::normal_distribution<float> noise(0.F, sigma);
  for (std::size_t i = 0; i < wedge.xyz.size(); ++i) {
    if (i % 4 != 3) wedge.xyz[i] += noise(rng);
  }
  return wedge;
}

// Points lie some half a spacing off, and near the crease among those of the other plane.
TEST(BorderVotes, NoiseAcrossASharpCreaseDoesNotCount) {
  for (const double degrees : {-160.0, -150.0, -135.0, 135.0, 150.0, 160.0}) {
    Wedge w = withNoise(makeWedge(degrees, 24), 0.015F, 25);
    const BorderVote agree = voteOn(w);
    EXPECT_GT(agree.weight, 0.F) << degrees;
    EXPECT_GT(agree.unanimity(), 0.9F) << degrees;
    for (std::size_t i = 1; i < w.segmentation.signs.size(); i += 2) w.segmentation.signs[i] = -1;
    EXPECT_FLOAT_EQ(voteOn(w).weight, -agree.weight) << degrees;
  }
}

// Of what lies one behind the other, such as a picture on a wall, the planes tell nothing.
TEST(BorderVotes, ParallelPlanesDoNotDecide) {
  Wedge w = withNoise(makeWedge(0, 26), 0.005F, 27);
  for (std::size_t i = 0; i < w.xyz.size(); i += 8) {
    w.xyz[i] += 0.5F;
    w.xyz[i + 2] -= 0.0225F;
  }
  const BorderVote vote = voteOn(w);
  ASSERT_GT(vote.count, 16U);
  EXPECT_LT(vote.unanimity(), 0.8F);
}

// The two sides of a plate one spacing thick, which have no border but the wall between them.
TEST(BorderVotes, NormalsOnBothSidesOfAWallPointApart) {
  Wedge plate = makeWedge(0, 23);
  for (std::size_t i = 0; i < plate.xyz.size(); i += 8) {
    plate.xyz[i] += 0.5F;  // below the other half
    plate.xyz[i + 2] -= 0.03F;
    plate.normals[i + 2] = -1.F;
  }
  const BorderVote apart = voteOn(plate, 0.01F);
  EXPECT_GT(apart.weight, 0.F);
  EXPECT_GT(apart.unanimity(), 0.99F);
  for (std::size_t i = 1; i < plate.segmentation.signs.size(); i += 2) {
    plate.segmentation.signs[i] = -1;
  }
  EXPECT_FLOAT_EQ(voteOn(plate, 0.01F).weight, -apart.weight);
}

// Where it is not known what a wall is: a sheet three spacings above another one.
TEST(BorderVotes, WhatLiesAboveIsAWall) {
  Wedge sheets = makeWedge(0, 28);
  for (std::size_t i = 0; i < sheets.xyz.size(); i += 8) {
    sheets.xyz[i] += 0.5F;
    sheets.xyz[i + 2] -= 0.09F;
  }
  const BorderVote vote = voteOn(sheets);
  ASSERT_GT(vote.count, 16U);
  EXPECT_LT(vote.weight, 0.F);
  EXPECT_TRUE(vote.wall_counts) << "nothing else is known of the two";
  EXPECT_GT(vote.wall.absolute, 0.9F * vote.absolute);
  for (const double degrees : {0.0, 30.0, 135.0}) {
    const BorderVote one_sheet = voteOn(makeWedge(degrees, 29));
    EXPECT_EQ(one_sheet.wall.absolute, 0.F) << degrees;
  }
  const BorderVote noisy = voteOn(withNoise(makeWedge(0, 29), 0.006F, 30));
  EXPECT_FALSE(noisy.wall_counts) << "noise of a fifth of a spacing";
}

// Lengths in spacings that a float cannot hold.
TEST(BorderVotes, PointsTooFarApartSayNothing) {
  const BorderVote vote = voteOn(makeWedge(30, 24), std::numeric_limits<float>::infinity(), 1e-40F);
  EXPECT_EQ(vote.weight, 0.F);
  EXPECT_EQ(vote.absolute, 0.F);
  EXPECT_GT(vote.count, 0U);
}

TEST(ClusterGraph, RecoversPlantedSigns) {
  std::mt19937 rng(22);
  constexpr std::int32_t kNodes = 200;
  std::vector<int> planted(kNodes);
  for (int& s : planted) s = rng() % 2 == 0 ? 1 : -1;
  std::vector<BorderVote> votes;
  for (std::int32_t a = 0; a < kNodes; ++a) {
    for (std::int32_t b = a + 1; b < std::min(kNodes, a + 4); ++b) {
      // The weakest border of each node lies, the others do not.
      const bool lies = b == a + 3;
      BorderVote v;
      v.a = a;
      v.b = b;
      v.absolute = lies ? 1.F : 10.F;
      v.weight = v.absolute * static_cast<float>(planted[static_cast<std::size_t>(a)] *
                                                 planted[static_cast<std::size_t>(b)]);
      if (lies) v.weight = -v.weight;
      v.reliable = v.absolute;
      votes.push_back(v);
    }
  }
  ClusterGraph graph(std::vector<std::uint32_t>(kNodes, 1), votes);
  graph.contract({ClusterGraph::Rule{}});
  EXPECT_EQ(graph.clusters().size(), 1U);
  int first = 0;
  const std::int32_t root = graph.find(0, first);
  for (std::int32_t s = 1; s < kNodes; ++s) {
    int sign = 0;
    EXPECT_EQ(graph.find(s, sign), root);
    EXPECT_EQ(sign * first, planted[static_cast<std::size_t>(s)] * planted[0]) << s;
  }
}

TEST(ClusterGraph, JoinsOnlyWhatTheRuleAllows) {
  std::vector<BorderVote> votes(2);
  votes[0].a = 0;
  votes[0].b = 1;
  votes[0].weight = 5.F;
  votes[0].absolute = 10.F;
  votes[1].a = 1;
  votes[1].b = 2;
  votes[1].weight = -9.5F;
  votes[1].absolute = 10.F;
  ClusterGraph graph({100, 100, 100}, votes);
  ClusterGraph::Rule rule;
  rule.unanimity = 0.9F;
  graph.contract({rule});
  EXPECT_EQ(graph.clusters().size(), 2U);
  int one = 0;
  int two = 0;
  EXPECT_EQ(graph.find(1, one), graph.find(2, two));
  EXPECT_EQ(one * two, -1);
  ASSERT_EQ(graph.edges().size(), 1U);
  ClusterGraph::Rule large;
  large.both_larger = 50;
  graph.contract({large});
  EXPECT_EQ(graph.clusters().size(), 2U) << "both clusters are larger than 50 points";
}

// Of the borders 0-1, 0-2 and 1-2.
std::vector<BorderVote> unanimousVotes(const std::array<float, 3>& weights) {
  std::vector<BorderVote> votes(3);
  votes[1].b = votes[2].b = 2;
  votes[0].b = votes[2].a = 1;
  for (std::size_t e = 0; e < 3; ++e) {
    votes[e].weight = weights[e];
    votes[e].absolute = votes[e].reliable = std::fabs(weights[e]);
  }
  return votes;
}

// 0-1 and 1-2 meet on one sheet, 0-2 only across a wall, as the turns of a roll do.
TEST(ClusterGraph, WallsHaveNoSayWhereClustersMeet) {
  std::vector<BorderVote> votes = unanimousVotes({20.F, -9.F, 60.F});
  ClusterGraph::Rule rule;
  rule.unanimity = 0.9F;
  rule.weight = 15.F;
  for (const bool is_wall : {true, false}) {
    votes[1].wall = is_wall ? Evidence(votes[1]) : Evidence{};
    votes[1].wall_counts = is_wall;
    ClusterGraph graph({10, 10, 10}, votes);
    graph.contract({rule});
    EXPECT_EQ(graph.clusters().size(), is_wall ? 1U : 2U);
    if (!is_wall) continue;
    int first = 0;
    int last = 0;
    graph.find(0, first);
    graph.find(2, last);
    EXPECT_EQ(first, last);
  }
}

TEST(ClusterGraph, OneRuleOfSeveralSuffices) {
  // 0-1 and 1-2 are long and of one mind, but of few reliable points; 0-2 is short and lies.
  std::vector<BorderVote> votes = unanimousVotes({40.F, -7.F, 60.F});
  votes[0].reliable = 16.F;
  votes[2].reliable = 20.F;
  ClusterGraph::Rule sure;
  sure.weight = 4.F;
  sure.reliable = 0.5F;
  ClusterGraph::Rule unanimous;
  unanimous.unanimity = 0.97F;
  unanimous.weight = 16.F;
  unanimous.reliable = 0.25F;
  const auto sideOfTwo = [&](const std::vector<ClusterGraph::Rule>& rules) {
    ClusterGraph graph({1, 1, 1}, votes);
    graph.contract(rules);
    graph.contract({ClusterGraph::Rule{}});
    int zero = 0;
    int two = 0;
    EXPECT_EQ(graph.find(0, zero), graph.find(2, two));
    return zero * two;
  };
  EXPECT_EQ(sideOfTwo({sure}), -1);
  EXPECT_EQ(sideOfTwo({sure, unanimous}), 1);
  EXPECT_EQ(sideOfTwo({unanimous, sure}), 1) << "their order does not matter";
  ClusterGraph none({1, 1, 1}, votes);
  none.contract({});
  EXPECT_EQ(none.clusters().size(), 3U);
}

TEST(ClusterGraph, ParallelBordersAddUpWithTheirSigns) {
  // 0-1 is sure; 2 agrees with 0 by 3 and disagrees with 1 by 5.
  ClusterGraph graph({1, 1, 1}, unanimousVotes({20.F, 3.F, -5.F}));
  ClusterGraph::Rule sure;
  sure.weight = 10.F;
  graph.contract({sure});
  ASSERT_EQ(graph.edges().size(), 1U);
  EXPECT_FLOAT_EQ(graph.edges()[0].weight, -2.F);
  EXPECT_FLOAT_EQ(graph.edges()[0].absolute, 8.F);
}

}  // namespace
}  // namespace segorient::test
