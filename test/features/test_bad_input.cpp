// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// Every class of the module on everything that may be wrong with a cloud, its indices, its normals
// and the settings: an error and an empty result, or NaN where there is nothing to go by.
#include <gtest/gtest.h>
#include <pcl/search/kdtree.h>
#include <segorient/features/awas_normal_estimation.h>
#include <segorient/features/lct_normal_estimation.h>
#include <segorient/features/ldt_normal_estimation.h>
#include <segorient/features/normal_recomputation.h>
#include <segorient/features/plane_normal_estimation.h>
#include <segorient/search/median_hash.h>

#include <functional>
#include <limits>
#include <vector>

#include "bad_clouds.h"

namespace segorient::test {
namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;
using Normals = pcl::PointCloud<pcl::Normal>;

struct Setting {
  int k;
  double radius;
  Planes result;  ///< what there is at most
};

const std::vector<Setting> kRefused{
    {0, 0, Planes::NONE},    {-3, 0, Planes::NONE},
    {0, -1, Planes::NONE},   {0, -kInfinity, Planes::NONE},
    {5, 0.1, Planes::NONE},  {0, kNaN, Planes::NONE},
    {-1, 0.5, Planes::NONE}, {std::numeric_limits<int>::min(), 0, Planes::NONE}};
const std::vector<Setting> kAccepted{
    {1, 0, Planes::NONE},       {2, 0, Planes::NONE},
    {9, 0, Planes::NEARLY_ALL}, {1000000000, 0, Planes::NEARLY_ALL},
    {0, 1e-42, Planes::MAYBE},  {0, 0.5, Planes::MAYBE},
    {0, 1e20, Planes::MAYBE},   {0, kInfinity, Planes::MAYBE}};

template <typename Estimation>
class BadInput : public testing::Test {
 protected:
  static void set(Estimation& estimation, const Setting& setting) {
    estimation.setKSearch(setting.k);
    estimation.setRadiusSearch(setting.radius);
  }
  const QuietPcl quiet_;
};
using Estimations = testing::Types<PlaneNormalEstimation<pcl::PointXYZ, pcl::Normal>,
                                   LCTNormalEstimation<pcl::PointXYZ, pcl::Normal>,
                                   LDTNormalEstimation<pcl::PointXYZ, pcl::Normal>,
                                   AwASNormalEstimation<pcl::PointXYZ, pcl::Normal>>;
TYPED_TEST_SUITE(BadInput, Estimations, );

// One object for all of them: what it was used for before must not matter.
TYPED_TEST(BadInput, CloudsIndicesAndSettings) {
  TypeParam estimation;
  estimation.setNumberOfThreads(1);
  forEachBadInput([&](const BadCloud& bad, const IndexCase& index) {
    estimation.setInputCloud(bad.cloud);
    estimation.setIndices(index.indices);
    Normals out(3, 1);
    for (const Setting& s : kRefused) {
      this->set(estimation, s);
      estimation.compute(out);
      EXPECT_TRUE(out.empty()) << "k " << s.k << " radius " << s.radius;
    }
    for (const Setting& s : kAccepted) {
      SCOPED_TRACE("k " + std::to_string(s.k) + " radius " + std::to_string(s.radius));
      this->set(estimation, s);
      estimation.compute(out);
      checkNormals(bad, index, out, s.result);
    }
  });
}

TYPED_TEST(BadInput, NoCloud) {
  TypeParam estimation;
  Normals out(3, 1);
  estimation.setKSearch(5);
  estimation.compute(out);
  EXPECT_TRUE(out.empty());
  estimation.setInputCloud(curvedPatch(50).makeShared());
  estimation.compute(out);
  EXPECT_EQ(out.size(), 50U);
  estimation.setInputCloud(nullptr);
  estimation.compute(out);
  EXPECT_TRUE(out.empty());
}

// Finds points that are not there, as a tree does that was built before its cloud shrank.
class LyingSearch : public pcl::search::KdTree<pcl::PointXYZ> {
 public:
  using Base = pcl::search::KdTree<pcl::PointXYZ>;
  int nearestKSearch(const pcl::PointXYZ& p, int k, pcl::Indices& indices,
                     std::vector<float>& distances) const override {
    Base::nearestKSearch(p, k, indices, distances);
    return withLies(indices, distances);
  }
  int radiusSearch(const pcl::PointXYZ& p, double radius, pcl::Indices& indices,
                   std::vector<float>& distances, unsigned int max_nn) const override {
    Base::radiusSearch(p, radius, indices, distances, max_nn);
    return withLies(indices, distances);
  }

