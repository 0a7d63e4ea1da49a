// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
//
// Points that are nowhere near the others: no class may mind.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "bad_clouds.h"
#include "every_class.h"

namespace segorient::test {
namespace {

struct Spoilt {
  XyzCloud::Ptr cloud;
  std::vector<std::size_t> kept;  ///< where the points of the clean cloud are
};

Spoilt spoil(const XyzCloud& clean, std::size_t count, const pcl::PointXYZ& at) {
  Spoilt out{pcl::make_shared<XyzCloud>(), {}};
  const std::size_t step = clean.size() / count;
  for (std::size_t i = 0; i < clean.size(); ++i) {
    if (i % step == 0 && i / step < count) out.cloud->push_back(at);
    out.kept.push_back(out.cloud->size());
    out.cloud->push_back(clean[i]);
  }
  out.cloud->is_dense = false;
  return out;
}

// Beyond the reach of floats: all else is as if they were not there, and they have no normal.
TEST(Strays, BeyondFloatsAreAsIfTheyWereNotThere) {
  const QuietPcl quiet;
  const XyzCloud clean = shapes();
  const std::vector<ClassResult> expected = runEveryClass(clean.makeShared());
  const std::pair<pcl::PointXYZ, std::size_t> strays[] = {
      {{1e30F, 1e30F, 1e30F}, 100}, {{-1e20F, 0.F, 3.F}, 1}, {{kNaN, kNaN, kNaN}, 10}};
  for (const auto& [at, count] : strays) {
    const Spoilt spoilt = spoil(clean, count, at);
    const std::vector<ClassResult> found = runEveryClass(spoilt.cloud);
    for (std::size_t c = 0; c < expected.size(); ++c) {
      SCOPED_TRACE(expected[c].name + ", " + std::to_string(count) + " at " + std::to_string(at.x));
      std::size_t other = 0;
      for (std::size_t i = 0; i < spoilt.kept.size(); ++i) {
        const std::size_t row = spoilt.kept[i];
        if (!expected[c].normals.empty())
          other += !isSame(found[c].normals[row], expected[c].normals[i]);
        if (!expected[c].labels.empty()) other += found[c].labels[row] != expected[c].labels[i];
      }
      EXPECT_EQ(other, 0U);
      for (std::size_t row = 0; row < spoilt.cloud->size(); ++row) {
        if (std::binary_search(spoilt.kept.begin(), spoilt.kept.end(), row)) continue;
        if (!found[c].normals.empty()) {
          ASSERT_TRUE(std::isnan(found[c].normals[row].normal_x)) << row;
        }
        if (!found[c].labels.empty()) {
          ASSERT_EQ(found[c].labels[row], -1) << row;
        }
      }
    }
  }
}

// A search of the user's own, a ready table, and indices that name the strays as well.
TEST(Strays, OfOtherWaysToNeighbors) {
  const QuietPcl quiet;
  const XyzCloud clean = shapes();
  const Spoilt spoilt = spoil(clean, 10, {1e30F, 1e30F, 1e30F});
  const auto tableOf = [](const XyzCloud::Ptr& cloud) {
    search::MedianHash<pcl::PointXYZ> search;
    search.setInputCloud(cloud);
    const auto table = std::make_shared<Neighborhoods>();
    search.nearestKSearchAll(16, *table);
    return table;
  };
  const NormalCloud normals =
      runEstimation<PlaneNormalEstimation<pcl::PointXYZ, pcl::Normal>>("", clean.makeShared())
          .normals;
  NormalCloud with_strays;
  with_strays.resize(spoilt.cloud->size());
  for (pcl::Normal& n : with_strays) n = pcl::Normal(0.F, 0.F, 1.F);
  for (std::size_t i = 0; i < clean.size(); ++i) with_strays[spoilt.kept[i]] = normals[i];
  const ClassResult expected =
      runSegmentation("", clean.makeShared(), normals, tableOf(clean.makeShared()));
  const ClassResult found = runSegmentation("", spoilt.cloud, with_strays, tableOf(spoilt.cloud));
  ASSERT_EQ(found.labels.size(), spoilt.cloud->size());
  for (std::size_t i = 0; i < clean.size(); ++i) {
    ASSERT_EQ(found.labels[spoilt.kept[i]], expected.labels[i]) << i;
  }
  for (std::size_t row = 0; row < spoilt.cloud->size(); ++row) {
    if (!std::binary_search(spoilt.kept.begin(), spoilt.kept.end(), row)) {
      EXPECT_EQ(found.labels[row], -1) << row;
    }
  }

  // Few rows, so that each is searched for by itself.
  PlaneNormalEstimation<pcl::PointXYZ, pcl::Normal> few;
  few.setInputCloud(spoilt.cloud);
  few.setKSearch(13);
  const auto indices = pcl::make_shared<pcl::Indices>();
  for (std::size_t row = 0; row < spoilt.cloud->size(); ++row) {
    const bool stray = !std::binary_search(spoilt.kept.begin(), spoilt.kept.end(), row);
    if (stray || row % 10 == 0) indices->push_back(static_cast<pcl::index_t>(row));
  }
  few.setIndices(indices);
  NormalCloud of_few;
  few.compute(of_few);
  ASSERT_EQ(of_few.size(), indices->size());
  for (std::size_t i = 0; i < indices->size(); ++i) {
    const auto row = static_cast<std::size_t>((*indices)[i]);
    const auto at = std::lower_bound(spoilt.kept.begin(), spoilt.kept.end(), row);
    const bool stray = at == spoilt.kept.end() || *at != row;
    EXPECT_EQ(std::isnan(of_few[i].normal_x), stray) << row;
    if (stray) continue;
    const pcl::Normal& n = normals[static_cast<std::size_t>(at - spoilt.kept.begin())];
    EXPECT_NEAR(std::abs(dotOf(of_few[i], n)), 1.F, 1e-5F);
  }
}

// Normals that strays were given: a point that is nowhere faces nowhere.
TEST(Strays, OfGivenNormals) {
  const QuietPcl quiet;
  const XyzCloud clean = shapes();
  const NormalCloud normals =
      runEstimation<PlaneNormalEstimation<pcl::PointXYZ, pcl::Normal>>("", clean.makeShared())
          .normals;
  const pcl::PointXYZ places[] = {{1e30F, 1e30F, 1e30F}, {kNaN, 0.F, 0.F}};
  for (const pcl::PointXYZ& at : places) {
    const Spoilt spoilt = spoil(clean, 10, at);
    NormalCloud with_strays;
    with_strays.resize(spoilt.cloud->size());
    for (pcl::Normal& n : with_strays) n = pcl::Normal(0.F, 0.F, 1.F);
    for (std::size_t i = 0; i < clean.size(); ++i) with_strays[spoilt.kept[i]] = normals[i];
    for (const OrientationMethod method : {OrientationMethod::AUTO, OrientationMethod::COMBINED}) {
      SCOPED_TRACE(std::string(toString(method)) + ", " + std::to_string(at.x));
      SegmentOrientation<pcl::PointXYZ, pcl::Normal> orientation;
      orientation.setMethod(method);
      NormalCloud expected;
      orientation.setInputCloud(clean.makeShared());
      orientation.setInputNormals(normals.makeShared());
      orientation.compute(expected);
      NormalCloud found;
      orientation.setInputCloud(spoilt.cloud);
      orientation.setInputNormals(with_strays.makeShared());
      orientation.compute(found);
      ASSERT_EQ(found.size(), spoilt.cloud->size());
      EXPECT_FALSE(found.is_dense);
      std::size_t other = 0;
      for (std::size_t i = 0; i < clean.size(); ++i) {
        other += !isSame(found[spoilt.kept[i]], expected[i]);
      }
      EXPECT_EQ(other, 0U);
      for (std::size_t row = 0; row < spoilt.cloud->size(); ++row) {
        if (std::binary_search(spoilt.kept.begin(), spoilt.kept.end(), row)) continue;
        EXPECT_TRUE(std::isnan(found[row].normal_x)) << row;
        EXPECT_EQ(orientation.getLabels()[row], -1) << row;
      }
    }
  }
}

// Near enough to be points: the others keep their signs and, within a hair, their angles.
TEST(Strays, WithinFloatsChangeNoSign) {
  const QuietPcl quiet;
  XyzCloud clean = shapes();
  for (pcl::PointXYZ& p : clean) {  // a place on a map of 16 km, in metres
    p.x += 8192.F;
    p.y += 4096.F;
  }
  const std::vector<ClassResult> expected = runEveryClass(clean.makeShared());
  for (const std::size_t count : {1U, 10U, 100U}) {
    const Spoilt spoilt = spoil(clean, count, {0.F, 0.F, 0.F});
    const std::vector<ClassResult> found = runEveryClass(spoilt.cloud);
    for (std::size_t c = 0; c < expected.size(); ++c) {
      if (expected[c].normals.empty()) continue;
      SCOPED_TRACE(expected[c].name + ", " + std::to_string(count));
      std::size_t other = 0;
      for (std::size_t i = 0; i < spoilt.kept.size(); ++i) {
        const float along = dotOf(found[c].normals[spoilt.kept[i]], expected[c].normals[i]);
        other += !((expected[c].oriented ? along : std::abs(along)) > 0.999F);
      }
      EXPECT_EQ(other, 0U);
    }
  }
}

}  // namespace
}  // namespace segorient::test
