// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// How near the normals of the default method are to the truth, and the one-sided rule behind them.
#include <gtest/gtest.h>
#include <segorient/orientation/pipeline.h>

#include <array>
#include <memory>
#include <random>

#include "features/automatic_normals.h"
#include "features/recompute_scene.h"
#include "orientation/automatic/final_normals.h"
#include "oriented_shapes.h"
#include "sheet_fixture.h"

namespace segorient::test {
namespace {

constexpr double kDegrees = 180 / M_PI;

double rms(const std::vector<float>& normals, const std::vector<float>& truth) {
  double sum = 0;
  for (std::size_t i = 0; i < truth.size(); i += 4) {
    const double cosine =
        std::min(1.0, std::fabs(static_cast<double>(dot3(&normals[i], &truth[i]))));
    sum += std::pow(std::acos(cosine) * kDegrees, 2);
  }
  return std::sqrt(sum / (static_cast<double>(truth.size()) / 4));
}

Face ball() {
  return {4 * M_PI, [](std::mt19937& rng, Eigen::Vector3d& p, Eigen::Vector3d& n) {
            std::normal_distribution<double> normal(0, 1);
            p = n = Eigen::Vector3d(normal(rng), normal(rng), normal(rng)).normalized();
          }};
}

OrientedCloud orient(const LabelledCloud& cloud, bool fit = true, int threads = 0) {
  PipelineOptions options;
  options.orientation.automatic.fit_normals = fit;
  options.threads = threads;
  return orientCloud(viewOf(cloud.xyz), nullptr, options);
}

TEST(FinalNormals, AreThoseOfTheFittedSurfaceWhereItIsSmooth) {
  const LabelledCloud cloud = sample("ball", {ball()}, 4000, 3, 0);
  std::vector<float> fitted(cloud.normals.size());
  estimateNormalsAutomatically(viewOf(cloud.xyz), neighborsOf(cloud.xyz), 0, fitted.data());
  const OrientedCloud oriented = orient(cloud);
  EXPECT_LE(rms(oriented.normals, cloud.normals), 1.02 * rms(fitted, cloud.normals) + 0.02);
  EXPECT_GT(rms(orient(cloud, false).normals, cloud.normals), 1.0);
  EXPECT_EQ(shareOutward(oriented.normals, cloud.normals), 1.0);
}

TEST(FinalNormals, AreOfOneFaceAtSharpEdges) {
  for (const std::vector<Face>& faces : {cube(), steppedSolid(), bracket()}) {
    const LabelledCloud cloud = sample("solid", faces, 8000, 5, 0);
    const OrientedCloud oriented = orient(cloud);
    const double before = rms(orient(cloud, false).normals, cloud.normals);
    EXPECT_LT(rms(oriented.normals, cloud.normals), 0.5 * before);
    EXPECT_GE(shareOutward(oriented.normals, cloud.normals), 0.9995);
  }
}

// Hills of many widths, down to five spacings, with slopes of 40 degrees and more.
LabelledCloud hills(std::size_t count, unsigned seed) {
  std::mt19937 rng(seed);
  std::uniform_real_distribution<double> uniform(0, 1);
  constexpr int kWaves = 40;
  Eigen::Array<double, kWaves, 4> waves;  // two components of the wave vector, phase, height
  for (int w = 0; w < kWaves; ++w) {
    const double k = 2 * M_PI / (5 * std::pow(8.0, uniform(rng)));
    const double angle = 2 * M_PI * uniform(rng);
    waves.row(w) << k * std::cos(angle), k * std::sin(angle), 2 * M_PI * uniform(rng),
        0.9 * std::sqrt(2.0 / kWaves) / k;
  }
  const double side = std::sqrt(static_cast<double>(count));
  const Face face{side * side, [=](std::mt19937& g, Eigen::Vector3d& p, Eigen::Vector3d& n) {
                    std::uniform_real_distribution<double> place(0, side);
                    p = {place(g), place(g), 0};
                    n = Eigen::Vector3d::UnitZ();
                    for (int w = 0; w < kWaves; ++w) {
                      const auto wave = waves.row(w);
                      const double at = wave(0) * p.x() + wave(1) * p.y() + wave(2);
                      p.z() += wave(3) * std::sin(at);
                      n.head<2>() -= wave(3) * std::cos(at) * wave.head<2>().matrix().transpose();
                    }
                    n.normalize();
                  }};
  return sample("hills", {face}, count, seed, 0);
}

// But for stray patches, which cost up to 6 %.
TEST(FinalNormals, SeeNoEdgesWhereASurfaceBendsEverywhere) {
  for (const unsigned seed : {1U, 2U, 3U}) {
    const LabelledCloud cloud = hills(5000, seed);
    std::vector<float> fitted(cloud.normals.size());
    estimateNormalsAutomatically(viewOf(cloud.xyz), neighborsOf(cloud.xyz), 0, fitted.data());
    EXPECT_LE(rms(orient(cloud).normals, cloud.normals), 1.07 * rms(fitted, cloud.normals)) << seed;
  }
}

TEST(FinalNormals, NoiseLeavesThemBetterThanEitherAndTurnsNone) {
  // Up to a quarter of a spacing edges are seen.
  for (const double sigma : {0.1, 0.25}) {
    const LabelledCloud cloud = sample("cube", cube(), 8000, 9, sigma);
    const OrientedCloud before = orient(cloud, false);
    const OrientedCloud oriented = orient(cloud);
    EXPECT_LT(rms(oriented.normals, cloud.normals), rms(before.normals, cloud.normals)) << sigma;
    EXPECT_GE(shareOutward(oriented.normals, cloud.normals),
              shareOutward(before.normals, cloud.normals) - 2e-4)
        << sigma;
  }
}

// Filtered normals are means over the edge, of which half would leave .91.
TEST(FinalNormals, AreOfOneFaceAtSharpEdgesInNoise) {
  double ratio = 0;
  for (const std::vector<Face>& faces : {cube(), steppedSolid(), bracket()}) {
    const LabelledCloud cloud = sample("solid", faces, 8000, 5, 0.1);
    const OrientedCloud oriented = orient(cloud);
    ratio +=
        rms(oriented.normals, cloud.normals) / rms(orient(cloud, false).normals, cloud.normals) / 3;
    EXPECT_GE(shareOutward(oriented.normals, cloud.normals), 0.999);
  }
  EXPECT_LT(ratio, 0.87);
}

TEST(FinalNormals, AreNoWorseWhereSensorsAreKnown) {
  // A ring of 1 and .15, some 14 spacings thick: planes of many points bend its normals.
  const LabelledCloud cloud = sample("ring", {torus(1, 0.15)}, 12000, 7, 0.15);
  constexpr std::array<std::array<float, 3>, 6> kStations{
      {{4, 0, 2}, {-4, 0, 2}, {0, 4, -2}, {0, -4, -2}, {0, 0, 5}, {0, 0, -5}}};
  PipelineOptions options;
  OrientationHints hints;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    // Of the station that sees the point most face on.
    std::array<float, 3> best{};
    float most = -1.F;
    for (const std::array<float, 3>& station : kStations) {
      std::array<float, 3> to{};
      for (std::size_t a = 0; a < 3; ++a) to[a] = station[a] - cloud.xyz[4 * i + a];
      const float cosine =
          dot3(to.data(), &cloud.normals[4 * i]) / std::sqrt(dot3(to.data(), to.data()));
      if (cosine > most) best = station;
      most = std::max(most, cosine);
    }
    hints.viewpoints.insert(hints.viewpoints.end(), best.begin(), best.end());
  }
  options.orientation.hints = std::make_shared<OrientationHints>(hints);
  const OrientedCloud seen = orientCloud(viewOf(cloud.xyz), nullptr, options);
  // Sensors know better than the field of all points, which averages normals where it is asked.
  PipelineOptions without_field;
  without_field.orientation.automatic.winding_normals = false;
  const OrientedCloud not_seen = orientCloud(viewOf(cloud.xyz), nullptr, without_field);
  EXPECT_LT(rms(seen.normals, cloud.normals), 1.1 * rms(not_seen.normals, cloud.normals));
  EXPECT_EQ(shareOutward(seen.normals, cloud.normals), 1.0);
}

// What a sensor saw, with noise that planes leave and surfaces of ten neighbours do not: those were
// fitted to it, as to depths that are rounded.
TEST(FinalNormals, WhereFewNeighborsHideTheNoiseNoneIsTakenFromThem) {
  const LabelledCloud sample_of_ball = sample("ball", {ball()}, 4000, 3, 0);
  PreparedCloud cloud(viewOf(sample_of_ball.xyz), nullptr, 0);
  cloud.findNeighbors(kSheetNeighbors, false);
  Segmentation segments;
  segments.labels.assign(cloud.size(), 0);
  segments.segments.resize(1);
  for (const bool hides : {false, true}) {
    detail::AutoNormals oriented;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      oriented.normals.insert(oriented.normals.end(), {0.6F, 0.F, 0.8F, 0.F});
      oriented.orientation.toward.insert(oriented.orientation.toward.end(), {0.F, 0.F, 1.F});
    }
    oriented.around.assign(cloud.size(), 0);
    oriented.sheets.scan_scales = true;
    oriented.sheets.noise.fine = hides ? 0.2F : 0.01F;
    const std::vector<float> before = oriented.normals;
    detail::MoreNeighbors more(cloud.points(), 0);
    detail::fitFinalNormals(cloud, more, segments, true, 0, nullptr, oriented);
    EXPECT_EQ(oriented.normals == before, hides);
  }
}

