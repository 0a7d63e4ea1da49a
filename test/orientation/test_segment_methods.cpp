// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include "orientation/paper/combination.h"
#include "segment_fixture.h"
#include "segmentation/segment_graph.h"

namespace segorient {
namespace {

using Results = std::vector<SegmentOrientationResult>;
using test::FaceSegments;
using test::undoes;

// All evidence about a cloud whose segments are its faces.
struct Evidence {
  std::vector<float> cosines;
  std::vector<BoundaryVote> boundary;
  std::vector<ExtremalEvidence> extremal;
  OrientationSettings options;

  Evidence(const FaceSegments& faces, SegmentAngle angle) {
    cosines =
        segmentCosines(faces.points(), faces.normalView(), faces.segmentation, faces.links, angle);
    boundary = localBoundaryVotes(faces.points(), faces.normalView(), faces.neighborhoods,
                                  faces.segmentation, faces.links);
    std::vector<pcl::index_t> rows(faces.cloud.size());
    std::iota(rows.begin(), rows.end(), pcl::index_t{0});
    extremal =
        gatherExtremalEvidence(findExtremalPoints(faces.points(), faces.normalView(), rows, 120),
                               faces.segmentation, options.gamma);
  }
  SegmentEvidence of(const FaceSegments& faces) const {
    return {faces.segmentation, faces.links, cosines, boundary, extremal};
  }
};

std::size_t countHard(const Results& results) {
  std::size_t count = 0;
  for (const SegmentOrientationResult& result : results) count += result.hard ? 1 : 0;
  return count;
}

// Every third face turned over.
std::vector<bool> someTurned(std::size_t faces) {
  std::vector<bool> turned(faces);
  for (std::size_t f = 0; f < faces; ++f) turned[f] = f % 3 == 1;
  return turned;
}

TEST(Propagation, FollowsSmallAngles) {
  // A vault of flat strips, 20 degrees from one to the next.
  std::vector<test::Face> vault;
  Eigen::Vector3d corner(0, 0, 0);
  for (int i = 0; i < 7; ++i) {
    const double t = i * 20 * M_PI / 180;
    const Eigen::Vector3d side(std::cos(t), 0, -std::sin(t));
    vault.push_back(test::parallelogram(corner, side, {0, 2, 0}));
    corner += side;
  }
  const std::vector<bool> turned = someTurned(vault.size());
  const FaceSegments faces(test::sample("vault", vault, 6000, 11), turned);
  for (const auto angle : {SegmentAngle::REFERENCE_NORMALS, SegmentAngle::ACROSS_BORDER}) {
    const Evidence evidence(faces, angle);
    const Results results = propagateOrientation(evidence.of(faces), evidence.options);
    EXPECT_TRUE(undoes(results, turned, true));
    EXPECT_EQ(countHard(results), 0U);
  }
}

// The paper's third interval: the tree cannot decide right angles, and says so.
TEST(Propagation, ReportsRightAnglesAsHard) {
  const FaceSegments faces(test::sample("cube", test::cube(), 6000, 12), someTurned(6));
  const Evidence evidence(faces, SegmentAngle::REFERENCE_NORMALS);
  const Results results = propagateOrientation(evidence.of(faces), evidence.options);
  EXPECT_EQ(countHard(results), 5U);  // all but the seed
  for (const SegmentOrientationResult& result : results) {
    if (!result.hard) continue;
    EXPECT_NE(result.sign, 0);
    EXPECT_LT(result.confidence, 0.25F);
  }
}

// Figure 2 a): a blade that the reference normals take for a smooth bend.
TEST(Propagation, IsWrongAtABladeWhereBoundariesReportIt) {
  const std::vector<bool> turned{false, true};
  const FaceSegments faces(test::sample("blade", test::wedge(25 * M_PI / 180), 3000, 13), turned);
  const Evidence evidence(faces, SegmentAngle::REFERENCE_NORMALS);
  const Results tree = propagateOrientation(evidence.of(faces), evidence.options);
  EXPECT_FALSE(undoes(tree, turned, true));
  EXPECT_EQ(countHard(tree), 0U);
  EXPECT_EQ(countHard(orientByBoundaries(evidence.of(faces), evidence.options)), 1U);
}

TEST(Methods, OrientSolidsOfManyFaces) {
  const std::vector<std::pair<std::string, std::vector<test::Face>>> solids{
      {"cube", test::cube()},
      {"prism", test::octagonalPrism()},
      {"stairs", test::steppedSolid()},
      {"bracket", test::bracket()},
      {"plate", test::plate(4, 6000)}};
  for (const auto& [name, shape] : solids) {
    const std::vector<bool> turned = someTurned(shape.size());
    const FaceSegments faces(test::sample(name, shape, 6000, 14), turned);
    for (const auto angle : {SegmentAngle::REFERENCE_NORMALS, SegmentAngle::ACROSS_BORDER}) {
      const Evidence evidence(faces, angle);
      const Results boundary = orientByBoundaries(evidence.of(faces), evidence.options);
      EXPECT_TRUE(undoes(boundary, turned, true)) << name;
      EXPECT_EQ(countHard(boundary), 0U) << name;
      const Results combined = orientCombined(evidence.of(faces), evidence.options);
      EXPECT_TRUE(undoes(combined, turned, true)) << name;
      EXPECT_EQ(countHard(combined), 0U) << name;
    }
    const Evidence evidence(faces, SegmentAngle::ACROSS_BORDER);
    const Results extremal = orientByExtremalPoints(evidence.of(faces), evidence.options);
    EXPECT_TRUE(undoes(extremal, turned, false)) << name;  // it knows the outside, too
  }
}

// Evidence made by hand, so that each decision of the combination is known.
class HandMade : public testing::Test {
 protected:
  // A chain of segments, link i between i and i + 1.
  void chain(std::size_t size) {
    segmentation.segments.resize(size);
    for (std::size_t s = 0; s < size; ++s) {
      segmentation.segments[s].size = static_cast<std::uint32_t>(100 - s);
      const auto label = static_cast<std::int32_t>(s);
      if (s + 1 < size) links.borders.push_back({label, label + 1, 0, 0});
    }
    listIncident(size, links);
    cosines.assign(size - 1, 0.F);
    boundary.assign(size - 1, {});
    extremal.assign(size, {});
  }
  Results combined() {
    return orientCombined({segmentation, links, cosines, boundary, extremal}, options);
  }

