// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <gtest/gtest.h>
#include <pcl/console/print.h>
#include <segorient/segmentation/normal_segmentation.h>

#include <functional>
#include <limits>
#include <random>
#include <string>

namespace segorient::test {
namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;
using Normals = pcl::PointCloud<pcl::Normal>;

struct Case {
  std::string name;
  std::function<void(Cloud&, Normals&)> change;
  bool labelled;  ///< whether any point ends up in a segment
};

const float kNaN = std::numeric_limits<float>::quiet_NaN();
const float kInfinity = std::numeric_limits<float>::infinity();

void scaleBy(Cloud& cloud, float factor) {
  for (auto& p : cloud) p.getVector3fMap() *= factor;
}

std::vector<Case> cases() {
  const auto keep = [](std::size_t n) {
    return [n](Cloud& c, Normals& m) {
      c.resize(n);
      m.resize(n);
    };
  };
  return {
      {"unchanged", [](Cloud&, Normals&) {}, true},
      {"empty", keep(0), false},
      {"one point", keep(1), true},
      {"two points", keep(2), true},
      {"three points", keep(3), true},
      {"all duplicates",
       [](Cloud& c, Normals&) {
         for (auto& p : c) p = c[0];
       },
       true},
      {"half duplicates",
       [](Cloud& c, Normals&) {
         for (std::size_t i = 0; i < c.size() / 2; ++i) c[i] = c[0];
       },
       true},
      {"collinear",
       [](Cloud& c, Normals&) {
         for (auto& p : c) p.y = p.z = 0;
       },
       true},
      {"all NaN",
       [](Cloud& c, Normals&) {
         for (auto& p : c) p.x = kNaN;
       },
       false},
      {"some Inf, said to be dense",
       [](Cloud& c, Normals&) {
         for (std::size_t i = 0; i < c.size(); i += 3) c[i].z = kInfinity;
       },
       true},
      {"normals of another size", [](Cloud&, Normals& m) { m.resize(3); }, false},
      {"NaN normals",
       [](Cloud&, Normals& m) {
         for (auto& n : m) n.normal_x = kNaN;
       },
       false},
      {"zero normals",
       [](Cloud&, Normals& m) {
         for (auto& n : m) n.normal_x = n.normal_y = n.normal_z = 0;
       },
       false},
      {"infinite normals",
       [](Cloud&, Normals& m) {
         for (auto& n : m) n.normal_z = kInfinity;
       },
       false},
      {"NaN curvature",
       [](Cloud&, Normals& m) {
         for (auto& n : m) n.curvature = kNaN;
       },
       true},
      {"huge", [](Cloud& c, Normals&) { scaleBy(c, 1e30F); }, true},
      {"tiny", [](Cloud& c, Normals&) { scaleBy(c, 1e-30F); }, true},
      {"denormal", [](Cloud& c, Normals&) { scaleBy(c, 1e-41F); }, true},
      {"far away",
       [](Cloud& c, Normals&) {
         for (auto& p : c) p.x += 4e6F;
       },
       true},
  };
}

void makePlane(Cloud& cloud, Normals& normals) {
  std::mt19937 rng(1);
  std::uniform_real_distribution<float> unit(0.F, 1.F);
  for (int i = 0; i < 400; ++i) {
    cloud.emplace_back(unit(rng), unit(rng), 0.01F * unit(rng));
    normals.emplace_back(0.F, 0.F, 1.F, 0.F);
  }
}

class BadInput : public ::testing::Test {
 protected:
  void SetUp() override { pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS); }
};

TEST_F(BadInput, Clouds) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    Cloud::Ptr cloud(new Cloud);
    Normals::Ptr normals(new Normals);
    makePlane(*cloud, *normals);
    c.change(*cloud, *normals);
    NormalSegmentation<pcl::PointXYZ, pcl::Normal> segmentation;
    segmentation.setInputCloud(cloud);
    segmentation.setInputNormals(normals);
    for (const unsigned int k : {0U, 5U, 1000U, std::numeric_limits<unsigned int>::max()}) {
      segmentation.setNumberOfNeighbours(k);
      std::vector<pcl::PointIndices> clusters(3);
      segmentation.extract(clusters);
      EXPECT_EQ(!clusters.empty(), c.labelled) << "k " << k;
      pcl::PointIndices cluster;
      segmentation.getSegmentFromPoint(0, cluster);
      segmentation.getColoredCloud();
      segmentation.getSegmentGraph();
    }
  }
}

