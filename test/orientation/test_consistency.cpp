// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <gtest/gtest.h>

#include <vector>

#include "orientation/paper/folded_segments.h"
#include "orientation/paper/mixed_segments.h"
#include "segment_fixture.h"

namespace segorient {
namespace {

using test::FaceSegments;
using test::LabelledCloud;

std::vector<SegmentOrientationResult> withSigns(const std::vector<int>& signs) {
  std::vector<SegmentOrientationResult> out(signs.size());
  for (std::size_t s = 0; s < signs.size(); ++s) {
    out[s].sign = static_cast<std::int8_t>(signs[s]);
    out[s].component = 0;
  }
  return out;
}

TEST(Consistency, CountsBordersForAndAgainst) {
  const FaceSegments faces(test::sample("cube", test::cube(), 6000, 81),
                           std::vector<bool>(6, false));
  const auto votes = localBoundaryVotes(faces.points(), faces.normalView(), faces.neighborhoods,
                                        faces.segmentation, faces.links);
  const auto right = withSigns({1, 1, 1, 1, 1, 1});
  ASSERT_EQ(balanceComponents(faces.links, votes, right).size(), 1U);
  EXPECT_LT(balanceComponents(faces.links, votes, right)[0].contradictingShare(), 0.05F);
  EXPECT_TRUE(findMixedSegments(faces.links, votes, right).empty());

  // One face turned over: all of its border is contradicted, a quarter of its neighbours'.
  const auto one_wrong = withSigns({1, 1, 1, -1, 1, 1});
  EXPECT_GT(balanceBorders(faces.links, votes, one_wrong)[3].contradictingShare(), 0.95F);
  EXPECT_EQ(findMixedSegments(faces.links, votes, one_wrong), std::vector<std::int32_t>{3});
  EXPECT_NEAR(balanceComponents(faces.links, votes, one_wrong)[0].contradictingShare(), 4. / 12,
              0.06);

  // Without signs there is nothing to contradict.
  EXPECT_EQ(balanceBorders(faces.links, votes, withSigns({0, 0, 0, 0, 0, 0}))[0].agreeing, 0.F);
}

// A face and a second one above it, in one segment: two bodies that touch somewhere.
TEST(FoldedSegments, AreFoundAndSlopesAreNot) {
  LabelledCloud sheets = test::sample("sheets",
                                      {test::parallelogram({0, 0, 0}, {1, 0, 0}, {0, 1, 0.5}),
                                       test::parallelogram({0.3, 0, 0.3}, {1, 0, 0}, {0, 1, 0.5})},
                                      3000, 82);
  const FaceSegments apart(sheets, {false, false});
  EXPECT_TRUE(findFoldedSegments(apart.points(), apart.neighborhoods, apart.segmentation).empty());
  for (int& face : sheets.face) face = 0;
  FaceSegments together(sheets, {false});
  EXPECT_EQ(findFoldedSegments(together.points(), together.neighborhoods, together.segmentation),
            std::vector<std::int32_t>{0});
  together.segmentation.segments[0].kind = SegmentKind::CONNECTED;
  EXPECT_TRUE(
      findFoldedSegments(together.points(), together.neighborhoods, together.segmentation).empty());
}

}  // namespace
}  // namespace segorient
