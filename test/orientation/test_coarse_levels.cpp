// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
//
// Coarser scales: scans that do not quite fit, and what looks like them.
#include <gtest/gtest.h>
#include <segorient/orientation/pipeline.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "orientation/automatic/blue_noise.h"
#include "orientation/automatic/layer_test.h"
#include "orientation/automatic/sign_energy.h"
#include "sheet_fixture.h"

namespace segorient::test {
namespace {

using Vector = std::array<double, 3>;

using Cloud = TrueNormals;

Vector onSphere(std::mt19937& rng) {
  std::normal_distribution<double> normal;
  const Vector v{normal(rng), normal(rng), normal(rng)};
  const double length = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
  return {v[0] / length, v[1] / length, v[2] / length};
}

constexpr double kArea = 4 * M_PI;  // of the unit sphere

// Two scans of a sphere, one of them moved by a multiple of their spacing.
Cloud twoScans(std::size_t n, double apart, unsigned seed) {
  std::mt19937 rng(seed);
  const Vector t = onSphere(rng);
  const double by = apart * std::sqrt(kArea / (static_cast<double>(n) / 2));
  Cloud out;
  for (std::size_t i = 0; i < n; ++i) {
    const Vector d = onSphere(rng);
    const double move = i % 2 == 0 ? 0.0 : by;
    out.add({d[0] + move * t[0], d[1] + move * t[1], d[2] + move * t[2]}, d);
  }
  return out;
}

// A hollow sphere whose wall is a multiple of the spacing thick; noise in spacings.
Cloud hollowSphere(std::size_t n, double wall, double noise, unsigned seed) {
  std::mt19937 rng(seed);
  std::normal_distribution<double> normal;
  const double spacing = std::sqrt(2 * kArea / static_cast<double>(n));
  Cloud out;
  for (std::size_t i = 0; i < n; ++i) {
    const Vector d = onSphere(rng);
    const bool inner = i % 2 == 0;
    const double r = inner ? 1 - wall * spacing : 1.0;
    Vector p{};
    for (std::size_t a = 0; a < 3; ++a) p[a] = r * d[a] + noise * spacing * normal(rng);
    out.add(p, inner ? Vector{-d[0], -d[1], -d[2]} : d);
  }
  return out;
}

OrientedCloud orient(const std::vector<float>& xyz, bool coarse_levels = true, int threads = 1,
                     const OrientationHints& hints = {}) {
  PipelineOptions options;
  options.threads = threads;
  options.orientation.hints = std::make_shared<OrientationHints>(hints);
  options.orientation.automatic.coarse_levels = coarse_levels;
  return orientCloud(viewOf(xyz), nullptr, options);
}

double right(const Cloud& cloud, bool coarse_levels = true, const OrientationHints& hints = {}) {
  return shareOutward(orient(cloud.xyz, coarse_levels, 1, hints).normals, cloud.normals);
}

// Two scans of a flat plate, one of them moved by so many of their spacings, most of that across
// its faces; or, hollow, both faces of a wall so thick.
Cloud plateOfTwo(std::size_t n, double apart, bool hollow, unsigned seed) {
  const Vector half{1.0, 0.7, 0.15};
  const Vector areas{half[1] * half[2], half[0] * half[2], half[0] * half[1]};
  const double area = 8 * (areas[0] + areas[1] + areas[2]);
  const double by = apart * std::sqrt(area / (static_cast<double>(n) / 2));
  std::mt19937 rng(seed);
  std::uniform_real_distribution<double> unit(-1, 1);
  std::discrete_distribution<std::size_t> axis({areas[0], areas[1], areas[2]});
  Cloud out;
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t a = axis(rng);
    const bool second = i % 2 == 1;
    Vector normal{0, 0, 0};
    normal[a] = unit(rng) < 0 ? -1 : 1;
    Vector p{};
    for (std::size_t b = 0; b < 3; ++b) {
      const double size = half[b] - (second && hollow ? by : 0.0);
      p[b] = size * (b == a ? normal[b] : unit(rng));
    }
    if (second && hollow) normal[a] = -normal[a];
    if (second && !hollow) p = {p[0] + 0.35 * by, p[1] + 0.25 * by, p[2] + 0.9 * by};
    out.add(p, normal);
  }
  return out;
}

class Layers : public testing::TestWithParam<double> {};

TEST_P(Layers, AreOneSurface) {
  const Cloud cloud = twoScans(6000, GetParam(), 1);
  EXPECT_GE(right(cloud), 0.995);
}

INSTANTIATE_TEST_SUITE_P(CoarseLevels, Layers, testing::Values(0.25, 0.5, 0.75, 1.0));

TEST(CoarseLevels, TellAPlateFromABoxOfThinWalls) {
  for (const unsigned seed : {31U, 32U, 33U}) {
    EXPECT_GE(right(plateOfTwo(16000, 1.0, false, seed)), 0.995) << seed;
    EXPECT_GE(right(plateOfTwo(16000, 0.8, true, seed)), 0.995) << seed;
  }
}

TEST(CoarseLevels, AreWhatMakesThemOne) {
  const Cloud cloud = twoScans(6000, 1.0, 1);
  EXPECT_LT(right(cloud, false), 0.95);
  const OrientedCloud oriented = orient(cloud.xyz);
  EXPECT_NE(oriented.report.normals_chosen.find("even subset"), std::string::npos);
  const auto& components = oriented.report.components;
  const std::size_t points = std::accumulate(
      components.begin(), components.end(), std::size_t{0},
      [](std::size_t sum, const ComponentOrientationResult& c) { return sum + c.points; });
  EXPECT_EQ(points, cloud.size());
}

// The own scale first; the one that is taken has the least of all, and a tenth less than that.
TEST(CoarseLevels, ReportTheEnergyOfEachScale) {
  const std::vector<ScaleEnergy> scales = orient(twoScans(6000, 1.0, 1).xyz).report.scales;
  ASSERT_GE(scales.size(), 2U);
  EXPECT_EQ(scales[0].radius, 0.F);
  EXPECT_FALSE(scales[0].taken);
  const auto taken =
      std::find_if(scales.begin(), scales.end(), [](const ScaleEnergy& s) { return s.taken; });
  ASSERT_NE(taken, scales.end());
  for (const ScaleEnergy& s : scales) {
    EXPECT_FLOAT_EQ(s.total, s.outside + 3.F * s.facing);
    EXPECT_GE(s.total, taken->total);
  }
  EXPECT_LT(taken->total, 0.9F * scales[0].total);
  EXPECT_EQ(
      std::count_if(scales.begin(), scales.end(), [](const ScaleEnergy& s) { return s.taken; }), 1);
  EXPECT_TRUE(orient(twoScans(6000, 0.0, 1).xyz).report.scales.empty());
}

// Terms of E by component and scale: two scans of a sphere contradict their borders and the winding
// number at their own scale, and hardly at the one that is taken.
TEST(CoarseLevels, ReportTheTermsOfEachComponent) {
  const Cloud cloud = twoScans(6000, 1.0, 1);
  OrientationHints hints;
  for (std::size_t i = 0; i < cloud.normals.size(); ++i) {
    if (i % 4 != 3) hints.normals.push_back(cloud.normals[i]);
  }
  const PipelineReport report = orient(cloud.xyz, true, 1, hints).report;
  ASSERT_GE(report.scales.size(), 2U);
  for (const ScaleEnergy& s : report.scales) {
    ASSERT_FALSE(s.components.empty());
    std::size_t points = 0;
    for (const ComponentEnergy& c : s.components) points += c.points;
    EXPECT_LE(points, cloud.size());
    EXPECT_GE(points, cloud.size() * 99 / 100);
    if (!s.taken) continue;
    const ComponentEnergy& own = report.scales[0].components[0];
    EXPECT_LT(s.components[0].winding, 0.03F);
    EXPECT_LT(s.components[0].winding, own.winding);
    EXPECT_LT(s.components[0].borders, own.borders);
    EXPECT_LT(s.components[0].known, 0.01F);
    EXPECT_EQ(s.components[0].winding, report.components[0].residual);
    EXPECT_EQ(s.components[0].borders, report.components[0].contradiction);
  }
}

// Half of what is known contradicts the other half: so it does the result.
TEST(CoarseLevels, SayHowMuchOfWhatIsKnownIsContradicted) {
  const Cloud cloud = twoScans(3000, 0.0, 1);
  OrientationHints hints;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const float sign = i % 4 == 0 ? -1.F : 1.F;
    for (std::size_t a = 0; a < 3; ++a) hints.normals.push_back(sign * cloud.normals[4 * i + a]);
  }
  const PipelineReport report = orient(cloud.xyz, true, 1, hints).report;
  EXPECT_NEAR(report.components[0].against_known, 0.25F, 0.02F);
  EXPECT_LT(report.components[0].contradiction, 0.01F);
  EXPECT_LT(report.components[0].residual, 0.03F);
}

