// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <gtest/gtest.h>
#include <segorient/surface/segment_mesh.h>

#include <algorithm>
#include <limits>
#include <map>
#include <numeric>
#include <set>

#include "labelled_solids.h"
#include "triangle_selection.h"

namespace segorient::test {
namespace {

PointView viewOf(const std::vector<float>& rows) {
  return {rows.data(), 4, rows.size() / 4};
}

std::vector<pcl::index_t> everyPoint(std::size_t n) {
  std::vector<pcl::index_t> members(n);
  std::iota(members.begin(), members.end(), 0);
  return members;
}

SegmentMesh meshOf(const std::vector<float>& xyz, const std::array<float, 3>& normal,
                   const TriangulationOptions& options = {}) {
  const auto members = everyPoint(xyz.size() / 4);
  return triangulatePoints(viewOf(xyz), members.data(), members.size(), normal, options);
}

Eigen::Vector3d at(const std::vector<float>& xyz, pcl::index_t i) {
  const float* p = &xyz[4 * static_cast<std::size_t>(i)];
  return {p[0], p[1], p[2]};
}

// What holds for every mesh: all points accounted for, edges with at most two triangles of one
// turn, boundary = edges of one triangle, one curve through a point.
void expectSound(const SegmentMesh& mesh, const std::vector<float>& xyz,
                 const Eigen::Vector3d& normal) {
  std::map<std::pair<pcl::index_t, pcl::index_t>, int> directed;
  std::multiset<pcl::index_t> points;
  for (const auto& t : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const int times = ++directed[{t[i], t[(i + 1) % 3]}];
      EXPECT_EQ(times, 1);
    }
    const Eigen::Vector3d a = at(xyz, t[0]);
    EXPECT_GT((at(xyz, t[1]) - a).cross(at(xyz, t[2]) - a).dot(normal), 0.0);
  }
  std::set<pcl::index_t> accounted;
  for (const auto& t : mesh.triangles) accounted.insert(t.begin(), t.end());
  const std::size_t in_triangles = accounted.size();
  accounted.insert(mesh.duplicates.begin(), mesh.duplicates.end());
  accounted.insert(mesh.loose.begin(), mesh.loose.end());
  EXPECT_EQ(accounted.size(), xyz.size() / 4);
  EXPECT_EQ(in_triangles + mesh.duplicates.size() + mesh.loose.size(), xyz.size() / 4);

