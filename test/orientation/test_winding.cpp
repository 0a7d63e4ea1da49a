// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// Winding numbers of spheres, components inside one another, and the sensor's place.
#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numeric>
#include <random>

#include "common/compact_cloud.h"
#include "orientation/automatic/orient_sheets.h"
#include "orientation/winding/dipole_sums.h"
#include "orientation/winding/winding_components.h"
#include "orientation/winding/winding_number.h"
#include "sheet_fixture.h"

namespace segorient::test {
namespace {

struct Balls {
  std::vector<float> xyz;
  std::vector<float> dipoles;
  std::vector<float> normals;
  std::vector<std::int32_t> components;
  std::vector<float> spacing;
};

// What is known of them if they are one sheet without walls.
struct OneSheet {
  explicit OneSheet(const Balls& balls)
      : above(balls.spacing.size(), std::numeric_limits<float>::max()),
        below(above.size(), -std::numeric_limits<float>::max()),
        reliable(above.size(), 1),
        field{balls.normals.data(), nullptr,      balls.spacing.data(),
              below.data(),         above.data(), reliable.data()} {}

  const std::vector<float> above;
  const std::vector<float> below;
  const std::vector<std::uint8_t> reliable;
  const SheetField field;
};

void addBall(Balls& balls, std::array<double, 3> center, double radius, std::size_t n, float sign) {
  const auto component =
      static_cast<std::int32_t>(balls.components.empty() ? 0 : balls.components.back() + 1);
  const double area = 4 * M_PI * radius * radius / static_cast<double>(n);
  for (std::size_t i = 0; i < n; ++i) {
    const double z = 1 - 2 * (static_cast<double>(i) + 0.5) / static_cast<double>(n);
    const double r = std::sqrt(1 - z * z);
    const double t = 2.399963229728653 * static_cast<double>(i);
    const std::array<double, 3> d{r * std::cos(t), r * std::sin(t), z};
    for (std::size_t a = 0; a < 3; ++a) {
      balls.xyz.push_back(static_cast<float>(center[a] + radius * d[a]));
      balls.normals.push_back(sign * static_cast<float>(d[a]));
      balls.dipoles.push_back(sign * static_cast<float>(area * d[a]));
    }
    balls.xyz.push_back(0.F);
    balls.normals.push_back(0.F);
    balls.dipoles.push_back(static_cast<float>(area));
    balls.components.push_back(component);
    balls.spacing.push_back(static_cast<float>(std::sqrt(area)));
  }
}

TEST(WindingNumber, IsOneInsideAndZeroOutside) {
  Balls ball;
  addBall(ball, {1, 2, 3}, 1, 4000, 1.F);
  WindingNumber winding;
  winding.build(viewOf(ball.xyz), ball.dipoles.data(), {});
  const float inside[3] = {1.2F, 2.1F, 2.7F};
  const float outside[3] = {3.F, 2.F, 3.F};
  EXPECT_NEAR(winding.evaluate(inside, 0.03F), 1.F, 0.01F);
  EXPECT_NEAR(winding.evaluate(outside, 0.03F), 0.F, 0.01F);
  EXPECT_NEAR(winding.evaluate(ball.xyz.data(), 0.03F), 0.5F, 0.05F);
}

// Trees of any shape, and of parts that several threads build.
TEST(WindingNumber, OfAnyNumberOfPointsIsNearTheSum) {
  std::vector<std::size_t> counts(200);
  std::iota(counts.begin(), counts.end(), 1U);
  counts.insert(counts.end(), {4095, 4096, 4097, 8193, 12345, 30000});
  Balls ball;
  addBall(ball, {0, 0, 0}, 1, 30000, 1.F);
  const float far[3] = {0.3F, -9.F, 4.F};
  const float near[3] = {0.4F, 0.3F, -0.2F};
  for (const std::size_t count : counts) {
    std::vector<std::uint32_t> rows(count);
    std::iota(rows.begin(), rows.end(), 0U);
    WindingNumber winding;
    winding.build(viewOf(ball.xyz), ball.dipoles.data(), rows, 1);
    WindingNumber by_four;
    by_four.build(viewOf(ball.xyz), ball.dipoles.data(), rows, 4);
    for (const float* x : {far, near}) {
      double sum = 0.0;
      double scale = 0.0;
      for (std::size_t i = 0; i < count; ++i) {
        double along = 0.0;
        double square = 0.0;
        for (std::size_t a = 0; a < 3; ++a) {
          const double d = static_cast<double>(ball.xyz[4 * i + a]) - static_cast<double>(x[a]);
          along += d * static_cast<double>(ball.dipoles[4 * i + a]);
          square += d * d;
        }
        const double term = along / (4.0 * M_PI * square * std::sqrt(square));
        sum += term;
        scale += std::abs(term);
      }
      EXPECT_NEAR(winding.evaluate(x, 0.F), sum, 0.05 * scale) << count;
      EXPECT_EQ(winding.evaluate(x, 0.F), by_four.evaluate(x, 0.F)) << count;
    }
  }
}

// Of a ball that holds all points, the parts that trees are built from list each of them once.
TEST(WindingNumber, HoldsEachPointOnce) {
  Balls ball;
  addBall(ball, {0, 0, 0}, 1, 30000, 1.F);
  DipoleList points;
  for (std::size_t i = 0; i < 30000; ++i) {
    const float place[3] = {static_cast<float>(i), 0.F, 0.F};
    points.add(place, &ball.dipoles[4 * i]);
  }
  points.fillBlock();
  for (const std::size_t count : {1, 15, 16, 17, 255, 4095, 4096, 4097, 8193, 12345, 30000}) {
    WindingNumber winding;
    std::vector<std::uint32_t> rows(count);
    std::iota(rows.begin(), rows.end(), 0U);
    winding.build(viewOf(ball.xyz), ball.dipoles.data(), rows, 4);
    DipoleList seen;
    const float center[3] = {0, 0, 0};
    winding.listDipoles(center, 100.F, points, seen);
    ASSERT_EQ(seen.size(), count);
    for (std::size_t i = 0; i < count; ++i) ASSERT_EQ(seen.x[i], static_cast<float>(i)) << count;
  }
}

// Blocks that are full and that are not, of places that are near each other and that are not, and
// with the points of a part only.
TEST(WindingNumber, OfManyPlacesIsThatOfEach) {
  Balls balls;
  addBall(balls, {0, 0, 0}, 1, 3000, 1.F);
  addBall(balls, {3, 0, 0}, 0.5, 700, -1.F);
  std::vector<std::uint32_t> part(3500);
  std::iota(part.begin(), part.end(), 100U);
  std::mt19937 random(3);
  std::uniform_real_distribution<float> place(-2.F, 4.F);
  for (const std::vector<std::uint32_t>& rows : {std::vector<std::uint32_t>{}, part}) {
    WindingNumber winding;
    winding.build(viewOf(balls.xyz), balls.dipoles.data(), rows);
    for (const std::size_t count : {0U, 1U, 15U, 16U, 17U, 400U}) {
      std::vector<float> at;
      std::vector<float> radii;
      for (std::size_t i = 0; i < count; ++i) {
        const bool on_surface = i % 3 != 0;
        for (std::size_t a = 0; a < 3; ++a) {
          at.push_back(on_surface ? balls.xyz[4 * i + a] : place(random));
        }
        radii.push_back(0.01F * static_cast<float>(i % 7));
      }
      for (const char* set : {"scalar", "avx2", "avx512"}) {
        SCOPED_TRACE(set);
        setenv("SEGORIENT_SIMD", set, 1);
        const std::vector<float> all = winding.evaluate({at.data(), 3, count}, radii, 0);
        unsetenv("SEGORIENT_SIMD");
        ASSERT_EQ(all.size(), count);
        for (std::size_t i = 0; i < count; ++i) {
          const float alone = winding.evaluate(&at[3 * i], radii[i]);
          if (std::isnan(alone)) {
            EXPECT_TRUE(std::isnan(all[i])) << i;  // on a point, without a radius
          } else {
            EXPECT_EQ(alone, all[i]) << i;
          }
        }
      }
    }
  }
}

TEST(WindingNumber, TreeIsNearTheSum) {
  const LabelledCloud cloud = sample("bracket", bracket(), 5000, 31);
  const CompactCloud compact = compactCloud(viewOf(cloud.xyz));
  std::vector<float> dipoles(4 * compact.size(), 1.F);
  for (std::size_t i = 0; i < compact.size(); ++i) {
    const auto row = static_cast<std::size_t>(compact.source[i]);
    for (std::size_t a = 0; a < 3; ++a) dipoles[4 * i + a] = cloud.normals[4 * row + a];
  }
  WindingNumber winding;
  winding.build(compact.view(), dipoles.data(), {});
  for (std::size_t k = 0; k < 50; ++k) {
    const float* x = compact.view()[k * 97];
    double sum = 0.0;
    double scale = 0.0;
    for (std::size_t j = 0; j < compact.size(); ++j) {
      const float* q = compact.view()[j];
      double d[3];
      double s = 0.0;
      for (std::size_t a = 0; a < 3; ++a) {
        d[a] = static_cast<double>(q[a]) - static_cast<double>(x[a]);
        s += d[a] * d[a];
      }
      s = std::max(s, 0.02 * 0.02);
      double dot = 0.0;
      for (std::size_t a = 0; a < 3; ++a) dot += d[a] * static_cast<double>(dipoles[4 * j + a]);
      sum += dot / (s * std::sqrt(s));
      scale += std::fabs(dot) / (s * std::sqrt(s));
    }
    EXPECT_NEAR(static_cast<double>(winding.evaluate(x, 0.02F)), sum / (4 * M_PI),
                0.05 * scale / (4 * M_PI));
  }
}

TEST(ComponentSigns, AlternateInNestedShellsWhateverTheyWere) {
  for (int pattern = 0; pattern < 8; ++pattern) {
    Balls balls;
    const auto sign = [&](int bit) { return (pattern >> bit & 1) != 0 ? 1.F : -1.F; };
    addBall(balls, {0, 0, 0}, 1, 3000, sign(0));
    addBall(balls, {0, 0, 0}, 0.8, 2000, sign(1));
    addBall(balls, {0.1, 0, 0}, 0.5, 1000, sign(2));
    const auto result = solveComponents(viewOf(balls.xyz), balls.dipoles.data(),
                                        balls.spacing.data(), balls.components, 3);
    ASSERT_EQ(result.size(), 3U);
    // Solid shell with a cavity, and a solid ball in it.
    EXPECT_EQ(static_cast<float>(result[0].sign) * sign(0), 1.F) << pattern;
    EXPECT_EQ(static_cast<float>(result[1].sign) * sign(1), -1.F) << pattern;
    EXPECT_EQ(static_cast<float>(result[2].sign) * sign(2), 1.F) << pattern;
    EXPECT_LT(result[0].residual, 0.03F);
    EXPECT_GT(result[0].evidence, 0.5F);
  }
}

// Alone the two surfaces around the gap are a hollow sphere. Together they have more points than
// the body around them, and come first.
TEST(ComponentSigns, KnowABallInItsSocket) {
  for (const float turned : {1.F, -1.F}) {
    Balls balls;
    addBall(balls, {0, 0, 0}, 0.8, 2000, turned);
    addBall(balls, {0, 0, 0}, 0.86, 2300, -turned);
    std::fill(balls.components.begin(), balls.components.end(), 0);
    addBall(balls, {0, 0, 0}, 1, 3100, 1.F);
    const auto result = solveComponents(viewOf(balls.xyz), balls.dipoles.data(),
                                        balls.spacing.data(), balls.components, 2);
    EXPECT_EQ(static_cast<float>(result[0].sign), turned);
    EXPECT_EQ(result[1].sign, 1);
    EXPECT_GT(result[0].evidence, 0.5F);
  }
}

TEST(ComponentSigns, TurnHundredsOfPartsOutward) {
  Balls balls;
  for (int i = 0; i < 300; ++i) {
    addBall(balls, {3.0 * (i % 20), 3.0 * (i / 20), 0.1 * i}, 1, 150, i % 3 == 0 ? -1.F : 1.F);
  }
  const auto result = solveComponents(viewOf(balls.xyz), balls.dipoles.data(), balls.spacing.data(),
                                      balls.components, 300);
  for (int i = 0; i < 300; ++i) {
    EXPECT_EQ(result[static_cast<std::size_t>(i)].sign, i % 3 == 0 ? -1 : 1) << i;
  }
}

TEST(ComponentSigns, APlaneHasNoEvidence) {
  std::vector<float> xyz;
  std::vector<float> dipoles;
  for (int i = 0; i < 40; ++i) {
    for (int j = 0; j < 40; ++j) {
      xyz.insert(xyz.end(), {static_cast<float>(i), static_cast<float>(j), 0.F, 0.F});
      dipoles.insert(dipoles.end(), {0.F, 0.F, 1.F, 1.F});
    }
  }
  const std::vector<std::int32_t> components(1600, 0);
  const std::vector<float> spacing(1600, 1.F);
  const auto result = solveComponents(viewOf(xyz), dipoles.data(), spacing.data(), components, 1);
  EXPECT_LT(result[0].evidence, 0.01F);
  EXPECT_GT(result[0].residual, 0.2F);
}

// A ball in three bands, from the south: all below z = -0.5, the middle and all above z = 0.6.
struct Bands {
  Balls ball;
  std::vector<std::int32_t> band;