// What is known of single points holds at every scale.
TEST(CoarseLevels, FollowAViewpoint) {
  const Cloud cloud = twoScans(6000, 1.0, 1);
  for (const std::array<float, 3>& place :
       {std::array<float, 3>{4.F, 1.F, 2.F}, std::array<float, 3>{0.F, 0.F, 30.F}}) {
    OrientationHints hints;
    hints.has_viewpoint = true;
    hints.viewpoint = place;
    EXPECT_LT(right(cloud, false, hints), 0.95);
    EXPECT_GE(right(cloud, true, hints), 0.99);
  }
}

TEST(CoarseLevels, FollowSeedsAndNormalsThatAreKnown) {
  const Cloud cloud = twoScans(6000, 1.0, 1);
  OrientationHints seeds;
  OrientationHints known;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const float* p = &cloud.xyz[4 * i];
    const float* n = &cloud.normals[4 * i];
    for (std::size_t a = 0; a < 3; ++a) known.normals.push_back(n[a]);
    if (i % 1000 == 0) seeds.seeds.push_back({{p[0], p[1], p[2]}, {n[0], n[1], n[2]}});
  }
  for (const OrientationHints& hints : {seeds, known}) {
    EXPECT_LT(right(cloud, false, hints), 0.95);
    EXPECT_GE(right(cloud, true, hints), 0.99);
  }
}