  std::set<std::pair<pcl::index_t, pcl::index_t>> open;
  for (const auto& [edge, count] : directed) {
    if (directed.count({edge.second, edge.first}) == 0) open.insert(edge);
  }
  std::set<std::pair<pcl::index_t, pcl::index_t>> traced;
  std::set<pcl::index_t> on_boundary(mesh.boundary.begin(), mesh.boundary.end());
  EXPECT_EQ(on_boundary.size(), mesh.boundary.size());
  for (std::size_t l = 0; l < mesh.loopCount(); ++l) {
    for (std::uint32_t i = mesh.loops[l]; i < mesh.loops[l + 1]; ++i) {
      const std::uint32_t next = i + 1 < mesh.loops[l + 1] ? i + 1 : mesh.loops[l];
      traced.insert({mesh.boundary[i], mesh.boundary[next]});
    }
  }
  EXPECT_EQ(traced, open);
}

std::pair<std::size_t, std::size_t> loopKinds(const SegmentMesh& mesh) {
  const auto holes =
      static_cast<std::size_t>(std::count(mesh.is_hole.begin(), mesh.is_hole.end(), 1));
  return {mesh.loopCount() - holes, holes};
}

TEST(SegmentMesh, PlanarFacesWithAndWithoutHoles) {
  struct Case {
    const char* name;
    Face face;
    std::size_t holes;
  };
  const Points2 concave{{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 2}, {3, 2}, {3, 3}, {0, 3}};
  const std::vector<Case> cases{
      {"square", lid(rectangle(1, 1), {}, 0, 1), 0},
      {"long", lid(rectangle(10, 0.7), {}, 0, 1), 0},
      {"concave", lid(concave, {}, 0, 1), 0},
      {"three holes",
       lid(rectangle(3, 2), {{0.6, 0.6, 0.25}, {1.5, 1.2, 0.35}, {2.4, 0.7, 0.2}}, 0, 1), 3}};
  for (const Case& c : cases) {
    for (unsigned seed = 1; seed <= 5; ++seed) {
      SCOPED_TRACE(std::string(c.name) + ", seed " + std::to_string(seed));
      const LabelledCloud cloud = sample(c.name, {c.face}, 6000, seed);
      const SegmentMesh mesh = meshOf(cloud.xyz, {0, 0, 1});
      expectSound(mesh, cloud.xyz, {0, 0, 1});
      EXPECT_TRUE(mesh.duplicates.empty());
      EXPECT_TRUE(mesh.loose.empty());
      EXPECT_EQ(loopKinds(mesh), std::make_pair(std::size_t{1}, c.holes));
      EXPECT_NEAR(mesh.area, c.face.area, 0.05 * c.face.area);
    }
  }
}

// Pockets between the points along a straight side are filled, a notch of the shape is not.
TEST(SegmentMesh, StraightSidesKeepTheirAreaAndNotchesStay) {
  const Points2 notched{{0, 0}, {1, 0}, {1, 1}, {0.65, 1}, {0.5, 0.5}, {0.35, 1}, {0, 1}};
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const LabelledCloud square =
        sample("square", {parallelogram({0, 0, 0}, {1, 0, 0}, {0, 1, 0})}, 900, seed);
    const SegmentMesh full = meshOf(square.xyz, {0, 0, 1});
    EXPECT_GE(full.area, 0.955) << seed;
    EXPECT_LE(full.area, 1.0);
    const LabelledCloud cut = sample("notched", {lid(notched, {}, 0, 1)}, 3000, seed);
    const SegmentMesh mesh = meshOf(cut.xyz, {0, 0, 1});
    EXPECT_NEAR(mesh.area / polygonArea(notched), 1.0, 0.04) << seed;
    EXPECT_EQ(mesh.loopCount(), 1U);
    expectSound(mesh, cut.xyz, {0, 0, 1});
  }
}

// A random sample of a square without the points of a circle, whose area is given in areas that a
// point has. In one of twenty such samples of 10,000 points a circle of some 15 is empty anyway.
std::vector<float> withHole(double area_in_points, unsigned seed) {
  const double radius = std::sqrt(area_in_points / (10000 * M_PI));
  const LabelledCloud cloud = sample("square", {lid(rectangle(1, 1), {}, 0, 1)}, 10000, seed);
  double middle[2] = {0, 0};
  for (std::size_t i = 0; i < cloud.xyz.size(); ++i) {
    if (i % 4 < 2) middle[i % 4] += static_cast<double>(cloud.xyz[i]) / 10000;
  }
  std::vector<float> kept;
  for (std::size_t i = 0; i < cloud.xyz.size(); i += 4) {
    const double x = static_cast<double>(cloud.xyz[i]) - middle[0];
    const double y = static_cast<double>(cloud.xyz[i + 1]) - middle[1];
    if (std::hypot(x, y) < radius) continue;
    kept.insert(kept.end(), &cloud.xyz[i], &cloud.xyz[i] + 4);
  }
  return kept;
}

TEST(SegmentMesh, HolesThatSamplingLeavesAreFilled) {
  TriangulationOptions left;
  left.fill_gaps = false;
  std::size_t left_open = 0;
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const std::vector<float> small = withHole(13, seed);
    const std::vector<float> large = withHole(40, seed);
    const SegmentMesh filled = meshOf(small, {0, 0, 1});
    const SegmentMesh holed = meshOf(large, {0, 0, 1});
    EXPECT_EQ(loopKinds(filled).second, 0U) << seed;
    EXPECT_EQ(loopKinds(holed).second, 1U) << seed;
    left_open += loopKinds(meshOf(small, {0, 0, 1}, left)).second;
    expectSound(filled, small, {0, 0, 1});
    expectSound(holed, large, {0, 0, 1});
  }
  EXPECT_GT(left_open, 0U);
}

TEST(SegmentMesh, NormalDecidesTheTurn) {
  const LabelledCloud cloud = sample("square", {lid(rectangle(1, 1), {}, 0, 1)}, 500, 3);
  const SegmentMesh up = meshOf(cloud.xyz, {0, 0, 1});
  const SegmentMesh down = meshOf(cloud.xyz, {0, 0, -1});
  expectSound(up, cloud.xyz, {0, 0, 1});
  expectSound(down, cloud.xyz, {0, 0, -1});
  EXPECT_EQ(up.triangles.size(), down.triangles.size());
}

