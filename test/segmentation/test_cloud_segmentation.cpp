// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <gtest/gtest.h>
#include <pcl/point_types.h>
#include <segorient/common/impl/cloud_access.hpp>
#include <segorient/segmentation/impl/cloud_segmentation.hpp>

#include <algorithm>
#include <limits>
#include <numeric>
#include <type_traits>

#include "segmentation_support.h"

namespace segorient::test {
namespace {

constexpr int kNeighbors = 12;

/// Normals in rows of seven floats with the curvature sixth; the others are NaN.
class Apart {
 public:
  explicit Apart(const std::vector<float>& rows)
      : floats_(kStride * rows.size() / 4, std::numeric_limits<float>::quiet_NaN()),
        size_(rows.size() / 4) {
    for (std::size_t i = 0; i < size_; ++i) {
      std::copy_n(&rows[4 * i], 3, &floats_[kStride * i]);
      floats_[kStride * i + kCurvature] = rows[4 * i + 3];
    }
  }
  NormalView view() const { return {PointView{floats_.data(), kStride, size_}, kCurvature}; }

 private:
  static constexpr std::size_t kStride = 7;
  static constexpr std::size_t kCurvature = 5;
  std::vector<float> floats_;
  std::size_t size_;
};

void expectTheSame(const CloudSegmentation::Input& input, const NormalView& apart) {
  CloudSegmentation together;
  ASSERT_TRUE(together.compute(input, {}));
  EXPECT_GE(together.segmentation().segments.size(), 6U);
  CloudSegmentation::Input other = input;
  other.normals = apart;
  CloudSegmentation separate;
  ASSERT_TRUE(separate.compute(other, {}));
  EXPECT_EQ(together.segmentation().labels, separate.segmentation().labels);
  EXPECT_EQ(together.segmentation().signs, separate.segmentation().signs);
}

TEST(CloudSegmentation, CurvaturesMayLieApartFromNormals) {
  const Prepared in(sample("bracket", bracket(), 8000, 6), kNeighbors);
  const Apart apart(in.normals);
  pcl::Indices most(7500);
  std::iota(most.begin(), most.end(), 250);
  CloudSegmentation::Input input;
  input.points = viewOf(in.cloud.xyz);
  input.normals = normalsOf(in.normals);
  input.neighbors = kNeighbors;
  for (const Neighborhoods* table : {static_cast<const Neighborhoods*>(nullptr), &in.table}) {
    for (const pcl::Indices* indices :
         {static_cast<const pcl::Indices*>(nullptr), static_cast<const pcl::Indices*>(&most)}) {
      SCOPED_TRACE(testing::Message()
                   << "table " << (table != nullptr) << ", indices " << (indices != nullptr));
      input.table = table;
      input.indices = indices;
      expectTheSame(input, apart.view());
    }
  }
}

TEST(CloudSegmentation, CurvaturesDecideWhereSegmentsStart) {
  // That they are read at all: without them other points are the first.
  Prepared in(sample("cylinder", cylinder(), 8000, 3), kNeighbors);
  CloudSegmentation::Input input;
  input.points = viewOf(in.cloud.xyz);
  input.normals = normalsOf(in.normals);
  CloudSegmentation with;
  ASSERT_TRUE(with.compute(input, {}));
  std::vector<float> flat = in.normals;
  for (std::size_t i = 3; i < flat.size(); i += 4) flat[i] = 0.F;
  input.normals = normalsOf(flat);
  CloudSegmentation without;
  ASSERT_TRUE(without.compute(input, {}));
  EXPECT_NE(with.segmentation().labels, without.segmentation().labels);
}

template <typename NormalT>
void fill(NormalT& to, int i) {
  using Number = std::decay_t<decltype(to.normal_x)>;
  to.normal_x = static_cast<Number>(i);
  to.normal_y = static_cast<Number>(10 * i);
  to.normal_z = static_cast<Number>(100 * i);
  to.curvature = static_cast<Number>(1000 * i);
}

template <typename NormalT>
void expectRead(bool in_place) {
  pcl::PointCloud<NormalT> cloud;
  cloud.resize(3);
  for (int i = 0; i < 3; ++i) fill(cloud.points[static_cast<std::size_t>(i)], i + 1);
  const CloudNormals<NormalT> normals(cloud);
  const NormalView& view = normals.view();
  ASSERT_EQ(view.size, 3U);
  const auto* first = reinterpret_cast<const float*>(&cloud.points.front().normal_x);
  EXPECT_EQ(view.data == first, in_place);
  for (std::size_t i = 0; i < 3; ++i) {
    const auto row = static_cast<float>(i + 1);
    EXPECT_EQ(view[i][0], row);
    EXPECT_EQ(view[i][1], 10.F * row);
    EXPECT_EQ(view[i][2], 100.F * row);
    EXPECT_EQ(view[i][view.curvature], 1000.F * row);
  }
}

struct DoubleNormal {
  double normal_x = 0, normal_y = 0, normal_z = 0, curvature = 0;
};
struct BackwardNormal {
  float normal_z = 0, normal_y = 0, normal_x = 0, curvature = 0;
};
struct DoubleCurvature {
  float normal_x = 0, normal_y = 0, normal_z = 0;
  double curvature = 0;
};
struct CurvatureFirst {
  float curvature = 0, normal_x = 0, normal_y = 0, normal_z = 0;
};

TEST(CloudNormals, ReadsWhateverLayoutTheTypeHas) {
  expectRead<pcl::Normal>(true);
  expectRead<pcl::PointNormal>(true);
  expectRead<pcl::PointXYZRGBNormal>(true);
  expectRead<pcl::PointXYZINormal>(true);
  expectRead<pcl::PointXYZLNormal>(true);
  expectRead<pcl::PointSurfel>(true);
  expectRead<DoubleNormal>(false);
  expectRead<BackwardNormal>(false);
  expectRead<CurvatureFirst>(false);
  expectRead<DoubleCurvature>(false);
  pcl::PointCloud<pcl::Axis> axes;
  axes.resize(2);
  axes[1].normal_y = 3.F;
  const CloudNormals<pcl::Axis> without(axes);
  EXPECT_EQ(without.view()[1][1], 3.F);
  EXPECT_EQ(without.view()[1][without.view().curvature], 0.F);
  EXPECT_EQ(CloudNormals<pcl::Normal>(pcl::PointCloud<pcl::Normal>()).view().size, 0U);
}

}  // namespace
}  // namespace segorient::test
