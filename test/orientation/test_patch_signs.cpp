// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
//
// Bodies in contact and bodies that overlap: each one's sides, by small patches and the winding
// number; and what must stay as it is.
#include <gtest/gtest.h>
#include <segorient/orientation/pipeline.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

#include "orientation/automatic/even_cells.h"
#include "orientation/automatic/orient_points.h"
#include "orientation/automatic/patch_equations.h"
#include "orientation/automatic/patch_signs.h"
#include "orientation/automatic/sign_patches.h"
#include "sheet_fixture.h"

namespace segorient::test {
namespace {

using detail::EvenCells;
using detail::SignPatches;

struct Bodies {
  std::vector<float> xyz;
  std::vector<float> normals;       // outward of each body
  std::vector<bool> is_in_contact;  // with another body

  void add(const std::array<float, 3>& p, const std::array<float, 3>& n, bool in_contact) {
    xyz.insert(xyz.end(), {p[0], p[1], p[2], 0.F});
    normals.insert(normals.end(), {n[0], n[1], n[2], 0.F});
    is_in_contact.push_back(in_contact);
  }

  void addNoise(float deviation, unsigned seed) {
    std::mt19937 rng(seed);
    std::normal_distribution<float> noise(0.F, deviation);
    for (std::size_t i = 0; i < xyz.size(); ++i) xyz[i] += i % 4 < 3 ? noise(rng) : 0.F;
  }

  // Share of the points on no face in contact whose normal is outward.
  double shareRight(const std::vector<float>& found) const {
    double right = 0.0;
    double all = 0.0;
    for (std::size_t i = 0; i < is_in_contact.size(); ++i) {
      if (is_in_contact[i]) continue;
      all += 1.0;
      if (dot3(&found[4 * i], &normals[4 * i]) > 0.F) right += 1.0;
    }
    return right / all;
  }
};

struct Box {
  std::array<float, 3> low;
  std::array<float, 3> high;

