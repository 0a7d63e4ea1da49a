// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "search/prepared_cloud.h"
#include "tiles/join_tiles.h"
#include "tiles/piece_graph.h"

namespace segorient::test {
namespace {

using detail::PieceTie;

PieceTie tie(std::int32_t a, std::int32_t b, float weight, std::uint32_t count) {
  PieceTie t;
  t.a = a;
  t.b = b;
  t.weight = weight;
  t.absolute = static_cast<float>(count);
  t.count = count;
  t.most = true;
  return t;
}

TileVote vote(std::int32_t a, std::int32_t b, float weight) {
  TileVote v;
  v.a = a;
  v.b = b;
  v.sheet[0] = weight;
  v.sheet[1] = v.sheet[2] = weight < 0.F ? -weight : weight;
  v.count = 1;
  return v;
}

// Points that both tiles have say how two pieces are turned to each other.
TEST(Join, PiecesOfTwoTilesVoteByTheirCommonPoints) {
  const std::vector<BorderVote> votes =
      detail::gatherVotes({vote(0, 2, 6.F)}, {tie(1, 0, -7.F, 7)});
  ASSERT_EQ(votes.size(), 2U);
  EXPECT_EQ(votes[0].a, 0);
  EXPECT_EQ(votes[0].b, 1);
  EXPECT_FLOAT_EQ(votes[0].weight, -7.F);
  EXPECT_EQ(votes[0].unanimity(), 1.F);
  EXPECT_EQ(votes[1].b, 2);
  EXPECT_FLOAT_EQ(votes[1].weight, 6.F);
}

// Common points say no more than as many of a border: one piece may mix two sides.
TEST(Join, BordersMayContradictCommonPoints) {
  const std::vector<BorderVote> votes =
      detail::gatherVotes({vote(0, 1, 12.F)}, {tie(0, 1, -7.F, 7)});
  ASSERT_EQ(votes.size(), 1U);
  EXPECT_FLOAT_EQ(votes[0].weight, 5.F);
  EXPECT_FLOAT_EQ(votes[0].absolute, 19.F);
}

// Votes of the same two pieces from two tiles are one border; walls count where they are most.
TEST(Join, VotesOfOneBorderAddUp) {
  TileVote wall = vote(0, 1, 0.F);
  wall.wall[0] = -3.F;
  wall.wall[1] = wall.wall[2] = 3.F;
  const auto sheet = detail::gatherVotes({vote(0, 1, 8.F), vote(0, 1, 8.F), wall}, {});
  ASSERT_EQ(sheet.size(), 1U);
  EXPECT_FALSE(sheet[0].wall_counts);
  EXPECT_FLOAT_EQ(sheet[0].weight, 16.F);
  const auto both = detail::gatherVotes({vote(0, 1, 2.F), wall}, {});
  ASSERT_EQ(both.size(), 1U);
  EXPECT_TRUE(both[0].wall_counts);
  EXPECT_FLOAT_EQ(both[0].weight, -1.F);
}

TEST(Join, LabelsOfOneSegmentBecomeOneAndAreNumberedBySize) {
  PieceTie weak = tie(1, 3, 1.F, 1);
  weak.most = false;
  std::size_t count = 0;
  const std::vector<std::uint32_t> labels =
      detail::uniteLabels({5, 30, 40, 2, 0}, {tie(0, 2, 9.F, 9), weak}, {}, count);
  EXPECT_EQ(labels[0], labels[2]);
  EXPECT_EQ(labels[0], 0U);
  EXPECT_EQ(labels[1], 1U);
  EXPECT_EQ(labels[3], 2U);
  EXPECT_EQ(count, 3U);
}

// 0 and 1 are next to each other in one tile; 2 of another one and 3 of a third one tie them
// together.
TEST(Join, SegmentsThatAreNextToEachOtherStayTwo) {
  std::size_t count = 0;
  const std::vector<PieceTie> ties{tie(0, 2, 5.F, 5), tie(2, 3, 9.F, 9), tie(1, 3, 7.F, 7)};
  const std::vector<std::uint32_t> labels =
      detail::uniteLabels({10, 20, 10, 10}, ties, {{0, 1}}, count);
  EXPECT_EQ(count, 2U);
  EXPECT_EQ(labels[2], labels[3]);
  EXPECT_EQ(labels[1], labels[3]) << "the stronger tie";
  EXPECT_NE(labels[0], labels[1]);
  EXPECT_EQ(detail::uniteLabels({10, 20, 10, 10}, ties, {}, count)[0], 0U);
  EXPECT_EQ(count, 1U);
}

// A square in quarters: sides are borders, two corners that meet are none.
TEST(Join, SegmentsThatMeetInACornerAreNotNextToEachOther) {
  constexpr std::size_t kSide = 20;
  std::vector<float> xyz;
  for (std::size_t i = 0; i < kSide * kSide; ++i) {
    xyz.insert(xyz.end(), {static_cast<float>(i % kSide), static_cast<float>(i / kSide), 0.F});
  }
  PreparedCloud cloud({xyz.data(), 3, kSide * kSide}, nullptr, 1);
  cloud.findNeighbors(8, false);
  std::vector<std::int32_t> labels(cloud.size());
  for (std::size_t i = 0; i < labels.size(); ++i) {
    const std::size_t row = cloud.rowOf(i);
    labels[i] = static_cast<std::int32_t>(row % kSide / 10 + 2 * (row / kSide / 10));
  }
  const std::vector<LabelBorder> borders = detail::labelBorders(cloud.neighborhoods(), labels);
  std::vector<std::pair<std::int32_t, std::int32_t>> found;
  for (const LabelBorder& b : borders) found.emplace_back(b.a, b.b);
  const std::vector<std::pair<std::int32_t, std::int32_t>> sides{{0, 1}, {0, 2}, {1, 3}, {2, 3}};
  EXPECT_EQ(found, sides);
}

TEST(Join, NothingAndTilesWithoutPiecesAreJoined) {
  TileJoiner none;
  EXPECT_TRUE(none.join({}).tiles.empty());
  TileJoiner empty;
  empty.addTile({}, {}, {}, {}, {0.0, 0.0, 0.0});
  const JoinedTiles joined = empty.join({});
  ASSERT_EQ(joined.tiles.size(), 1U);
  EXPECT_TRUE(joined.tiles[0].patches.empty());
}

// A level sheet of 40 by 40 patches, as one piece that faces up. Its left half was seen from above,
// its right half from above and from below in turns.
JoinedTiles joinSheet(bool sensors_found) {
  std::vector<TilePatch> patches;
  JoinOptions options;
  for (std::uint32_t i = 0; i < 1600; ++i) {
    TilePatch p;
    p.position[0] = 0.1F * static_cast<float>(i % 40);
    p.position[1] = 0.1F * static_cast<float>(i / 40);
    p.normal[2] = 1.F;
    p.spacing = 0.1F;
    p.piece = 0;
    p.points = p.reliable = 1;
    p.row = i;
    patches.push_back(p);
    const bool left = i % 40 < 20;
    const float z = left || i % 2 == 0 ? 3.F : -3.F;
    options.hints.viewpoints.insert(options.hints.viewpoints.end(), {left ? 1.F : 3.F, 2.F, z});
  }
  options.sensors_found = sensors_found;
  TileJoiner joiner;
  joiner.addTile({1600}, {}, patches, {}, {0.0, 0.0, 0.0});
  return joiner.join(options);
}

// Of sensors that were given, the others are followed. Those that were found together explain the
// densities together, or do not.
TEST(Join, FoundSensorsOfWhichOneSeesBothSidesAreNotFollowed) {
  const JoinedTiles given = joinSheet(false);
  EXPECT_FALSE(given.sensors_dropped);
  EXPECT_FALSE(given.tiles[0].toward.empty());
  const JoinedTiles found = joinSheet(true);
  EXPECT_TRUE(found.sensors_dropped);
  EXPECT_TRUE(found.tiles[0].toward.empty());
  EXPECT_EQ(found.tiles[0].patches.size(), 1600U);
}

TilePatch patchAt(const std::array<float, 3>& position, const std::array<float, 3>& normal,
                  float spacing, std::int32_t piece, std::uint32_t row) {
  TilePatch p;
  std::copy(position.begin(), position.end(), p.position);
  std::copy(normal.begin(), normal.end(), p.normal);
  p.spacing = spacing;
  p.piece = piece;
  p.points = p.reliable = 1;
  p.row = row;
  return p;
}

// A ridge, even along and across, and a place beside it, which would see its far side from below:
// whether that is followed.
bool followsPlaceBesideRidge(const CloudPlace& place) {
  std::vector<TilePatch> patches;
  for (std::uint32_t i = 0; i < 3200; ++i) {
    const float turn = 0.05F * (static_cast<float>(i % 40) - 19.5F);
    const std::array<float, 3> n{std::sin(turn), 0.F, std::cos(turn)};
    patches.push_back(
        patchAt({2.F * n[0], 0.1F * static_cast<float>(i / 40), 2.F * n[2]}, n, 0.1F, 0, i));
  }
  JoinOptions options;
  options.hints.has_viewpoint = true;
  options.hints.viewpoint = {9.F, 4.F, 1.F};
  options.place = place;
  TileJoiner joiner;
  joiner.addTile({3200}, {}, patches, {}, {0.0, 0.0, 0.0});
  const JoinedTiles joined = joiner.join(options);
  EXPECT_EQ(joined.sensors_dropped, joined.tiles[0].toward.empty());
  return !joined.sensors_dropped;
}

TEST(Join, WhatShadowsSayOfOnePlaceIsHeard) {
  EXPECT_FALSE(followsPlaceBesideRidge({}));
  CloudPlace place;
  place.shadows.steps = 0.3F;
  EXPECT_TRUE(followsPlaceBesideRidge(place));
}

// A closed body knows its outside better than a place that can't have seen it whole.
TEST(Join, APlaceThatDecidesNothingIsLeftAside) {
  constexpr std::uint32_t kPatches = 2000;
  std::vector<TilePatch> patches;
  for (std::uint32_t i = 0; i < kPatches; ++i) {
    const float z = 1.F - (2.F * static_cast<float>(i) + 1.F) / kPatches;
    const float r = std::sqrt(1.F - z * z);
    const float turn = 2.39996323F * static_cast<float>(i);
    const std::array<float, 3> n{r * std::cos(turn), r * std::sin(turn), z};
    patches.push_back(patchAt(n, {-n[0], -n[1], -n[2]}, 0.08F, 0, i));
  }
  JoinOptions options;
  options.hints.has_viewpoint = true;
  options.hints.viewpoint = {5.F, 0.F, 0.F};
  TileJoiner joiner;
  joiner.addTile({kPatches}, {}, patches, {}, {0.0, 0.0, 0.0});
  const JoinedTiles joined = joiner.join(options);
  EXPECT_TRUE(joined.sensors_dropped);
  EXPECT_TRUE(joined.tiles[0].toward.empty());
  ASSERT_EQ(joined.tiles[0].pieces.size(), 1U);
  EXPECT_EQ(joined.tiles[0].pieces[0], -1);
}

}  // namespace
}  // namespace segorient::test
