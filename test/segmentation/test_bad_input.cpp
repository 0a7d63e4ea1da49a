// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <gtest/gtest.h>
#include <segorient/search/median_hash.h>
#include <segorient/segmentation/normal_segmentation.h>

#include <algorithm>
#include <functional>
#include <limits>

#include "bad_clouds.h"
#include "common/bulk_bounds.h"

namespace segorient::test {
namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;
using Normals = pcl::PointCloud<pcl::Normal>;

struct NormalsCase {
  const char* name;
  std::function<void(Normals&)> change;
  bool labelled;  ///< whether any valid point ends up in a segment
};

const std::vector<NormalsCase> kNormals{
    {"good", [](Normals&) {}, true},
    {"too few", [](Normals& n) { n.resize(n.size() / 2); }, false},
    {"too many", [](Normals& n) { n.resize(n.size() + 1); }, false},
    {"NaN",
     [](Normals& n) {
       for (auto& p : n) p.normal_x = kNaN;
     },
     false},
    {"zero",
     [](Normals& n) {
       for (auto& p : n) p.normal_z = 0.F;
     },
     false},
    {"infinite",
     [](Normals& n) {
       for (auto& p : n) p.normal_z = kInfinity;
     },
     false},
    {"huge",
     [](Normals& n) {
       for (auto& p : n) p.normal_z *= 1e30F;
     },
     true},
    {"tiny",
     [](Normals& n) {
       for (auto& p : n) p.normal_z *= 1e-30F;
     },
     true},
    {"NaN curvature",
     [](Normals& n) {
       for (auto& p : n) p.curvature = kNaN;
     },
     true}};

void makePlane(Cloud& cloud, Normals& normals) {
  cloud = curvedPatch(400);
  normals.resize(400);
  for (auto& n : normals) n.normal_z = 1.F;
}

class BadInput : public ::testing::Test {
 protected:
  const QuietPcl quiet_;
};

// Labels exactly where there is a point to label, members and clusters as the labels say.
void checkSegments(const BadCloud& bad, const IndexCase& index, bool labelled,
                   NormalSegmentation<pcl::PointXYZ, pcl::Normal>& segmentation) {
  std::vector<pcl::PointIndices> clusters(3);
  segmentation.extract(clusters);
  const std::size_t size = bad.cloud->size();
  std::vector<bool> wanted(size, false);
  const std::size_t rows = index.indices ? index.indices->size() : size;
  const auto position = [&](std::size_t i) -> std::array<double, 3> {
    const pcl::PointXYZ* p = pointOf(*bad.cloud, index.indices, i);
    const double none = std::numeric_limits<double>::quiet_NaN();
    if (p == nullptr) return {none, none, none};
    return {static_cast<double>(p->x), static_cast<double>(p->y), static_cast<double>(p->z)};
  };
  const Bounds bulk = bulkBounds(rows, position);
  for (std::size_t i = 0; i < rows; ++i) {
    const pcl::PointXYZ* point = pointOf(*bad.cloud, index.indices, i);
    if (point == nullptr || bulk.isBeyondFloats(position(i))) continue;
    wanted[static_cast<std::size_t>(point - &(*bad.cloud)[0])] = labelled;
  }
  const std::vector<std::int32_t>& labels = segmentation.getLabels();
  if (!labels.empty()) {
    ASSERT_EQ(labels.size(), size);
    for (std::size_t i = 0; i < size; ++i) ASSERT_EQ(labels[i] >= 0, wanted[i]) << i;
  }
  const auto count = std::count(wanted.begin(), wanted.end(), true);
  std::size_t members = 0;
  for (const auto& cluster : clusters) members += cluster.indices.size();
  EXPECT_EQ(members, static_cast<std::size_t>(count));
  pcl::PointIndices cluster;
  segmentation.getSegmentFromPoint(-1, cluster);
  EXPECT_TRUE(cluster.indices.empty());
  segmentation.getColoredCloud();
  segmentation.getPlanarSegmentGraph();
}

// One object for all of them: what it was used for before must not matter.
TEST_F(BadInput, CloudsIndicesAndNormals) {
  NormalSegmentation<pcl::PointXYZ, pcl::Normal> segmentation;
  segmentation.setNumberOfThreads(1);
  forEachBadInput([&](const BadCloud& bad, const IndexCase& index) {
    for (const NormalsCase& c : kNormals) {
      SCOPED_TRACE(c.name);
      const std::size_t size = bad.cloud->size();
      auto normals = pcl::make_shared<Normals>(size, 1, pcl::Normal(0.F, 0.F, 1.F));
      c.change(*normals);
      segmentation.setInputCloud(bad.cloud);
      segmentation.setIndices(index.indices);
      segmentation.setInputNormals(normals);
      for (const unsigned int k : {1U, 5U, std::numeric_limits<unsigned int>::max()}) {
        segmentation.setNumberOfNeighbours(k);
        checkSegments(bad, index, c.labelled, segmentation);
      }
    }
  });
}

// Also where floats cannot hold their squares.
TEST_F(BadInput, LengthsOfNormalsDoNotMatter) {
  auto cloud = pcl::make_shared<Cloud>();
  for (int face = 0; face < 2; ++face) {
    for (int i = 0; i < 400; ++i) {
      const float u = 0.05F * (static_cast<float>(i % 20) + 0.5F);
      const float v = 0.05F * (static_cast<float>(i / 20) + 0.5F);
      cloud->emplace_back(face == 0 ? u : 0.F, v, face == 0 ? 0.F : u);
    }
  }
  std::vector<std::int32_t> labels;
  for (const float length : {1.F, 1e-30F, 1e-20F, 1e20F, 1e30F}) {
    auto normals = pcl::make_shared<Normals>();
    for (std::size_t i = 0; i < cloud->size(); ++i) {
      normals->emplace_back(i < 400 ? 0.F : length, 0.F, i < 400 ? length : 0.F);
    }
    NormalSegmentation<pcl::PointXYZ, pcl::Normal> segmentation;
    segmentation.setInputCloud(cloud);
    segmentation.setInputNormals(normals);
    std::vector<pcl::PointIndices> clusters;
    segmentation.extract(clusters);
    EXPECT_EQ(clusters.size(), 2U) << length;
    if (labels.empty()) labels = segmentation.getLabels();
    EXPECT_EQ(segmentation.getLabels(), labels) << length;
  }
}

TEST_F(BadInput, SearchOfAnotherCloud) {
  Cloud::Ptr cloud(new Cloud);
  Normals::Ptr normals(new Normals);
  makePlane(*cloud, *normals);
  NormalSegmentation<pcl::PointXYZ, pcl::Normal> segmentation;
  pcl::search::KdTree<pcl::PointXYZ>::Ptr search(new search::MedianHash<pcl::PointXYZ>);
  search->setInputCloud(curvedPatch(7).makeShared());
  segmentation.setSearchMethod(search);
  segmentation.setInputCloud(cloud);
  segmentation.setInputNormals(normals);
  std::vector<pcl::PointIndices> clusters;
  segmentation.extract(clusters);
  EXPECT_EQ(std::count(segmentation.getLabels().begin(), segmentation.getLabels().end(), -1), 0);
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