TEST_F(BadInput, NullsAndReuse) {
  Cloud::Ptr cloud(new Cloud);
  Normals::Ptr normals(new Normals);
  makePlane(*cloud, *normals);
  NormalSegmentation<pcl::PointXYZ, pcl::Normal> segmentation;
  std::vector<pcl::PointIndices> clusters;
  segmentation.extract(clusters);
  EXPECT_TRUE(clusters.empty());
  segmentation.setInputCloud(nullptr);
  segmentation.extract(clusters);
  EXPECT_TRUE(clusters.empty());
  segmentation.setInputCloud(cloud);
  segmentation.extract(clusters);
  EXPECT_TRUE(clusters.empty());
  segmentation.setInputNormals(normals);
  segmentation.extract(clusters);
  EXPECT_FALSE(clusters.empty());
  segmentation.setIndices(pcl::IndicesPtr(new pcl::Indices));
  segmentation.extract(clusters);
  EXPECT_TRUE(clusters.empty());
  segmentation.setIndices(pcl::IndicesConstPtr());
  segmentation.extract(clusters);
  EXPECT_FALSE(clusters.empty());
  segmentation.setIndices(pcl::IndicesPtr(new pcl::Indices{-1, 4000, 7, 7}));
  segmentation.extract(clusters);
  ASSERT_EQ(clusters.size(), 1U);
  EXPECT_EQ(clusters[0].indices, pcl::Indices{7});
  Cloud::Ptr other(new Cloud(*cloud));
  other->resize(100);
  segmentation.setInputCloud(other);
  segmentation.extract(clusters);
  EXPECT_TRUE(clusters.empty());
  EXPECT_TRUE(segmentation.getLabels().empty());
}

TEST_F(BadInput, StrangeSettings) {
  Cloud::Ptr cloud(new Cloud);
  Normals::Ptr normals(new Normals);
  makePlane(*cloud, *normals);
  for (const float value : {0.F, -1.F, 100.F, kNaN, kInfinity}) {
    NormalSegmentation<pcl::PointXYZ, pcl::Normal> segmentation;
    segmentation.setInputCloud(cloud);
    segmentation.setInputNormals(normals);
    segmentation.setSmoothnessThreshold(value);
    segmentation.setReferenceThreshold(value);
    segmentation.setReferenceTolerance(value);
    segmentation.setNeighborShare(value);
    segmentation.setMaximumGap(value);
    segmentation.setMaximumOffset(value);
    for (const std::size_t small : {std::size_t{0}, std::numeric_limits<std::size_t>::max()}) {
      segmentation.setSmallSegmentSize(small);
      std::vector<pcl::PointIndices> clusters;
      segmentation.extract(clusters);
      EXPECT_EQ(segmentation.getLabels().size(), cloud->size());
    }
  }
}

TEST_F(BadInput, TableOfAnotherCloud) {
  Cloud::Ptr cloud(new Cloud);
  Normals::Ptr normals(new Normals);
  makePlane(*cloud, *normals);
  auto table = std::make_shared<Neighborhoods>();
  for (const std::size_t rows : {std::size_t{0}, std::size_t{10}, cloud->size()}) {
    table->reset(rows, 4);
    for (std::size_t r = 0; r < rows; ++r) {
      table->setCount(r, 1);
      table->mutableIndices(r)[0] = 1 << 20;
    }
    NormalSegmentation<pcl::PointXYZ, pcl::Normal> segmentation;
    segmentation.setInputCloud(cloud);
    segmentation.setInputNormals(normals);
    segmentation.setNeighborhoods(table);
    std::vector<pcl::PointIndices> clusters;
    segmentation.extract(clusters);
    EXPECT_TRUE(clusters.empty());
  }
}

}  // namespace
}  // namespace segorient::test
