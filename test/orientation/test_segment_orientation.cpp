// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <gtest/gtest.h>
#include <pcl/common/io.h>
#include <pcl/console/print.h>
#include <pcl/search/kdtree.h>
#include <segorient/orientation/segment_orientation.h>
#include <segorient/search/median_hash.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <random>

#include "class_clouds.h"

namespace segorient {
namespace {

using Orientation = SegmentOrientation<pcl::PointXYZ, pcl::Normal>;
using Normals = pcl::PointCloud<pcl::Normal>;
using test::LabelledCloud;

class SegmentOrientationTest : public testing::Test {
 protected:
  void SetUp() override { pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS); }
  void TearDown() override { pcl::console::setVerbosityLevel(pcl::console::L_INFO); }

  // The normals of `points`, oriented; with what else was set.
  Normals orient(const Normals::ConstPtr& normals, OrientationMethod method) {
    orientation.setInputCloud(points);
    orientation.setInputNormals(normals);
    orientation.setMethod(method);
    Normals out;
    orientation.compute(out);
    return out;
  }

  Orientation orientation;
  const LabelledCloud cloud = test::sample("bracket", test::bracket(), 5000, 71);
  const pcl::PointCloud<pcl::PointXYZ>::Ptr points = test::toPcl(cloud);
  const std::vector<float> scrambled = test::scrambledNormals(cloud, 72);
};

TEST_F(SegmentOrientationTest, PointNormalOutputCarriesThePoint) {
  const auto normals = pcl::make_shared<pcl::PointCloud<pcl::PointNormal>>();
  pcl::copyPointCloud(*test::toPclNormals(scrambled), *normals);
  SegmentOrientation<pcl::PointXYZ, pcl::PointNormal> with_places;
  with_places.setInputCloud(points);
  with_places.setInputNormals(normals);
  pcl::PointCloud<pcl::PointNormal> out;
  with_places.compute(out);
  ASSERT_EQ(out.size(), points->size());
  for (std::size_t i = 0; i < out.size(); ++i) {
    ASSERT_EQ(out[i].getVector3fMap(), (*points)[i].getVector3fMap());
  }
}

// A search that nobody may ask.
class NoSearch : public pcl::search::KdTree<pcl::PointXYZ> {
 public:
  using Base = pcl::search::KdTree<pcl::PointXYZ>;
  using Base::nearestKSearch;
  int nearestKSearch(const pcl::PointXYZ& /*point*/, int /*k*/, pcl::Indices& /*indices*/,
                     std::vector<float>& /*distances*/) const override {
    ADD_FAILURE() << "there is a table";
    return 0;
  }
};

// Neighbours are found once for all stages.
TEST_F(SegmentOrientationTest, AReadyTableIsAsGoodAsASearch) {
  search::MedianHash<pcl::PointXYZ> search;
  search.setInputCloud(points);
  const auto table = std::make_shared<Neighborhoods>();
  search.nearestKSearchAll(20, *table);
  for (const auto method : {Orientation::AUTO, Orientation::COMBINED}) {
    orientation.setNeighborhoods({});
    orientation.setSearchMethod({});
    orientation.setKSearch(20);
    const Normals searched = orient(test::toPclNormals(scrambled), method);
    orientation.setNeighborhoods(table);
    orientation.setSearchMethod(pcl::make_shared<NoSearch>());
    for (const int k : {0, 20}) {
      orientation.setKSearch(k);
      const Normals ready = orient(test::toPclNormals(scrambled), method);
      ASSERT_EQ(ready.size(), searched.size());
      for (std::size_t i = 0; i < ready.size(); ++i) {
        ASSERT_EQ(ready[i].getNormalVector3fMap(), searched[i].getNormalVector3fMap()) << i;
      }
    }
  }
  orientation.setNeighborhoods(std::make_shared<Neighborhoods>());
  EXPECT_TRUE(orient(test::toPclNormals(scrambled), Orientation::COMBINED).empty());
  const auto alone = std::make_shared<Neighborhoods>();
  search.nearestKSearchAll(1, *alone);
  orientation.setNeighborhoods(alone);
  EXPECT_TRUE(orient(test::toPclNormals(scrambled), Orientation::COMBINED).empty());
}

TEST_F(SegmentOrientationTest, EachMethodTurnsTrueNormalsOutward) {
  for (const auto method :
       {Orientation::AUTO, Orientation::BOUNDARY, Orientation::COMBINED, Orientation::EXTREMAL}) {
    const Normals out = orient(test::toPclNormals(scrambled), method);
    ASSERT_EQ(out.size(), cloud.size());
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      wrong += test::agrees(out[i], cloud, i) ? 0 : 1;
      EXPECT_EQ(std::abs(out[i].normal_x), std::abs(scrambled[4 * i]));
    }
    EXPECT_LE(wrong, 5U) << toString(method);  // at most some at the very edges
    // Everything in a segment is turned: its reference normal and what its signs refer to.
    const Segmentation& used = orientation.getUsedSegmentation();
    std::size_t apart = 0;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      ASSERT_GE(used.labels[i], 0);
      const auto& reference =
          used.segments[static_cast<std::size_t>(used.labels[i])].reference_normal;
      const float* n = &cloud.normals[4 * i];
      const float along = reference[0] * n[0] + reference[1] * n[1] + reference[2] * n[2];
      const float own = test::dot3(&scrambled[4 * i], n) * static_cast<float>(used.signs[i]);
      apart += along > 0 && own > 0 ? 0 : 1;
    }
    EXPECT_LE(apart, cloud.size() / 20) << toString(method);  // strips along edges are mixed
  }
}