  explicit Bands(const std::array<float, 3>& signs) {
    addBall(ball, {0, 0, 0}, 1, 4000, 1.F);
    for (std::size_t i = 0; i < ball.spacing.size(); ++i) {
      const float z = ball.xyz[4 * i + 2];
      band.push_back(z < -0.5F ? 0 : (z < 0.6F ? 1 : 2));
      for (std::size_t a = 0; a < 3; ++a) {
        ball.dipoles[4 * i + a] *= signs[static_cast<std::size_t>(band.back())];
      }
    }
  }
};

TEST(LooseParts, AreTurnedWhereTheWindingNumberWantsThem) {
  for (int pattern = 0; pattern < 3; ++pattern) {
    const Bands bands({1.F, pattern == 1 ? -1.F : 1.F, pattern == 2 ? -1.F : 1.F});
    const auto turn = turnParts(viewOf(bands.ball.xyz), bands.ball.dipoles.data(),
                                bands.ball.spacing.data(), bands.band, 3, 1);
    ASSERT_EQ(turn.size(), 3U);
    EXPECT_EQ(turn[0], 1);
    EXPECT_EQ(turn[1], pattern == 1 ? -1 : 1) << pattern;
    EXPECT_EQ(turn[2], pattern == 2 ? -1 : 1) << pattern;
  }
}

// A ball in a hollow ball. The inner ball has most of the points, and they are as wrong as before
// when the wall alone is turned.
TEST(LooseParts, OneAfterTheOtherWhereTwoAreWrong) {
  Balls balls;
  addBall(balls, {0, 0, 0}, 1, 800, 1.F);
  addBall(balls, {0, 0, 0}, 0.85F, 600, 1.F);
  addBall(balls, {0.1F, 0, 0}, 0.55F, 2000, -1.F);
  EXPECT_EQ(turnParts(viewOf(balls.xyz), balls.dipoles.data(), balls.spacing.data(),
                      balls.components, 3, 1),
            (std::vector<std::int8_t>{1, -1, -1}));
}

// Above a wide sheet that faces up w is -1/2, so that a ball on it is as far off as an open surface
// when it is right, and by another surface more when it is inside out.
TEST(LooseParts, StandOnASheet) {
  for (const float sign : {1.F, -1.F}) {
    Balls scene;
    for (int i = 0; i < 10000; ++i) {
      const float p[4] = {0.2F * static_cast<float>(i % 100) - 9.9F,
                          0.2F * static_cast<float>(i / 100) - 9.9F, 0.F, 0.F};
      const float up[4] = {0.F, 0.F, 0.04F, 0.04F};
      scene.xyz.insert(scene.xyz.end(), p, p + 4);
      scene.dipoles.insert(scene.dipoles.end(), up, up + 4);
      scene.spacing.push_back(0.2F);
      scene.components.push_back(0);
    }
    const auto first = scene.components.size();
    addBall(scene, {0, 0, 1.1F}, 1, 1000, sign);
    std::fill(scene.components.begin() + static_cast<std::ptrdiff_t>(first), scene.components.end(),
              1);
    const auto turn = turnParts(viewOf(scene.xyz), scene.dipoles.data(), scene.spacing.data(),
                                scene.components, 2, 1);
    EXPECT_EQ(turn, (std::vector<std::int8_t>{1, sign < 0.F ? std::int8_t{-1} : std::int8_t{1}}));
  }
}

TEST(LooseParts, FixedOnesStay) {
  const Bands bands({1.F, 1.F, -1.F});
  const auto turn = turnParts(viewOf(bands.ball.xyz), bands.ball.dipoles.data(),
                              bands.ball.spacing.data(), bands.band, 3, 3);
  EXPECT_EQ(turn, (std::vector<std::int8_t>{1, 1, 1}));
}

TEST(LooseParts, ThoseWithoutPointsChangeNothing) {
  const Bands bands({1.F, 1.F, -1.F});
  const Balls& ball = bands.ball;
  EXPECT_EQ(turnParts(viewOf(ball.xyz), ball.dipoles.data(), ball.spacing.data(), bands.band, 5, 1),
            (std::vector<std::int8_t>{1, 1, -1, 1, 1}));
  Balls alone;
  addBall(alone, {0, 0, 0}, 1, 1000, -1.F);
  const auto components = [&](std::size_t count) {
    return solveComponents(viewOf(alone.xyz), alone.dipoles.data(), alone.spacing.data(),
                           alone.components, count);
  };
  EXPECT_EQ(components(3)[0].sign, -1);
  EXPECT_EQ(components(3)[0].residual, components(1)[0].residual);
  EXPECT_EQ(components(3)[2].evidence, 0.F);
}

TEST(LooseParts, ThoseOfUnknownAreaStay) {
  Bands bands({1.F, 1.F, -1.F});
  for (std::size_t i = 0; i < bands.band.size(); i += 5) {
    bands.ball.dipoles[4 * i] = std::numeric_limits<float>::quiet_NaN();
  }
  EXPECT_EQ(turnParts(viewOf(bands.ball.xyz), bands.ball.dipoles.data(), bands.ball.spacing.data(),
                      bands.band, 3, 1),
            (std::vector<std::int8_t>{1, 1, 1}));
}

TEST(LooseParts, HalvesOfAPlaneStayAsTheyAre) {
  std::vector<float> xyz;
  std::vector<float> dipoles;
  std::vector<std::int32_t> parts;
  for (int i = 0; i < 40; ++i) {
    for (int j = 0; j < 40; ++j) {
      xyz.insert(xyz.end(), {static_cast<float>(i), static_cast<float>(j), 0.F, 0.F});
      dipoles.insert(dipoles.end(), {0.F, 0.F, i < 20 ? 1.F : -1.F, 1.F});
      parts.push_back(i < 20 ? 0 : 1);
    }
  }
  const std::vector<float> spacing(1600, 1.F);
  EXPECT_EQ(turnParts(viewOf(xyz), dipoles.data(), spacing.data(), parts, 2, 1),
            (std::vector<std::int8_t>{1, 1}));
}

// Along most of a border, now here, now there, the points have the wrong sign, so that it says the
// opposite of what is right, though not unanimously.
TEST(LooseParts, AreFoundByTheirBorders) {
  const Bands bands({1.F, 1.F, 1.F});
  const std::size_t n = bands.band.size();
  Segmentation segmentation;
  segmentation.labels = bands.band;
  segmentation.signs.assign(n, 1);
  segmentation.segments.resize(3);
  for (std::size_t i = 0; i < n; ++i) {
    ++segmentation.segments[static_cast<std::size_t>(bands.band[i])].size;
    const float* p = &bands.ball.xyz[4 * i];
    const bool at_border = p[2] >= 0.6F && p[2] < 0.75F;
    if (at_border && std::sin(12.F * std::atan2(p[1], p[0])) < 0.4F) segmentation.signs[i] = -1;
  }
  const OneSheet sheet(bands.ball);
  const Neighborhoods table = neighborsOf(bands.ball.xyz);
  segmentation.segments.resize(4);  // the last one has no points
  for (const bool by_winding : {false, true}) {
    AutomaticOptions options;
    options.turn_loose_parts = by_winding;
    const AutoOrientation out =
        orientSheets(viewOf(bands.ball.xyz), table, sheet.field, segmentation,
                     borderVotes(viewOf(bands.ball.xyz), table, sheet.field, segmentation),
                     bands.ball.xyz.size() / 3, options);
    EXPECT_EQ(out.result.segments[0].sign, 1);
    EXPECT_EQ(out.result.segments[1].sign, 1);
    EXPECT_EQ(out.result.segments[2].sign, by_winding ? 1 : -1);
  }
}

// The same where it is the largest of four parts that its borders turn the wrong way: of the others
// none is better off if it is turned, too.
TEST(LooseParts, MayBeTheLargest) {
  Balls ball;
  addBall(ball, {0, 0, 0}, 1, 6000, 1.F);
  const std::size_t n = ball.xyz.size() / 4;
  Segmentation segmentation;
  segmentation.signs.assign(n, 1);
  segmentation.segments.resize(4);
  for (std::size_t i = 0; i < n; ++i) {
    const float* p = &ball.xyz[4 * i];
    const float z = p[2];
    segmentation.labels.push_back(z < -0.5F ? 0 : z < 0.F ? 1 : z < 0.6F ? 2 : 3);
    ++segmentation.segments[static_cast<std::size_t>(segmentation.labels[i])].size;
    // How much of a border says the wrong thing: most of the largest's, less of that between the
    // southern ones.
    const double wave = std::sin(12.0 * static_cast<double>(std::atan2(p[1], p[0])));
    const bool at_largest = z >= 0.F && (z < 0.12F || (z >= 0.48F && z < 0.6F));
    const bool in_south = z >= -0.5F && z < -0.38F;
    if ((at_largest && wave < 0.4) || (in_south && wave < -0.2)) segmentation.signs[i] = -1;
  }
  ASSERT_GT(segmentation.segments[2].size, segmentation.segments[1].size);
  const OneSheet sheet(ball);
  const Neighborhoods table = neighborsOf(ball.xyz);
  for (const bool by_winding : {false, true}) {
    AutomaticOptions options;
    options.turn_loose_parts = by_winding;
    const AutoOrientation out =
        orientSheets(viewOf(ball.xyz), table, sheet.field, segmentation,
                     borderVotes(viewOf(ball.xyz), table, sheet.field, segmentation),
                     ball.xyz.size() / 3, options);
    for (std::size_t s = 0; s < 4; ++s) {
      EXPECT_EQ(out.result.segments[s].sign, s == 2 && !by_winding ? -1 : 1) << s << by_winding;
    }
  }
}

// A plane of two segments, between which more of the border says the wrong thing than the right
// one.
TEST(Ground, FacesOneWayWhereItsBordersHardlyTell) {
  Balls plane;
  std::mt19937 rng(7);
  std::uniform_real_distribution<float> unit(0.F, 40.F);
  Segmentation segmentation;
  segmentation.segments.resize(2);
  for (int i = 0; i < 1600; ++i) {
    const float x = unit(rng);
    const float y = unit(rng);
    const int segment = x < 28.F ? 0 : 1;
    const bool wrong = x >= 28.F && x < 30.F && std::fmod(y, 4.F) < 2.5F;
    plane.xyz.insert(plane.xyz.end(), {x, y, 0.F, 0.F});
    plane.normals.insert(plane.normals.end(), {0.F, 0.F, 1.F, 0.F});
    plane.spacing.push_back(1.F);
    segmentation.labels.push_back(segment);
    segmentation.signs.push_back(wrong ? -1 : 1);
    ++segmentation.segments[static_cast<std::size_t>(segment)].size;
  }
  const OneSheet sheet(plane);
  const Neighborhoods table = neighborsOf(plane.xyz);
  for (const SurfaceKind told : {SurfaceKind::UNKNOWN, SurfaceKind::CLOSED}) {
    PointHints hints;
    hints.surface = told;
    const AutoOrientation out = orientSheets(
        viewOf(plane.xyz), table, sheet.field, segmentation,
        borderVotes(viewOf(plane.xyz), table, sheet.field, segmentation), 1600, {}, hints);
    EXPECT_EQ(out.result.segments[0].sign, 1);
    EXPECT_EQ(out.result.segments[1].sign, told == SurfaceKind::CLOSED ? -1 : 1);
  }
}

}  // namespace
}  // namespace segorient::test