TEST(FinalNormals, OfThinWallsStayThoseOfTheirOwnSide) {
  const LabelledCloud cloud = sample("plate", plate(1, 8000), 8000, 13, 0);
  PipelineOptions sheets;  // their planes alone: neither fitted nor mended by a field
  sheets.orientation.automatic.fit_normals = false;
  sheets.orientation.automatic.winding_normals = false;
  const OrientedCloud before = orientCloud(viewOf(cloud.xyz), nullptr, sheets);
  const OrientedCloud after = orient(cloud);
  EXPECT_LE(rms(after.normals, cloud.normals), 1.02 * rms(before.normals, cloud.normals));
  EXPECT_GE(shareOutward(after.normals, cloud.normals),
            shareOutward(before.normals, cloud.normals));
}

TEST(FinalNormals, DoNotDependOnThreads) {
  const LabelledCloud cloud = sample("steps", steppedSolid(), 6000, 17, 0.1);
  EXPECT_EQ(orient(cloud, true, 1).normals, orient(cloud, true, 3).normals);
}

// Two square grids that meet at a right angle along y, oriented; the rows begin `first` spacings
// from the edge, so that the first row of the first face is on it for 0.
struct GridEdge {
  std::vector<float> xyz;
  std::vector<float> normals;
  std::vector<std::int32_t> labels;