// Points seen from within face inward, whatever a scale says of them.
TEST(CoarseLevels, LeaveSensorsTheLastWord) {
  const Cloud cloud = twoScans(6000, 1.0, 1);
  OrientationHints hints;
  hints.viewpoints.assign(3 * cloud.size(), 0.F);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    for (std::size_t a = 0; a < 3; ++a) {
      hints.viewpoints[3 * i + a] = cloud.xyz[4 * i + a] - cloud.normals[4 * i + a];
    }
  }
  EXPECT_LE(right(cloud, true, hints), 0.002);
}

// A closed wall has the same points as two layers, but for its even thickness.
TEST(CoarseLevels, LeaveTheTwoSidesOfAWallApart) {
  const Cloud clean = hollowSphere(6000, 1.0, 0.0, 3);
  EXPECT_GE(right(clean), 0.99);
  const Cloud thin = hollowSphere(6000, 0.5, 0.0, 3);
  EXPECT_GE(right(thin), right(thin, false));
  const Cloud noisy = hollowSphere(6000, 0.8, 0.15, 3);
  EXPECT_GE(right(noisy), right(noisy, false));
}

// Both sides of the gap face each other, which a level takes for one sheet.
TEST(CoarseLevels, LeaveTwoBlocksApart) {
  const double spacing = 0.03;
  std::mt19937 rng(41);
  std::uniform_real_distribution<double> unit(-0.5, 0.5);
  Cloud cloud;
  for (const double middle : {5.0, 6.0 + 0.8 * spacing}) {
    for (int i = 0; i < static_cast<int>(6.0 / (spacing * spacing)); ++i) {
      const std::size_t axis = rng() % 3;
      const double side = rng() % 2 == 0 ? 1.0 : -1.0;
      Vector p{unit(rng), unit(rng), unit(rng)};
      Vector n{};
      p[axis] = 0.5 * side;
      n[axis] = side;
      p[0] += middle;
      cloud.add(p, n);
    }
  }
  EXPECT_GT(right(cloud), 0.998);
}

