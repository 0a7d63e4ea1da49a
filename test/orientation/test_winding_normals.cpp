// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// Normals from the winding-number field: against its definition, and where it is to help.
#include <gtest/gtest.h>
#include <segorient/orientation/pipeline.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "common/compact_cloud.h"
#include "orientation/winding/winding_normals.h"
#include "orientation/winding/winding_number.h"
#include "sheet_fixture.h"

namespace segorient::test {
namespace {

// The field by its definition, all points one by one.
double smearedField(const CompactCloud& cloud, const std::vector<float>& dipoles,
                    const Eigen::Vector3d& x, double radius) {
  double w = 0.0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const float* p = cloud.view()[i];
    const Eigen::Vector3d d = Eigen::Map<const Eigen::Vector3f>(p).cast<double>() - x;
    const Eigen::Vector3d m = Eigen::Map<const Eigen::Vector3f>(&dipoles[4 * i]).cast<double>();
    w += m.dot(d) / std::pow(d.squaredNorm() + radius * radius, 1.5);
  }
  return w / (4 * M_PI);
}

TEST(WindingNumber, FallsAsItsDefinitionDoes) {
  const LabelledCloud cloud = sample("bracket", bracket(), 4000, 33);
  const CompactCloud compact = compactCloud(viewOf(cloud.xyz));
  std::vector<float> dipoles(4 * compact.size(), 1.F);
  for (std::size_t i = 0; i < compact.size(); ++i) {
    std::copy_n(&cloud.normals[4 * static_cast<std::size_t>(compact.source[i])], 3,
                &dipoles[4 * i]);
  }
  WindingNumber winding;
  winding.build(compact.view(), dipoles.data(), {});
  DipoleList points;
  for (std::size_t i = 0; i < compact.size(); ++i) points.add(compact.view()[i], &dipoles[4 * i]);
  const auto radius = static_cast<float>(cloud.spacing / static_cast<double>(compact.unit));
  const double step = 1e-3 * static_cast<double>(radius);
  for (std::size_t k = 0; k < 60; ++k) {
    const float* p = compact.view()[k * 61];
    const Eigen::Vector3d x = Eigen::Map<const Eigen::Vector3f>(p).cast<double>();
    Eigen::Vector3d falls;
    for (Eigen::Index a = 0; a < 3; ++a) {
      const Eigen::Vector3d e = step * Eigen::Vector3d::Unit(a);
      falls[a] = (smearedField(compact, dipoles, x - e, static_cast<double>(radius)) -
                  smearedField(compact, dipoles, x + e, static_cast<double>(radius))) /
                 (2 * step);
    }
    Eigen::Vector3f got;
    DipoleList seen;
    // At the ball's center, and at its rim.
    const float reach = k % 2 == 0 ? 0.F : 4 * radius;
    const float center[3] = {p[0] + reach, p[1], p[2]};
    winding.listDipoles(center, 1.01F * reach, points, seen);
    EXPECT_LT(seen.size(), compact.size());
    steepestDescent(seen, p, radius, got.data());
    EXPECT_LT((got.cast<double>() - falls).norm(), 0.05 * falls.norm()) << k;
  }
}

// Prism over a triangle of 50 degrees at two of its corners: two acute edges, lids at right angles.
std::vector<Face> roof() {
  const double height = std::tan(50 * M_PI / 180);
  const Eigen::Vector3d along(0, 2, 0);
  const Eigen::Vector3d left(-1, -1, 0);
  const Eigen::Vector3d right(1, -1, 0);
  const Eigen::Vector3d top(0, -1, height);
  std::vector<Face> faces{parallelogram(left, along, right - left),
                          parallelogram(right, along, top - right),
                          parallelogram(top, along, left - top)};
  const Points2 gable{{-1, 0}, {1, 0}, {0, height}};
  for (const double y : {-1.0, 1.0}) {
    const Face flat = lid(gable, {}, y, y);
    faces.push_back({flat.area, [flat](std::mt19937& rng, Eigen::Vector3d& p, Eigen::Vector3d& n) {
                       flat.draw(rng, p, n);
                       p = Eigen::Vector3d(p.x(), p.z(), p.y());
                       n = Eigen::Vector3d(n.x(), n.z(), n.y());
                     }});
  }
  return faces;
}

TEST(WindingNormals, AreWorthTheirTimeAtAcuteEdges) {
  for (const double sigma : {0.3, 0.6}) {
    const LabelledCloud cloud = sample("roof", roof(), 12000, 7, sigma);
    PipelineOptions without;
    without.orientation.automatic.winding_normals = false;
    const auto wrong = [&](const PipelineOptions& options) {
      const OrientedCloud oriented = orientCloud(viewOf(cloud.xyz), nullptr, options);
      return 1 - shareOutward(oriented.normals, cloud.normals);
    };
    EXPECT_LT(wrong({}), 0.7 * wrong(without)) << sigma;
    EXPECT_LT(wrong({}), 0.01) << sigma;
  }
}

// A sphere with one normal turned over, one missing, and doubts about every second point, whose
// normals are 27 degrees off.
struct Doubts {
  LabelledCloud cloud;
  FilteredNormals normals;
  std::vector<float> spacing;
};

void tiltAtRandom(std::mt19937& rng, float* n) {
  std::normal_distribution<float> gauss(0.F, 1.F);
  Eigen::Map<Eigen::Vector3f> normal(n);
  const Eigen::Vector3f side =
      normal.cross(Eigen::Vector3f(gauss(rng), gauss(rng), gauss(rng))).normalized();
  normal = (normal + 0.5F * side).normalized();
}

Doubts doubts() {
  std::mt19937 rng(5);
  Doubts d;
  for (int i = 0; i < 2000; ++i) {
    const double z = 1 - (2 * i + 1) / 2000.0;
    const double r = std::sqrt(1 - z * z);
    const double t = 2.399963229728653 * i;
    for (const double c : {r * std::cos(t), r * std::sin(t), z, 0.0}) {
      d.cloud.xyz.push_back(static_cast<float>(c));
    }
  }
  d.normals.normals = d.cloud.xyz;
  for (std::size_t i = 0; i < 2000; ++i) {
    d.normals.normals[4 * i + 3] = 0.25F;
    d.normals.confidences.push_back(i % 2 == 0 ? 0.5F : 0.99F);
    if (i % 2 == 0) tiltAtRandom(rng, &d.normals.normals[4 * i]);
    d.spacing.push_back(0.08F);
  }
  for (std::size_t a = 0; a < 3; ++a) {
    d.normals.normals[4 * 600 + a] *= -1.F;
    d.normals.normals[4 * 900 + a] = std::numeric_limits<float>::quiet_NaN();
  }
  return d;
}

TEST(WindingNormals, ChangeOnlyWhatIsInDoubt) {
  Doubts d = doubts();
  const FilteredNormals before = d.normals;
  EXPECT_EQ(refineByWinding(viewOf(d.cloud.xyz), d.spacing, 0.2F, false, 0, d.normals), 998U);
  EXPECT_EQ(d.normals.confidences, before.confidences);
  for (std::size_t i = 0; i < 2000; ++i) {
    const float* n = &d.normals.normals[4 * i];
    EXPECT_EQ(n[3], 0.25F);
    if (i == 900) {
      EXPECT_TRUE(std::isnan(n[0]));
    } else if (i % 2 != 0 || i == 600) {
      EXPECT_TRUE(std::equal(n, n + 4, &before.normals[4 * i]));
    } else {
      EXPECT_NEAR(dot3(n, n), 1.F, 1e-5F);
      EXPECT_GT(dot3(n, &d.cloud.xyz[4 * i]), 0.97F) << i;  // 0.89 before
    }
  }
}

TEST(WindingNormals, LeaveCleanCloudsAlone) {
  Doubts d = doubts();
  const FilteredNormals before = d.normals;
  EXPECT_EQ(refineByWinding(viewOf(d.cloud.xyz), d.spacing, 0.05F, false, 0, d.normals), 0U);
  EXPECT_TRUE(std::equal(before.normals.begin(), before.normals.begin() + 4 * 900,
                         d.normals.normals.begin()));
}

TEST(WindingNormals, AreTheSameForAnyNumberOfThreads) {
  Doubts one = doubts();
  Doubts four = doubts();
  refineByWinding(viewOf(one.cloud.xyz), one.spacing, 0.2F, false, 1, one.normals);
  refineByWinding(viewOf(four.cloud.xyz), four.spacing, 0.2F, false, 4, four.normals);
  for (std::size_t i = 0; i < one.normals.normals.size(); ++i) {
    if (i / 4 == 900) continue;
    ASSERT_EQ(one.normals.normals[i], four.normals.normals[i]);
  }
}

TEST(WindingNormals, OfNothingAreNothing) {
  FilteredNormals none;
  EXPECT_EQ(refineByWinding({}, {}, 0.2F, false, 0, none), 0U);
  Doubts d = doubts();
  EXPECT_EQ(refineByWinding(viewOf(d.cloud.xyz), {0.1F}, 0.2F, false, 0, d.normals), 0U);
  const float unknown = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(refineByWinding(viewOf(d.cloud.xyz), d.spacing, unknown, false, 0, d.normals), 0U);
  d.normals.confidences.pop_back();
  EXPECT_EQ(refineByWinding(viewOf(d.cloud.xyz), d.spacing, 0.2F, false, 0, d.normals), 0U);
  // All in one place, or so near that squares vanish.
  FilteredNormals near;
  near.normals = {0.F, 0.F, 1.F, 0.F, 0.F, 0.F, 1.F, 0.F};
  near.confidences = {0.F, 0.F};
  const std::vector<float> xyz{0.F, 0.F, 0.F, 0.F, 1e-30F, 0.F, 0.F, 0.F};
  refineByWinding(viewOf(xyz), {1e-30F, 0.F}, 0.2F, false, 0, near);
  EXPECT_EQ(near.normals[2], 1.F);
  EXPECT_EQ(near.normals[6], 1.F);
}

}  // namespace
}  // namespace segorient::test
