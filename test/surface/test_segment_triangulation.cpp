// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <gtest/gtest.h>
#include <pcl/console/print.h>
#include <pcl/conversions.h>
#include <pcl/point_types.h>
#include <segorient/surface/segment_triangulation.h>
#include <segorient/segmentation/impl/cloud_segmentation.hpp>

#include <limits>
#include <set>

#include "labelled_solids.h"

namespace segorient::test {
namespace {

using Cloud = pcl::PointCloud<pcl::PointNormal>;
using Triangulation = SegmentTriangulation<pcl::PointNormal>;

Cloud::Ptr toPcl(const LabelledCloud& in) {
  Cloud::Ptr cloud(new Cloud);
  for (std::size_t i = 0; i < in.size(); ++i) {
    pcl::PointNormal p;
    p.getVector3fMap() = Eigen::Map<const Eigen::Vector3f>(&in.xyz[4 * i]);
    p.getNormalVector3fMap() = Eigen::Map<const Eigen::Vector3f>(&in.normals[4 * i]);
    p.curvature = 0;
    cloud->push_back(p);
  }
  return cloud;
}

Segmentation facesOf(const LabelledCloud& in) {
  CloudSegmentation::Input input;
  input.points = {in.xyz.data(), 4, in.size()};
  input.normals = {in.normals.data(), 4, in.size()};
  CloudSegmentation segmentation;
  EXPECT_TRUE(segmentation.compute(input, {}));
  return segmentation.segmentation();
}

TEST(SegmentTriangulation, FacesOfAHoledSolid) {
  const LabelledCloud in = sample("holed", holedSolid(), 20000, 1);
  Triangulation triangulation;
  triangulation.setInputCloud(toPcl(in));
  pcl::PolygonMesh mesh;
  triangulation.reconstruct(mesh);
  EXPECT_EQ(mesh.cloud.width * mesh.cloud.height, in.size());
  std::size_t polygons = 0;
  double area = 0;
  std::size_t holes = 0;
  for (const SegmentMesh& m : triangulation.getMeshes()) {
    polygons += m.triangles.size();
    area += m.area;
    holes += static_cast<std::size_t>(std::count(m.is_hole.begin(), m.is_hole.end(), 1));
  }
  EXPECT_EQ(mesh.polygons.size(), polygons);
  EXPECT_NEAR(area, in.area, 0.08 * in.area);
  EXPECT_EQ(holes, 4U);
  // All turn the same way as the segments' normals.
  const Segmentation s = facesOf(in);
  std::size_t checked = 0;
  for (const auto& polygon : mesh.polygons) {
    ASSERT_EQ(polygon.vertices.size(), 3U);
    const auto point = [&](int i) {
      const auto v = static_cast<std::size_t>(polygon.vertices[static_cast<std::size_t>(i)]);
      return Eigen::Vector3f(in.xyz[4 * v], in.xyz[4 * v + 1], in.xyz[4 * v + 2]);
    };
    const auto label = s.labels[static_cast<std::size_t>(polygon.vertices[0])];
    const Eigen::Vector3f normal(
        s.segments[static_cast<std::size_t>(label)].reference_normal.data());
    if ((point(1) - point(0)).cross(point(2) - point(0)).dot(normal) > 0) ++checked;
  }
  EXPECT_EQ(checked, mesh.polygons.size());
}

TEST(SegmentTriangulation, GivenSegmentationAndSingleMeshes) {
  const LabelledCloud in = sample("cube", cube(), 6000, 2);
  Triangulation triangulation;
  triangulation.setInputCloud(toPcl(in));
  triangulation.setSegmentation(facesOf(in));
  std::vector<pcl::Vertices> polygons;
  triangulation.reconstruct(polygons);
  pcl::PolygonMesh one;
  ASSERT_TRUE(triangulation.getSegmentMesh(0, one));
  EXPECT_EQ(one.polygons.size(), triangulation.getMeshes()[0].triangles.size());
  Cloud points;
  pcl::fromPCLPointCloud2(one.cloud, points);
  EXPECT_EQ(points.size(), triangulation.getSegmentation().segments[0].size);
  for (const auto& polygon : one.polygons) {
    for (const auto v : polygon.vertices) ASSERT_LT(static_cast<std::size_t>(v), points.size());
  }
  EXPECT_FALSE(triangulation.getSegmentMesh(1000, one));
  EXPECT_TRUE(one.polygons.empty());

  const auto meshes = triangulation.getMeshes();
  triangulation.setNumberOfThreads(2);
  std::vector<pcl::Vertices> again;
  triangulation.reconstruct(again);
  ASSERT_EQ(again.size(), polygons.size());
  for (std::size_t i = 0; i < again.size(); ++i) ASSERT_EQ(again[i].vertices, polygons[i].vertices);
}

// What was triangulated stays what it was when another cloud is set.
TEST(SegmentTriangulation, MeshesAreOfTheCloudThatWasTriangulated) {
  Triangulation triangulation;
  triangulation.setInputCloud(toPcl(sample("cube", cube(), 6000, 2)));
  pcl::PolygonMesh all;
  pcl::PolygonMesh before;
  triangulation.reconstruct(all);
  ASSERT_TRUE(triangulation.getSegmentMesh(0, before));
  triangulation.setInputCloud(toPcl(sample("cube", cube(), 20, 3)));
  pcl::PolygonMesh after;
  ASSERT_TRUE(triangulation.getSegmentMesh(0, after));
  EXPECT_EQ(after.cloud.data, before.cloud.data);
  EXPECT_EQ(after.polygons.size(), before.polygons.size());
}

TEST(SegmentTriangulation, IndicesLimitTheMesh) {
  const LabelledCloud in = sample("cube", cube(), 6000, 3);
  for (const bool given : {false, true}) {
    Triangulation triangulation;
    triangulation.setInputCloud(toPcl(in));
    if (given) triangulation.setSegmentation(facesOf(in));
    pcl::IndicesPtr indices(new pcl::Indices{-3, 1 << 30});
    for (pcl::index_t i = 0; i < 6000; ++i) {
      if (in.face[static_cast<std::size_t>(i)] < 3) indices->push_back(i);
    }
    triangulation.setIndices(indices);
    std::vector<pcl::Vertices> polygons;
    triangulation.reconstruct(polygons);
    EXPECT_GT(polygons.size(), 5000U);
    for (const auto& polygon : polygons) {
      for (const auto v : polygon.vertices) ASSERT_LT(in.face[static_cast<std::size_t>(v)], 3);
    }
  }
}

TEST(SegmentTriangulation, AllSegments) {
  LabelledCloud in = sample("cube", cube(), 3000, 4);
  Segmentation s = facesOf(in);
  for (Segment& segment : s.segments) segment.kind = SegmentKind::CONNECTED;
  Triangulation triangulation;
  triangulation.setInputCloud(toPcl(in));
  triangulation.setSegmentation(s);
  std::vector<pcl::Vertices> polygons;
  triangulation.reconstruct(polygons);
  EXPECT_TRUE(polygons.empty());
  triangulation.setAllSegments(true);
  triangulation.reconstruct(polygons);
  EXPECT_GT(polygons.size(), 5000U);
}

TEST(SegmentTriangulation, SettersHaveGetters) {
  Triangulation t;
  t.setKappa1(0.2F);
  t.setKappa2(0.5F);
  t.setCriticalFactor(1.5F);
  t.setNumberOfBins(30);
  t.setFillGaps(false);
  t.setAllSegments(true);
  t.setNumberOfThreads(3);
  EXPECT_EQ(t.getKappa1(), 0.2F);
  EXPECT_EQ(t.getKappa2(), 0.5F);
  EXPECT_EQ(t.getCriticalFactor(), 1.5F);
  EXPECT_EQ(t.getNumberOfBins(), 30);
  EXPECT_FALSE(t.getFillGaps());
  EXPECT_TRUE(t.getAllSegments());
  EXPECT_EQ(t.getNumberOfThreads(), 3U);
}

}  // namespace
}  // namespace segorient::test