TEST(CoarseLevels, DependOnNeitherThreadsNorOrder) {
  const Cloud cloud = twoScans(4000, 0.75, 5);
  const OrientedCloud one = orient(cloud.xyz, true, 1);
  const OrientedCloud three = orient(cloud.xyz, true, 3);
  ASSERT_NE(one.report.normals_chosen.find("even subset"), std::string::npos);
  EXPECT_EQ(one.normals, three.normals);
  EXPECT_EQ(one.confidences, three.confidences);
  std::vector<std::size_t> order(cloud.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::shuffle(order.begin(), order.end(), std::mt19937(7));
  std::vector<float> shuffled(cloud.xyz.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    std::copy_n(&cloud.xyz[4 * order[i]], 4, &shuffled[4 * i]);
  }
  const OrientedCloud other = orient(shuffled);
  for (std::size_t i = 0; i < order.size(); ++i) {
    for (std::size_t a = 0; a < 4; ++a) {
      ASSERT_EQ(other.normals[4 * i + a], one.normals[4 * order[i] + a]) << i;
    }
  }
}

TEST(SignEnergy, IsLeastAtTheTruth) {
  for (const Cloud& cloud : {twoScans(6000, 0.5, 8), hollowSphere(6000, 1.0, 0.1, 8)}) {
    const Neighborhoods table = neighborsOf(cloud.xyz);
    const detail::SignJudge judge(viewOf(cloud.xyz), table, 1);
    const float truth = judge.judge(cloud.normals).total();
    EXPECT_LT(truth, 0.06F);
    std::vector<float> inside_out = cloud.normals;
    std::vector<float> half = cloud.normals;
    std::vector<float> one_sided = cloud.normals;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      for (std::size_t a = 0; a < 3; ++a) {
        inside_out[4 * i + a] *= -1.F;
        if (cloud.xyz[4 * i] > 0.3F) half[4 * i + a] *= -1.F;
        if (i % 2 == 0) one_sided[4 * i + a] *= -1.F;
      }
    }
    EXPECT_GT(judge.judge(inside_out).total(), truth + 0.02F);
    EXPECT_GT(judge.judge(half).total(), truth + 0.02F);
    // Of a closed wall, turning one side makes one surface of both: that is what LayerTest is for.
    EXPECT_GT(judge.judge(one_sided).total(), truth - 0.03F);
  }
}

TEST(SignEnergy, TellsBacksFromFaces) {
  const Cloud wall = hollowSphere(4000, 0.7, 0.0, 9);
  const Neighborhoods table = neighborsOf(wall.xyz);
  const detail::OpposedPairs as_is = detail::opposedPairs(viewOf(wall.xyz), table, wall.normals, 1);
  EXPECT_LT(as_is.facing, 0.001F);
  EXPECT_GT(as_is.backs, 0.2F);
  std::vector<float> turned = wall.normals;
  for (float& v : turned) v = -v;
  const detail::OpposedPairs other = detail::opposedPairs(viewOf(wall.xyz), table, turned, 1);
  EXPECT_NEAR(other.facing, as_is.backs, 1e-5);
  EXPECT_NEAR(other.backs, as_is.facing, 1e-5);
}

