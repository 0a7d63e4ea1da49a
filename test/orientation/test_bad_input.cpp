// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// Both classes of the module on everything that may be wrong with a cloud, its normals, its indices
// and the settings: an error and an empty result, or NaN where there is nothing to go by.
#include <gtest/gtest.h>
#include <segorient/orientation/oriented_normal_estimation.h>
#include <segorient/orientation/segment_orientation.h>

#include <limits>
#include <string>
#include <vector>

#include "bad_clouds.h"

namespace segorient::test {
namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;
using Normals = pcl::PointCloud<pcl::Normal>;

constexpr OrientationMethod kMethods[] = {
    OrientationMethod::AUTO,     OrientationMethod::PROPAGATION, OrientationMethod::BOUNDARY,
    OrientationMethod::COMBINED, OrientationMethod::EXTREMAL,    OrientationMethod::HOPPE};

class BadInput : public testing::TestWithParam<OrientationMethod> {
 protected:
  const QuietPcl quiet_;
};
INSTANTIATE_TEST_SUITE_P(Methods, BadInput, testing::ValuesIn(kMethods),
                         [](const testing::TestParamInfo<OrientationMethod>& method) {
                           return std::string(toString(method.param));
                         });

// One object for all of them: what it was used for before must not matter.
TEST_P(BadInput, EstimationOfCloudsAndIndices) {
  OrientedNormalEstimation<pcl::PointXYZ, pcl::Normal> estimation;
  estimation.setMethod(GetParam());
  estimation.setNumberOfThreads(1);
  forEachBadInput([&](const BadCloud& bad, const IndexCase& index) {
    estimation.setInputCloud(bad.cloud);
    estimation.setIndices(index.indices);
    Normals out(3, 1);
    for (const int k : {-1, std::numeric_limits<int>::min()}) {
      estimation.setKSearch(k);
      estimation.compute(out);
      EXPECT_TRUE(out.empty());
      EXPECT_TRUE(estimation.getLabels().empty());
    }
    for (const int k : {0, 1, std::numeric_limits<int>::max()}) {
      SCOPED_TRACE("k " + std::to_string(k));
      estimation.setKSearch(k);
      estimation.compute(out);
      if (k == 1) continue;  // one neighbour makes no plane but where the method has its own
      checkNormals(bad, index, out);
      EXPECT_EQ(estimation.getLabels().size(), out.size());
    }
  });
}

TEST_P(BadInput, EstimationWithoutACloud) {
  OrientedNormalEstimation<pcl::PointXYZ, pcl::Normal> estimation;
  estimation.setMethod(GetParam());
  Normals out(3, 1);
  estimation.compute(out);
  EXPECT_TRUE(out.empty());
  estimation.setInputCloud(curvedPatch(50).makeShared());
  for (const double radius : {0.1, 1e20, kInfinity + 0.0}) {
    estimation.setRadiusSearch(radius);
    estimation.compute(out);
    EXPECT_EQ(out.size(), 50U) << radius;
  }
  for (const double radius : {-1.0, kNaN + 0.0}) {
    estimation.setRadiusSearch(radius);
    estimation.compute(out);
    EXPECT_TRUE(out.empty()) << radius;
  }
  estimation.setRadiusSearch(0.1);
  estimation.setKSearch(10);
  estimation.compute(out);
  EXPECT_TRUE(out.empty()) << "both, as in PCL";
  estimation.setInputCloud(nullptr);
  estimation.compute(out);
  EXPECT_TRUE(out.empty());
  EXPECT_TRUE(estimation.getLabels().empty());
}

TEST_P(BadInput, EstimationOnSurfacesOfAllKinds) {
  for (const BadCloud& bad : badClouds()) {
    SCOPED_TRACE(bad.name);
    OrientedNormalEstimation<pcl::PointXYZ, pcl::Normal> estimation;
    estimation.setMethod(GetParam());
    estimation.setNumberOfThreads(1);
    estimation.setInputCloud(curvedPatch(20).makeShared());
    estimation.setSearchSurface(bad.cloud);
    Normals out;
    estimation.compute(out);
    ASSERT_EQ(out.size(), 20U);
    for (const auto& n : out) EXPECT_TRUE(isUnitOrNan(n));
  }
}

// Lengths whose squares a float cannot hold.
TEST_P(BadInput, NormalsOfAnyLengthAreTurnedAlike) {
  const Cloud::Ptr cloud = curvedPatch(400).makeShared();
  OrientedNormalEstimation<pcl::PointXYZ, pcl::Normal> estimation;
  estimation.setInputCloud(cloud);
  Normals truth;
  estimation.compute(truth);
  SegmentOrientation<pcl::PointXYZ, pcl::Normal> orientation;
  orientation.setMethod(GetParam());
  orientation.setInputCloud(cloud);
  std::vector<float> expected;
  for (const float length : {1.F, 1e-25F, 1e-30F, 1e25F, 1e30F}) {
    auto normals = pcl::make_shared<Normals>(truth);
    for (std::size_t i = 0; i < normals->size(); ++i) {
      for (float& c : (*normals)[i].normal) c *= i % 3 == 0 ? -length : length;
    }
    orientation.setInputNormals(normals);
    Normals out;
    orientation.compute(out);
    ASSERT_EQ(out.size(), 400U);
    for (std::size_t i = 0; i < out.size(); ++i) {
      const float side = out[i].normal_z * truth[i].normal_z;
      if (length == 1.F) expected.push_back(side);
      ASSERT_EQ(side > 0.F, expected[i] > 0.F) << length << " row " << i;
    }
  }
}

TEST_P(BadInput, OrientationOfCloudsNormalsAndIndices) {
  SegmentOrientation<pcl::PointXYZ, pcl::Normal> orientation;
  orientation.setMethod(GetParam());
  orientation.setNumberOfThreads(1);
  forEachBadInput([&](const BadCloud& bad, const IndexCase& index) {
    const std::size_t size = bad.cloud->size();
    const std::size_t rows = index.indices ? index.indices->size() : size;
    orientation.setInputCloud(bad.cloud);
    orientation.setIndices(index.indices);
    for (const float z : {1.F, 0.F, kNaN, kInfinity, 1e30F}) {
      SCOPED_TRACE("normal " + std::to_string(z));
      orientation.setInputNormals(pcl::make_shared<Normals>(size, 1, pcl::Normal(0.F, 0.F, z)));
      // More neighbours than points are no matter of the normals.
      const std::vector<int> ks =
          z == 1.F ? std::vector<int>{0, 1, std::numeric_limits<int>::max()} : std::vector<int>{0};
      for (const int k : ks) {
        orientation.setKSearch(k);
        Normals out(3, 1);
        orientation.compute(out);
        ASSERT_EQ(out.size(), size == 0 ? 0U : rows) << "k " << k;
        for (std::size_t i = 0; i < out.size(); ++i) {
          ASSERT_TRUE(z != 1.F || isUnitOrNan(out[i])) << out[i];
          if (pointOf(*bad.cloud, index.indices, i) == nullptr) {
            ASSERT_TRUE(std::isnan(out[i].normal_z)) << i;
          }
        }
      }
    }
  });
}

// Seeds that are no place or no direction and viewpoints that are nowhere change nothing.
TEST_P(BadInput, HintsThatSayNothing) {
  const auto seed = [](float x, float normal) {
    pcl::PointNormal out;
    out.x = x;
    out.y = out.z = 0.F;
    out.normal_x = out.normal_y = 0.F;
    out.normal_z = normal;
    return out;
  };
  const auto seeds = pcl::make_shared<pcl::PointCloud<pcl::PointNormal>>();
  // The last is in other coordinates.
  for (const float x : {kNaN, kInfinity, 5e5F}) seeds->push_back(seed(x, -1.F));
  for (const float normal : {kNaN, -kInfinity, 0.F}) seeds->push_back(seed(0.F, normal));
  const auto cloud = curvedPatch(150).makeShared();
  const auto expectUnchanged = [&](auto& object, auto& out) {
    object.setMethod(GetParam());
    object.setInputCloud(cloud);
    object.compute(out);
    const Normals without = out;
    for (const float x : {0.F, kNaN, kInfinity, -kInfinity}) {
      if (x != 0.F) object.setViewPoint(x, 0.F, -1.F);
      object.setSeeds(seeds);
      object.compute(out);
      ASSERT_EQ(out.size(), cloud->size());
      for (std::size_t i = 0; i < out.size(); ++i) {
        ASSERT_EQ(out[i].getNormalVector3fMap(), without[i].getNormalVector3fMap()) << i;
      }
    }
    seeds->push_back(seed(0.F, -1.F));
    object.compute(out);
    seeds->erase(seeds->end() - 1);
    EXPECT_TRUE(GetParam() != OrientationMethod::AUTO || out[0].normal_z < 0.F);
  };
  Normals out;
  OrientedNormalEstimation<pcl::PointXYZ, pcl::Normal> estimation;
  expectUnchanged(estimation, out);
  const auto normals = pcl::make_shared<Normals>(out);
  SegmentOrientation<pcl::PointXYZ, pcl::Normal> orientation;
  orientation.setInputNormals(normals);
  expectUnchanged(orientation, out);
}

TEST_P(BadInput, OrientationOfMismatchedInput) {
  SegmentOrientation<pcl::PointXYZ, pcl::Normal> orientation;
  orientation.setMethod(GetParam());
  const auto expectEmpty = [&](const char* what) {
    Normals out(3, 1);
    orientation.compute(out);
    EXPECT_TRUE(out.empty()) << what;
    EXPECT_TRUE(orientation.getLabels().empty()) << what;
  };
  const auto normals = [](std::uint32_t count) {
    return pcl::make_shared<Normals>(count, 1, pcl::Normal(0.F, 0.F, 1.F));
  };
  expectEmpty("nothing set");
  orientation.setInputCloud(curvedPatch(50).makeShared());
  expectEmpty("no normals");
  orientation.setInputNormals(normals(49));
  expectEmpty("too few normals");
  orientation.setInputNormals(normals(51));
  expectEmpty("too many normals");
  orientation.setInputNormals(normals(50));
  orientation.setKSearch(-1);
  expectEmpty("negative k");
  orientation.setKSearch(0);
  orientation.setInputCloud(nullptr);
  expectEmpty("no cloud");
  orientation.setInputCloud(curvedPatch(50).makeShared());
  Normals out;
  orientation.compute(out);
  EXPECT_EQ(out.size(), 50U);
}

}  // namespace
}  // namespace segorient::test
