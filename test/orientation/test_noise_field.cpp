// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
//
// Fields of oriented points at many places, solutions that agree with them, and what they are for:
// noise that is as large as parts are thick.
#include <gtest/gtest.h>
#include <segorient/orientation/pipeline.h>
#include <segorient/search/median_hash_index.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <random>
#include <vector>

#include "common/compact_cloud.h"
#include "common/dot.h"
#include "common/median.h"
#include "features/sheet_fit.h"
#include "orientation/automatic/noise_field.h"
#include "orientation/winding/dipole_fields.h"
#include "orientation/winding/field_solver.h"
#include "sheet_fixture.h"

namespace segorient::test {
namespace {

using Vector = Eigen::Vector3d;

Vector at(const PointView& points, std::size_t i) {
  return Eigen::Map<const Eigen::Vector3f>(points[i]).cast<double>();
}

// A bracket with area 1 a point, in an order that keeps near points together.
struct Bracket {
  CompactCloud cloud;
  std::vector<float> dipoles;
  float radius = 0.F;

  explicit Bracket(std::size_t n) {
    const LabelledCloud labelled = sample("bracket", bracket(), n, 5);
    cloud = compactCloud(viewOf(labelled.xyz));
    dipoles.assign(4 * cloud.size(), 1.F);
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      std::copy_n(&labelled.normals[4 * static_cast<std::size_t>(cloud.source[i])], 3,
                  &dipoles[4 * i]);
    }
    radius = 2.F * static_cast<float>(labelled.spacing / static_cast<double>(cloud.unit));
  }
};

TEST(DipoleFields, AreTheSumsOverAllPoints) {
  const Bracket b(3000);
  const PointView points = b.cloud.view();
  const DipoleCloud from{points, b.dipoles};
  const std::vector<float> numbers = windingNumbers(points, from, b.radius, 1);
  const std::vector<float> descents = steepestDescents(points, from, b.radius, 1);
  const std::vector<float> pulls = windingPulls(points, from, b.radius, 1);
  const double r2 = std::pow(static_cast<double>(b.radius), 2);
  for (std::size_t i = 0; i < points.size; i += 50) {
    double number = 0.0;
    double most = 0.0;  // of any that are in line
    Vector descent = Vector::Zero();
    Vector pull = Vector::Zero();
    for (std::size_t j = 0; j < points.size; ++j) {
      const Vector d = at(points, j) - at(points, i);
      const Vector m = Eigen::Map<const Eigen::Vector3f>(&b.dipoles[4 * j]).cast<double>();
      const double s = d.squaredNorm() + r2;
      const double weight = 1.0 / (4 * M_PI * std::pow(s, 1.5));
      number += weight * m.dot(d);
      most += weight * d.norm();
      descent += weight * (m - 3 * m.dot(d) / s * d);
      pull -= weight * m.x() * d;
    }
    EXPECT_NEAR(static_cast<double>(numbers[i]), number, 0.05 * most) << i;
    const Vector descends = Eigen::Map<const Eigen::Vector3f>(&descents[4 * i]).cast<double>();
    EXPECT_LT((descends - descent).norm(), 0.05 * descent.norm()) << i;
    const Vector pulled = Eigen::Map<const Eigen::Vector3f>(&pulls[4 * i]).cast<double>();
    EXPECT_LT((pulled - pull).norm(), 0.05 * most) << i;
  }
}

TEST(DipoleFields, DoNotDependOnThreadsAndKeepToTheirRows) {
  const Bracket b(3000);
  const PointView points = b.cloud.view();
  EXPECT_EQ(windingNumbers(points, {points, b.dipoles}, b.radius, 1),
            windingNumbers(points, {points, b.dipoles}, b.radius, 4));
  std::vector<float> few(b.dipoles.size(), 0.F);
  std::vector<std::uint32_t> rows;
  for (std::uint32_t i = 100; i < 200; ++i) {
    rows.push_back(i);
    std::copy_n(&b.dipoles[4 * std::size_t{i}], 4, &few[4 * std::size_t{i}]);
  }
  const std::vector<float> of_rows =
      windingNumbers(points, {points, b.dipoles, &rows}, b.radius, 1);
  const std::vector<float> of_few = windingNumbers(points, {points, few}, b.radius, 1);
  const float most = *std::max_element(of_few.begin(), of_few.end());
  for (std::size_t i = 0; i < points.size; ++i) EXPECT_NEAR(of_rows[i], of_few[i], 0.05F * most);
}

// A sphere, a hollow one whose inner wall faces the cavity, or a piece of a plane.
struct Samples {
  std::vector<float> places;
  std::vector<float> normals;
  std::vector<float> areas;
  Neighborhoods table;