// A search that counts how often it is asked.
class CountingSearch : public pcl::search::KdTree<pcl::PointXYZ> {
 public:
  using pcl::search::KdTree<pcl::PointXYZ>::nearestKSearch;
  int nearestKSearch(const pcl::PointXYZ& point, int k, pcl::Indices& indices,
                     std::vector<float>& distances) const override {
    ++queries;
    return pcl::search::KdTree<pcl::PointXYZ>::nearestKSearch(point, k, indices, distances);
  }
  mutable std::size_t queries = 0;
};

TEST_F(SegmentOrientationTest, TakesASearchOfOthers) {
  points->push_back((*points)[0]);  // repeated points are one neighbour
  auto normals = test::toPclNormals(scrambled);
  normals->push_back((*normals)[0]);
  const Normals own = orient(normals, Orientation::COMBINED);
  const auto search = pcl::make_shared<CountingSearch>();
  orientation.setSearchMethod(search);
  const Normals theirs = orient(normals, Orientation::COMBINED);
  EXPECT_EQ(search->queries, cloud.size());
  ASSERT_EQ(theirs.size(), own.size());
  std::size_t different = 0;
  for (std::size_t i = 0; i < own.size(); ++i) {
    different += own[i].normal_x == theirs[i].normal_x ? 0 : 1;
  }
  EXPECT_LE(different, 5U);  // the repeated point costs its neighbours one entry
}

// A tube whose segments differ by about the growing angle: smooth borders that the angle between
// reference normals cannot decide, and the angle across the border can (paper, 3.1, and ours).
TEST_F(SegmentOrientationTest, TheAngleOfSegmentsIsSelectable) {
  const LabelledCloud ring = test::sample("torus", {test::torus(1, 0.4)}, 6000, 73);
  orientation.setInputCloud(test::toPcl(ring));
  orientation.setInputNormals(test::toPclNormals(test::scrambledNormals(ring, 74)));
  orientation.setMethod(Orientation::PROPAGATION);
  orientation.setGamma(0.35F);
  std::vector<std::size_t> hard;
  for (const auto angle : {SegmentAngle::REFERENCE_NORMALS, SegmentAngle::ACROSS_BORDER}) {
    orientation.setSegmentAngle(angle);
    Normals out;
    orientation.compute(out);
    hard.push_back(0);
    for (const auto& segment : orientation.getResult().segments) hard.back() += segment.hard;
  }
  EXPECT_GT(hard[0], 3 + 3 * hard[1]);
}

