// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// No setting is accepted and ignored without a word, and the paper's have a name.
#include <gtest/gtest.h>
#include <pcl/point_types.h>
#include <segorient/features/normal_recomputation.h>
#include <segorient/orientation/oriented_normal_estimation.h>
#include <segorient/orientation/segment_orientation.h>

#include <cmath>
#include <cstring>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

namespace segorient::test {
namespace {

using Names = std::vector<std::string>;

constexpr OrientationMethod kMethods[] = {
    OrientationMethod::AUTO,     OrientationMethod::PROPAGATION, OrientationMethod::BOUNDARY,
    OrientationMethod::COMBINED, OrientationMethod::EXTREMAL,    OrientationMethod::HOPPE};

TEST(Settings, DefaultsHaveAllTheirEffect) {
  for (const OrientationMethod method : kMethods) {
    PipelineOptions options;
    options.orientation.method = method;
    EXPECT_EQ(settingsWithoutEffect(options), Names{}) << toString(method);
  }
}

TEST(Settings, ThePaperToTheLetterHasAllItsEffect) {
  for (const OrientationMethod method : kMethods) {
    if (method == OrientationMethod::AUTO) continue;
    EXPECT_EQ(settingsWithoutEffect(paperPipelineOptions(method)), Names{}) << toString(method);
    EXPECT_EQ(settingsWithoutEffect(paperOptions(method)), Names{}) << toString(method);
  }
  const PipelineOptions paper = paperPipelineOptions();
  EXPECT_EQ(paper.orientation.method, OrientationMethod::COMBINED);
  EXPECT_EQ(paper.segmentation.max_offset, 0.F);
  EXPECT_EQ(paper.segmentation.max_gap, 0.F);
  EXPECT_EQ(paper.recomputation.rule, RecomputationRule::MODIFIED_NEIGHBORHOODS);
  EXPECT_TRUE(paper.recomputation.delta_between_references);
  EXPECT_EQ(paper.orientation.angle, SegmentAngle::REFERENCE_NORMALS);
  EXPECT_EQ(paper.orientation.boundary, BoundaryTest::TRIANGULATED);
  EXPECT_EQ(paper.orientation.triangulation.critical_factor, 1.F);
  EXPECT_FALSE(paper.orientation.triangulation.fill_gaps);
  EXPECT_FALSE(paper.orientation.check_borders);
  EXPECT_FALSE(paper.orientation.turn_outward);
  EXPECT_FALSE(paper.segmentation.settle_edges);
}

TEST(Settings, OfOtherMethodsAreNamed) {
  PipelineOptions options;
  options.normals.estimator = NormalEstimator::LDT;
  options.recomputations = 2;
  options.orientation.gamma = 0.5F;
  EXPECT_EQ(settingsWithoutEffect(options),
            (Names{"orientation.gamma", "normals.estimator", "recomputations"}));
  options.orientation.method = OrientationMethod::COMBINED;
  EXPECT_EQ(settingsWithoutEffect(options), Names{});
  options.orientation.automatic.denoise = false;
  options.orientation.triangulation.kappa1 = 0.2F;
  EXPECT_EQ(settingsWithoutEffect(options),
            (Names{"orientation.triangulation.kappa1", "orientation.automatic.denoise"}));
}

TEST(Settings, OfTheDefaultMethodAreNamedByTheOthers) {
  PipelineOptions options;
  options.orientation.method = OrientationMethod::PROPAGATION;
  options.orientation.check_borders = false;
  options.orientation.automatic.beta = 0.4F;
  auto hints = std::make_shared<OrientationHints>();
  hints->scans = {0, 1};
  options.orientation.hints = hints;
  EXPECT_EQ(settingsWithoutEffect(options), (Names{"orientation.check_borders", "orientation.hints",
                                                   "orientation.automatic.beta"}));
  // Chosen normals look for sensors by any method.
  options = PipelineOptions();
  options.orientation.method = OrientationMethod::COMBINED;
  options.orientation.automatic.find_sensors = false;
  EXPECT_EQ(settingsWithoutEffect(options), Names{});
  options.k = 12;
  EXPECT_EQ(settingsWithoutEffect(options), Names{"orientation.automatic.find_sensors"});
}

SEGORIENT_DEPRECATED_BEGIN
TEST(Settings, OfVersionOneThatDoNothingTodayAreNamed) {
  PipelineOptions options;
  options.automatic.wind_components = false;
  EXPECT_EQ(settingsWithoutEffect(options), Names{});
  options.automatic.flip_clusters = false;
  options.automatic.infer_viewpoint = true;
  EXPECT_EQ(settingsWithoutEffect(options),
            (Names{"automatic.flip_clusters", "automatic.infer_viewpoint"}));
}
SEGORIENT_DEPRECATED_END

TEST(Settings, OfOneDoorOnlyAreNamedByTheOther) {
  OrientationSettings settings;
  settings.automatic.find_sensors = false;
  EXPECT_EQ(settingsWithoutEffect(settings), Names{"automatic.find_sensors"});
  PipelineOptions options;
  options.orientation = settings;
  EXPECT_EQ(settingsWithoutEffect(options), Names{});
  options.orientation.turn_outward = false;
  EXPECT_EQ(settingsWithoutEffect(options), Names{"orientation.turn_outward"});
}

TEST(Settings, OfStagesThatAreLeftOutAreNamed) {
  PipelineOptions options;
  options.segmentation.max_gap = 0.F;
  options.segmentation.compare_with_seed = true;
  EXPECT_EQ(settingsWithoutEffect(options),
            (Names{"segmentation.max_gap", "segmentation.compare_with_seed"}));
  options.segmentation.unite_smooth = true;
  EXPECT_EQ(settingsWithoutEffect(options), Names{"segmentation.max_gap"});
  options.orientation.method = OrientationMethod::BOUNDARY;
  EXPECT_EQ(settingsWithoutEffect(options), Names{"segmentation.unite_smooth"});
  options.segmentation.unite_smooth = false;
  options.recomputation.delta = 0.5F;
  EXPECT_EQ(settingsWithoutEffect(options), Names{"recomputation.delta"});
  options.recomputations = 1;
  EXPECT_EQ(settingsWithoutEffect(options), Names{"recomputation.delta"});
  options.recomputation.rule = RecomputationRule::MODIFIED_NEIGHBORHOODS;
  EXPECT_EQ(settingsWithoutEffect(options), Names{});
}

// Two boxes' faces and a ball, with some noise, the same in every run.
std::vector<float> someCloud() {
  std::vector<float> xyz;
  for (int i = 0; i < 1200; ++i) {
    const float z = 1.F - 2.F * (static_cast<float>(i) + 0.5F) / 1200.F;
    const float turn = 2.3999632F * static_cast<float>(i);
    const float r = 1.F + 0.01F * std::sin(37.F * static_cast<float>(i));
    const float flat = r * std::sqrt(1.F - z * z);
    for (const float v : {flat * std::cos(turn), flat * std::sin(turn), r * z}) xyz.push_back(v);
  }
  for (int i = 0; i < 900; ++i) {
    const int row = i / 30;
    const float u = static_cast<float>(i % 30) / 15.F - 1.F;
    const float v = static_cast<float>(row) / 15.F - 1.F;
    const float w = 0.005F * std::sin(53.F * static_cast<float>(i));
    for (const float c : {u + 1.5F, v, w}) xyz.push_back(c);
    for (const float c : {u + 1.5F, -1.F + w, v + 1.F}) xyz.push_back(c);
  }
  return xyz;
}

TEST(Settings, ThoseThatAreNamedChangeNothing) {
  using Change = void (*)(PipelineOptions&);
  const std::vector<Change> changes{
      [](PipelineOptions& o) { o.normals.estimator = NormalEstimator::LDT; },
      [](PipelineOptions& o) { o.normals.first_guess = NormalEstimator::LCT; },
      [](PipelineOptions& o) { o.recomputations = 1; },
      [](PipelineOptions& o) { o.recomputation.edge_angle = 0.1F; },
      [](PipelineOptions& o) { o.recomputation.delta = 0.1F; },
      [](PipelineOptions& o) { o.segmentation.max_gap = 1.5F; },
      [](PipelineOptions& o) { o.segmentation.max_offset = 0.1F; },
      [](PipelineOptions& o) { o.segmentation.max_residual = 0.001F; },
      [](PipelineOptions& o) { o.segmentation.max_curvature = 0.001F; },
      [](PipelineOptions& o) { o.segmentation.compare_with_seed = true; },
      [](PipelineOptions& o) { o.segmentation.settle_edges = false; },
      [](PipelineOptions& o) { o.segmentation.unite_smooth = true; },
      [](PipelineOptions& o) { o.orientation.gamma = 0.05F; },
      [](PipelineOptions& o) { o.orientation.angle = SegmentAngle::REFERENCE_NORMALS; },
      [](PipelineOptions& o) { o.orientation.boundary = BoundaryTest::TRIANGULATED; },
      [](PipelineOptions& o) { o.orientation.triangulation.kappa2 = 0.05F; },
      [](PipelineOptions& o) { o.orientation.min_margin = 0.99F; },
      [](PipelineOptions& o) { o.orientation.max_box_points = 20; },
      [](PipelineOptions& o) { o.orientation.check_borders = false; },
      [](PipelineOptions& o) { o.orientation.turn_outward = false; },
      [](PipelineOptions& o) { o.orientation.automatic.clean_up = false; },
      [](PipelineOptions& o) { o.orientation.automatic.fit_normals = false; }};
  const std::vector<float> xyz = someCloud();
  const PointView points{xyz.data(), 3, xyz.size() / 3};
  for (const OrientationMethod method : kMethods) {
    PipelineOptions standard;
    standard.orientation.method = method;
    PipelineOptions options = standard;
    std::size_t named = 0;
    for (const Change& change : changes) {
      PipelineOptions alone = standard;
      change(alone);
      if (settingsWithoutEffect(alone).empty()) continue;
      change(options);
      ++named;
    }
    const Names names = settingsWithoutEffect(options);
    ASSERT_EQ(names.size(), named);
    const OrientedCloud without = orientCloud(points, nullptr, standard);
    const OrientedCloud with = orientCloud(points, nullptr, options);
    EXPECT_EQ(std::memcmp(with.normals.data(), without.normals.data(),
                          without.normals.size() * sizeof(float)),
              0)
        << testing::PrintToString(names);
    EXPECT_EQ(with.segmentation.labels, without.segmentation.labels);
    EXPECT_EQ(with.confidences, without.confidences);
  }
}

TEST(Settings, AnglesOfSegmentsAreNotNamed) {
  OrientedNormalEstimation<pcl::PointXYZ, pcl::Normal> estimation;
  estimation.setMethod(OrientationMethod::PROPAGATION);
  estimation.setSmoothnessThreshold(0.2F);
  estimation.setReferenceThreshold(0.4F);
  EXPECT_EQ(settingsWithoutEffect(estimation.getOptions()), Names{});
}

TEST(Settings, TheClassesWarn) {
  auto cloud = pcl::make_shared<pcl::PointCloud<pcl::PointXYZ>>();
  for (int i = 0; i < 100; ++i) {
    const int row = i / 10;
    cloud->emplace_back(static_cast<float>(i % 10), static_cast<float>(row), 0.F);
  }
  OrientedNormalEstimation<pcl::PointXYZ, pcl::Normal> estimation;
  estimation.setInputCloud(cloud);
  pcl::PointCloud<pcl::Normal> output;
  testing::internal::CaptureStderr();
  estimation.compute(output);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  estimation.setGamma(0.2F);
  testing::internal::CaptureStderr();
  estimation.compute(output);
  EXPECT_NE(testing::internal::GetCapturedStderr().find("gamma changes nothing with method auto"),
            std::string::npos);

  SegmentOrientation<pcl::PointXYZ, pcl::Normal> orientation;
  orientation.setInputCloud(cloud);
  orientation.setInputNormals(
      pcl::make_shared<pcl::PointCloud<pcl::Normal>>(100, 1, pcl::Normal(0.F, 0.F, 1.F)));
  orientation.setMinMargin(0.25F);
  testing::internal::CaptureStderr();
  orientation.compute(output);
  EXPECT_NE(testing::internal::GetCapturedStderr().find("min_margin"), std::string::npos);
  orientation.setOptions(paperOptions());
  testing::internal::CaptureStderr();
  orientation.compute(output);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(output.size(), 100U);
  SegmentationSettings segments;
  segments.unite_smooth = true;
  segments.max_gap = 1.F;
  orientation.setSegmentationOptions(segments);
  testing::internal::CaptureStderr();
  orientation.compute(output);
  std::string said = testing::internal::GetCapturedStderr();
  EXPECT_NE(said.find("segmentation.unite_smooth"), std::string::npos);
  EXPECT_EQ(said.find("segmentation.max_gap"), std::string::npos);
  orientation.setSegmentation(std::make_shared<Segmentation>(orientation.getUsedSegmentation()));
  testing::internal::CaptureStderr();
  orientation.compute(output);
  said = testing::internal::GetCapturedStderr();
  EXPECT_NE(said.find("segmentation.max_gap"), std::string::npos);
  EXPECT_NE(said.find("and given segments"), std::string::npos) << said;

  // Nobody set the sensor origin of a cloud.
  auto from_a_sensor = pcl::make_shared<pcl::PointCloud<pcl::PointXYZ>>(*cloud);
  from_a_sensor->sensor_origin_ = {4.F, 4.F, 9.F, 0.F};
  OrientedNormalEstimation<pcl::PointXYZ, pcl::Normal> combined;
  combined.setMethod(OrientationMethod::COMBINED);
  combined.setInputCloud(from_a_sensor);
  testing::internal::CaptureStderr();
  combined.compute(output);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  combined.setViewPoint(4.F, 4.F, 9.F);
  testing::internal::CaptureStderr();
  combined.compute(output);
  EXPECT_NE(testing::internal::GetCapturedStderr().find("hints"), std::string::npos);
}

TEST(Settings, KSearchCountsThePointEverywhere) {
  NormalRecomputation<pcl::PointXYZ, pcl::Normal> recomputation;
  EXPECT_EQ(recomputation.getKSearch(), 21);
  recomputation.setKSearch(13);
  EXPECT_EQ(recomputation.getKSearch(), 13);
}

template <typename Settings, typename = void>
struct HasThreads : std::false_type {};
template <typename Settings>
struct HasThreads<Settings, std::void_t<decltype(Settings::threads)>> : std::true_type {};

TEST(Settings, ThreadsAreSetOnce) {
  EXPECT_TRUE(HasThreads<PipelineOptions>::value);
  EXPECT_FALSE(HasThreads<decltype(PipelineOptions::normals)>::value);
  EXPECT_FALSE(HasThreads<decltype(PipelineOptions::segmentation)>::value);
  EXPECT_FALSE(HasThreads<decltype(PipelineOptions::recomputation)>::value);
  EXPECT_FALSE(HasThreads<decltype(PipelineOptions::orientation)>::value);
  EXPECT_FALSE(HasThreads<decltype(OrientationSettings::triangulation)>::value);
}

}  // namespace
}  // namespace segorient::test
