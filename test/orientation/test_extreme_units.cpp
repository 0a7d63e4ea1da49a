// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
//
// Units that nobody has: squares and cubes of such lengths are beyond floats, and no class may
// mind.
#include <gtest/gtest.h>
#include <pcl/common/io.h>
#include <segorient/surface/segment_triangulation.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "bad_clouds.h"
#include "every_class.h"

namespace segorient::test {
namespace {

XyzCloud::Ptr inUnit(const XyzCloud& cloud, float unit) {
  const auto out = cloud.makeShared();
  for (pcl::PointXYZ& p : *out) {
    for (float* v : {&p.x, &p.y, &p.z}) *v *= unit;
  }
  return out;
}

// By a power of two nothing is rounded, so that nothing at all may change.
std::string nameOf(float unit) {
  return unit < 1.F ? "1e-30" : "1e30";
}

TEST(ExtremeUnits, OfPowersOfTwoChangeNothing) {
  const QuietPcl quiet;
  const XyzCloud clean = shapes();
  const std::vector<ClassResult> expected = runEveryClass(clean.makeShared());
  for (const int exponent : {-100, 100}) {
    const std::vector<ClassResult> found = runEveryClass(inUnit(clean, std::ldexp(1.F, exponent)));
    for (std::size_t c = 0; c < expected.size(); ++c) {
      SCOPED_TRACE(expected[c].name + ", 2^" + std::to_string(exponent));
      EXPECT_EQ(found[c].labels, expected[c].labels);
      ASSERT_EQ(found[c].normals.size(), expected[c].normals.size());
      std::size_t other = 0;
      for (std::size_t i = 0; i < expected[c].normals.size(); ++i) {
        other += !isSame(found[c].normals[i], expected[c].normals[i]);
      }
      EXPECT_EQ(other, 0U);
    }
  }
}

TEST(ExtremeUnits, GiveTheSameSigns) {
  const QuietPcl quiet;
  const XyzCloud clean = shapes();
  const std::vector<ClassResult> expected = runEveryClass(clean.makeShared());
  for (const float unit : {1e-30F, 1e30F}) {
    const std::vector<ClassResult> found = runEveryClass(inUnit(clean, unit));
    for (std::size_t c = 0; c < expected.size(); ++c) {
      if (!expected[c].oriented) continue;
      SCOPED_TRACE(expected[c].name + ", " + nameOf(unit));
      std::size_t reversed = 0;
      ASSERT_EQ(found[c].normals.size(), expected[c].normals.size());
      for (std::size_t i = 0; i < expected[c].normals.size(); ++i) {
        // On an edge, rounding may choose another of its faces.
        reversed += !(dotOf(found[c].normals[i], expected[c].normals[i]) > -0.1F);
      }
      EXPECT_EQ(reversed, 0U);
    }
  }
}

TEST(ExtremeUnits, UnorientedNormalsStayTheSame) {
  const QuietPcl quiet;
  const XyzCloud clean = shapes();
  const std::vector<ClassResult> expected = runEveryClass(clean.makeShared());
  for (const float unit : {1e-30F, 1e30F}) {
    const std::vector<ClassResult> found = runEveryClass(inUnit(clean, unit));
    for (std::size_t c = 0; c < expected.size(); ++c) {
      if (expected[c].oriented || expected[c].normals.empty()) continue;
      SCOPED_TRACE(expected[c].name + ", " + nameOf(unit));
      ASSERT_EQ(found[c].normals.size(), expected[c].normals.size());
      std::size_t other = 0;
      for (std::size_t i = 0; i < expected[c].normals.size(); ++i) {
        other += !(std::abs(dotOf(found[c].normals[i], expected[c].normals[i])) > 0.99F);
      }
      // Rounding of the coordinates alone may move a point from one segment to the next.
      EXPECT_LE(other, expected[c].name == "NormalRecomputation" ? 3U : 0U);
    }
  }
}

NormalCloud planeNormals(const XyzCloud::Ptr& cloud) {
  return runEstimation<PlaneNormalEstimation<pcl::PointXYZ, pcl::Normal>>("plane", cloud).normals;
}

TEST(ExtremeUnits, EveryMethodOfSegmentOrientation) {
  const QuietPcl quiet;
  const XyzCloud clean = shapes();
  const auto normals = planeNormals(clean.makeShared()).makeShared();
  for (const OrientationMethod method :
       {OrientationMethod::AUTO, OrientationMethod::PROPAGATION, OrientationMethod::BOUNDARY,
        OrientationMethod::COMBINED, OrientationMethod::EXTREMAL, OrientationMethod::HOPPE}) {
    SegmentOrientation<pcl::PointXYZ, pcl::Normal> orientation;
    orientation.setMethod(method);
    orientation.setInputNormals(normals);
    orientation.setInputCloud(clean.makeShared());
    NormalCloud expected;
    orientation.compute(expected);
    for (const float unit : {1e-30F, 1e30F}) {
      SCOPED_TRACE(std::string(toString(method)) + ", " + nameOf(unit));
      orientation.setInputCloud(inUnit(clean, unit));
      NormalCloud found;
      orientation.compute(found);
      ASSERT_EQ(found.size(), expected.size());
      std::size_t reversed = 0;
      for (std::size_t i = 0; i < found.size(); ++i) {
        reversed += !(dotOf(found[i], expected[i]) > 0.F);
      }
      EXPECT_EQ(reversed, 0U);
    }
  }
}

// Triangles by their points in ascending order: whether they are turned to get there.
std::map<std::vector<pcl::index_t>, bool> trianglesOf(const XyzCloud& cloud,
                                                      const NormalCloud& normals) {
  auto both = pcl::make_shared<pcl::PointCloud<pcl::PointNormal>>();
  pcl::concatenateFields(cloud, normals, *both);
  SegmentTriangulation<pcl::PointNormal> triangulation;
  triangulation.setInputCloud(both);
  std::vector<pcl::Vertices> polygons;
  triangulation.reconstruct(polygons);
  std::map<std::vector<pcl::index_t>, bool> out;
  for (const pcl::Vertices& polygon : polygons) {
    std::vector<pcl::index_t> v(polygon.vertices.begin(), polygon.vertices.end());
    std::rotate(v.begin(), std::min_element(v.begin(), v.end()), v.end());
    const bool turned = v[1] > v[2];
    if (turned) std::swap(v[1], v[2]);
    out[v] = turned;
  }
  return out;
}

TEST(ExtremeUnits, TrianglesStayTheSame) {
  const QuietPcl quiet;
  const XyzCloud clean = shapes();
  const NormalCloud normals = planeNormals(clean.makeShared());
  const auto expected = trianglesOf(clean, normals);
  ASSERT_GT(expected.size(), clean.size());
  for (const float unit : {1e-30F, 1e30F}) {
    SCOPED_TRACE(nameOf(unit));
    const auto found = trianglesOf(*inUnit(clean, unit), normals);
    std::size_t same = 0;
    for (const auto& [vertices, turned] : found) {
      const auto known = expected.find(vertices);
      if (known == expected.end()) continue;
      EXPECT_EQ(known->second, turned);
      ++same;
    }
    // Four points that are on one circle but for rounding have two triangulations.
    EXPECT_GT(same, expected.size() - expected.size() / 100);
    EXPECT_LT(found.size(), expected.size() + expected.size() / 100);
  }
}

}  // namespace
}  // namespace segorient::test