TEST(SegmentMesh, CurvedSegmentHasItsOwnArea) {
  // A strip of 60 degrees of a cylinder, seen from its middle.
  LabelledCloud cloud = sample("tube", {cylinderSide(0, 0, 1, 0, 3, 1)}, 30000, 4);
  std::vector<float> strip;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (cloud.xyz[4 * i] > std::cos(M_PI / 6)) {
      strip.insert(strip.end(), &cloud.xyz[4 * i], &cloud.xyz[4 * i] + 4);
    }
  }
  const SegmentMesh mesh = meshOf(strip, {1, 0, 0});
  expectSound(mesh, strip, {1, 0, 0});
  EXPECT_EQ(loopKinds(mesh), std::make_pair(std::size_t{1}, std::size_t{0}));
  EXPECT_NEAR(mesh.area, M_PI / 3 * 3, 0.05 * M_PI);
}

TEST(SegmentMesh, PartsFarApartAreParts) {
  LabelledCloud cloud = sample("left", {lid(rectangle(1, 1), {}, 0, 1)}, 1000, 5);
  const LabelledCloud other =
      sample("right", {parallelogram({1.5, 0, 0}, {1, 0, 0}, {0, 1, 0})}, 1000, 6);
  cloud.xyz.insert(cloud.xyz.end(), other.xyz.begin(), other.xyz.end());
  const SegmentMesh mesh = meshOf(cloud.xyz, {0, 0, 1});
  expectSound(mesh, cloud.xyz, {0, 0, 1});
  EXPECT_EQ(loopKinds(mesh), std::make_pair(std::size_t{2}, std::size_t{0}));
  EXPECT_NEAR(mesh.area, 2.0, 0.15);
}

TEST(SegmentMesh, StrayPointsAreTakenIn) {
  // Sparse points beside a dense patch and pinches between clusters: still sound.
  for (unsigned seed = 1; seed <= 20; ++seed) {
    std::mt19937 rng(seed);
    std::uniform_real_distribution<float> unit(0.F, 1.F);
    std::vector<float> xyz;
    for (int i = 0; i < 300; ++i) {
      const float scale = i < 200 ? 0.1F : 1.F;
      xyz.insert(xyz.end(), {scale * unit(rng), scale * unit(rng), 0.F, 0.F});
    }
    const SegmentMesh mesh = meshOf(xyz, {0, 0, 1});
    expectSound(mesh, xyz, {0, 0, 1});
    EXPECT_TRUE(mesh.loose.empty());
  }
}

TEST(SegmentMesh, ParametersAct) {
  const LabelledCloud cloud = sample("concave", {lid(rectangle(1, 1), {}, 0, 1)}, 3000, 7);
  TriangulationOptions options;
  const SegmentMesh usual = meshOf(cloud.xyz, {0, 0, 1}, options);
  options.critical_factor = 1;
  const SegmentMesh paper = meshOf(cloud.xyz, {0, 0, 1}, options);
  EXPECT_FLOAT_EQ(2 * paper.critical_length, usual.critical_length);
  EXPECT_LT(paper.area, usual.area);
  EXPECT_GT(paper.loopCount(), usual.loopCount());
  options = {};
  options.kappa2 = 0.3F;
  const SegmentMesh peeled = meshOf(cloud.xyz, {0, 0, 1}, options);
  EXPECT_EQ(peeled.critical_length, usual.critical_length);
  EXPECT_LT(peeled.area, usual.area);
  options = {};
  options.kappa1 = 0.9F;
  const SegmentMesh early = meshOf(cloud.xyz, {0, 0, 1}, options);
  EXPECT_LT(early.critical_length, usual.critical_length);
  options = {};
  options.bins = 5;
  const SegmentMesh coarse = meshOf(cloud.xyz, {0, 0, 1}, options);
  EXPECT_NE(coarse.critical_length, usual.critical_length);
  options = {};
  options.fill_gaps = false;
  const SegmentMesh open = meshOf(cloud.xyz, {0, 0, 1}, options);
  EXPECT_EQ(open.critical_length, usual.critical_length);
  EXPECT_LT(open.area, usual.area);
  for (const SegmentMesh* mesh : {&paper, &peeled, &early, &coarse, &open}) {
    expectSound(*mesh, cloud.xyz, {0, 0, 1});
  }
}

