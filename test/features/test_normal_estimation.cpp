// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <gtest/gtest.h>
#include <pcl/features/normal_3d_omp.h>
#include <pcl/search/kdtree.h>
#include <segorient/features/awas_normal_estimation.h>
#include <segorient/features/lct_normal_estimation.h>
#include <segorient/features/ldt_normal_estimation.h>
#include <segorient/features/plane_normal_estimation.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>
#include <utility>

#include "feature_clouds.h"

namespace segorient::test {
namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;
using Normals = pcl::PointCloud<pcl::Normal>;
using Plane = PlaneNormalEstimation<pcl::PointXYZ, pcl::Normal>;
using PclPlane = pcl::NormalEstimationOMP<pcl::PointXYZ, pcl::Normal>;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

/// PCL's normals are single precision throughout: a few of them are off by more than its rounding.
void expectSameAsPcl(const Normals& ours, const Normals& theirs) {
  ASSERT_EQ(ours.size(), theirs.size());
  EXPECT_EQ(ours.width, theirs.width);
  EXPECT_EQ(ours.height, theirs.height);
  EXPECT_EQ(ours.is_dense, theirs.is_dense);
  std::size_t different = 0;
  for (std::size_t i = 0; i < ours.size(); ++i) {
    if (std::isnan(theirs[i].normal_x)) {
      EXPECT_TRUE(std::isnan(ours[i].normal_x) && std::isnan(ours[i].curvature));
      continue;
    }
    const float same = ours[i].getNormalVector3fMap().dot(theirs[i].getNormalVector3fMap());
    different += same < 0.9999F || std::abs(ours[i].curvature - theirs[i].curvature) > 1e-4F;
  }
  EXPECT_LE(different, ours.size() / 200);
}

template <typename Estimation>
Normals computed(Estimation&& estimation) {
  Normals normals;
  estimation.compute(normals);
  return normals;
}

TEST(PlaneNormalEstimation, DropInForPcl) {
  const Cloud::Ptr cloud = Cloud(torus(6000, 1).points).makeShared();
  Plane ours;
  PclPlane theirs;
  ours.setInputCloud(cloud);
  theirs.setInputCloud(cloud);
  for (const int k : {5, 11, 30}) {
    ours.setKSearch(k);
    theirs.setKSearch(k);
    expectSameAsPcl(computed(ours), computed(theirs));
  }
  ours.setKSearch(0);
  theirs.setKSearch(0);
  ours.setRadiusSearch(0.12);
  theirs.setRadiusSearch(0.12);
  expectSameAsPcl(computed(ours), computed(theirs));

  for (const std::size_t step : {2U, 50U}) {  // many and few indices take different ways
    const auto indices = pcl::make_shared<pcl::Indices>();
    for (std::size_t i = 0; i < cloud->size(); i += step) {
      indices->push_back(static_cast<pcl::index_t>(cloud->size() - 1 - i));
    }
    ours.setIndices(indices);
    theirs.setIndices(indices);
    expectSameAsPcl(computed(ours), computed(theirs));
    ours.setRadiusSearch(0);
    theirs.setRadiusSearch(0);
    ours.setKSearch(15);
    theirs.setKSearch(15);
    expectSameAsPcl(computed(ours), computed(theirs));
  }
}

TEST(PlaneNormalEstimation, SearchSurfaceAndViewpoint) {
  const Cloud::Ptr surface = Cloud(torus(6000, 1).points).makeShared();
  const Cloud::Ptr queries = Cloud(torus(500, 2).points).makeShared();
  Plane ours;
  PclPlane theirs;
  ours.setInputCloud(queries);
  theirs.setInputCloud(queries);
  ours.setSearchSurface(surface);
  theirs.setSearchSurface(surface);
  ours.setViewPoint(1, 2, 30);
  theirs.setViewPoint(1, 2, 30);
  ours.setKSearch(12);
  theirs.setKSearch(12);
  const Normals expected = computed(theirs);
  expectSameAsPcl(computed(ours), expected);
  ours.setSearchMethod(pcl::make_shared<pcl::search::KdTree<pcl::PointXYZ>>());
  expectSameAsPcl(computed(ours), expected);
}

TEST(PlaneNormalEstimation, SearchMethodOfAnotherCloudIsRebuilt) {
  const Cloud::Ptr cloud = Cloud(torus(2000, 1).points).makeShared();
  const auto tree = pcl::make_shared<pcl::search::KdTree<pcl::PointXYZ>>();
  tree->setInputCloud(Cloud(sphere(50, 1).points).makeShared());
  Plane ours;
  ours.setInputCloud(cloud);
  ours.setKSearch(10);
  const Normals expected = computed(ours);
  ours.setSearchMethod(tree);
  expectSameAsPcl(computed(ours), expected);
  EXPECT_EQ(tree->getInputCloud(), cloud);
}

/// A search of somebody's own, as plain as it may be: writes into the room that PCL gives it.
class PlainSearch : public pcl::search::Search<pcl::PointXYZ> {
 public:
  PlainSearch() : Search("PlainSearch") {}
  int nearestKSearch(const pcl::PointXYZ& point, int k, pcl::Indices& indices,
                     std::vector<float>& distances) const override {
    EXPECT_GE(indices.size(), static_cast<std::size_t>(k));
    EXPECT_GE(distances.size(), static_cast<std::size_t>(k));
    std::vector<std::pair<float, pcl::index_t>> all;
    for (std::size_t i = 0; i < input_->size(); ++i) {
      const float d = (point.getVector3fMap() - (*input_)[i].getVector3fMap()).squaredNorm();
      all.emplace_back(d, static_cast<pcl::index_t>(i));
    }
    std::sort(all.begin(), all.end());
    const int found = std::min(k - missing, static_cast<int>(all.size()));
    for (int i = 0; i < found; ++i) {
      std::tie(distances[static_cast<std::size_t>(i)], indices[static_cast<std::size_t>(i)]) =
          all[static_cast<std::size_t>(i)];
    }
    return found;
  }
  int radiusSearch(const pcl::PointXYZ&, double, pcl::Indices&, std::vector<float>&,
                   unsigned int) const override {
    return 0;
  }
  int missing = 0;  ///< finds so many less than it is asked for, and leaves the rest as it is
};

TEST(PlaneNormalEstimation, SearchThatNeedsRoom) {
  const Cloud::Ptr cloud = Cloud(torus(400, 5).points).makeShared();
  const auto plain = pcl::make_shared<PlainSearch>();
  for (const int missing : {0, 3}) {
    plain->missing = missing;
    Plane ours(2);
    ours.setInputCloud(cloud);
    ours.setSearchMethod(plain);
    ours.setKSearch(12);
    PclPlane theirs;
    theirs.setInputCloud(cloud);
    theirs.setKSearch(12 - missing);
    expectSameAsPcl(computed(ours), computed(theirs));
  }
  Plane more;
  more.setInputCloud(cloud);
  more.setSearchMethod(plain);
  plain->missing = 0;
  more.setKSearch(1000000000);  // all there are
  EXPECT_EQ(computed(more).size(), cloud->size());
  more.setKSearch(0);
  more.setRadiusSearch(0.1);  // finds nothing
  for (const auto& n : computed(more)) EXPECT_TRUE(std::isnan(n.normal_x));
}

TEST(NormalEstimation, ConstructorsTakeThreads) {
  using Out = pcl::Normal;
  EXPECT_EQ(Plane(4).getNumberOfThreads(), 4U);
  EXPECT_EQ((LCTNormalEstimation<pcl::PointXYZ, Out>(3).getNumberOfThreads()), 3U);
  EXPECT_EQ((LDTNormalEstimation<pcl::PointXYZ, Out>(2).getNumberOfThreads()), 2U);
  EXPECT_EQ((AwASNormalEstimation<pcl::PointXYZ, Out>(1).getNumberOfThreads()), 1U);
  EXPECT_EQ(Plane().getNumberOfThreads(), 0U);
}

TEST(PlaneNormalEstimation, AnyNumberOfThreadsGivesTheSame) {
  const Cloud::Ptr cloud = Cloud(torus(3000, 2).points).makeShared();
  Normals expected;
  for (const unsigned int threads : {1U, 7U, 65536U, 4294967295U}) {
    Plane ours(threads);
    ours.setInputCloud(cloud);
    ours.setKSearch(12);
    const Normals normals = computed(ours);
    if (threads == 1) expected = normals;
    for (std::size_t i = 0; i < cloud->size(); ++i) {
      EXPECT_EQ(normals[i].getNormalVector3fMap(), expected[i].getNormalVector3fMap());
    }
  }
}

TEST(PlaneNormalEstimation, OrganizedWithHoles) {
  Cloud cloud(40, 30);
  cloud.is_dense = false;
  for (unsigned u = 0; u < 40; ++u) {
    for (unsigned v = 0; v < 30; ++v) {
      const float x = 0.1F * static_cast<float>(u);
      const float y = 0.1F * static_cast<float>(v);
      cloud(u, v) = {x, y, 2.F + 0.05F * x * x};
      if ((u + 3 * v) % 17 == 0) cloud(u, v).z = kNaN;
    }
  }
  const Cloud::Ptr shared = cloud.makeShared();
  Plane ours;
  PclPlane theirs;
  ours.setInputCloud(shared);
  theirs.setInputCloud(shared);
  theirs.setSearchMethod(pcl::make_shared<pcl::search::KdTree<pcl::PointXYZ>>());
  ours.setKSearch(9);
  theirs.setKSearch(9);
  const Normals a = computed(ours);
  const Normals b = computed(theirs);
  EXPECT_EQ(a.width, 40U);
  EXPECT_EQ(a.height, 30U);
  EXPECT_FALSE(a.is_dense);
  // On a grid the ninth neighbour is one of several equally far: only the holes must agree.
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(std::isnan(a[i].normal_x), std::isnan(b[i].normal_x));
  }
}

