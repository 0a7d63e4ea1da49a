// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <gtest/gtest.h>
#include <segorient/surface/segment_mesh.h>

#include <cmath>
#include <vector>

#include "orientation/paper/segment_relations.h"
#include "orientation/paper/triangulated_boundary.h"
#include "segment_fixture.h"
#include "segmentation/segment_graph.h"

namespace segorient {
namespace {

using test::FaceSegments;

constexpr double kDegree = M_PI / 180;

// Convex and concave, sharp and smooth; the faces as they are and one of them turned over.
TEST(BoundaryVotes, TellEveryDihedralAngle) {
  for (const int degrees : {45, 60, 90, 120, 150, 180, 210, 240, 270, 300, 315}) {
    for (const bool turned : {false, true}) {
      const FaceSegments faces(test::sample("wedge", test::wedge(degrees * kDegree), 3000, 5),
                               {false, turned});
      ASSERT_EQ(faces.links.borders.size(), 1U);
      const auto votes = localBoundaryVotes(faces.points(), faces.normalView(), faces.neighborhoods,
                                            faces.segmentation, faces.links);
      EXPECT_TRUE(votes[0].decides(0.5F)) << degrees << " degrees: " << votes[0].margin;
      EXPECT_EQ(votes[0].margin > 0, !turned) << degrees << " degrees";
    }
  }
}

// Where the faces fold back over each other within a neighbourhood, the border is not clear; then
// no wrong decision is made.
TEST(BoundaryVotes, DoNotDecideAboutBlades) {
  for (const int degrees : {10, 20, 30}) {
    for (const unsigned seed : {1U, 2U, 3U}) {
      const FaceSegments faces(test::sample("wedge", test::wedge(degrees * kDegree), 3000, seed),
                               {false, false});
      const auto votes = localBoundaryVotes(faces.points(), faces.normalView(), faces.neighborhoods,
                                            faces.segmentation, faces.links);
      EXPECT_FALSE(votes[0].decides(0.5F) && votes[0].margin < 0) << degrees;
    }
  }
}

TEST(TriangulatedBoundary, TellsDihedralAnglesAndEdgesOfBlades) {
  for (const int degrees : {20, 45, 90, 135, 180, 225, 270}) {
    for (const bool turned : {false, true}) {
      const FaceSegments faces(test::sample("wedge", test::wedge(degrees * kDegree), 3000, 5),
                               {false, turned});
      const auto meshes = triangulateSegments(faces.points(), faces.segmentation, {});
      const auto votes =
          triangulatedBoundaryVotes(faces.points(), faces.segmentation, faces.links, meshes);
      EXPECT_TRUE(votes[0].decides(0.5F)) << degrees << " degrees: " << votes[0].margin;
      EXPECT_EQ(votes[0].margin > 0, !turned) << degrees << " degrees";
    }
  }
}

// "For several special cases: degenerated segment shapes (e.g. thin triangulation)": nothing is
// decided.
TEST(TriangulatedBoundary, SaysNothingWithoutTriangles) {
  const FaceSegments faces(
      test::sample("line",
                   {test::parallelogram({0, 0, 0}, {1, 0, 0}, {0, 1, 0}),
                    test::parallelogram({1, 0, 0}, {1e-6, 0, 0}, {0, 1e-6, 0})},
                   1000, 5),
      {false, false});
  std::vector<SegmentMesh> meshes = triangulateSegments(faces.points(), faces.segmentation, {});
  meshes[0] = SegmentMesh{};
  for (const BoundaryVote& vote :
       triangulatedBoundaryVotes(faces.points(), faces.segmentation, faces.links, meshes)) {
    EXPECT_FALSE(vote.decides(0.1F));
  }
  for (const BoundaryVote& vote :
       triangulatedBoundaryVotes(faces.points(), faces.segmentation, faces.links, {})) {
    EXPECT_FALSE(vote.decides(0.1F));
  }
}

// Figure 2 of the paper: what an angle cannot tell.
TEST(SegmentCosines, CannotTellFigureTwo) {
  // b) perpendicular faces: convex and concave look alike, and neither has a sign.
  for (const int degrees : {90, 270}) {
    const FaceSegments faces(test::sample("wedge", test::wedge(degrees * kDegree), 3000, 6),
                             {false, false});
    for (const auto angle : {SegmentAngle::REFERENCE_NORMALS, SegmentAngle::ACROSS_BORDER}) {
      const auto cosines = segmentCosines(faces.points(), faces.normalView(), faces.segmentation,
                                          faces.links, angle);
      EXPECT_NEAR(cosines[0], 0, 0.05);
    }
  }
  // a) the same angle, but right for the one and wrong for the other: a flat ridge and a sharp one.
  const FaceSegments ridge(test::sample("wedge", test::wedge(150 * kDegree), 3000, 6),
                           {false, false});
  const FaceSegments blade(test::sample("wedge", test::wedge(30 * kDegree), 3000, 6),
                           {false, true});
  const auto flat = segmentCosines(ridge.points(), ridge.normalView(), ridge.segmentation,
                                   ridge.links, SegmentAngle::REFERENCE_NORMALS);
  const auto sharp = segmentCosines(blade.points(), blade.normalView(), blade.segmentation,
                                    blade.links, SegmentAngle::REFERENCE_NORMALS);
  EXPECT_NEAR(flat[0], std::cos(30 * kDegree), 1e-3);
  EXPECT_NEAR(sharp[0], std::cos(30 * kDegree), 1e-3);  // consistent, it says: it is not
}

TEST(SegmentCosines, PairsAcrossAGapSayNothing) {
  // Two sheets one spacing apart, facing away from each other.
  const double h = 0.03;
  const FaceSegments sheets(test::sample("sheets",
                                         {test::parallelogram({0, 0, 0}, {1, 0, 0}, {0, 1, 0}),
                                          test::parallelogram({0, 0, -h}, {0, 1, 0}, {1, 0, 0})},
                                         2000, 8),
                            {false, false});
  ASSERT_EQ(sheets.links.borders.size(), 1U);
  const auto across = segmentCosines(sheets.points(), sheets.normalView(), sheets.segmentation,
                                     sheets.links, SegmentAngle::ACROSS_BORDER);
  const auto reference = segmentCosines(sheets.points(), sheets.normalView(), sheets.segmentation,
                                        sheets.links, SegmentAngle::REFERENCE_NORMALS);
  EXPECT_LT(reference[0], -0.99F);
  EXPECT_GT(across[0], -0.8F);
  EXPECT_GT(std::acos(std::abs(across[0])), 0.61F);  // undecided
}

TEST(SegmentLinks, NameTheLargestNeighbourFirst) {
  // A small face between a medium and a large one, labels not in order of size.
  const FaceSegments strips(test::sample("strips",
                                         {test::parallelogram({1, 0, 0}, {0.3, 0, 0}, {0, 1, 0}),
                                          test::parallelogram({0, 0, 0}, {1, 0, 0}, {0, 1, 0}),
                                          test::parallelogram({1.3, 0, 0}, {2, 0, 0}, {0, 1, 0})},
                                         3000, 9),
                            {false, false, false});
  const std::uint32_t first = strips.links.offsets[0];
  ASSERT_EQ(strips.links.offsets[1] - first, 2U);
  EXPECT_EQ(otherOf(strips.links.borders[strips.links.incident[first]], 0), 2);
  EXPECT_EQ(otherOf(strips.links.borders[strips.links.incident[first + 1]], 0), 1);
}

TEST(SegmentLinks, BridgeAStripOfSmallSegments) {
  // Three strips side by side; the middle one is a connected segment.
  FaceSegments strips(test::sample("strips",
                                   {test::parallelogram({0, 0, 0}, {1, 0, 0}, {0, 1, 0}),
                                    test::parallelogram({1, 0, 0}, {0.1, 0, 0}, {0, 1, 0}),
                                    test::parallelogram({1.1, 0, 0}, {1, 0, 0}, {0, 1, 0})},
                                   3000, 9),
                      {false, false, true});
  EXPECT_EQ(strips.links.borders.size(), 2U);
  strips.segmentation.segments[1].kind = SegmentKind::CONNECTED;
  strips.links = linkRegularSegments(strips.segmentation,
                                     buildSegmentGraph(strips.segmentation, strips.neighborhoods),
                                     strips.neighborhoods);
  ASSERT_EQ(strips.links.borders.size(), 1U);
  const SegmentBorder& link = strips.links.borders[0];
  EXPECT_EQ(link.a, 0);
  EXPECT_EQ(link.b, 2);
  EXPECT_GT(link.size, 10U);
  for (std::uint32_t i = link.first; i < link.first + link.size; ++i) {
    const BorderPair& pair = strips.links.pairs[i];
    EXPECT_EQ(strips.segmentation.labels[static_cast<std::size_t>(pair.in_a)], 0);
    EXPECT_EQ(strips.segmentation.labels[static_cast<std::size_t>(pair.in_b)], 2);
  }
  const auto votes = localBoundaryVotes(strips.points(), strips.normalView(), strips.neighborhoods,
                                        strips.segmentation, strips.links);
  EXPECT_LT(votes[0].margin, -0.5F);
}

}  // namespace
}  // namespace segorient