TEST_F(SegmentOrientationTest, HoppesTreeNeedsNoSegmentsButASmoothSurface) {
  const LabelledCloud ring = test::sample("torus", {test::torus(1, 0.4)}, 4000, 75);
  orientation.setInputCloud(test::toPcl(ring));
  orientation.setInputNormals(test::toPclNormals(test::scrambledNormals(ring, 76)));
  orientation.setMethod(Orientation::HOPPE);
  Normals out;
  orientation.compute(out);
  ASSERT_EQ(out.size(), ring.size());
  for (std::size_t i = 0; i < ring.size(); ++i) EXPECT_TRUE(test::agrees(out[i], ring, i));
  ASSERT_EQ(orientation.getResult().components.size(), 1U);
  EXPECT_EQ(orientation.getResult().components[0].by, DecidedBy::EXTREMAL);
}

TEST_F(SegmentOrientationTest, TakesSegmentsOfOthers) {
  auto segments = std::make_shared<Segmentation>();
  segments->labels.assign(cloud.face.begin(), cloud.face.end());
  segments->segments.resize(8);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const bool same = test::dot3(&scrambled[4 * i], &cloud.normals[4 * i]) > 0;
    const bool turned = cloud.face[i] % 2 == 1;
    segments->signs.push_back(same != turned ? std::int8_t{1} : std::int8_t{-1});
  }
  orientation.setSegmentation(segments);
  Normals out = orient(test::toPclNormals(scrambled), Orientation::BOUNDARY);
  ASSERT_EQ(out.size(), cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) EXPECT_TRUE(test::agrees(out[i], cloud, i));
  ASSERT_EQ(orientation.getResult().segments.size(), 8U);
  for (std::size_t s = 0; s < 8; ++s) {
    EXPECT_EQ(orientation.getResult().segments[s].sign, s % 2 == 1 ? -1 : 1);
    EXPECT_GT(orientation.getResult().segments[s].confidence, 0.5F);
  }
  EXPECT_EQ(orientation.getLabels(), segments->labels);

  segments->labels[17] = 8;  // no such segment
  orientation.compute(out);
  EXPECT_TRUE(out.empty());
}

// Noise of three spacings: positions are smoothed and the field decides, whoever made the segments.
TEST_F(SegmentOrientationTest, SegmentsOfOthersDoNotChangeTheSignsOfAuto) {
  LabelledCloud ring = test::sample("torus", {test::torus(1, 0.4)}, 6000, 77);
  std::mt19937 generator(78);
  std::normal_distribution<float> noise(0.F, 0.1F);
  for (std::size_t i = 0; i < ring.size(); ++i) {
    for (std::size_t a = 0; a < 3; ++a) ring.xyz[4 * i + a] += noise(generator);
  }
  orientation.setInputCloud(test::toPcl(ring));
  orientation.setInputNormals(test::toPclNormals(test::scrambledNormals(ring, 79)));
  Normals own;
  orientation.compute(own);
  ASSERT_EQ(own.size(), ring.size());
  EXPECT_GT(orientation.getResult().segments.size(), 1U);

  auto segments = std::make_shared<Segmentation>(orientation.getUsedSegmentation());
  std::fill(segments->labels.begin(), segments->labels.end(), 0);
  segments->segments.resize(1);
  orientation.setSegmentation(segments);
  Normals given;
  orientation.compute(given);
  ASSERT_EQ(given.size(), own.size());
  for (std::size_t i = 0; i < own.size(); ++i) EXPECT_EQ(given[i].normal_x, own[i].normal_x);
}

TEST_F(SegmentOrientationTest, CopesWithHolesAndRepeatedPoints) {
  auto normals = test::toPclNormals(scrambled);
  for (std::size_t i = 0; i < 50; ++i) {
    (*normals)[i].normal_y = std::numeric_limits<float>::quiet_NaN();
    (*points)[100 + i].x = std::numeric_limits<float>::infinity();
    (*normals)[200 + i].getNormalVector3fMap().setZero();
  }
  for (std::size_t i = 300; i < 600; ++i) {  // again, with the normal turned over
    points->push_back((*points)[i]);
    const pcl::Normal& n = (*normals)[i];
    normals->push_back(pcl::Normal(-n.normal_x, -n.normal_y, -n.normal_z));
  }
  const Normals out = orient(normals, Orientation::COMBINED);
  ASSERT_EQ(out.size(), points->size());
  EXPECT_FALSE(out.is_dense);
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const bool bad = i < 50 || (i >= 100 && i < 150) || (i >= 200 && i < 250);
    EXPECT_EQ(std::isnan(out[i].normal_x), bad) << i;
    if (!bad && !test::agrees(out[i], cloud, i)) ++wrong;
  }
  EXPECT_LE(wrong, 5U);
  for (std::size_t i = 0; i < 300; ++i) {
    EXPECT_EQ(out[cloud.size() + i].normal_x, out[300 + i].normal_x);
    EXPECT_EQ(out[cloud.size() + i].normal_z, out[300 + i].normal_z);
  }
}