TEST(PlaneNormalEstimation, ReadyTable) {
  const Sample sample = torus(3000, 5);
  const Cloud::Ptr cloud = Cloud(sample.points).makeShared();
  const auto table = pcl::make_shared<Neighborhoods>(neighborsOf(sample.view(), 19));
  Plane by_search;
  Plane by_table;
  by_search.setInputCloud(cloud);
  by_table.setInputCloud(cloud);
  by_table.setNeighborhoods(table);
  EXPECT_EQ(by_table.getNeighborhoods(), table);
  const auto expectEqual = [](const Normals& a, const Normals& b) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
      ASSERT_EQ(a[i].getNormalVector3fMap(), b[i].getNormalVector3fMap());
    }
  };
  by_search.setKSearch(20);
  expectEqual(computed(by_search), computed(by_table));
  by_search.setKSearch(12);
  by_table.setKSearch(12);
  expectEqual(computed(by_search), computed(by_table));
  const auto indices = pcl::make_shared<pcl::Indices>(pcl::Indices{5, 4, 2000, 5});
  by_search.setIndices(indices);
  by_table.setIndices(indices);
  expectEqual(computed(by_search), computed(by_table));

  // A table of all points is read by point also where the indices are all points in another order.
  const auto reversed = pcl::make_shared<pcl::Indices>(cloud->size());
  std::iota(reversed->rbegin(), reversed->rend(), 0);
  by_search.setIndices(reversed);
  by_table.setIndices(reversed);
  expectEqual(computed(by_search), computed(by_table));

  by_table.setInputCloud(Cloud(sphere(77, 1).points).makeShared());
  by_table.setIndices(pcl::IndicesPtr());
  EXPECT_TRUE(computed(by_table).empty());  // a table of another cloud
}

