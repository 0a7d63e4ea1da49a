// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <gtest/gtest.h>
#include <pcl/search/kdtree.h>
#include <pcl/segmentation/region_growing.h>
#include <segorient/segmentation/normal_segmentation.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <set>

#include "partition_quality.h"
#include "segmentation_support.h"

namespace segorient::test {
namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;
using Normals = pcl::PointCloud<pcl::Normal>;
using Segmenter = NormalSegmentation<pcl::PointXYZ, pcl::Normal>;

struct PclInput {
  explicit PclInput(const Prepared& in) {
    for (std::size_t i = 0; i < in.cloud.size(); ++i) {
      cloud->emplace_back(in.cloud.xyz[4 * i], in.cloud.xyz[4 * i + 1], in.cloud.xyz[4 * i + 2]);
      const float* n = &in.normals[4 * i];
      normals->emplace_back(n[0], n[1], n[2], n[3]);
    }
  }
  Cloud::Ptr cloud{new Cloud};
  Normals::Ptr normals{new Normals};
};

// A pipeline as users have it: only the type changes.
template <typename SegmentationT>
std::vector<pcl::PointIndices> runPipeline(const PclInput& in) {
  SegmentationT segmentation;
  segmentation.setMinClusterSize(50);
  segmentation.setMaxClusterSize(1000000);
  segmentation.setSearchMethod(
      pcl::search::Search<pcl::PointXYZ>::Ptr(new pcl::search::KdTree<pcl::PointXYZ>));
  segmentation.setNumberOfNeighbours(20);
  segmentation.setInputCloud(in.cloud);
  segmentation.setInputNormals(in.normals);
  segmentation.setSmoothnessThreshold(static_cast<float>(8.0 / 180.0 * M_PI));
  segmentation.setCurvatureThreshold(0.1F);
  std::vector<pcl::PointIndices> clusters;
  segmentation.extract(clusters);
  EXPECT_EQ(segmentation.getColoredCloud()->size(), in.cloud->size());
  pcl::PointIndices one;
  segmentation.getSegmentFromPoint(clusters.front().indices.front(), one);
  EXPECT_EQ(one.indices.size(), clusters.front().indices.size());
  return clusters;
}

TEST(NormalSegmentation, DropsInForRegionGrowing) {
  const PclInput in(Prepared(sample("cube", cube(), 12000, 1)));
  const auto theirs = runPipeline<pcl::RegionGrowing<pcl::PointXYZ, pcl::Normal>>(in);
  const auto ours = runPipeline<Segmenter>(in);
  EXPECT_EQ(theirs.size(), 6U);
  EXPECT_EQ(ours.size(), 6U);
}

TEST(NormalSegmentation, LabelsAndClustersAgree) {
  const Prepared prepared(sample("bracket", bracket(), 8000, 2));
  const PclInput in(prepared);
  Segmenter segmentation;
  segmentation.setInputCloud(in.cloud);
  segmentation.setInputNormals(in.normals);
  std::vector<pcl::PointIndices> clusters;
  segmentation.extract(clusters);
  ASSERT_EQ(clusters.size(), segmentation.getPlanarSegmentation().segments.size());
  std::size_t points = 0;
  for (std::size_t c = 0; c < clusters.size(); ++c) {
    points += clusters[c].indices.size();
    for (const pcl::index_t i : clusters[c].indices) {
      EXPECT_EQ(segmentation.getLabels()[static_cast<std::size_t>(i)],
                static_cast<std::int32_t>(c));
    }
  }
  EXPECT_EQ(points, in.cloud->size());
  // The partition is that of the core, whose points are in another order here.
  EXPECT_GE(adjustedRandIndex(segmentation.getLabels(), prepared.segment().labels), 0.99);

  pcl::PointIndices cluster;
  segmentation.getSegmentFromPoint(clusters[1].indices[0], cluster);
  EXPECT_EQ(cluster.indices, clusters[1].indices);
  segmentation.getSegmentFromPoint(-1, cluster);
  EXPECT_TRUE(cluster.indices.empty());
  segmentation.getSegmentFromPoint(1000000, cluster);
  EXPECT_TRUE(cluster.indices.empty());
}

TEST(NormalSegmentation, ClusterSizesFilterOnlyTheOutput) {
  const PclInput in(Prepared(sample("bracket", bracket(), 8000, 2)));
  Segmenter segmentation;
  segmentation.setInputCloud(in.cloud);
  segmentation.setInputNormals(in.normals);
  std::vector<pcl::PointIndices> all;
  segmentation.extract(all);
  segmentation.setMinClusterSize(100);
  segmentation.setMaxClusterSize(static_cast<pcl::uindex_t>(all[1].indices.size()));
  std::vector<pcl::PointIndices> some;
  segmentation.extract(some);
  for (const auto& cluster : some) {
    EXPECT_GE(cluster.indices.size(), 100U);
    EXPECT_LE(cluster.indices.size(), all[1].indices.size());
  }
  EXPECT_LT(some.size(), all.size());
  EXPECT_EQ(segmentation.getPlanarSegmentation().segments.size(), all.size());
}

TEST(NormalSegmentation, AllWaysToNeighborsGiveTheSame) {
  const Prepared prepared(sample("holed", holedSolid(), 8000, 3));
  const PclInput in(prepared);
  Segmenter own;
  own.setInputCloud(in.cloud);
  own.setInputNormals(in.normals);
  std::vector<pcl::PointIndices> clusters;
  own.extract(clusters);
  Segmenter searched;
  searched.setInputCloud(in.cloud);
  searched.setInputNormals(in.normals);
  searched.setSearchMethod(
      pcl::search::Search<pcl::PointXYZ>::Ptr(new pcl::search::KdTree<pcl::PointXYZ>));
  searched.extract(clusters);
  EXPECT_EQ(own.getLabels(), searched.getLabels());
  Segmenter ready;
  ready.setInputCloud(in.cloud);
  ready.setInputNormals(in.normals);
  ready.setNeighborhoods(std::make_shared<const Neighborhoods>(prepared.table));
  ready.extract(clusters);
  SegmentationOptions options;
  options.neighbors = static_cast<int>(ready.getNumberOfNeighbours());
  EXPECT_EQ(ready.getPlanarSegmentation().labels, prepared.segment(options).labels);
}

TEST(NormalSegmentation, IndicesAndBadPoints) {
  const Prepared prepared(sample("cube", cube(), 9000, 4));
  PclInput in(prepared);
  (*in.cloud)[6].x = std::numeric_limits<float>::quiet_NaN();
  (*in.normals)[9].normal_y = std::numeric_limits<float>::quiet_NaN();
  in.cloud->is_dense = false;
  pcl::IndicesPtr indices(new pcl::Indices);
  std::set<pcl::index_t> wanted;
  for (std::size_t i = 0; i < in.cloud->size(); ++i) {
    if (prepared.cloud.face[i] == 2) continue;
    indices->push_back(static_cast<pcl::index_t>(i));
    wanted.insert(indices->back());
  }
  wanted.erase(6);
  wanted.erase(9);
  indices->insert(indices->end(), {-4, 1 << 30, indices->front()});
  const bool ready_table[] = {false, true};
  for (const bool ready : ready_table) {
    Segmenter segmentation;
    segmentation.setInputCloud(in.cloud);
    segmentation.setInputNormals(in.normals);
    segmentation.setIndices(indices);
    if (ready) segmentation.setNeighborhoods(std::make_shared<const Neighborhoods>(prepared.table));
    std::vector<pcl::PointIndices> clusters;
    segmentation.extract(clusters);
    std::set<pcl::index_t> seen;
    std::size_t total = 0;
    for (const auto& cluster : clusters) {
      seen.insert(cluster.indices.begin(), cluster.indices.end());
      total += cluster.indices.size();
    }
    EXPECT_EQ(seen, wanted);
    EXPECT_EQ(total, wanted.size());
    EXPECT_EQ(std::count_if(clusters.begin(), clusters.end(),
                            [](const auto& c) { return c.indices.size() > 500; }),
              5);
  }
}

// A search that holds the points of the last call is put on those of this one.
TEST(NormalSegmentation, OneSearchServesOneSetOfIndicesAfterTheOther) {
  const PclInput in(Prepared(sample("cube", cube(), 6000, 4)));
  const auto search = pcl::make_shared<pcl::search::KdTree<pcl::PointXYZ>>();
  pcl::Indices all(in.cloud->size());
  std::iota(all.begin(), all.end(), 0);
  const auto half = static_cast<std::ptrdiff_t>(all.size() / 2);
  const std::vector<pcl::Indices> subsets{pcl::Indices(all.begin(), all.begin() + half),
                                          pcl::Indices(all.begin() + half, all.end()), all};
  Segmenter used;
  used.setSearchMethod(search);
  for (const pcl::Indices& subset : subsets) {
    Segmenter fresh;
    std::vector<pcl::PointIndices> clusters;
    for (Segmenter* segmentation : {&used, &fresh}) {
      segmentation->setInputCloud(in.cloud);
      segmentation->setInputNormals(in.normals);
      segmentation->setIndices(pcl::make_shared<pcl::Indices>(subset));
      segmentation->extract(clusters);
    }
    EXPECT_EQ(used.getLabels(), fresh.getLabels());
  }
}

TEST(NormalSegmentation, DuplicatesShareTheirLabel) {
  const Prepared prepared(sample("cube", cube(), 3000, 5));
  PclInput in(prepared);
  const std::size_t n = in.cloud->size();
  for (std::size_t copy = 0; copy < 30; ++copy) {
    for (std::size_t i = 0; i < n; i += 2) {
      in.cloud->push_back((*in.cloud)[i]);
      pcl::Normal normal = (*in.normals)[i];
      normal.getNormalVector3fMap() *= -1.F;
      in.normals->push_back(normal);
    }
  }
  Segmenter segmentation;
  segmentation.setInputCloud(in.cloud);
  segmentation.setInputNormals(in.normals);
  std::vector<pcl::PointIndices> clusters;
  segmentation.extract(clusters);
  const Segmentation& s = segmentation.getPlanarSegmentation();
  for (std::size_t at = n, i = 0; at < in.cloud->size(); ++at, i = i + 2 < n ? i + 2 : 0) {
    EXPECT_EQ(s.labels[at], s.labels[i]);
    EXPECT_EQ(s.signs[at], -s.signs[i]);
  }
  EXPECT_GE(
      purity(std::vector<std::int32_t>(s.labels.begin(), s.labels.begin() + static_cast<long>(n)),
             prepared.cloud.face),
      0.97);
  const SegmentGraph graph = segmentation.getPlanarSegmentGraph();
  EXPECT_FALSE(graph.pairs.empty());
  for (const SegmentBorder& border : graph.borders) {
    for (std::size_t i = border.first; i < border.first + border.size; ++i) {
      EXPECT_EQ(s.labels[static_cast<std::size_t>(graph.pairs[i].in_a)], border.a);
      EXPECT_EQ(s.labels[static_cast<std::size_t>(graph.pairs[i].in_b)], border.b);
    }
  }
}

TEST(NormalSegmentation, ShufflingDoesNotMatter) {
  const PclInput in(Prepared(sample("cylinder", cylinder(), 10000, 6, 0.1)));
  std::vector<std::size_t> order(in.cloud->size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::shuffle(order.begin(), order.end(), std::mt19937(1));
  Cloud::Ptr cloud(new Cloud);
  Normals::Ptr normals(new Normals);
  for (const std::size_t i : order) {
    cloud->push_back((*in.cloud)[i]);
    normals->push_back((*in.normals)[i]);
  }
  std::vector<pcl::PointIndices> clusters;
  Segmenter segmentation;
  segmentation.setInputCloud(in.cloud);
  segmentation.setInputNormals(in.normals);
  segmentation.extract(clusters);
  const std::vector<std::int32_t> before = segmentation.getLabels();
  segmentation.setInputCloud(cloud);
  segmentation.setInputNormals(normals);
  segmentation.extract(clusters);
  std::vector<std::int32_t> after(before.size());
  for (std::size_t i = 0; i < order.size(); ++i) after[order[i]] = segmentation.getLabels()[i];
  EXPECT_DOUBLE_EQ(adjustedRandIndex(before, after), 1.0);
}

TEST(NormalSegmentation, RotationHardlyMatters) {
  std::vector<std::vector<std::int32_t>> labels;
  for (const double angle : {0.0, 0.7}) {
    LabelledCloud cloud = sample("bracket", bracket(), 15000, 8);
    const Eigen::Matrix3f turn =
        Eigen::AngleAxisf(static_cast<float>(angle), Eigen::Vector3f(1, 2, 3).normalized())
            .toRotationMatrix();
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      Eigen::Map<Eigen::Vector3f> p(&cloud.xyz[4 * i]);
      p = (turn * p).eval();
    }
    const PclInput in{Prepared(std::move(cloud))};
    Segmenter segmentation;
    segmentation.setInputCloud(in.cloud);
    segmentation.setInputNormals(in.normals);
    std::vector<pcl::PointIndices> clusters;
    segmentation.extract(clusters);
    labels.push_back(segmentation.getLabels());
  }
  EXPECT_GE(adjustedRandIndex(labels[0], labels[1]), 0.98);
}

TEST(NormalSegmentation, ColorsAreOfTheLabel) {
  const PclInput in(Prepared(sample("cube", cube(), 3000, 5)));
  (*in.normals)[0].normal_x = std::numeric_limits<float>::quiet_NaN();
  Segmenter segmentation;
  EXPECT_EQ(segmentation.getColoredCloud(), nullptr);
  segmentation.setInputCloud(in.cloud);
  segmentation.setInputNormals(in.normals);
  std::vector<pcl::PointIndices> clusters;
  segmentation.extract(clusters);
  const auto rgb = segmentation.getColoredCloud();
  const auto rgba = segmentation.getColoredCloudRGBA();
  ASSERT_EQ(rgb->size(), in.cloud->size());
  std::set<std::uint32_t> of_first;
  std::set<std::uint32_t> of_faces;
  for (std::size_t i = 0; i < rgb->size(); ++i) {
    EXPECT_EQ((*rgb)[i].r, (*rgba)[i].r);
    EXPECT_EQ((*rgb)[i].x, (*in.cloud)[i].x);
    const std::int32_t label = segmentation.getLabels()[i];
    if (label == 0) of_first.insert((*rgb)[i].rgba);
    if (label >= 0 && label < 6) of_faces.insert((*rgb)[i].rgba);
  }
  EXPECT_EQ(of_first.size(), 1U);
  EXPECT_EQ(of_faces.size(), 6U);
  EXPECT_EQ((*rgb)[0].r, (*rgb)[0].g);
}

/// A quarter of a cylinder of radius 1, points in a grid, true normals.
class OnACylinder : public testing::Test {
 protected:
  OnACylinder() {
    for (int i = 0; i < 60; ++i) {
      for (int j = 0; j < 40; ++j) {
        const float angle = 1.5F * static_cast<float>(i) / 59.F;
        cloud->push_back({std::cos(angle), std::sin(angle), 0.025F * static_cast<float>(j)});
        normals->push_back({std::cos(angle), std::sin(angle), 0.F});
      }
    }
    s.setInputCloud(cloud);
    s.setInputNormals(normals);
  }
  void growByAlphaAlone() {
    s.setReferenceThreshold(2.F);
    s.setSmoothnessThreshold(0.3F);
    s.setUniteSmooth(false);
  }
  void leaveAsGrown() {
    s.setAbsorbSmall(false);
    s.setExtractEdges(false);
    s.setConnectSmall(false);
    s.setSettleEdges(false);
  }
  void expectFacesWithinAlphaOfTheirSeeds() {
    std::vector<pcl::PointIndices> clusters;
    s.extract(clusters);
    EXPECT_GE(clusters.size(), 3U) << "1.5 in parts of at most .6";
    for (const pcl::PointIndices& cluster : clusters) {
      float low = 9.F;
      float high = -9.F;
      for (const pcl::index_t i : cluster.indices) {
        const auto& p = (*cloud)[static_cast<std::size_t>(i)];
        low = std::min(low, std::atan2(p.y, p.x));
        high = std::max(high, std::atan2(p.y, p.x));
      }
      EXPECT_LE(high - low, 2.F * 0.3F + 1e-3F);
    }
  }