  void add(const Vector& p, const Vector& n) {
    for (std::size_t a = 0; a < 4; ++a) {
      places.push_back(a < 3 ? static_cast<float>(p[static_cast<Eigen::Index>(a)]) : 0.F);
      normals.push_back(a < 3 ? static_cast<float>(n[static_cast<Eigen::Index>(a)]) : 0.F);
    }
  }
  PointView view() const { return {places.data(), 4, places.size() / 4}; }
  // Near points side by side, and neighbours.
  void finish(float area) {
    const CompactCloud sorted = compactCloud(view());
    std::vector<float> in_order;
    std::vector<float> normals_in_order;
    for (const auto source : sorted.source) {
      const auto i = static_cast<std::ptrdiff_t>(4 * source);
      in_order.insert(in_order.end(), places.begin() + i, places.begin() + i + 4);
      normals_in_order.insert(normals_in_order.end(), normals.begin() + i, normals.begin() + i + 4);
    }
    places = in_order;
    normals = normals_in_order;
    areas.assign(places.size() / 4, area);
    search::MedianHashIndex index;
    index.build(view(), nullptr, {});
    index.nearestKAll(9, table, false);
  }
};

Samples sphere(std::size_t n, unsigned seed) {
  std::mt19937 rng(seed);
  std::normal_distribution<double> normal;
  Samples out;
  for (std::size_t i = 0; i < n; ++i) {
    const Vector d = Vector(normal(rng), normal(rng), normal(rng)).normalized();
    out.add(d, d);
  }
  out.finish(static_cast<float>(4 * M_PI / static_cast<double>(n)));
  return out;
}

constexpr float kWide = 0.2F;  // some three spacings

TEST(FieldSolver, FindsTheOutsideFromNothing) {
  const Samples s = sphere(2000, 1);
  const FieldSolver solver(s.view(), s.table, s.areas, kWide, 1);
  const std::vector<float> found = solver.solve(std::vector<float>(4 * s.areas.size(), 0.F),
                                                std::vector<float>(s.areas.size(), 0.1F));
  for (std::size_t i = 0; i < s.areas.size(); ++i) {
    EXPECT_GT(at(s.view(), i).dot(Eigen::Map<const Eigen::Vector3f>(&found[4 * i]).cast<double>()),
              0.9);
  }
}

TEST(FieldSolver, PatchThatContradictsTheRestGivesWay) {
  const Samples s = sphere(2000, 4);
  std::vector<float> normals = s.normals;
  for (std::size_t i = 0; i < s.areas.size(); ++i) {
    if (s.places[4 * i] < 0.9F) continue;  // a cap: a twentieth
    for (std::size_t a = 0; a < 3; ++a) normals[4 * i + a] = -normals[4 * i + a];
  }
  const FieldSolver solver(s.view(), s.table, s.areas, kWide, 1);
  const auto wrong = [&]() {
    int count = 0;
    for (std::size_t i = 0; i < s.areas.size(); ++i) {
      count += dot(&normals[4 * i], &s.normals[4 * i]) > 0.F ? 0 : 1;
    }
    return count;
  };
  for (int before = wrong(), round = 0; before > 0; before = wrong()) {
    ASSERT_LT(++round, 5);
    const std::vector<float> weights(s.areas.size(), 2 * solver.fit(normals).spread);
    normals = solver.solve(normals, weights);
    ASSERT_LT(wrong(), before);
  }
}

// How many normals of a sphere point inward after a solution, of those of a cap that do before.
int wrongOfCap(const Samples& s, float weight_of_cap) {
  std::vector<float> normals = s.normals;
  std::vector<float> weights(s.areas.size(), 1.F);
  for (std::size_t i = 0; i < s.areas.size(); ++i) {
    if (s.places[4 * i] < 0.93F) continue;
    for (std::size_t a = 0; a < 3; ++a) normals[4 * i + a] = -normals[4 * i + a];
    weights[i] = weight_of_cap;
  }
  normals = FieldSolver(s.view(), s.table, s.areas, kWide, 1).solve(normals, weights);
  int count = 0;
  for (std::size_t i = 0; i < s.areas.size(); ++i) {
    count += dot(&normals[4 * i], &s.normals[4 * i]) > 0.F ? 0 : 1;
  }
  return count;
}

TEST(FieldSolver, EvidenceOfLittleWeightGivesWay) {
  int strong = 0;
  int weak = 0;
  for (unsigned seed = 1; seed <= 6; ++seed) {
    const Samples s = sphere(2000, seed);
    strong += wrongOfCap(s, 1.F);
    weak += wrongOfCap(s, 0.01F);
  }
  EXPECT_LT(4 * weak, 3 * strong);
}

TEST(FieldSolver, FitIsBestForTheTruthWhateverTheAreas) {
  Samples s = sphere(2000, 2);
  std::vector<float> turned = s.normals;  // one half the wrong way
  for (std::size_t i = 0; i < s.areas.size(); ++i) {
    if (s.places[4 * i] < 0.F) continue;
    for (std::size_t a = 0; a < 3; ++a) turned[4 * i + a] = -turned[4 * i + a];
  }
  for (const float factor : {1.F, 3.F}) {
    for (float& a : s.areas) a *= factor;
    const FieldSolver solver(s.view(), s.table, s.areas, kWide, 1);
    EXPECT_LT(solver.fit(s.normals).spread, 0.005F);
    EXPECT_GT(solver.fit(turned).spread, 0.02F);
    EXPECT_NEAR(factor * solver.fit(s.normals).factor, 1.2F, 0.1F);  // smoothing lessens w
    std::vector<float> inward = s.normals;
    for (float& v : inward) v = -v;
    EXPECT_LT(solver.fit(inward).factor, 0.F);
  }
}

TEST(FieldSolver, PlaneSaysNothing) {
  std::mt19937 rng(3);
  std::uniform_real_distribution<double> side(-1.0, 1.0);
  Samples s;
  for (int i = 0; i < 2000; ++i) s.add({side(rng), side(rng), 0.0}, Vector::UnitZ());
  s.finish(0.002F);
  const FieldSolver solver(s.view(), s.table, s.areas, kWide, 1);
  EXPECT_GT(solver.fit(s.normals).spread, 0.24F);
}

// A body with a thin wing, as an aircraft has it; noise in spacings.
struct Noisy {
  std::vector<float> xyz;
  std::vector<float> normals;
};

Vector draw(std::mt19937& rng, std::normal_distribution<double>& normal) {
  return {normal(rng), normal(rng), normal(rng)};
}

void add(const Vector& p, const Vector& n, Noisy& out) {
  for (const double v : {p[0], p[1], p[2], 0.0}) out.xyz.push_back(static_cast<float>(v));
  for (const double v : {n[0], n[1], n[2], 0.0}) out.normals.push_back(static_cast<float>(v));
}

Noisy winged(std::size_t n, double noise, unsigned seed) {
  std::mt19937 rng(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const Vector axes[2] = {{1.0, 0.25, 0.25}, {0.3, 1.4, 0.05}};
  const double area = 1.9 + 2 * M_PI * axes[1][0] * axes[1][1];
  const double spacing = std::sqrt(area / static_cast<double>(n));
  Noisy out;
  while (out.xyz.size() < 4 * n) {
    const bool wing = unit(rng) < 0.58;
    const Vector& a = axes[wing ? 1 : 0];
    const Vector& b = axes[wing ? 0 : 1];
    const Vector d = draw(rng, normal).normalized();
    const Vector p = d.cwiseProduct(a);
    Vector m = d.cwiseQuotient(a);
    if (unit(rng) > m.norm() * a.minCoeff()) continue;  // even over the surface
    if (p.cwiseQuotient(b).squaredNorm() < 1.0) continue;
    add(p + noise * spacing * draw(rng, normal), m.normalized(), out);
  }
  return out;
}

double right(const Noisy& cloud, bool winding_normals, int threads = 1) {
  PipelineOptions options;
  options.threads = threads;
  options.orientation.automatic.winding_normals = winding_normals;
  return shareOutward(orientCloud(viewOf(cloud.xyz), nullptr, options).normals, cloud.normals);
}

TEST(NoiseField, ThinPartsAreToldApart) {
  double with = 0.0;
  double without = 0.0;
  for (unsigned seed = 1; seed <= 2; ++seed) {
    const Noisy cloud = winged(8000, 0.6, seed);
    with += 0.5 * right(cloud, true);
    without += 0.5 * right(cloud, false);
  }
  // It gains .007; coarser scales find the most of what is left.
  EXPECT_GT(with, without + 0.004) << without;
}

// Share of normals on the side that is told, by few points or by all of them.
// \param side 1 = outward, -1 = inward
double rightByHints(const Noisy& cloud, bool few, float side) {
  OrientationHints hints;
  hints.normals.assign(3 * cloud.normals.size() / 4, 0.F);
  for (std::size_t i = 0; i < cloud.normals.size() / 4; ++i) {
    const float* n = &cloud.normals[4 * i];
    const float* p = &cloud.xyz[4 * i];
    for (std::size_t a = 0; a < 3; ++a) hints.normals[3 * i + a] = side * n[a];
    if (i % 500 != 0) continue;
    hints.seeds.push_back({{p[0], p[1], p[2]}, {side * n[0], side * n[1], side * n[2]}});
  }
  few ? hints.normals.clear() : hints.seeds.clear();
  PipelineOptions options;
  options.orientation.hints = std::make_shared<OrientationHints>(hints);
  const double outward =
      shareOutward(orientCloud(viewOf(cloud.xyz), nullptr, options).normals, cloud.normals);
  return side > 0.F ? outward : 1.0 - outward;
}

// The field knows more of single points than what is said of parts, whichever side that wants.
TEST(NoiseField, IsAskedWhereSeedsOrNormalsAreKnownToo) {
  const Noisy cloud = winged(8000, 0.6, 1);
  const double best = right(cloud, true);
  ASSERT_GT(best, right(cloud, false) + 0.004);
  for (const bool few : {true, false}) {
    for (const float side : {1.F, -1.F}) {
      EXPECT_GT(rightByHints(cloud, few, side), best - 0.001) << few << side;
    }
  }
}

TEST(NoiseField, CleanCloudsAreNotTouched) {
  const Noisy cloud = winged(6000, 0.0, 4);
  PipelineOptions options;
  const OrientedCloud with = orientCloud(viewOf(cloud.xyz), nullptr, options);
  options.orientation.automatic.winding_normals = false;
  const OrientedCloud without = orientCloud(viewOf(cloud.xyz), nullptr, options);
  EXPECT_EQ(with.normals, without.normals);
}

TEST(NoiseField, DoesNotDependOnThreads) {
  const Noisy cloud = winged(6000, 1.0, 5);
  PipelineOptions options;
  options.threads = 1;
  const OrientedCloud one = orientCloud(viewOf(cloud.xyz), nullptr, options);
  options.threads = 4;
  EXPECT_EQ(one.normals, orientCloud(viewOf(cloud.xyz), nullptr, options).normals);
}

// A ball, and the field of its own normals.
struct BallField {
  Noisy ball;
  detail::NoiseField field;

  BallField() {
    std::mt19937 rng(8);
    std::normal_distribution<double> normal;
    for (int i = 0; i < 4000; ++i) {
      const Vector d = draw(rng, normal).normalized();
      add(d, d, ball);
    }
    field.places = ball.xyz;
    field.dipoles = ball.normals;
    for (float& v : field.dipoles) v *= static_cast<float>(4 * M_PI / 4000);
    for (std::size_t i = 3; i < field.dipoles.size(); i += 4) {
      field.dipoles[i] = static_cast<float>(4 * M_PI / 4000);
    }
    field.radius = 0.1F;
    field.factor = 1.F;
  }
  PointView point(std::size_t i) const { return {&ball.xyz[4 * i], 4, 1}; }
  std::vector<float> tilted(std::size_t i, double degrees) const {
    const Eigen::Map<const Eigen::Vector3f> n(&ball.normals[4 * i]);
    const auto angle = static_cast<float>(degrees * M_PI / 180);
    const Eigen::Vector3f t = std::cos(angle) * n + std::sin(angle) * n.unitOrthogonal();
    return {t[0], t[1], t[2], 0.F};
  }
  float cosine(std::size_t i, const std::vector<float>& n) const {
    return dot(n.data(), &ball.normals[4 * i]);
  }
};

// Where the field is coarser than the points it mends what is far off, and leaves the rest.
TEST(NoiseField, MendsOnlyNormalsThatAreFarOff) {
  BallField of;
  of.field.averaged_below = 0.7F;
  Neighborhoods alone;
  alone.reset(1, 1, false);
  const auto cosineAfter = [&](std::size_t i, double degrees) {
    detail::AutoNormals found;
    found.normals = of.tilted(i, degrees);
    found.confidences = {1.F};
    detail::takeNoiseField(of.point(i), alone, of.field, 1, found);
    return of.cosine(i, found.normals);
  };
  for (std::size_t i = 0; i < 50; ++i) {
    EXPECT_NEAR(cosineAfter(i, 20), std::cos(20 * M_PI / 180), 1e-5) << i;
    EXPECT_GT(cosineAfter(i, 70), std::cos(50 * M_PI / 180)) << i;
    EXPECT_GT(cosineAfter(i, 160), std::cos(21 * M_PI / 180)) << i;
  }
}

// Lines that are far off are the field's, and sides are nobody's to turn.
TEST(NoiseField, GivesLinesWhereSidesAreKnown) {
  const BallField of;
  const auto cosineAfter = [&](std::size_t i, double degrees) {
    std::vector<float> normals = of.tilted(i, degrees);
    detail::takeFieldLines(of.point(i), of.field, 1, normals);
    EXPECT_EQ(normals[3], 0.F);
    return of.cosine(i, normals);
  };
  for (std::size_t i = 0; i < 50; ++i) {
    EXPECT_NEAR(cosineAfter(i, 20), std::cos(20 * M_PI / 180), 1e-5) << i;
    EXPECT_GT(cosineAfter(i, 70), std::cos(10 * M_PI / 180)) << i;
    EXPECT_NEAR(cosineAfter(i, 160), std::cos(160 * M_PI / 180), 1e-5) << i;
  }
  std::vector<float> none{std::numeric_limits<float>::quiet_NaN(), 0.F, 0.F, 0.F};
  detail::takeFieldLines(of.point(0), of.field, 1, none);
  EXPECT_TRUE(std::isnan(none[0]));
  std::vector<float> kept = of.tilted(0, 70);
  detail::takeFieldLines(of.point(0), {}, 1, kept);
  EXPECT_EQ(kept, of.tilted(0, 70));
}

// A sheet whose field falls the other way in its middle. Where only that middle can be looked at,
// nothing there shows that to turn it would tear the sheet.
TEST(NoiseField, APartOfTheCloudTearsNoSheetThatTheWholeKeeps) {
  constexpr int kSide = 40;
  std::vector<float> xyz;
  detail::NoiseField field;
  detail::AutoNormals whole;
  std::vector<std::size_t> middle;
  for (int i = 0; i < kSide * kSide; ++i) {
    const auto x = static_cast<float>(i % kSide);
    const auto y = static_cast<float>(i / kSide);
    xyz.insert(xyz.end(), {x, y, 0.F, 0.F});
    const bool inner = std::hypot(x - 20.F, y - 20.F) < 10.F;
    field.dipoles.insert(field.dipoles.end(), {0.F, 0.F, inner ? -1.F : 1.F, 1.F});
    whole.normals.insert(whole.normals.end(), {0.F, 0.F, 1.F, 0.F});
    if (std::hypot(x - 20.F, y - 20.F) < 7.F) middle.push_back(static_cast<std::size_t>(i));
  }
  field.places = xyz;
  field.radius = 1.5F;
  field.factor = 1.F;
  field.consistent = true;
  whole.confidences.assign(field.places.size() / 4, 1.F);
  std::vector<float> part_xyz;
  detail::AutoNormals part;
  for (const std::size_t i : middle) {
    part_xyz.insert(part_xyz.end(), &xyz[4 * i], &xyz[4 * i] + 4);
    part.normals.insert(part.normals.end(), {0.F, 0.F, 1.F, 0.F});
    part.confidences.push_back(1.F);
  }
  const auto turned = [](const detail::AutoNormals& found) {
    std::size_t count = 0;
    for (std::size_t i = 2; i < found.normals.size(); i += 4) count += found.normals[i] < 0.F;
    return count;
  };
  detail::AutoNormals alone = part;
  detail::takeNoiseField(viewOf(part_xyz), neighborsOf(part_xyz, 8), field, 1, alone);
  EXPECT_EQ(turned(alone), middle.size());
  detail::findWhatSheetsKeep(viewOf(xyz), neighborsOf(xyz, 8), whole.normals, 1, field);
  detail::takeNoiseField(viewOf(part_xyz), neighborsOf(part_xyz, 8), field, 1, part);
  EXPECT_EQ(turned(part), 0U);
  detail::takeNoiseField(viewOf(xyz), neighborsOf(xyz, 8), field, 1, whole);
  EXPECT_EQ(turned(whole), 0U);
}

std::ptrdiff_t countSure(const Noisy& cloud) {
  const OrientedCloud found = orientCloud(viewOf(cloud.xyz), nullptr, PipelineOptions{});
  return std::count_if(found.confidences.begin(), found.confidences.end(),
                       [](float c) { return c > 0.9F; });
}

// A bowl whose wall is a spacing thick, in noise of a third: an open sheet with some more noise
// looks the same, and which of the two it is decides half of the signs.
TEST(NoiseField, SidesOfAThinWallInNoiseAreNotSure) {
  std::mt19937 rng(7);
  std::normal_distribution<double> normal;
  const double spacing = std::sqrt(4 * M_PI / 10000);
  Noisy cloud;
  for (int i = 0; i < 10000; ++i) {
    Vector d = draw(rng, normal).normalized();
    d.z() = -std::fabs(d.z());
    const double side = i % 2 == 0 ? 1.0 : -1.0;
    add(d + spacing * (0.5 * side * d + 0.3 * draw(rng, normal)), side * d, cloud);
  }
  EXPECT_EQ(countSure(cloud), 0);
}

// A hollow ball whose wall is so thin that both sides come out as one sheet: what is left of points
// on either side of its middle is flatter than noise. A ball with as much noise stays sure.
TEST(NoiseField, TwoSidesThatCameOutAsOneAreNotSure) {
  std::mt19937 rng(9);
  std::normal_distribution<double> normal;
  const double spacing = std::sqrt(4 * M_PI / 10000);
  Noisy hollow;
  Noisy ball;
  for (int i = 0; i < 10000; ++i) {
    const Vector d = draw(rng, normal).normalized();
    const double side = i % 2 == 0 ? 1.0 : -1.0;
    add(d + spacing * (0.3 * side * d + 0.18 * draw(rng, normal)), side * d, hollow);
    add(d + spacing * 0.35 * draw(rng, normal), d, ball);
  }
  EXPECT_EQ(countSure(hollow), 0);
  EXPECT_GT(countSure(ball), 9000);
}

TEST(NoiseField, SolidsInNoiseStaySure) {
  EXPECT_GT(countSure(winged(8000, 0.3, 8)), 4000);
}

TEST(NoiseField, OpenSheetStaysOneSheet) {
  std::mt19937 rng(6);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> side(-1.0, 1.0);
  Noisy cloud;
  constexpr std::size_t kPoints = 6000;
  const double spacing = std::sqrt(4.0 / static_cast<double>(kPoints));
  for (std::size_t i = 0; i < kPoints; ++i) {
    const double x = side(rng);
    const Vector p(x, side(rng), 0.2 * std::sin(3 * x));
    add(p + spacing * draw(rng, normal), Vector(-0.6 * std::cos(3 * x), 0, 1).normalized(), cloud);
  }
  EXPECT_GT(std::fabs(right(cloud, true) - 0.5), 0.49);
}

// A patch that faces the wrong way is less evidence where its signs are unsure, if signs contradict
// each other; if not, all are as good.
TEST(NoiseField, UnsureSignsAreLessEvidenceWhereTheyContradict) {
  const LabelledCloud cloud = sample("bracket", bracket(), 8000, 9, 0.3);
  const PointView points = viewOf(cloud.xyz);
  const Neighborhoods table = neighborsOf(cloud.xyz);
  std::vector<float> normals(cloud.normals.begin(), cloud.normals.end());
  std::vector<float> confidences(points.size, 1.F);
  std::vector<std::size_t> wrong;
  for (int j = 0; j < table.count(0); ++j) {
    const auto near = static_cast<std::size_t>(table.indices(0)[j]);
    for (int k = 0; k < table.count(near); ++k) {
      const auto i = static_cast<std::size_t>(table.indices(near)[k]);
      if (confidences[i] < 1.F) continue;
      confidences[i] = 0.1F;
      wrong.push_back(i);
      for (std::size_t a = 0; a < 3; ++a) normals[4 * i + a] *= -1.F;
    }
  }
  const auto field = [&](const std::vector<float>& of_signs, bool consistent) {
    return detail::findNoiseField(points, table, normals, 0, of_signs,
                                  detail::KnownField{consistent, false});
  };
  const detail::NoiseField sure = field(confidences, false);
  const detail::NoiseField alike = field({}, false);
  EXPECT_EQ(field(confidences, true).dipoles, alike.dipoles);
  // How far the cells nearest to the patch say the truth.
  const auto truth = [&](const detail::NoiseField& found) {
    const std::size_t cells = found.places.size() / 4;
    double sum = 0.0;
    for (const std::size_t i : wrong) {
      std::size_t nearest = 0;
      float least = std::numeric_limits<float>::infinity();
      for (std::size_t c = 0; c < cells; ++c) {
        float square = 0.F;
        for (std::size_t a = 0; a < 3; ++a) {
          const float d = found.places[4 * c + a] - points[i][a];
          square += d * d;
        }
        if (square >= least) continue;
        least = square;
        nearest = c;
      }
      sum -= static_cast<double>(dot(&found.dipoles[4 * nearest], &normals[4 * i]));
    }
    return sum;
  };
  EXPECT_GT(truth(sure), truth(alike));
}

// Less noise leaves less of it to be averaged, and more of fine parts to be seen.
TEST(NoiseField, IsAsFineAsTheNoiseAllows) {
  std::vector<float> radii;
  for (const double sigma : {0.1, 0.3, 1.0, 3.0}) {
    const LabelledCloud cloud = sample("bracket", bracket(), 8000, 9, sigma);
    const PointView points = viewOf(cloud.xyz);
    const Neighborhoods table = neighborsOf(cloud.xyz);
    const std::vector<float> normals(cloud.normals.begin(), cloud.normals.end());
    std::vector<float> spacings;
    for (std::size_t i = 0; i < points.size; ++i) {
      spacings.push_back(detail::meanDistance(points, table, i, detail::kFirstRing));
    }
    const detail::NoiseField field =
        detail::findNoiseField(points, table, normals, 0, {}, detail::KnownField{true, true});
    radii.push_back(field.radius / median(std::move(spacings)));
  }
  EXPECT_NEAR(radii[0], 0.6F * detail::kNoisyField.last, 0.01F);
  EXPECT_NEAR(radii[1], radii[0], 0.01F);
  EXPECT_GT(radii[2], 1.05F * radii[1]);
  EXPECT_NEAR(radii[3], detail::kNoisyField.last, 0.01F);
}

// A wall of a spacing asks for it, a solid does not.
TEST(NoiseField, IsFineWhereSomethingIsThin) {
  const auto isFine = [](const LabelledCloud& cloud) {
    const std::vector<float> normals(cloud.normals.begin(), cloud.normals.end());
    return detail::findNoiseField(viewOf(cloud.xyz), neighborsOf(cloud.xyz), normals, 0).fine;
  };
  EXPECT_TRUE(isFine(sample("plate", plate(1, 6000), 6000, 9, 0.2)));
  EXPECT_FALSE(isFine(sample("cube", cube(), 6000, 9, 0.2)));
}

// Normals of a cloud whose near points are side by side.
struct Ordered {
  CompactCloud cloud;
  std::vector<float> normals;

  explicit Ordered(const Noisy& from) : cloud(compactCloud(viewOf(from.xyz))) {
    for (const auto source : cloud.source) {
      const float* n = &from.normals[4 * static_cast<std::size_t>(source)];
      normals.insert(normals.end(), n, n + 4);
    }
  }
};

// What the fine field makes of true normals but for those that face up around a place.
struct Mended {
  double before = 0.0;
  std::vector<float> normals;

  Mended(const Ordered& cloud, double radius) {
    const PointView points = cloud.cloud.view();
    detail::AutoNormals found;
    found.normals = cloud.normals;
    found.confidences.assign(points.size, 1.F);
    for (std::size_t i = 0; i < points.size; ++i) {
      const Vector p = at(points, i) * static_cast<double>(cloud.cloud.unit);
      const bool around = std::hypot(p[0] - 0.1, p[1] - 0.8) < radius;
      if (!around || !(cloud.normals[4 * i + 2] > 0.F)) continue;
      for (std::size_t a = 0; a < 3; ++a) found.normals[4 * i + a] *= -1.F;
    }
    before = shareOutward(found.normals, cloud.normals);
    const std::vector<float> xyz(cloud.cloud.xyz.begin(), cloud.cloud.xyz.end());
    detail::takeFineField(points, neighborsOf(xyz), 0, found);
    normals = found.normals;
  }
};

// Sides of the wing are some spacings apart there.
TEST(FineField, TurnsPatchesOfAThinPartBack) {
  const Ordered cloud(winged(8000, 0.0, 4));
  for (const double radius : {0.05, 0.12, 0.2}) {
    const Mended patch(cloud, radius);
    const double wrong = 1.0 - shareOutward(patch.normals, cloud.normals);
    EXPECT_LT(wrong, 0.75 * (1.0 - patch.before)) << radius;
  }
  EXPECT_GT(shareOutward(Mended(cloud, 0.0).normals, cloud.normals), 0.999) << "the truth";
}

// Without an inside the field says nothing of sides.
TEST(FineField, LeavesOpenSheetsAsTheyAre) {
  std::mt19937 rng(6);
  std::uniform_real_distribution<double> side(-1.0, 1.0);
  Noisy sheet;
  for (int i = 0; i < 4000; ++i) add({side(rng), side(rng), 0.0}, Vector::UnitZ(), sheet);
  const std::vector<float> after = Mended(Ordered(sheet), 0.15).normals;
  std::size_t down = 0;
  for (std::size_t i = 2; i < after.size(); i += 4) down += after[i] < 0.F ? 1 : 0;
  EXPECT_GT(down, 50U);
}

}  // namespace
}  // namespace segorient::test