TEST(PlaneNormalEstimation, PointNormalOutputCarriesThePoint) {
  const Cloud::Ptr cloud = Cloud(torus(500, 5).points).makeShared();
  PlaneNormalEstimation<pcl::PointXYZ, pcl::PointNormal> estimation;
  estimation.setInputCloud(cloud);
  estimation.setKSearch(8);
  pcl::PointCloud<pcl::PointNormal> out;
  estimation.compute(out);
  ASSERT_EQ(out.size(), cloud->size());
  for (std::size_t i = 0; i < out.size(); ++i) {
    EXPECT_EQ(out[i].getVector3fMap(), (*cloud)[i].getVector3fMap());
  }
}

TEST(PlaneNormalEstimation, DuplicatesDoNotFillNeighborhoods) {
  const Sample sample = torus(2000, 3);
  Cloud cloud;
  for (int copy = 0; copy < 12; ++copy) cloud += sample.points;
  Plane single;
  Plane repeated;
  single.setInputCloud(Cloud(sample.points).makeShared());
  repeated.setInputCloud(cloud.makeShared());
  single.setKSearch(10);
  repeated.setKSearch(10);
  const Normals a = computed(single);
  const Normals b = computed(repeated);
  ASSERT_EQ(b.size(), cloud.size());
  for (std::size_t i = 0; i < b.size(); ++i) {
    ASSERT_EQ(a[i % a.size()].getNormalVector3fMap(), b[i].getNormalVector3fMap());
  }
}