 private:
  static int withLies(pcl::Indices& indices, std::vector<float>& distances) {
    for (const pcl::index_t lie : {pcl::index_t{-1}, pcl::index_t{1 << 30}}) {
      indices.push_back(lie);
      distances.push_back(1.F);
    }
    return static_cast<int>(indices.size());
  }
};

TYPED_TEST(BadInput, NeighborsThatAreNotThereAreLeftOut) {
  const Cloud::Ptr cloud = curvedPatch(200).makeShared();
  for (const bool by_k : {true, false}) {
    Normals truth;
    Normals out;
    for (const bool lying : {false, true}) {
      TypeParam estimation;
      estimation.setInputCloud(cloud);
      this->set(estimation, {by_k ? 9 : 0, by_k ? 0.0 : 0.4, Planes::NEARLY_ALL});
      if (lying) estimation.setSearchMethod(pcl::make_shared<LyingSearch>());
      if (!lying) estimation.setSearchMethod(pcl::make_shared<LyingSearch::Base>());
      estimation.compute(lying ? out : truth);
    }
    ASSERT_EQ(out.size(), 200U);
    for (std::size_t i = 0; i < out.size(); ++i) {
      const float x = out[i].normal_x;
      const float expected = truth[i].normal_x;
      ASSERT_TRUE(x == expected || (std::isnan(x) && std::isnan(expected))) << i;
    }
  }
}

// The search method is used as it comes, on whatever it was built before.
TYPED_TEST(BadInput, SearchOfAnotherCloud) {
  const auto search = pcl::make_shared<search::MedianHash<pcl::PointXYZ>>();
  search->setInputCloud(curvedPatch(7).makeShared());
  for (const BadCloud& bad : badClouds()) {
    SCOPED_TRACE(bad.name);
    TypeParam with_search;
    TypeParam without;
    Normals outputs[2];
    with_search.setSearchMethod(search);
    for (auto* estimation : {&with_search, &without}) {
      estimation->setInputCloud(bad.cloud);
      estimation->setKSearch(9);
      estimation->compute(outputs[estimation == &without ? 1 : 0]);
    }
    ASSERT_EQ(outputs[0].size(), outputs[1].size());
    for (std::size_t i = 0; i < outputs[0].size(); ++i) EXPECT_TRUE(isUnitOrNan(outputs[0][i]));
  }
}

TYPED_TEST(BadInput, SurfaceOfAllKinds) {
  const auto input = curvedPatch(20).makeShared();
  for (const BadCloud& bad : badClouds()) {
    SCOPED_TRACE(bad.name);
    TypeParam estimation;
    estimation.setInputCloud(input);
    estimation.setSearchSurface(bad.cloud);
    estimation.setKSearch(9);
    Normals out;
    estimation.compute(out);
    ASSERT_EQ(out.size(), 20U);
    for (const auto& n : out) EXPECT_TRUE(isUnitOrNan(n));
  }
}

struct NormalsCase {
  const char* name;
  bool accepted;
  std::function<void(Normals&)> change;
};

const std::vector<NormalsCase> kNormals{
    {"good", true, [](Normals&) {}},
    {"too few", false, [](Normals& n) { n.resize(n.size() / 2); }},
    {"too many", false, [](Normals& n) { n.resize(n.size() + 1); }},
    {"NaN", true,
     [](Normals& n) {
       for (auto& p : n) p.normal_y = kNaN;
     }},
    {"zero", true,
     [](Normals& n) {
       for (auto& p : n) p.normal_z = 0.F;
     }},
    {"huge", true, [](Normals& n) {
       for (auto& p : n) p.normal_z = 1e30F;
     }}};

class BadRecomputation : public testing::TestWithParam<RecomputationRule> {
 protected:
  const QuietPcl quiet_;
};
INSTANTIATE_TEST_SUITE_P(Rules, BadRecomputation,
                         testing::Values(RecomputationRule::ONE_SIDED,
                                         RecomputationRule::MODIFIED_NEIGHBORHOODS));

TEST_P(BadRecomputation, CloudsIndicesNormalsAndLabels) {
  NormalRecomputation<pcl::PointXYZ, pcl::Normal> recomputation;
  recomputation.setRule(GetParam());
  recomputation.setNumberOfThreads(1);
  forEachBadInput([&](const BadCloud& bad, const IndexCase& index) {
    const std::size_t size = bad.cloud->size();
    for (const NormalsCase& c : kNormals) {
      SCOPED_TRACE(c.name);
      auto normals = pcl::make_shared<Normals>(size, 1, pcl::Normal(0.F, 0.F, 1.F));
      c.change(*normals);
      const bool accepted = size > 0 && normals->size() == size;
      std::vector<std::int32_t> labels(size);
      for (std::size_t i = 0; i < size; ++i) {
        labels[i] = i % 9 == 8 ? (i % 2 == 0 ? -7 : 1 << 30) : static_cast<int>(i % 2);
      }
      recomputation.setInputCloud(bad.cloud);
      recomputation.setIndices(index.indices);
      recomputation.setInputNormals(normals);
      recomputation.setLabels(labels, {1, 1});
      const bool good = c.name == kNormals[0].name;
      for (const int k : good ? std::vector<int>{-4, 1, 20} : std::vector<int>{20}) {
        recomputation.setKSearch(k);
        Normals out(3, 1);
        recomputation.compute(out);
        const std::size_t rows = index.indices ? index.indices->size() : size;
        EXPECT_EQ(out.size(), accepted ? rows : 0U) << "k " << k;
      }
    }
  });
}

TEST_P(BadRecomputation, MissingAndMismatchedInput) {
  NormalRecomputation<pcl::PointXYZ, pcl::Normal> recomputation;
  recomputation.setRule(GetParam());
  const auto expectEmpty = [&](const char* what) {
    Normals out(3, 1);
    recomputation.compute(out);
    EXPECT_TRUE(out.empty()) << what;
  };
  expectEmpty("nothing set");
  recomputation.setInputCloud(curvedPatch(50).makeShared());
  expectEmpty("no normals");
  recomputation.setInputNormals(pcl::make_shared<Normals>(50, 1, pcl::Normal(0.F, 0.F, 1.F)));
  expectEmpty("no labels");
  recomputation.setLabels({0, 0, 0}, {1});
  expectEmpty("too few labels");
  recomputation.setLabels(std::vector<std::int32_t>(50, 0), {});
  recomputation.setNeighborhoods(pcl::make_shared<Neighborhoods>());
  expectEmpty("a table of another cloud");
  recomputation.setNeighborhoods({});
  recomputation.setInputCloud(nullptr);
  expectEmpty("no cloud");
  recomputation.setInputCloud(curvedPatch(50).makeShared());
  recomputation.setKSearch(std::numeric_limits<int>::max());
  Normals out;
  recomputation.compute(out);
  EXPECT_EQ(out.size(), 50U);
}

}  // namespace
}  // namespace segorient::test