TEST(SegmentMesh, DegenerateInput) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<float> line{0, 0, 0, 0, 1, 1, 0, 0, 2, 2, 0, 0, 3, 3, 0, 0, 1, 1, 0, 0};
  const SegmentMesh collinear = meshOf(line, {0, 0, 1});
  EXPECT_TRUE(collinear.triangles.empty());
  EXPECT_EQ(collinear.duplicates, std::vector<pcl::index_t>{4});
  EXPECT_EQ(collinear.loose.size(), 4U);
  const std::vector<float> good{0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0};
  EXPECT_EQ(meshOf(good, {0, 0, 1}).triangles.size(), 1U);
  EXPECT_EQ(meshOf(good, {0, 0, 0}).loose.size(), 3U);
  EXPECT_EQ(meshOf(good, {nan, 0, 1}).loose.size(), 3U);
  EXPECT_TRUE(meshOf({}, {0, 0, 1}).loose.empty());
  std::vector<float> with_nan = good;
  with_nan.insert(with_nan.end(), {nan, 0, 0, 0});
  const SegmentMesh partial = meshOf(with_nan, {0, 0, 1});
  EXPECT_EQ(partial.triangles.size(), 1U);
  EXPECT_EQ(partial.loose, std::vector<pcl::index_t>{3});
  const LabelledCloud cloud = sample("square", {lid(rectangle(1, 1), {}, 0, 1)}, 300, 3);
  const SegmentMesh plain = meshOf(cloud.xyz, {0, 0, 1});
  for (const float scale : {0x1p-120F, 0x1p-60F, 0x1p60F, 0x1p120F}) {
    std::vector<float> scaled = cloud.xyz;
    for (float& v : scaled) v *= scale;
    EXPECT_EQ(meshOf(scaled, {0, 0, 1}).triangles, plain.triangles) << scale;
  }
}

TEST(SegmentMesh, GridOfDuplicates) {
  std::vector<float> xyz;
  for (int copy = 0; copy < 2; ++copy) {
    for (int i = 0; i < 30; ++i) {
      for (int j = 0; j < 30; ++j) {
        xyz.insert(xyz.end(), {static_cast<float>(i), static_cast<float>(j), 0.F, 0.F});
      }
    }
  }
  const SegmentMesh mesh = meshOf(xyz, {0, 0, 1});
  expectSound(mesh, xyz, {0, 0, 1});
  EXPECT_EQ(mesh.duplicates.size(), 900U);
  EXPECT_NEAR(mesh.area, 29.0 * 29.0, 1e-3);
  EXPECT_EQ(loopKinds(mesh), std::make_pair(std::size_t{1}, std::size_t{0}));
}

// Bins of half a unit from 1 to 3 hold 6, 0, 1 and 1 lengths: the critical one is the end of the
// last bin that has more than its share of the fullest.
TEST(CriticalLength, IsTheEndOfTheLastFullBin) {
  const std::vector<float> lengths{1.F, 1.F, 1.F, 1.F, 1.F, 1.F, 2.F, 3.F};
  TriangulationOptions options;
  options.bins = 4;
  options.critical_factor = 2.F;
  options.kappa1 = 0.1F;
  EXPECT_FLOAT_EQ(surface::criticalLength(lengths, 1.F, options), 2 * 3.F);
  options.kappa1 = 0.2F;
  EXPECT_FLOAT_EQ(surface::criticalLength(lengths, 1.F, options), 2 * 1.5F);
  // Bins of a quarter of the median length, the ninth of which is the last with an edge.
  options.bins = 0;
  options.kappa1 = 0.1F;
  EXPECT_FLOAT_EQ(surface::criticalLength(lengths, 1.F, options), 2 * 3.25F);
  EXPECT_FLOAT_EQ(surface::criticalLength({4.F, 4.F}, 4.F, options), 2 * 4.F);
  const float infinity = std::numeric_limits<float>::infinity();
  EXPECT_EQ(surface::criticalLength({4.F, infinity, infinity}, infinity, options), infinity);
}

}  // namespace
}  // namespace segorient::test