TEST(AwASNormalEstimation, SettersAndCurvatures) {
  AwASNormalEstimation<pcl::PointXYZ, pcl::Normal> estimation;
  EXPECT_EQ(estimation.getDegree(), 2);
  EXPECT_EQ(estimation.getFirstGuess(), NormalEstimator::PLANE);
  const Sample ball = sphere(3000, 1);
  estimation.setInputCloud(Cloud(ball.points).makeShared());
  estimation.setKSearch(20);
  estimation.setDegree(3);
  estimation.setFirstGuess(NormalEstimator::LCT);
  estimation.setNumberOfThreads(2);
  EXPECT_EQ(estimation.getDegree(), 3);
  EXPECT_EQ(estimation.getFirstGuess(), NormalEstimator::LCT);
  EXPECT_EQ(estimation.getNumberOfThreads(), 2U);
  const Normals cubic = computed(estimation);
  estimation.setDegree(2);
  const Normals quadratic = computed(estimation);
  double errors[2] = {0, 0};
  for (std::size_t i = 0; i < ball.normals.size(); ++i) {
    errors[0] += angleBetween(ball.normals[i], quadratic[i].normal);
    errors[1] += angleBetween(ball.normals[i], cubic[i].normal);
  }
  EXPECT_LT(errors[0], 3000 * 0.1 * kDegree);
  EXPECT_LT(errors[1], 3000 * 0.1 * kDegree);
  EXPECT_NE(errors[0], errors[1]);

  pcl::PointCloud<pcl::PrincipalCurvatures> curvatures;
  estimation.getPrincipalCurvatures(curvatures);
  EXPECT_TRUE(curvatures.empty());
  estimation.setComputePrincipalCurvatures(true);
  estimation.setViewPoint(0, 0, 0);  // in the sphere's centre: normals inward
  computed(estimation);
  estimation.getPrincipalCurvatures(curvatures);
  ASSERT_EQ(curvatures.size(), ball.normals.size());
  for (const auto& c : curvatures) {
    ASSERT_NEAR(c.pc1, 1.F, 0.15F);
    ASSERT_NEAR(c.pc2, 1.F, 0.15F);
  }
  estimation.setViewPoint(100, 0, 0);
  computed(estimation);
  estimation.getPrincipalCurvatures(curvatures);
  for (std::size_t i = 0; i < curvatures.size(); ++i) {
    if (std::abs(ball.normals[i].x()) < 0.1F) continue;
    ASSERT_NEAR(curvatures[i].pc1, ball.normals[i].x() > 0.F ? -1.F : 1.F, 0.15F);
  }
}

}  // namespace
}  // namespace segorient::test
