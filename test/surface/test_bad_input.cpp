// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// SegmentTriangulation on everything that may be wrong with a cloud, its normals, its indices, its
// segmentation and the settings: an error and no polygons, or triangles of valid points.
#include <gtest/gtest.h>
#include <segorient/surface/segment_triangulation.h>

#include <functional>
#include <limits>

#include "bad_clouds.h"

namespace segorient::test {
namespace {

using Cloud = pcl::PointCloud<pcl::PointNormal>;
using Triangulation = SegmentTriangulation<pcl::PointNormal>;

Cloud::Ptr withNormals(const pcl::PointCloud<pcl::PointXYZ>& points, float z = 1.F) {
  auto cloud = pcl::make_shared<Cloud>();
  for (const auto& p : points) cloud->emplace_back(p.x, p.y, p.z, 0.F, 0.F, z);
  cloud->is_dense = points.is_dense;
  return cloud;
}

// All points in one segment.
Segmentation oneSegment(std::size_t size) {
  Segmentation s;
  s.labels.assign(size, 0);
  s.signs.assign(size, 1);
  for (std::size_t i = 0; i < size; ++i) s.members.push_back(static_cast<pcl::index_t>(i));
  Segment segment;
  segment.size = static_cast<std::uint32_t>(size);
  segment.reference_normal = {0.F, 0.F, 1.F};
  s.segments.push_back(segment);
  return s;
}

class BadInput : public testing::Test {
 protected:
  std::size_t trianglesOf(const pcl::PointCloud<pcl::PointXYZ>& points,
                          const pcl::IndicesPtr& indices = nullptr) {
    std::vector<pcl::Vertices> polygons(2);
    triangulation_.reconstruct(polygons);
    std::vector<bool> used(points.size(), false);
    const std::size_t rows = indices ? indices->size() : points.size();
    for (std::size_t i = 0; i < rows; ++i) {
      const pcl::PointXYZ* point = pointOf(points, indices, i);
      if (point != nullptr) used[static_cast<std::size_t>(point - &points[0])] = true;
    }
    for (const auto& polygon : polygons) {
      EXPECT_EQ(polygon.vertices.size(), 3U);
      for (const auto v : polygon.vertices) EXPECT_TRUE(used.at(static_cast<std::size_t>(v))) << v;
    }
    pcl::PolygonMesh mesh;
    triangulation_.reconstruct(mesh);
    EXPECT_EQ(mesh.polygons.size(), polygons.size());
    return polygons.size();
  }