TEST_F(SegmentOrientationTest, OutputBelongsToTheIndicesAndMayBeTheInput) {
  auto normals = test::toPclNormals(scrambled);
  orientation.setInputCloud(points);
  orientation.setInputNormals(normals);
  orientation.setIndices(pcl::make_shared<pcl::Indices>(pcl::Indices{10, 4999, -1, 5000}));
  orientation.compute(*normals);
  ASSERT_EQ(normals->size(), 4U);
  EXPECT_TRUE(test::agrees((*normals)[0], cloud, 10));
  EXPECT_TRUE(test::agrees((*normals)[1], cloud, 4999));
  EXPECT_TRUE(std::isnan((*normals)[2].normal_x));
  EXPECT_TRUE(std::isnan((*normals)[3].normal_x));
}

TEST_F(SegmentOrientationTest, WithoutTurningOutwardTheLargestSegmentKeepsItsSign) {
  std::vector<float> inward = cloud.normals;
  for (float& c : inward) c = -c;
  orientation.setTurnOutward(false);
  const Normals out = orient(test::toPclNormals(inward), Orientation::BOUNDARY);
  std::size_t outward = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) outward += test::agrees(out[i], cloud, i) ? 1 : 0;
  EXPECT_TRUE(outward <= 5 || outward + 5 >= cloud.size());
  EXPECT_EQ(orientation.getResult().segments[0].by, DecidedBy::SEED);
  EXPECT_EQ(orientation.getResult().segments[0].sign, 1);
}

TEST_F(SegmentOrientationTest, GettersReturnWhatWasSet) {
  orientation.setMethod(Orientation::EXTREMAL);
  orientation.setGamma(0.5F);
  orientation.setSegmentAngle(SegmentAngle::REFERENCE_NORMALS);
  orientation.setBoundaryTest(BoundaryTest::TRIANGULATED);
  orientation.setCheckBorders(false);
  const auto search = pcl::make_shared<pcl::search::KdTree<pcl::PointXYZ>>();
  orientation.setSearchMethod(search);
  orientation.setMinMargin(0.7F);
  orientation.setMaxBoxPoints(60);
  orientation.setTurnOutward(false);
  orientation.setNumberOfThreads(2);
  orientation.setKSearch(9);
  TriangulationOptions triangulation;
  triangulation.critical_factor = 1.F;
  orientation.setTriangulationOptions(triangulation);
  EXPECT_EQ(orientation.getTriangulationOptions().critical_factor, 1.F);
  EXPECT_EQ(orientation.getMethod(), Orientation::EXTREMAL);
  EXPECT_EQ(orientation.getGamma(), 0.5F);
  EXPECT_EQ(orientation.getSegmentAngle(), SegmentAngle::REFERENCE_NORMALS);
  EXPECT_EQ(orientation.getBoundaryTest(), BoundaryTest::TRIANGULATED);
  EXPECT_FALSE(orientation.getCheckBorders());
  EXPECT_EQ(orientation.getSearchMethod(), search);
  EXPECT_EQ(orientation.getMinMargin(), 0.7F);
  EXPECT_EQ(orientation.getMaxBoxPoints(), 60U);
  EXPECT_FALSE(orientation.getTurnOutward());
  EXPECT_EQ(orientation.getNumberOfThreads(), 2U);
  EXPECT_EQ(orientation.getKSearch(), 9);
}

}  // namespace
}  // namespace segorient