  Segmentation segmentation;
  SegmentGraph links;
  std::vector<float> cosines;
  std::vector<BoundaryVote> boundary;
  std::vector<ExtremalEvidence> extremal;
  OrientationSettings options;
};

TEST_F(HandMade, CombinedTakesAngleThenBoundaryThenExtremalPointsThenGuesses) {
  chain(5);
  cosines[0] = -0.95F;       // opposite
  boundary[1] = {0.9F, 10};  // consistent
  extremal[0] = {0.1F, 1, 1.F, 5};
  extremal[3] = {0.1F, -1, 1.F, 5};
  boundary[3] = {-0.2F, 10};  // too weak to decide
  const Results results = combined();
  EXPECT_EQ(results[0].by, DecidedBy::SEED);
  EXPECT_EQ(results[1].sign, -1);
  EXPECT_EQ(results[1].by, DecidedBy::PROPAGATION);
  EXPECT_EQ(results[2].sign, -1);
  EXPECT_EQ(results[2].by, DecidedBy::BOUNDARY);
  EXPECT_EQ(results[3].sign, -1);
  EXPECT_EQ(results[3].by, DecidedBy::EXTREMAL);
  EXPECT_EQ(results[4].sign, 1);
  EXPECT_TRUE(results[4].hard);
  EXPECT_LT(results[4].confidence, 0.3F);
  EXPECT_EQ(countHard(results), 1U);
}

TEST_F(HandMade, CombinedBelievesNeitherOfTwoThatContradict) {
  chain(2);
  cosines[0] = 0.95F;
  boundary[0] = {-0.9F, 10};
  EXPECT_TRUE(combined()[1].hard);
}

TEST_F(HandMade, ExtremalPointsAreSeenRelativeToTheRest) {
  chain(2);
  extremal[0] = {0.1F, -1, 1.F, 5};  // the seed, kept as it is, points inward
  extremal[1] = {0.1F, 1, 1.F, 5};
  const Results results = combined();
  EXPECT_EQ(results[0].sign, 1);
  EXPECT_EQ(results[1].sign, -1);
}

// A hard segment in the middle of a ring is decided once its other neighbour is.
TEST_F(HandMade, HardSegmentsAreTriedAgain) {
  // 0 - 1 unclear, 0 - 2 clear, 1 - 2 clear.
  segmentation.segments.resize(3);
  for (Segment& segment : segmentation.segments) segment.size = 100;
  links.borders = {{0, 1, 0, 0}, {0, 2, 0, 0}, {1, 2, 0, 0}};
  listIncident(3, links);
  cosines = {0.5F, 0.1F, 0.1F};  // the unclear link comes first
  boundary = {{0.1F, 10}, {-0.9F, 10}, {-0.9F, 10}};
  extremal.resize(3);
  const Results results = combined();
  EXPECT_EQ(results[1].sign, 1);
  EXPECT_EQ(results[1].by, DecidedBy::BOUNDARY);
  EXPECT_EQ(results[2].sign, -1);
  EXPECT_EQ(countHard(results), 0U);
}

// Labels of a user's own segments need not be in order of their sizes.
TEST_F(HandMade, TheLargestSegmentIsTheStart) {
  chain(3);
  segmentation.segments[2].size = 500;
  cosines = {0.95F, 0.95F};
  for (const Results& results :
       {combined(),
        propagateOrientation({segmentation, links, cosines, boundary, extremal}, options)}) {
    EXPECT_EQ(results[2].by, DecidedBy::SEED);
    EXPECT_EQ(results[0].by, DecidedBy::PROPAGATION);
  }
}

TEST_F(HandMade, AngleAndBoundaryAreComparedIfAsked) {
  chain(2);
  cosines[0] = 0.95F;
  boundary[0] = {-0.9F, 10};
  options.check_borders = false;
  const Results results = combined();
  EXPECT_EQ(results[1].sign, 1);  // the paper's: the tree goes first
  EXPECT_EQ(results[1].by, DecidedBy::PROPAGATION);
  EXPECT_FALSE(results[1].hard);
}

TEST_F(HandMade, OtherKindsAreLeftOutAndComponentsCounted) {
  chain(3);
  segmentation.segments[1].kind = SegmentKind::CONNECTED;
  links.borders.clear();
  listIncident(3, links);
  for (const Results& results :
       {combined(), orientByBoundaries({segmentation, links, cosines, boundary, extremal}, options),
        propagateOrientation({segmentation, links, cosines, boundary, extremal}, options),
        orientByExtremalPoints({segmentation, links, cosines, boundary, extremal}, options)}) {
    EXPECT_EQ(results[0].component, 0);
    EXPECT_EQ(results[1].sign, 0);
    EXPECT_EQ(results[1].component, -1);
    EXPECT_EQ(results[2].component, 1);
    EXPECT_EQ(results[2].sign, 1);
  }
}

}  // namespace
}  // namespace segorient