  const QuietPcl quiet_;
  Triangulation triangulation_;
};

TEST_F(BadInput, CloudsIndicesNormalsAndSegmentations) {
  triangulation_.setNumberOfThreads(1);
  forEachBadInput([&](const BadCloud& bad, const IndexCase& index) {
    const std::size_t size = bad.cloud->size();
    triangulation_.setIndices(index.indices);
    const bool few = index.indices && index.indices->size() < 100;
    std::size_t with_unit_normals = 0;
    for (const float z : {1.F, 1e30F, 0.F, kNaN, kInfinity}) {
      triangulation_.setInputCloud(withNormals(*bad.cloud, z));
      triangulation_.setSegmentation({});
      const std::size_t own = trianglesOf(*bad.cloud, index.indices);
      if (z == 1.F) with_unit_normals = own;
      const bool some = (z == 1.F || z == 1e30F) && bad.planes != Planes::NONE;
      EXPECT_EQ(own, some ? with_unit_normals : 0U) << "normal " << z;
      triangulation_.setSegmentation(oneSegment(size));
      trianglesOf(*bad.cloud, index.indices);
      triangulation_.setSegmentation(oneSegment(size + 1));  // of another cloud
      EXPECT_EQ(trianglesOf(*bad.cloud, index.indices), 0U);
    }
    if (bad.name == "unharmed" && !few) {
      triangulation_.setSegmentation(oneSegment(size));
      EXPECT_GT(trianglesOf(*bad.cloud, index.indices), 200U);
    }
  });
}

// A grid with holes, as a depth camera sees it, gives the mesh of the same points in a list.
TEST_F(BadInput, OrganisedCloudsWithHoles) {
  constexpr std::uint32_t kWidth = 20;
  constexpr std::uint32_t kHeight = 15;
  pcl::PointCloud<pcl::PointXYZ> grid;
  for (std::uint32_t i = 0; i < kWidth * kHeight; ++i) {
    const float x = i % 7 == 3 ? kNaN : static_cast<float>(i % kWidth);
    grid.emplace_back(x, static_cast<float>(i / kWidth), 0.F);
  }
  grid.is_dense = false;
  const Cloud::Ptr list = withNormals(grid);
  const Cloud::Ptr organised = withNormals(grid);
  organised->width = kWidth;
  organised->height = kHeight;
  for (const Segmentation& segmentation : {Segmentation{}, oneSegment(grid.size())}) {
    triangulation_.setSegmentation(segmentation);
    triangulation_.setInputCloud(list);
    pcl::PolygonMesh expected;
    triangulation_.reconstruct(expected);
    triangulation_.setInputCloud(organised);
    pcl::PolygonMesh mesh;
    triangulation_.reconstruct(mesh);
    EXPECT_GT(trianglesOf(grid), 200U);
    ASSERT_EQ(mesh.polygons.size(), expected.polygons.size());
    for (std::size_t i = 0; i < mesh.polygons.size(); ++i) {
      EXPECT_EQ(mesh.polygons[i].vertices, expected.polygons[i].vertices);
    }
    EXPECT_EQ(mesh.cloud.width, kWidth);
    EXPECT_EQ(mesh.cloud.height, kHeight);
  }
}

TEST_F(BadInput, NoCloud) {
  EXPECT_EQ(trianglesOf({}), 0U);
  triangulation_.setInputCloud(withNormals(curvedPatch(100)));
  triangulation_.setSegmentation(oneSegment(100));
  EXPECT_GT(trianglesOf(curvedPatch(100)), 100U);
  triangulation_.setInputCloud(nullptr);
  EXPECT_EQ(trianglesOf({}), 0U);
  EXPECT_TRUE(triangulation_.getMeshes().empty());
  pcl::PolygonMesh mesh;
  EXPECT_FALSE(triangulation_.getSegmentMesh(0, mesh));
}

TEST_F(BadInput, BrokenSegmentations) {
  struct Case {
    const char* name;
    std::function<void(Segmentation&)> change;
  };
  const std::vector<Case> cases{
      {"member out of range", [](Segmentation& s) { s.members[3] = 5000; }},
      {"negative member", [](Segmentation& s) { s.members[3] = -1; }},
      {"too large a segment", [](Segmentation& s) { s.segments[0].size = 4000; }},
      {"range that wraps around", [](Segmentation& s) { s.segments[0].first = 0xffffffffU; }},
      {"too few labels", [](Segmentation& s) { s.labels.resize(3); }}};
  const auto points = curvedPatch(100);
  triangulation_.setInputCloud(withNormals(points));
  for (const Case& c : cases) {
    SCOPED_TRACE(c.name);
    Segmentation s = oneSegment(100);
    c.change(s);
    triangulation_.setSegmentation(s);
    EXPECT_EQ(trianglesOf(points), 0U);
  }
  Segmentation s = oneSegment(100);
  s.segments[0].reference_normal = {kNaN, 0.F, 0.F};
  triangulation_.setSegmentation(s);
  EXPECT_EQ(trianglesOf(points), 0U);
}

TEST_F(BadInput, StrangeSettings) {
  const auto points = curvedPatch(100);
  triangulation_.setInputCloud(withNormals(points));
  triangulation_.setSegmentation(oneSegment(100));
  for (const float value : {0.F, -1.F, 1e30F, kNaN, kInfinity}) {
    triangulation_.setKappa1(value);
    triangulation_.setKappa2(value);
    triangulation_.setCriticalFactor(value);
    for (const int bins : {std::numeric_limits<int>::min(), -7, 0, 1, 1 << 30}) {
      triangulation_.setNumberOfBins(bins);
      trianglesOf(points);
    }
  }
}

}  // namespace
}  // namespace segorient::test
