// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// One segmentation: whoever asks for a cloud's segments gets the same.
#include <gtest/gtest.h>
#include <pcl/features/normal_3d.h>
#include <pcl/point_types.h>
#include <segorient/features/plane_normal_estimation.h>
#include <segorient/orientation/oriented_normal_estimation.h>
#include <segorient/orientation/pipeline.h>
#include <segorient/orientation/segment_orientation.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "oriented_shapes.h"

namespace segorient::test {
namespace {

pcl::PointCloud<pcl::PointXYZ>::Ptr toPcl(const LabelledCloud& cloud) {
  pcl::PointCloud<pcl::PointXYZ>::Ptr out(new pcl::PointCloud<pcl::PointXYZ>);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    out->emplace_back(cloud.xyz[4 * i], cloud.xyz[4 * i + 1], cloud.xyz[4 * i + 2]);
  }
  return out;
}

std::vector<LabelledCloud> clouds() {
  std::vector<LabelledCloud> out;
  out.push_back(sample("bracket", bracket(), 5000, 71));
  out.push_back(sample("cylinder", cylinder(), 5000, 72, 0.1));
  out.push_back(sample("plate", plate(2, 5000), 5000, 73));
  // So noisy that positions are smoothed first.
  out.push_back(sample("noisy cylinder", cylinder(), 3000, 79, 0.45));
  return out;
}

TEST(OneSegmentation, ComesFromEveryDoor) {
  for (const LabelledCloud& cloud : clouds()) {
    for (const float beta : {0.F, 0.35F}) {
      PipelineOptions options;
      if (beta > 0.F) options.segmentation.beta = options.orientation.automatic.beta = beta;
      const PointView points{cloud.xyz.data(), 4, cloud.size()};
      const OrientedCloud oriented = orientCloud(points, nullptr, options);
      const std::vector<std::int32_t>& labels = oriented.segmentation.labels;
      ASSERT_GT(oriented.segmentation.segments.size(), 1U) << cloud.name;
      const OrientedCloud segmented = segmentCloud(points, options);
      EXPECT_EQ(segmented.segmentation.labels, labels) << cloud.name;
      const auto input = toPcl(cloud);

      OrientedNormalEstimation<pcl::PointXYZ, pcl::Normal> estimation;
      estimation.setInputCloud(input);
      estimation.setOptions(options);
      pcl::PointCloud<pcl::Normal>::Ptr normals(new pcl::PointCloud<pcl::Normal>);
      estimation.compute(*normals);
      EXPECT_EQ(estimation.getLabels(), labels) << cloud.name;

      SegmentOrientation<pcl::PointXYZ, pcl::Normal> orientation;
      orientation.setInputCloud(input);
      orientation.setInputNormals(normals);
      orientation.setSegmentationOptions(options.segmentation);
      if (beta > 0.F) continue;  // it has no setter for the default method's own angles
      pcl::PointCloud<pcl::Normal> turned;
      orientation.compute(turned);
      EXPECT_EQ(orientation.getLabels(), labels) << cloud.name;
    }
  }
}

TEST(OneSegmentation, OfAMethodIsTheSameWithoutItsOrientation) {
  const LabelledCloud cloud = sample("bracket", bracket(), 5000, 74);
  const PointView points{cloud.xyz.data(), 4, cloud.size()};
  PipelineOptions options;
  options.orientation.method = OrientationMethod::COMBINED;
  options.normals.estimator = NormalEstimator::LCT;
  options.recomputations = 2;
  EXPECT_EQ(segmentCloud(points, options).segmentation.labels,
            orientCloud(points, nullptr, options).segmentation.labels);
}

TEST(OneSegmentation, AgreesWithinEachSegment) {
  for (const LabelledCloud& cloud : clouds()) {
    const OrientedCloud out = segmentCloud({cloud.xyz.data(), 4, cloud.size()}, {});
    std::size_t turned = 0;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      const std::int32_t label = out.segmentation.labels[i];
      ASSERT_GE(label, 0) << cloud.name;
      const Segment& segment = out.segmentation.segments[static_cast<std::size_t>(label)];
      if (segment.kind != SegmentKind::REGULAR) continue;
      const float* n = &out.normals[4 * i];
      const auto& r = segment.reference_normal;
      turned += n[0] * r[0] + n[1] * r[1] + n[2] * r[2] < 0.F ? 1U : 0U;
    }
    EXPECT_EQ(turned, 0U) << cloud.name;
  }
}

TEST(OneSegmentation, HasThePointsWhoseNormalsAreOfItsFace) {
  // Of a cube, each normal but those of a corner or two is of one face; so are its segments.
  for (const unsigned seed : {76U, 77U, 78U}) {
    const LabelledCloud cloud = sample("cube", cube(), 6000, seed);
    const OrientedCloud out = segmentCloud({cloud.xyz.data(), 4, cloud.size()}, {});
    std::size_t contrary = 0;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      const auto label = static_cast<std::size_t>(out.segmentation.labels[i]);
      const auto& face = out.segmentation.segments[label].reference_normal;
      const float* n = &out.normals[4 * i];
      contrary += n[0] * face[0] + n[1] * face[1] + n[2] * face[2] < 0.5F ? 1U : 0U;
    }
    EXPECT_LE(contrary, 1U) << seed;
  }
}

TEST(OneSegmentation, UnitesFacesWhereItIsAskedTo) {
  const LabelledCloud cloud = sample("cylinder", cylinder(), 8000, 75);
  const PointView points{cloud.xyz.data(), 4, cloud.size()};
  PipelineOptions options;
  const auto regular = [&] {
    const OrientedCloud out = orientCloud(points, nullptr, options);
    return std::count_if(out.segmentation.segments.begin(), out.segmentation.segments.end(),
                         [](const Segment& s) { return s.kind == SegmentKind::REGULAR; });
  };
  EXPECT_GT(regular(), 3);
  options.segmentation.unite_smooth = true;
  EXPECT_EQ(regular(), 3);
}

}  // namespace
}  // namespace segorient::test