  bool holds(const std::array<float, 3>& p) const {
    for (std::size_t a = 0; a < 3; ++a) {
      if (p[a] < low[a] || p[a] > high[a]) return false;
    }
    return true;
  }
};

// All faces of all boxes, those in contact, too.
Bodies sampleBoxes(const std::vector<Box>& boxes, float per_area, unsigned seed) {
  std::mt19937 rng(seed);
  Bodies out;
  for (const Box& box : boxes) {
    for (std::size_t a = 0; a < 3; ++a) {
      const std::size_t b = (a + 1) % 3;
      const std::size_t c = (a + 2) % 3;
      std::uniform_real_distribution<float> along_b(box.low[b], box.high[b]);
      std::uniform_real_distribution<float> along_c(box.low[c], box.high[c]);
      const float area = (box.high[b] - box.low[b]) * (box.high[c] - box.low[c]);
      for (const bool high : {false, true}) {
        for (int i = 0; i < static_cast<int>(area * per_area); ++i) {
          std::array<float, 3> p{};
          p[a] = high ? box.high[a] : box.low[a];
          p[b] = along_b(rng);
          p[c] = along_c(rng);
          std::array<float, 3> n{};
          n[a] = high ? 1.F : -1.F;
          std::array<float, 3> before = p;
          before[a] += 1e-4F * n[a];
          bool in_contact = false;
          for (const Box& other : boxes) {
            in_contact = in_contact || (&other != &box && other.holds(before));
          }
          out.add(p, n, in_contact);
        }
      }
    }
  }
  return out;
}

// Three boxes on one another, each set off from the next.
std::vector<Box> stack() {
  return {{{-.5F, -.4F, 0.F}, {.5F, .4F, .35F}},
          {{-.3F, -.45F, .35F}, {.35F, .2F, .6F}},
          {{-.45F, -.3F, .6F}, {.2F, .35F, 1.F}}};
}

void addSphere(Bodies& bodies, const std::array<float, 3>& center, float radius, int count,
               std::mt19937& rng) {
  std::normal_distribution<float> normal;
  for (int i = 0; i < count; ++i) {
    std::array<float, 3> n{normal(rng), normal(rng), normal(rng)};
    const float length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    std::array<float, 3> p{};
    for (std::size_t a = 0; a < 3; ++a) {
      n[a] /= length;
      p[a] = center[a] + radius * n[a];
    }
    bodies.add(p, n, false);
  }
}

OrientedCloud orient(const std::vector<float>& xyz, int threads = 1) {
  PipelineOptions options;
  options.threads = threads;
  return orientCloud(viewOf(xyz), nullptr, options);
}

// A wave of heights, and normals.
Bodies wave(int side) {
  std::mt19937 rng(4);
  std::uniform_real_distribution<float> jitter(-.3F, .3F);
  Bodies out;
  for (int i = 0; i < side; ++i) {
    for (int j = 0; j < side; ++j) {
      const float x = (static_cast<float>(i) + jitter(rng)) / static_cast<float>(side);
      const float y = (static_cast<float>(j) + jitter(rng)) / static_cast<float>(side);
      const float slope = .9F * std::cos(9.F * x);
      const float length = std::sqrt(1.F + slope * slope);
      out.add({x, y, .1F * std::sin(9.F * x)}, {-slope / length, 0.F, 1.F / length}, false);
    }
  }
  return out;
}

// A sheet rolled up, two turns of a spiral: with a false wall between them it would bound a body.
Bodies roll(std::size_t n) {
  std::mt19937 rng(5);
  std::uniform_real_distribution<float> unit(0.F, 1.F);
  Bodies out;
  for (std::size_t i = 0; i < n; ++i) {
    const float angle = 12.6F * std::pow(unit(rng), .7F);
    const float r = .4F + .12F * angle;
    const float x = .12F * std::cos(angle) - r * std::sin(angle);
    const float y = .12F * std::sin(angle) + r * std::cos(angle);
    const float length = std::sqrt(x * x + y * y);
    out.add({r * std::cos(angle), r * std::sin(angle), 2.F * unit(rng)},
            {y / length, -x / length, 0.F}, false);
  }
  return out;
}

TEST(PatchSigns, RolledSheetStaysOneSheet) {
  const Bodies sheet = roll(20000);
  const OrientedCloud found = orientCloud(viewOf(sheet.xyz), nullptr, PipelineOptions{});
  EXPECT_GT(std::fabs(sheet.shareRight(found.normals) - .5), .49);
}

TEST(SignPatches, AreFlatPiecesThatEndAtEdges) {
  const Bodies cube = sampleBoxes({{{0.F, 0.F, 0.F}, {1.F, 1.F, 1.F}}}, 2000.F, 3);
  const EvenCells cells = detail::gatherCells(viewOf(cube.xyz), cube.normals, .02F, 1);
  const SignPatches patches = detail::growPatches(cells);
  ASSERT_GT(patches.size(), 12U);
  float share = 0.F;
  for (std::size_t p = 0; p < patches.size(); ++p) {
    EXPECT_LE(patches.cells[p].size(), 80U);
    share += patches.areas[p];
    const std::size_t first = patches.cells[p].front();
    for (const std::uint32_t c : patches.cells[p]) {
      EXPECT_GT(dot3(&cells.normals[4 * first], &cells.normals[4 * std::size_t{c}]), .5F);
      EXPECT_EQ(patches.of[c], static_cast<std::int32_t>(p));
    }
  }
  EXPECT_GT(share, .9F);
  EXPECT_LE(share, 1.001F);
}

TEST(SignPatches, BordersSayWhetherNormalsAgree) {
  Bodies sheet = wave(60);
  for (std::size_t i = 0; i < sheet.is_in_contact.size(); ++i) {
    if (sheet.xyz[4 * i + 1] < .5F) continue;
    for (std::size_t a = 0; a < 3; ++a) sheet.normals[4 * i + a] *= -1.F;
  }
  const EvenCells cells = detail::gatherCells(viewOf(sheet.xyz), sheet.normals, .015F, 1);
  const SignPatches patches = detail::growPatches(cells);
  bool any_opposed = false;
  for (const detail::PatchBorder& border : patches.borders) {
    const float ya = cells.places[4 * std::size_t{patches.cells[border.a].front()} + 1];
    const float yb = cells.places[4 * std::size_t{patches.cells[border.b].front()} + 1];
    EXPECT_EQ(border.agreement > 0.F, (ya < .5F) == (yb < .5F)) << ya << ' ' << yb;
    any_opposed = any_opposed || border.agreement < 0.F;
  }
  EXPECT_TRUE(any_opposed);
  // A line of 60 points among 3600 with eight neighbours each, of which three lie across it.
  EXPECT_NEAR(detail::brokenShare(cells, cells.normals), 2. * 60 * 3 / (3600. * 8), .008);
}

// Of so many parts without a neighbour no field tells the signs, and equations go by the square.
TEST(PatchSigns, OfManySmallPartsNoEquationsAreMade) {
  for (const std::size_t parts : {900U, 1100U}) {
    Bodies chips;
    for (std::size_t i = 0; i < 16 * parts; ++i) {
      const auto part = static_cast<float>(i / 16);
      const float x = 20.F * part + static_cast<float>(i % 4);
      chips.add({x, static_cast<float>(i / 4 % 4), 0.F}, {0.F, 0.F, 1.F}, false);
    }
    const EvenCells cells = detail::gatherCells(viewOf(chips.xyz), chips.normals, .5F, 1);
    const detail::PatchEquations equations(cells, 1.F, 1);
    EXPECT_EQ(equations.size(), parts < 1000 ? parts : 0U);
  }
}

TEST(PatchSigns, BodiesInContactHaveTheirOutsideOut) {
  const Bodies bodies = sampleBoxes(stack(), 4000.F, 7);
  const OrientedCloud found = orient(bodies.xyz);
  EXPECT_GT(bodies.shareRight(found.normals), .93);
  double hidden = 0.0;
  double surely = 0.0;
  for (std::size_t i = 0; i < bodies.is_in_contact.size(); ++i) {
    if (!bodies.is_in_contact[i]) continue;
    hidden += 1.0;
    if (found.confidences[i] > .9F) surely += 1.0;
  }
  EXPECT_LT(surely, .05 * hidden);  // which of both bodies such a point is of cannot be known
}

Bodies panels() {
  constexpr float kThick = .06F;
  return sampleBoxes({{{0.F, 0.F, 0.F}, {1.F, .8F, kThick}},
                      {{0.F, 0.F, .6F}, {1.F, .8F, .6F + kThick}},
                      {{0.F, 0.F, kThick}, {kThick, .8F, .6F}},
                      {{1.F - kThick, 0.F, kThick}, {1.F, .8F, .6F}},
                      {{kThick, 0.F, kThick}, {1.F - kThick, kThick, .6F}},
                      {{kThick, .8F - kThick, kThick}, {1.F - kThick, .8F, .6F}}},
                     3000.F, 11);
}

Bodies overlappingBoxes() {
  return sampleBoxes({{{0.F, 0.F, 0.F}, {1.F, 1.F, 1.F}},
                      {{.6F, .6F, .6F}, {1.5F, 1.5F, 1.5F}},
                      {{.2F, .3F, .8F}, {.7F, .8F, 1.8F}},
                      {{-.5F, .2F, .2F}, {.3F, .7F, .6F}}},
                     1000.F, 13);
}

TEST(PatchSigns, PanelsThatTouchMakeABox) {
  const Bodies bodies = panels();
  EXPECT_GT(bodies.shareRight(orient(bodies.xyz).normals), .97);
}

TEST(PatchSigns, SpheresThatOverlapKeepTheirOutsides) {
  std::mt19937 rng(5);
  Bodies bodies;
  addSphere(bodies, {0.F, 0.F, 0.F}, .5F, 6000, rng);
  addSphere(bodies, {.55F, .1F, 0.F}, .45F, 5000, rng);
  addSphere(bodies, {.2F, .5F, .2F}, .4F, 4000, rng);
  EXPECT_GT(bodies.shareRight(orient(bodies.xyz).normals), .95);
}

// The field of all points, which noise is for elsewhere, wants the inside of one closed surface.
TEST(PatchSigns, NoiseDoesNotHideThatBodiesTouchOrOverlap) {
  Bodies in_contact = panels();
  in_contact.addNoise(.25F / std::sqrt(3000.F), 6);
  EXPECT_GT(in_contact.shareRight(orient(in_contact.xyz).normals), .95);
  Bodies overlapping = overlappingBoxes();
  overlapping.addNoise(.35F / std::sqrt(1000.F), 7);
  EXPECT_GT(overlapping.shareRight(orient(overlapping.xyz).normals), .97);
}

TEST(PatchSigns, AreTheSameForAnyNumberOfThreads) {
  const Bodies bodies = sampleBoxes(stack(), 2000.F, 9);
  const OrientedCloud one = orient(bodies.xyz, 1);
  const OrientedCloud four = orient(bodies.xyz, 4);
  EXPECT_EQ(one.normals, four.normals);
  EXPECT_EQ(one.confidences, four.confidences);
}

// Before the winding number of a closed surface, of a sheet, and of nothing.
TEST(PatchSigns, LeaveAloneWhatIsNotInContact) {
  for (const Bodies& bodies :
       {sampleBoxes({{{0.F, 0.F, 0.F}, {1.F, 1.F, 1.F}}}, 1500.F, 3), wave(90)}) {
    detail::AutoNormals found;
    found.normals = bodies.normals;
    found.confidences.assign(bodies.is_in_contact.size(), 1.F);
    found.spacing = .012F;
    AutoOrientation orientation;
    orientation.result.components.resize(1);
    orientation.result.components[0].points = bodies.is_in_contact.size();
    orientation.result.components[0].residual = .2F;  // so that it is looked at
    orientation.ground.resize(1);
    const detail::CellSigns signs = detail::findCellSigns(viewOf(bodies.xyz), found.normals,
                                                          found.spacing, orientation, false, 1);
    EXPECT_TRUE(signs.empty());
    detail::takeCellSigns(viewOf(bodies.xyz), signs, found);
    EXPECT_EQ(found.normals, bodies.normals);
    EXPECT_EQ(found.confidences, std::vector<float>(bodies.is_in_contact.size(), 1.F));
  }
  EXPECT_TRUE(detail::findCellSigns({nullptr, 4, 0}, {}, 0.F, {}, true, 1).empty());
}

}  // namespace
}  // namespace segorient::test
