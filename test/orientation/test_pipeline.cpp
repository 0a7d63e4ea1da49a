// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <gtest/gtest.h>
#include <segorient/orientation/pipeline.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "oriented_shapes.h"

namespace segorient {
namespace {

using test::LabelledCloud;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

PipelineOptions withMethod(OrientationMethod method) {
  PipelineOptions options;
  options.orientation.method = method;
  return options;
}

// Every method, and the boundaries by triangulations.
std::vector<PipelineOptions> allMethods() {
  std::vector<PipelineOptions> out;
  for (const auto method :
       {OrientationMethod::AUTO, OrientationMethod::PROPAGATION, OrientationMethod::BOUNDARY,
        OrientationMethod::COMBINED, OrientationMethod::EXTREMAL, OrientationMethod::HOPPE}) {
    out.push_back(withMethod(method));
  }
  out.push_back(withMethod(OrientationMethod::COMBINED));
  out.back().orientation.boundary = BoundaryTest::TRIANGULATED;
  return out;
}

std::vector<LabelledCloud> closedSolids() {
  std::vector<LabelledCloud> out;
  out.push_back(test::sample("sphere", {test::sphere({0, 0, 0}, 1)}, 6000, 41));
  out.push_back(test::sample("torus", {test::torus(1, 0.4)}, 6000, 42));
  out.push_back(test::sample("cube", test::cube(), 6000, 43));
  out.push_back(test::sample("prism", test::octagonalPrism(), 6000, 44));
  out.push_back(test::sample("stairs", test::steppedSolid(), 6000, 45));
  out.push_back(test::sample("holed", test::holedSolid(), 8000, 46));
  out.push_back(test::sample("bracket", test::bracket(), 6000, 47));
  out.push_back(test::sample("cylinder", test::cylinder(), 6000, 48));
  out.push_back(test::sample("plate", test::plate(5, 6000), 6000, 49));
  return out;
}

TEST(Pipeline, OrientsClosedSolidsOutward) {
  for (const LabelledCloud& cloud : closedSolids()) {
    for (const auto method : {OrientationMethod::AUTO, OrientationMethod::BOUNDARY,
                              OrientationMethod::COMBINED, OrientationMethod::EXTREMAL}) {
      const OrientedCloud result = orientCloud(test::pointsOf(cloud), nullptr, withMethod(method));
      const test::Agreement agreement = test::compareNormals(cloud, result.normals);
      EXPECT_EQ(agreement.wrong_off_edges, 0U) << cloud.name << " by " << toString(method);
      EXPECT_LE(agreement.wrong, cloud.size() / 200) << cloud.name << " by " << toString(method);
      EXPECT_EQ(result.report.without_normal, 0U);
    }
  }
}

TEST(Pipeline, OrientsNoisySolids) {
  for (const double sigma : {0.1, 0.25}) {
    const LabelledCloud cloud = test::sample("bracket", test::bracket(), 12000, 50, sigma);
    const OrientedCloud result =
        orientCloud(test::pointsOf(cloud), nullptr, withMethod(OrientationMethod::COMBINED));
    EXPECT_EQ(test::compareNormals(cloud, result.normals).wrong_off_edges, 0U) << sigma;
  }
}

TEST(Pipeline, MakesAConsistentSurfaceOfAnOpenOne) {
  const LabelledCloud cloud = test::sample("bowl", {test::bowl({0, 0, 0}, 1)}, 6000, 51);
  const OrientedCloud result =
      orientCloud(test::pointsOf(cloud), nullptr, withMethod(OrientationMethod::COMBINED));
  const std::size_t wrong = test::compareNormals(cloud, result.normals).wrong;
  EXPECT_EQ(std::min(wrong, cloud.size() - wrong), 0U);
  ASSERT_EQ(result.report.components.size(), 1U);
  EXPECT_LT(result.report.components[0].confidence, 0.6F);  // and says that it is not sure
}

// 3000 rows of a solid, repeated and holed, in two orders.
TEST(Pipeline, DoesNotDependOnTheOrderOfRows) {
  const LabelledCloud cloud = test::sample("holed", test::holedSolid(), 5000, 52);
  std::vector<std::size_t> order(cloud.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::mt19937 rng(53);
  std::shuffle(order.begin(), order.end(), rng);
  std::vector<float> shuffled;
  for (const std::size_t i : order) {
    shuffled.insert(shuffled.end(), &cloud.xyz[4 * i], &cloud.xyz[4 * i] + 4);
  }
  for (const PipelineOptions& options : allMethods()) {
    const OrientedCloud a = orientCloud(test::pointsOf(cloud), nullptr, options);
    const OrientedCloud b = orientCloud({shuffled.data(), 4, cloud.size()}, nullptr, options);
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      ASSERT_EQ(std::memcmp(&b.normals[4 * i], &a.normals[4 * order[i]], 16), 0);
      ASSERT_EQ(b.segmentation.labels[i], a.segmentation.labels[order[i]]);
    }
  }
}

TEST(Pipeline, DoesNotDependOnThreads) {
  const LabelledCloud cloud = test::sample("stairs", test::steppedSolid(), 6000, 54, 0.1);
  for (PipelineOptions options : allMethods()) {
    options.threads = 1;
    const OrientedCloud one = orientCloud(test::pointsOf(cloud), nullptr, options);
    for (const int threads : {2, 3}) {
      options.threads = threads;
      const OrientedCloud many = orientCloud(test::pointsOf(cloud), nullptr, options);
      EXPECT_EQ(one.normals, many.normals);
      EXPECT_EQ(one.confidences, many.confidences);
      EXPECT_EQ(one.segmentation.labels, many.segmentation.labels);
    }
  }
}

TEST(Pipeline, RepeatedAndNonFiniteRows) {
  LabelledCloud cloud = test::sample("sphere", {test::sphere({0, 0, 0}, 1)}, 3000, 55);
  const OrientedCloud clean = orientCloud(test::pointsOf(cloud), nullptr, {});
  std::vector<float> rows = cloud.xyz;
  for (int i = 0; i < 500; ++i) rows.insert(rows.end(), cloud.xyz.begin(), cloud.xyz.begin() + 4);
  rows.insert(rows.end(), {kNaN, 0.F, 0.F, 0.F, 0.F, kInfinity, 0.F, 0.F});
  const std::size_t n = rows.size() / 4;
  const OrientedCloud result = orientCloud({rows.data(), 4, n}, nullptr, {});
  EXPECT_EQ(result.report.points, n);
  EXPECT_EQ(result.report.non_finite, 2U);
  EXPECT_EQ(result.report.duplicates, 500U);
  EXPECT_EQ(result.report.without_normal, 2U);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    ASSERT_EQ(std::memcmp(&result.normals[4 * i], &clean.normals[4 * i], 16), 0);
  }
  for (std::size_t i = cloud.size(); i < n - 2; ++i) {
    ASSERT_EQ(std::memcmp(&result.normals[4 * i], clean.normals.data(), 16), 0);
    ASSERT_EQ(result.segmentation.labels[i], clean.segmentation.labels[0]);
  }
  EXPECT_TRUE(std::isnan(result.normals[4 * n - 1]));
  EXPECT_TRUE(std::isnan(result.normals[4 * n - 8]));
  EXPECT_EQ(result.segmentation.labels[n - 1], -1);
}

TEST(Pipeline, SegmentsHoldTheirRowsAndSigns) {
  const LabelledCloud cloud = test::sample("cube", test::cube(), 4000, 56);
  const OrientedCloud result =
      orientCloud(test::pointsOf(cloud), nullptr, withMethod(OrientationMethod::COMBINED));
  const Segmentation& segmentation = result.segmentation;
  ASSERT_EQ(result.segments.size(), segmentation.segments.size());
  std::size_t members = 0;
  for (std::size_t s = 0; s < segmentation.segments.size(); ++s) {
    for (const pcl::index_t* p = segmentation.begin(s); p != segmentation.end(s); ++p) {
      const auto i = static_cast<std::size_t>(*p);
      ASSERT_EQ(segmentation.labels[i], static_cast<std::int32_t>(s));
      if (segmentation.segments[s].kind == SegmentKind::REGULAR) {
        ASSERT_EQ(segmentation.signs[i], 1);  // everything in a segment is turned together
      }
      ++members;
    }
  }
  EXPECT_EQ(members, cloud.size());
  EXPECT_GE(result.report.regular_segments, 6U);
}

TEST(Pipeline, ReportsStagesInOrder) {
  const LabelledCloud cloud = test::sample("sphere", {test::sphere({0, 0, 0}, 1)}, 2000, 57);
  std::vector<std::pair<std::string, double>> calls;
  const OrientedCloud result =
      orientCloud(test::pointsOf(cloud), nullptr, {},
                  [&](const char* stage, double fraction) { calls.emplace_back(stage, fraction); });
  ASSERT_GE(calls.size(), 3U);
  EXPECT_EQ(calls.front().first, "search");
  EXPECT_EQ(calls.back().second, 1.0);
  for (std::size_t i = 1; i < calls.size(); ++i) EXPECT_LE(calls[i - 1].second, calls[i].second);
  std::vector<std::string> stages;
  double seconds = 0.0;
  for (const StageTime& s : result.report.stages) {
    stages.push_back(s.stage);
    seconds += s.seconds;
  }
  EXPECT_EQ(stages, (std::vector<std::string>{"search", "normals", "segmentation", "orientation",
                                              "recomputation", "output"}));
  EXPECT_NEAR(seconds, result.report.seconds, 1e-6);
  EXPECT_GT(result.report.peak_memory, 0U);
  // h of a random sampling: the mean distance to the 6 nearest is 0.5 to 1.5 of the square's side.
  EXPECT_GT(result.report.spacing, 0.5 * cloud.spacing);
  EXPECT_LT(result.report.spacing, 1.5 * cloud.spacing);
  EXPECT_LT(result.report.noise, 0.1F);
}

TEST(Pipeline, IndicesAreTheCloud) {
  const LabelledCloud cloud =
      test::sample("two", {test::sphere({0, 0, 0}, 1), test::sphere({9, 0, 0}, 1)}, 4000, 58);
  std::vector<pcl::index_t> indices;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (cloud.face[i] == 1) indices.push_back(static_cast<pcl::index_t>(i));
  }
  const std::size_t valid = indices.size();
  indices.push_back(-1);
  indices.push_back(static_cast<pcl::index_t>(cloud.size()));
  indices.push_back(indices[0]);
  const OrientedCloud result = orientCloud(test::pointsOf(cloud), &indices, {});
  ASSERT_EQ(result.confidences.size(), indices.size());
  EXPECT_EQ(result.report.non_finite, 2U);
  EXPECT_EQ(result.report.components.size(), 1U);
  for (std::size_t i = 0; i < valid; ++i) {
    EXPECT_GT(test::dot3(&result.normals[4 * i],
                         &cloud.normals[4 * static_cast<std::size_t>(indices[i])]),
              0.F);
  }
  EXPECT_TRUE(std::isnan(result.normals[4 * valid]));
  EXPECT_EQ(std::memcmp(&result.normals[4 * valid + 8], result.normals.data(), 16), 0);
}