TEST(LayerTest, TellsLayersFromWalls) {
  // What a coarse scale sees of both: the normals of one sphere.
  const auto scatter = [](const Cloud& cloud) {
    std::vector<float> around(cloud.xyz.size());
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      const float* p = &cloud.xyz[4 * i];
      const float length = std::sqrt(dot3(p, p));
      for (std::size_t a = 0; a < 3; ++a) around[4 * i + a] = p[a] / length;
      around[4 * i + 3] = 1.F;
    }
    return detail::thicknessScatter(viewOf(cloud.xyz), neighborsOf(cloud.xyz), around, 1);
  };
  for (const unsigned seed : {11U, 12U, 13U}) {
    EXPECT_GT(scatter(twoScans(6000, 0.5, seed)), 0.35F);
    EXPECT_GT(scatter(twoScans(6000, 1.0, seed)), 0.35F);
    EXPECT_LT(scatter(hollowSphere(6000, 0.6, 0.0, seed)), 0.2F);
    EXPECT_LT(scatter(hollowSphere(6000, 0.6, 0.2, seed)), 0.2F);
    EXPECT_LT(scatter(hollowSphere(6000, 1.2, 0.3, seed)), 0.2F);
  }
}

// Nearly all of a plate is two faces, which any motion leaves as far apart as a wall's.
TEST(LayerTest, AsksTheRimsOfAPlateToo) {
  const auto scatter = [](bool hollow, unsigned seed) {
    const Cloud cloud = plateOfTwo(12000, 0.8, hollow, seed);
    std::vector<float> around;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      // Near edges, coarse normals are spread.
      int near = 0;
      for (std::size_t a = 0; a < 3; ++a) {
        constexpr std::array<float, 3> kHalf{1.F, 0.7F, 0.15F};
        near += std::fabs(cloud.xyz[4 * i + a]) > kHalf[a] - 0.06F ? 1 : 0;
        around.push_back(std::fabs(cloud.normals[4 * i + a]));
      }
      around.push_back(near == 1 ? 1.F : 0.F);
    }
    return detail::thicknessScatter(viewOf(cloud.xyz), neighborsOf(cloud.xyz), around, 1);
  };
  for (const unsigned seed : {21U, 22U, 23U}) {
    EXPECT_GT(scatter(false, seed), 0.3F);
    EXPECT_LT(scatter(true, seed), 0.2F);
  }
}

TEST(BlueNoise, IsFarApartAndLeavesNoGap) {
  const Cloud cloud = twoScans(3000, 0.5, 15);
  const PointView points = viewOf(cloud.xyz);
  const float radius = 0.12F;
  const detail::BlueNoise even = detail::thinOut(points, radius, 2);
  const auto squares = [&](std::size_t i, std::size_t j) {
    float sum = 0.F;
    for (std::size_t a = 0; a < 3; ++a) {
      sum += (points[i][a] - points[j][a]) * (points[i][a] - points[j][a]);
    }
    return sum;
  };
  for (std::size_t i = 0; i < even.kept.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      ASSERT_GE(squares(even.kept[i], even.kept[j]), radius * radius);
    }
  }
  for (std::size_t i = 0; i < points.size; ++i) {
    float nearest = 1e9F;
    for (const std::uint32_t k : even.kept) nearest = std::min(nearest, squares(i, k));
    ASSERT_LT(nearest, radius * radius);
    ASSERT_EQ(squares(i, even.kept[even.cell_of[i]]), nearest);
  }
}

TEST(BlueNoise, RefusesRadiiThatFloatsCannotTell) {
  const Cloud cloud = twoScans(100, 0.5, 16);
  for (const float radius : {0.F, -1.F, 1e-20F, std::nanf("")}) {
    EXPECT_TRUE(detail::thinOut(viewOf(cloud.xyz), radius, 1).kept.empty());
  }
  EXPECT_TRUE(detail::thinOut({nullptr, 4, 0}, 1.F, 1).kept.empty());
}

}  // namespace
}  // namespace segorient::test
