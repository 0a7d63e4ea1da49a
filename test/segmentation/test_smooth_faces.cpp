// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <gtest/gtest.h>
#include <segorient/segmentation/normal_segmentation.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "grid_solids.h"
#include "partition_quality.h"
#include "segmentation/region_growing.h"
#include "segmentation_support.h"

namespace segorient::test {
namespace {

struct Result {
  Segmentation segments;
  Segmentation faces;
  SegmentationReport report;
};

Result segmentBoth(const Prepared& in, const SegmentationOptions& options = {}) {
  Result r;
  r.segments = segmentByNormals(viewOf(in.cloud.xyz), normalsOf(in.normals), in.table, options,
                                &r.report, &r.faces);
  return r;
}

std::size_t countRegular(const Segmentation& s) {
  return static_cast<std::size_t>(
      std::count_if(s.segments.begin(), s.segments.end(),
                    [](const Segment& t) { return t.kind == SegmentKind::REGULAR; }));
}

// Share of neighbours in one face whose signed normals agree.
double agreement(const Prepared& in, const Segmentation& s) {
  std::size_t pairs = 0;
  std::size_t good = 0;
  for (std::size_t p = 0; p < s.labels.size(); ++p) {
    for (int j = 1; j < 5; ++j) {
      const auto q = static_cast<std::size_t>(in.table.indices(p)[j]);
      if (s.labels[q] != s.labels[p]) continue;
      float dot = 0;
      for (std::size_t c = 0; c < 3; ++c) dot += in.normals[4 * p + c] * in.normals[4 * q + c];
      ++pairs;
      good += dot * static_cast<float>(s.signs[p] * s.signs[q]) > 0.F ? 1U : 0U;
    }
  }
  return static_cast<double>(good) / static_cast<double>(pairs);
}

TEST(Strips, GridsOfABoxHaveSixSegments) {
  for (const int steps : {20, 40}) {
    for (const double angle : {0.0, 0.3}) {
      for (const int k : {10, 12, 18, 24}) {
        const Prepared in(gridBox(steps, steps, steps, angle), k);
        SegmentationReport report;
        const Segmentation s = in.segment({}, &report);
        EXPECT_EQ(s.segments.size(), 6U) << steps << " " << angle << " " << k;
        EXPECT_EQ(report.regular, 6U);
        // Points of an edge belong to both of its faces: 12 edges of `steps` points, half of them
        // wrong in the worst case, and none else.
        const double wrong =
            (1 - purity(s.labels, in.cloud.face)) * static_cast<double>(in.cloud.size());
        EXPECT_LE(wrong, 12.0 * steps);
        const double inside = static_cast<double>(s.segments.back().size);
        EXPECT_GE(inside, (steps - 1) * (steps - 1));
      }
    }
  }
}

TEST(Strips, RowsOnEdgesAreSegmentsWithoutTheStep) {
  const Prepared in(gridBox(40, 40, 40), 12);
  SegmentationOptions options;
  options.settle_edges = false;
  EXPECT_GT(in.segment(options).segments.size(), 6U);
}

// The sides of a plate are faces, not strips that its top and bottom may take.
TEST(Strips, NarrowFacesStay) {
  const Prepared in(sample("plate", prism(rectangle(1, 1), 0.05), 10000, 3), 12);  // 3.4 spacings
  const Segmentation s = in.segment();
  std::size_t sides = 0;
  std::size_t taken = 0;
  for (std::size_t p = 0; p < in.cloud.size(); ++p) {
    if (in.cloud.face[p] < 2) continue;
    ++sides;
    const auto label = static_cast<std::size_t>(s.labels[p]);
    taken += s.segments[label].size > 3000 ? 1U : 0U;
  }
  EXPECT_LT(static_cast<double>(taken), 0.25 * static_cast<double>(sides));
  EXPECT_GE(purity(s.labels, in.cloud.face), 0.975);
}

TEST(SmoothFaces, RoundFacesAreOne) {
  for (const auto& [name, faces] :
       {std::pair<std::string, std::vector<Face>>{"holed", holedSolid()},
        {"cylinder", cylinder()}}) {
    for (const double sigma : {0.0, 0.1, 0.25}) {
      const Prepared in(sample(name, faces, 30000, 5, sigma), sigma > 0.2 ? 18 : 12);
      const Result r = segmentBoth(in);
      const double index = adjustedRandIndex(r.faces.labels, in.cloud.face);
      EXPECT_GE(index, sigma == 0.0 ? 0.98 : sigma < 0.2 ? 0.97 : 0.95) << name << " " << sigma;
      EXPECT_LT(adjustedRandIndex(r.segments.labels, in.cloud.face), 0.92);
      EXPECT_EQ(r.report.united, r.segments.segments.size() - r.faces.segments.size());
      EXPECT_GE(agreement(in, r.faces), 0.999) << name << " " << sigma;
    }
  }
}

TEST(SmoothFaces, SharpEdgesStay) {
  for (const auto& [name, faces] : {std::pair<std::string, std::vector<Face>>{"cube", cube()},
                                    {"octagonal prism", octagonalPrism()},
                                    {"stepped", steppedSolid()},
                                    {"bracket", bracket()}}) {
    for (const double sigma : {0.0, 0.25}) {
      const Prepared in(sample(name, faces, 20000, 6, sigma), sigma > 0.2 ? 18 : 12);
      const Result r = segmentBoth(in);
      EXPECT_GE(adjustedRandIndex(r.faces.labels, in.cloud.face), sigma == 0.0 ? 0.985 : 0.95)
          << name << " " << sigma;
      EXPECT_GE(countRegular(r.faces), faces.size());
    }
  }
}

// A sphere is smooth everywhere; both sides of a thin plate are flat, parallel and near.
TEST(SmoothFaces, AWholeSphereAndBothSidesOfAPlate) {
  LabelledCloud ball;
  std::mt19937 rng(4);
  std::normal_distribution<double> normal(0, 1);
  for (int i = 0; i < 8000; ++i) {
    const Eigen::Vector3d p = Eigen::Vector3d(normal(rng), normal(rng), normal(rng)).normalized();
    for (int c = 0; c < 3; ++c) ball.xyz.push_back(static_cast<float>(p[c]));
    ball.xyz.push_back(0);
    ball.face.push_back(0);
  }
  const Prepared sphere(std::move(ball), 12);
  const Result round = segmentBoth(sphere);
  EXPECT_GT(round.segments.segments.size(), 5U);
  EXPECT_EQ(round.faces.segments.size(), 1U);
  EXPECT_EQ(agreement(sphere, round.faces), 1.0);

  const Prepared thin(sample("plate", plate(2.0, 12000), 12000, 4), 10);
  const Result flat = segmentBoth(thin);
  std::vector<std::int32_t> labels = flat.faces.labels;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    if (thin.cloud.face[i] > 1) labels[i] = -1;
  }
  EXPECT_GE(purity(labels, thin.cloud.face), 0.995);
}

TEST(SmoothFaces, DoNotDependOnThreadsAndContainWholeSegments) {
  const Prepared in(sample("holed", holedSolid(), 12000, 8));
  SegmentationOptions options;
  options.threads = 1;
  const Result one = segmentBoth(in, options);
  options.threads = 3;
  const Result three = segmentBoth(in, options);
  EXPECT_EQ(one.faces.labels, three.faces.labels);
  EXPECT_EQ(one.faces.signs, three.faces.signs);
  ASSERT_LT(one.faces.segments.size(), one.segments.segments.size());
  for (std::size_t s = 0; s < one.segments.segments.size(); ++s) {
    std::set<std::int32_t> faces;
    for (const auto* p = one.segments.begin(s); p != one.segments.end(s); ++p) {
      faces.insert(one.faces.labels[static_cast<std::size_t>(*p)]);
    }
    EXPECT_EQ(faces.size(), 1U);
  }
  for (std::size_t s = 1; s < one.faces.segments.size(); ++s) {
    EXPECT_GE(one.faces.segments[s - 1].size, one.faces.segments[s].size);
  }
}

TEST(SmoothFaces, GettersOfTheClassGiveFacesOrSegments) {
  const Prepared in(sample("cylinder", cylinder(), 12000, 9));
  pcl::PointCloud<pcl::PointXYZ>::Ptr cloud(new pcl::PointCloud<pcl::PointXYZ>);
  pcl::PointCloud<pcl::Normal>::Ptr normals(new pcl::PointCloud<pcl::Normal>);
  for (std::size_t i = 0; i < in.cloud.size(); ++i) {
    cloud->emplace_back(in.cloud.xyz[4 * i], in.cloud.xyz[4 * i + 1], in.cloud.xyz[4 * i + 2]);
    normals->emplace_back(in.normals[4 * i], in.normals[4 * i + 1], in.normals[4 * i + 2],
                          in.normals[4 * i + 3]);
  }
  cloud->push_back((*cloud)[0]);  // a duplicate
  normals->push_back((*normals)[0]);
  cloud->emplace_back(NAN, 0.F, 0.F);
  normals->emplace_back(0.F, 0.F, 1.F, 0.F);
  NormalSegmentation<pcl::PointXYZ, pcl::Normal> segmentation;
  segmentation.setInputCloud(cloud);
  segmentation.setInputNormals(normals);
  EXPECT_TRUE(segmentation.getUniteSmooth());
  std::vector<pcl::PointIndices> faces;
  segmentation.extract(faces);
  EXPECT_EQ(segmentation.getSegments().size(), faces.size());
  EXPECT_GT(segmentation.getPlanarSegmentation().segments.size(), faces.size());
  EXPECT_GT(segmentation.getReport().united, 0U);
  for (std::size_t f = 0; f < faces.size(); ++f) {
    EXPECT_EQ(segmentation.getSegments()[f].size, faces[f].indices.size());
  }

  const std::vector<float> sure = segmentation.getConfidences();
  ASSERT_EQ(sure.size(), cloud->size());
  EXPECT_EQ(sure.back(), 0.F);
  EXPECT_EQ(sure[in.cloud.size()], sure[0]);
  for (std::size_t i = 0; i < in.cloud.size(); ++i) {
    // In the middle of the side all neighbours are in the same face.
    if (in.cloud.face[i] == 2 && std::abs(in.cloud.xyz[4 * i + 2] - 0.5F) < 0.2F) {
      EXPECT_EQ(sure[i], 1.F);
    }
    EXPECT_GE(sure[i], 0.F);
    EXPECT_LE(sure[i], 1.F);
  }

  segmentation.setUniteSmooth(false);
  std::vector<pcl::PointIndices> segments;
  segmentation.extract(segments);
  EXPECT_EQ(segments.size(), segmentation.getPlanarSegmentation().segments.size());
  EXPECT_EQ(segmentation.getLabels(), segmentation.getPlanarSegmentation().labels);
  EXPECT_EQ(segmentation.getReport().united, 0U);
}

}  // namespace
}  // namespace segorient::test