TEST(Pipeline, SelectRowsKeepsLabelsAndFindsMembers) {
  const LabelledCloud cloud = test::sample("cube", test::cube(), 3000, 59);
  const OrientedCloud whole = orientCloud(test::pointsOf(cloud), nullptr, {});
  const OrientedCloud some = selectRows(whole, {5, 5, 100, -3, 3000});
  ASSERT_EQ(some.confidences.size(), 5U);
  EXPECT_EQ(some.segmentation.labels[0], whole.segmentation.labels[5]);
  EXPECT_EQ(some.segmentation.labels[3], -1);
  EXPECT_EQ(some.segmentation.labels[4], -1);
  EXPECT_EQ(std::memcmp(&some.normals[8], &whole.normals[400], 16), 0);
  EXPECT_TRUE(std::isnan(some.normals[12]));
  EXPECT_EQ(some.segmentation.members.size(), 3U);
}

// Whatever there is too little of: a defined answer.
TEST(Pipeline, DegenerateClouds) {
  std::vector<std::pair<std::string, std::vector<float>>> clouds;
  clouds.emplace_back("none", std::vector<float>{});
  for (int n = 1; n <= 5; ++n) {
    std::vector<float> few;
    for (int i = 0; i < n; ++i) {
      few.insert(few.end(), {static_cast<float>(i), static_cast<float>(i * i), 0.F, 0.F});
    }
    clouds.emplace_back(std::to_string(n) + " points", few);
  }
  std::vector<float> line;
  std::vector<float> same;
  std::vector<float> nan;
  std::vector<float> plane;
  std::vector<float> huge;
  std::vector<float> tiny;
  for (int i = 0; i < 400; ++i) {
    const auto t = static_cast<float>(i);
    const auto u = static_cast<float>((i * 37) % 100);
    line.insert(line.end(), {t, 2 * t, 3 * t, 0.F});
    same.insert(same.end(), {1.F, 2.F, 3.F, 0.F});
    nan.insert(nan.end(), {kNaN, t, kInfinity, 0.F});
    plane.insert(plane.end(), {t, u, 5.F, 0.F});
    huge.insert(huge.end(), {t * 1e30F, u * 1e30F, -t * u * 1e28F, 0.F});
    tiny.insert(tiny.end(), {t * 1e-30F, u * 1e-30F, t * u * 1e-32F, 0.F});
  }
  clouds.emplace_back("line", line);
  clouds.emplace_back("same", same);
  clouds.emplace_back("nan", nan);
  clouds.emplace_back("plane", plane);
  clouds.emplace_back("huge", huge);
  clouds.emplace_back("tiny", tiny);
  for (const auto& [name, rows] : clouds) {
    for (const int k : {0, 1, 1000000000}) {
      for (const auto method :
           {OrientationMethod::AUTO, OrientationMethod::PROPAGATION, OrientationMethod::BOUNDARY,
            OrientationMethod::COMBINED, OrientationMethod::EXTREMAL}) {
        PipelineOptions options = withMethod(method);
        options.k = k;
        const std::size_t n = rows.size() / 4;
        const OrientedCloud result = orientCloud({rows.data(), 4, n}, nullptr, options);
        ASSERT_EQ(result.normals.size(), rows.size()) << name;
        ASSERT_EQ(result.segmentation.labels.size(), n) << name;
        for (std::size_t i = 0; i < n; ++i) {
          const float* normal = &result.normals[4 * i];
          ASSERT_TRUE(std::isnan(normal[0]) || std::abs(test::dot3(normal, normal) - 1.F) < 1e-3F)
              << name;
        }
        if (name == "plane" && (k == 0 || k == 1000000000)) {
          EXPECT_EQ(result.report.without_normal, 0U);
          for (std::size_t i = 1; i < n; ++i) {
            ASSERT_EQ(result.normals[2] > 0, result.normals[4 * i + 2] > 0);
          }
        }
      }
    }
  }
}

TEST(Method, NamesGoBothWays) {
  for (const auto method :
       {OrientationMethod::AUTO, OrientationMethod::PROPAGATION, OrientationMethod::BOUNDARY,
        OrientationMethod::COMBINED, OrientationMethod::EXTREMAL, OrientationMethod::HOPPE}) {
    OrientationMethod read = OrientationMethod::AUTO;
    EXPECT_TRUE(fromString(toString(method), read));
    EXPECT_EQ(read, method);
  }
  OrientationMethod kept = OrientationMethod::BOUNDARY;
  EXPECT_FALSE(fromString("Auto", kept));
  EXPECT_FALSE(fromString("", kept));
  EXPECT_EQ(kept, OrientationMethod::BOUNDARY);
}

}  // namespace
}  // namespace segorient
