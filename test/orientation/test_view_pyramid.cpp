// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// Cameras that are found as the sides of their image meet in them.
#include <gtest/gtest.h>
#include <segorient/orientation/pipeline.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <random>
#include <vector>

#include "orientation/sensors/flat_points.h"
#include "orientation/sensors/view_pyramid.h"
#include "scanned_boxes.h"
#include "sheet_fixture.h"
#include "voxel_thinned.h"

namespace segorient::test {
namespace {

// What a camera sees of a room, thinned as by pcl::VoxelGrid and then turned and moved.
struct View {
  std::vector<float> xyz;  // 4 floats a point
  Vector eye{0.0, 0.0, 0.0};

  double shareFacing(const std::vector<float>& normals) const {
    std::size_t facing = 0;
    for (std::size_t i = 0; i < xyz.size(); i += 4) {
      double along = 0.0;
      for (std::size_t a = 0; a < 3; ++a) {
        along += static_cast<double>(normals[i + a]) * (eye[a] - static_cast<double>(xyz[i + a]));
      }
      facing += along > 0.0 ? 1 : 0;
    }
    return 4.0 * static_cast<double>(facing) / static_cast<double>(xyz.size());
  }
};

// About z, then about x.
Vector turned(const Vector& v, double by) {
  const double c = std::cos(by);
  const double s = std::sin(by);
  const double y = s * v[0] + c * v[1];
  return {c * v[0] - s * v[1], c * y - s * v[2], s * y + c * v[2]};
}

// A room with boxes all over its floor, shelves on its walls and lamps below its ceiling: each side
// of an image cuts several of their faces.
std::vector<Box> furnishedRoom() {
  std::vector<Box> out{{{0, 0, 0}, {6, 5, 2.6}}};
  std::mt19937 random(11);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (int i = 0; i < 24; ++i) {
    const Vector low{2.0 + 3.4 * unit(random), 4.4 * unit(random), i % 3 == 0 ? 2.1 : 0.0};
    const double height = i % 3 == 0 ? 0.5 : 0.2 + 0.9 * unit(random);
    out.push_back({low, {low[0] + 0.5, low[1] + 0.5, low[2] + height}});
  }
  for (int i = 0; i < 6; ++i) {
    const double at = 0.8 * i;
    out.push_back({{5.6 - 0.1 * i, at, 0.9 + 0.2 * i}, {6.0, at + 0.7, 1.1 + 0.2 * i}});
  }
  return out;
}

constexpr Vector kEye{0.3, 2.4, 1.3};
constexpr Vector kGaze{1.0, 0.0, 0.0};

// What a camera at kEye sees along kGaze.
std::vector<float> imageOf(const std::vector<Box>& boxes) {
  std::vector<float> rows;
  for (int v = 0; v < 180; ++v) {
    for (int u = 0; u < 240; ++u) {
      const Vector along{1.0, (119.5 - u) / 215.0, (89.5 - v) / 215.0};
      double nearest = std::numeric_limits<double>::infinity();
      for (const Box& box : boxes) {
        Vector normal{};
        nearest = std::min(nearest, hit(box, kEye, along, normal));
      }
      for (std::size_t a = 0; a < 3; ++a) {
        rows.push_back(static_cast<float>(kEye[a] + nearest * along[a]));
      }
    }
  }
  return rows;
}

View thinnedView(double by, const Vector& shift) {
  static const std::vector<float> kRows = imageOf(furnishedRoom());
  View out;
  out.xyz = thinned({kRows.data(), 3, kRows.size() / 3}, 0.05);
  const auto move = [&](const Vector& v) {
    Vector moved = turned(v, by);
    for (std::size_t a = 0; a < 3; ++a) moved[a] += shift[a];
    return moved;
  };
  out.eye = move(kEye);
  for (std::size_t i = 0; i < out.xyz.size(); i += 4) {
    const Vector p = move({static_cast<double>(out.xyz[i]), static_cast<double>(out.xyz[i + 1]),
                           static_cast<double>(out.xyz[i + 2])});
    for (std::size_t a = 0; a < 3; ++a) out.xyz[i + a] = static_cast<float>(p[a]);
  }
  return out;
}

double distanceTo(const std::array<float, 3>& place, const Vector& truth) {
  double square = 0.0;
  for (std::size_t a = 0; a < 3; ++a) {
    square += std::pow(static_cast<double>(place[a]) - truth[a], 2);
  }
  return std::sqrt(square);
}

// Which planes are tried depends on how a view is turned: not all are found, but none elsewhere.
TEST(Apexes, ThinnedViewsFaceTheirCamera) {
  std::size_t met = 0;
  std::size_t found = 0;
  const std::vector<double> turns{0.0, 0.6, 1.3, 1.9, 2.7, 3.5, 4.4, 5.1, 5.8};
  for (const double by : turns) {
    const View view = thinnedView(by, {7.0, -4.0, 9.0});
    const auto apexes = detail::findApexes(detail::FlatPoints(viewOf(view.xyz), 1), 1);
    const bool meets = std::any_of(apexes.begin(), apexes.end(), [&](const auto& apex) {
      return distanceTo(apex.place, view.eye) < 0.05;  // a cell, in a view 6 wide
    });
    met += meets ? 1 : 0;
    const OrientedCloud cloud = orientCloud(viewOf(view.xyz), nullptr, {});
    const std::vector<FoundSensor>& sensors = cloud.report.sensors.sensors;
    if (sensors.empty()) continue;
    ASSERT_EQ(sensors.size(), 1U);
    ++found;
    EXPECT_EQ(sensors[0].kind, SensorKind::CAMERA);
    EXPECT_EQ(sensors[0].evidence, SensorEvidence::SHADOWS);
    EXPECT_TRUE(sensors[0].sure);
    EXPECT_FALSE(sensors[0].suggested);
    EXPECT_LT(distanceTo(sensors[0].position, view.eye), 0.5) << by;
    const Vector gaze = turned(kGaze, by);
    double along = 0.0;
    for (std::size_t a = 0; a < 3; ++a) along += gaze[a] * static_cast<double>(sensors[0].axis[a]);
    EXPECT_GT(along, 0.95) << by;
    EXPECT_GE(view.shareFacing(cloud.normals), 0.99) << by;
  }
  EXPECT_GE(met, 6U);
  EXPECT_GE(found, 7U);
}

// The sides of a tapered body meet as well, and are faces. So do those of a tapered tube, which is
// open, and whose rims lie in planes.
TEST(Apexes, OfBodiesNobodyIsClaimed) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (const bool open : {false, true}) {
    std::vector<float> xyz;
    for (int i = 0; i < 20000; ++i) {
      // Wide below: half a side of 1 at the height 0, of .5 at the height 1.
      const int face = i % (open ? 4 : 6);
      Vector p{unit(random), unit(random), 0.5 + 0.5 * unit(random)};
      if (face < 4) {
        p[static_cast<std::size_t>(face) / 2] = face % 2 == 0 ? 1.0 : -1.0;
      } else {
        p[2] = face == 4 ? 0.0 : 1.0;
      }
      for (std::size_t a = 0; a < 2; ++a) p[a] *= 1.0 - 0.5 * p[2];
      for (const double v : {p[0] + 5.0, p[1] - 3.0, p[2], 0.0}) {
        xyz.push_back(static_cast<float>(v));
      }
    }
    EXPECT_TRUE(findSensors(viewOf(xyz)).sensors.empty()) << open;
  }
}

TEST(Apexes, OrderAndThreadsDoNotMatter) {
  const View view = thinnedView(0.6, {7.0, -4.0, 9.0});
  std::vector<float> reversed;
  for (std::size_t i = view.xyz.size(); i > 0; i -= 4) {
    reversed.insert(reversed.end(), &view.xyz[i - 4], &view.xyz[i - 4] + 4);
  }
  SensorOptions one;
  one.threads = 1;
  SensorOptions three;
  three.threads = 3;
  const SensorReport a = findSensors(viewOf(view.xyz), one);
  const SensorReport b = findSensors(viewOf(reversed), three);
  ASSERT_EQ(a.sensors.size(), 1U);
  ASSERT_EQ(b.sensors.size(), 1U);
  EXPECT_EQ(a.sensors[0].position, b.sensors[0].position);
  EXPECT_EQ(a.sensors[0].axis, b.sensors[0].axis);
}

TEST(Apexes, FewPointsAndSuchInOnePlaceOrOnALineHaveNone) {
  const auto apexesOf = [](const std::vector<float>& xyz) {
    return detail::findApexes(detail::FlatPoints(viewOf(xyz), 1), 1).size();
  };
  EXPECT_EQ(apexesOf(std::vector<float>(4, 1.F)), 0U);
  EXPECT_EQ(apexesOf(std::vector<float>(4000, 1.F)), 0U);
  std::vector<float> line(8000, 0.F);
  for (std::size_t i = 0; i < line.size(); i += 4) line[i] = static_cast<float>(i);
  EXPECT_EQ(apexesOf(line), 0U);
}

// What somebody suggests without having been there gives way to a camera that hides far less.
TEST(Apexes, AnotherPlaceThatIsSuggestedDoesNotHideTheCamera) {
  const View view = thinnedView(1.9, {0.3, 0.2, 0.1});
  SensorOptions options;
  options.suggestions = {{static_cast<float>(view.eye[0]), static_cast<float>(view.eye[1]),
                          static_cast<float>(view.eye[2])}};
  const SensorReport right = findSensors(viewOf(view.xyz), options);
  ASSERT_EQ(right.sensors.size(), 1U);
  EXPECT_TRUE(right.sensors[0].suggested);
  options.suggestions[0][0] += 9.F;
  const SensorReport wrong = findSensors(viewOf(view.xyz), options);
  ASSERT_EQ(wrong.sensors.size(), 1U);
  EXPECT_FALSE(wrong.sensors[0].suggested);
  EXPECT_LT(distanceTo(wrong.sensors[0].position, view.eye), 0.1);
}

}  // namespace
}  // namespace segorient::test