  explicit GridEdge(float first) {
    for (int face = 0; face < 2; ++face) {
      for (int row = 0; row < 20; ++row) {
        const float from_edge =
            static_cast<float>(row) + (first > 0.F ? first : (face == 0 ? 0.F : 1.F));
        for (int along = 0; along < 40; ++along) {
          const auto y = static_cast<float>(along);
          if (face == 0) xyz.insert(xyz.end(), {from_edge, y, 0.F, 0.F});
          if (face == 1) xyz.insert(xyz.end(), {0.F, y, -from_edge, 0.F});
          if (face == 0) normals.insert(normals.end(), {0.F, 0.F, 1.F, 0.F});
          if (face == 1) normals.insert(normals.end(), {-1.F, 0.F, 0.F, 0.F});
          labels.push_back(face);
        }
      }
    }
  }
  std::vector<detail::Recomputed> run() const {
    const Neighborhoods table = neighborsOf(xyz, 12);
    const std::vector<std::uint8_t> regular{1, 1};
    const detail::RecomputationScene scene{viewOf(xyz), table, regular, labels, normals, 13, 1};
    return detail::OneSidedRule({}, detail::OneSidedNormal::EXPECTED).apply(scene);
  }
};

TEST(ExpectedNormals, AreToldWherePointsLieOnTheEdgeItself) {
  const GridEdge grid(0.F);
  std::size_t on_edge = 0;
  for (const detail::Recomputed& r : grid.run()) {
    const bool on = grid.xyz[4 * r.point] == 0.F && grid.xyz[4 * r.point + 2] == 0.F;
    EXPECT_TRUE(!r.on_edge || (on && !r.accepted)) << r.point;
    on_edge += r.on_edge ? 1 : 0;
  }
  EXPECT_GE(on_edge, 30U);
}

TEST(ExpectedNormals, KeepTheirFaceAndItsSideBesideTheEdge) {
  const GridEdge grid(0.5F);
  std::size_t accepted = 0;
  for (const detail::Recomputed& r : grid.run()) {
    EXPECT_FALSE(r.on_edge);
    if (!r.accepted) continue;
    ++accepted;
    EXPECT_EQ(r.label, grid.labels[r.point]);
    EXPECT_GT(dot3(r.normal, &grid.normals[4 * r.point]), 0.999F) << r.point;
  }
  EXPECT_GE(accepted, 60U);
}

}  // namespace
}  // namespace segorient::test