  const pcl::PointCloud<pcl::PointXYZ>::Ptr cloud{new pcl::PointCloud<pcl::PointXYZ>};
  const pcl::PointCloud<pcl::Normal>::Ptr normals{new pcl::PointCloud<pcl::Normal>};
  Segmenter s;
};

std::size_t facesOf(Segmenter& s) {
  std::vector<pcl::PointIndices> clusters;
  s.extract(clusters);
  return clusters.size();
}

TEST_F(OnACylinder, SmoothModeAndResidualAsInRegionGrowing) {
  growByAlphaAlone();
  EXPECT_EQ(facesOf(s), 1U) << "from neighbour to neighbour it is one face";
  s.setSmoothModeFlag(false);
  expectFacesWithinAlphaOfTheirSeeds();
  s.setSmoothModeFlag(true);
  s.setResidualTestFlag(true);  // a neighbour is off the tangent plane by .0003 to .003
  s.setResidualThreshold(0.1F);
  EXPECT_EQ(facesOf(s), 1U);
  leaveAsGrown();
  s.setResidualThreshold(1e-5F);
  EXPECT_GE(facesOf(s), 12U) << "no farther than to the next columns";
}

// What a test parted must not be united again because its border is smooth.
TEST_F(OnACylinder, UnitingHeedsTheTests) {
  for (std::size_t i = 0; i < cloud->size(); ++i) {  // three columns in the middle are rough
    const float angle = std::atan2((*cloud)[i].y, (*cloud)[i].x);
    (*normals)[i].curvature = angle > 0.7F && angle < 0.77F ? 0.2F : 0.01F;
  }
  EXPECT_EQ(facesOf(s), 1U) << "parted by beta alone";
  s.setSmoothModeFlag(false);
  s.setSmoothnessThreshold(0.3F);
  expectFacesWithinAlphaOfTheirSeeds();
  s.setSmoothModeFlag(true);
  s.setCurvatureThreshold(0.1F);
  EXPECT_GE(facesOf(s), 2U);
  s.setCurvatureTestFlag(false);
  EXPECT_EQ(facesOf(s), 1U);
  s.setResidualTestFlag(true);
  s.setResidualThreshold(1e-5F);
  EXPECT_GE(facesOf(s), 5U);
}

using Partition = std::set<std::set<pcl::index_t>>;

template <typename SegmentationT>
Partition partition(SegmentationT& segmentation) {
  std::vector<pcl::PointIndices> clusters;
  segmentation.extract(clusters);
  Partition out;
  for (const pcl::PointIndices& c : clusters) out.emplace(c.indices.begin(), c.indices.end());
  return out;
}

// With everything off that PCL does not have, the modes and tests cut as PCL's do.
TEST(NormalSegmentation, BareGrowingIsThatOfRegionGrowing) {
  const PclInput in(Prepared(sample("cube", cube(), 3000, 1)));
  pcl::RegionGrowing<pcl::PointXYZ, pcl::Normal> theirs;
  Segmenter ours;
  ours.setReferenceThreshold(2.F);
  ours.setMaximumGap(0.F);
  ours.setMaximumOffset(0.F);
  ours.setAbsorbSmall(false);
  ours.setExtractEdges(false);
  ours.setSettleEdges(false);
  ours.setConnectSmall(false);
  theirs.setNumberOfNeighbours(11);  // the point itself is one
  ours.setNumberOfNeighbours(10);
  const auto both = [&](auto&& set) {
    set(theirs);
    set(ours);
  };
  both([&](auto& s) {
    s.setInputCloud(in.cloud);
    s.setInputNormals(in.normals);
    s.setSmoothnessThreshold(0.1F);
    s.setCurvatureThreshold(0.02F);
    s.setResidualThreshold(0.01F);
  });
  ours.setUniteSmooth(false);
  std::set<std::size_t> sizes;
  for (const bool smooth : {true, false}) {
    for (const int tests : {1, 2, 3}) {
      both([&](auto& s) {
        s.setSmoothModeFlag(smooth);
        s.setCurvatureTestFlag((tests & 1) != 0);
        s.setResidualTestFlag((tests & 2) != 0);
        s.setCurvatureTestFlag((tests & 1) != 0);
      });
      const Partition expected = partition(theirs);
      EXPECT_EQ(partition(ours), expected) << smooth << " " << tests;
      sizes.insert(expected.size());
    }
  }
  EXPECT_GE(sizes.size(), 4U) << "the settings make a difference";
}

TEST_F(OnACylinder, ResidualIsInTheUnitOfTheCloud) {
  growByAlphaAlone();
  leaveAsGrown();
  s.setResidualTestFlag(true);
  for (const float unit : {1e-3F, 1.F, 1e3F}) {
    const auto scaled = pcl::make_shared<pcl::PointCloud<pcl::PointXYZ>>(*cloud);
    for (pcl::PointXYZ& p : *scaled) {
      for (float* v : {&p.x, &p.y, &p.z}) *v *= unit;
    }
    s.setInputCloud(scaled);
    s.setResidualThreshold(0.1F * unit);
    EXPECT_EQ(facesOf(s), 1U) << unit;
    s.setResidualThreshold(1e-5F * unit);
    EXPECT_GE(facesOf(s), 12U) << unit;
  }
}

TEST_F(OnACylinder, SettingsWithoutAMeaningGiveNoSegments) {
  s.setNumberOfNeighbours(0);
  EXPECT_EQ(s.getNumberOfNeighbours(), 0U);
  EXPECT_EQ(facesOf(s), 0U);
  s.setNumberOfNeighbours(10);
  EXPECT_GE(facesOf(s), 1U);
  s.setResidualTestFlag(true);
  for (const float bad : {0.F, -10.F, std::numeric_limits<float>::quiet_NaN()}) {
    s.setResidualThreshold(bad);
    EXPECT_EQ(facesOf(s), 0U);
  }
  s.setResidualTestFlag(false);
  EXPECT_GE(facesOf(s), 1U);
}

TEST_F(OnACylinder, ExtractSeesWhatChangedInPlace) {
  EXPECT_GE(facesOf(s), 1U);
  for (auto& n : *normals) n.normal_x = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(facesOf(s), 0U);
}

TEST(NormalSegmentation, SettersHaveGetters) {
  Segmenter s;
  s.setNumberOfNeighbours(9);
  s.setSmoothnessThreshold(0.1F);
  s.setReferenceThreshold(0.2F);
  s.setReferenceTolerance(0.05F);
  s.setCurvatureThreshold(0.3F);
  s.setCurvatureTestFlag(false);
  s.setSmallSegmentSize(7);
  s.setNeighborShare(0.6F);
  s.setMaximumGap(4.F);
  s.setMaximumOffset(0.7F);
  s.setAbsorbSmall(false);
  s.setExtractEdges(false);
  s.setConnectSmall(false);
  s.setSettleEdges(false);
  s.setMinClusterSize(3);
  s.setMaxClusterSize(5);
  s.setNumberOfThreads(2);
  EXPECT_EQ(s.getNumberOfNeighbours(), 9U);
  EXPECT_EQ(s.getSmoothnessThreshold(), 0.1F);
  EXPECT_EQ(s.getReferenceThreshold(), 0.2F);
  EXPECT_EQ(s.getReferenceTolerance(), 0.05F);
  EXPECT_EQ(s.getCurvatureThreshold(), 0.3F);
  EXPECT_FALSE(s.getCurvatureTestFlag());
  EXPECT_EQ(s.getSmallSegmentSize(), 7U);
  EXPECT_EQ(s.getNeighborShare(), 0.6F);
  EXPECT_EQ(s.getMaximumGap(), 4.F);
  EXPECT_EQ(s.getMaximumOffset(), 0.7F);
  EXPECT_FALSE(s.getAbsorbSmall() || s.getExtractEdges() || s.getConnectSmall() ||
               s.getSettleEdges());
  EXPECT_EQ(s.getMinClusterSize(), 3U);
  EXPECT_EQ(s.getMaxClusterSize(), 5U);
  EXPECT_EQ(s.getNumberOfThreads(), 2U);
  EXPECT_TRUE(s.getSmoothModeFlag());
  EXPECT_FALSE(s.getResidualTestFlag());
  EXPECT_EQ(s.getResidualThreshold(),
            (pcl::RegionGrowing<pcl::PointXYZ, pcl::Normal>().getResidualThreshold()));
  s.setSmoothModeFlag(false);
  s.setResidualTestFlag(true);
  s.setResidualThreshold(0.5F);
  EXPECT_FALSE(s.getSmoothModeFlag());
  EXPECT_TRUE(s.getResidualTestFlag());
  EXPECT_EQ(s.getResidualThreshold(), 0.5F);
  EXPECT_EQ(s.getSearchMethod(), nullptr);
  EXPECT_EQ(s.getNeighborhoods(), nullptr);
  EXPECT_EQ(s.getInputNormals(), nullptr);
}

}  // namespace
}  // namespace segorient::test
