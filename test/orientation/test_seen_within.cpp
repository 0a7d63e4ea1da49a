// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// Scenes that were seen from so many places that no search finds them.
#include <gtest/gtest.h>
#include <segorient/orientation/pipeline.h>
#include <segorient/orientation/sensors.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "sensor_scans.h"

namespace segorient {
namespace {

TEST(SeenWithin, ARoomFacesWhoWasCarriedAboutInIt) {
  const Carried carried = carriedAbout();
  const PointView points = carried.scan.view();
  const SensorReport report = findSensors(points);
  EXPECT_TRUE(report.sensors.empty());
  ASSERT_EQ(report.directions.size(), 3 * points.size) << report.why;
  const OrientedCloud cloud = orientCloud(points, nullptr, {});
  std::size_t facing = 0;
  for (std::size_t i = 0; i < points.size; ++i) {
    double sum = 0.0;
    for (std::size_t a = 0; a < 3; ++a) {
      sum += static_cast<double>(cloud.normals[4 * i + a]) *
             (carried.from[i][a] - static_cast<double>(points[i][a]));
    }
    facing += sum > 0.0 ? 1 : 0;
  }
  EXPECT_GT(static_cast<double>(facing), 0.99 * static_cast<double>(points.size));
}

// An ellipsoid 3 x 1 x 1, seen by a camera that is carried around it at half its width.
std::vector<float> carriedAround() {
  const Vector half{1.5, 0.5, 0.5};
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  std::vector<float> rows;
  for (int i = 0; i < 40; ++i) {
    Vector place{};
    Vector out{};
    double length = 0.0;
    double slope = 0.0;
    for (double& v : out) {
      v = normal(random);
      length += v * v;
    }
    for (std::size_t a = 0; a < 3; ++a) {
      out[a] /= std::sqrt(length);
      slope += std::pow(out[a] / half[a], 2);
    }
    for (std::size_t a = 0; a < 3; ++a) {
      place[a] = out[a] * half[a] + 0.5 * out[a] / half[a] / std::sqrt(slope);
    }
    for (int r = 0; r < 4000; ++r) {
      Vector d{};
      double dd = 0.0;
      double od = 0.0;
      double oo = -1.0;
      for (std::size_t a = 0; a < 3; ++a) {
        d[a] = -out[a] / half[a] / std::sqrt(slope) + 0.25 * normal(random);
        dd += std::pow(d[a] / half[a], 2);
        od += d[a] * place[a] / (half[a] * half[a]);
        oo += std::pow(place[a] / half[a], 2);
      }
      const double root = od * od - dd * oo;
      if (root < 0.0 || od > 0.0) continue;
      const double t = (-od - std::sqrt(root)) / dd;
      for (std::size_t a = 0; a < 3; ++a) rows.push_back(static_cast<float>(place[a] + t * d[a]));
    }
  }
  return rows;
}

TEST(SeenWithin, ABodyWasNotSeenFromItsInside) {
  const std::vector<float> rows = carriedAround();
  const PointView points{rows.data(), 3, rows.size() / 3};
  const SensorReport report = findSensors(points);
  EXPECT_GT(report.deviation, 2.F * report.chance);
  EXPECT_TRUE(report.directions.empty()) << report.why;
  const OrientedCloud cloud = orientCloud(points, nullptr, {});
  std::size_t outward = 0;
  for (std::size_t i = 0; i < points.size; ++i) {
    double sum = 0.0;
    for (std::size_t a = 0; a < 3; ++a) {
      const double weight = a == 0 ? 1.0 : 9.0;
      sum += weight * static_cast<double>(cloud.normals[4 * i + a]) *
             static_cast<double>(points[i][a]);
    }
    outward += sum > 0.0 ? 1 : 0;
  }
  EXPECT_GT(static_cast<double>(outward), 0.99 * static_cast<double>(points.size));
}

// An ellipsoid with another one as its head, which was sampled some ten times as densely. From
// places in either its density is even, as those of somebody who looked around in two hollows might
// be.
class Bust {
 public:
  struct Part {
    std::array<float, 3> middle;
    std::array<float, 3> radii;
    float share;  // of the points that are kept

    float heightOf(const float* p) const {
      float sum = 0.F;
      for (std::size_t a = 0; a < 3; ++a) sum += std::pow((p[a] - middle[a]) / radii[a], 2.F);
      return sum - 1.F;
    }
  };

  Bust() {
    std::mt19937 random(5);
    std::normal_distribution<float> normal;
    std::uniform_real_distribution<float> uniform(0.F, 1.F);
    for (const Part& part : parts_) {
      const float least = *std::min_element(part.radii.begin(), part.radii.end());
      for (int i = 0; i < 45000; ++i) {
        std::array<float, 3> way{normal(random), normal(random), normal(random)};
        const float length = std::hypot(std::hypot(way[0], way[1]), way[2]);
        float stretch = 0.F;
        float p[3];
        for (std::size_t a = 0; a < 3; ++a) {
          way[a] /= length;
          stretch += std::pow(way[a] / part.radii[a], 2.F);
          p[a] = part.middle[a] + part.radii[a] * way[a];
        }
        // Even on the surface.
        if (uniform(random) > std::sqrt(stretch) * least) continue;
        const Part& other = &part == &parts_[0] ? parts_[1] : parts_[0];
        if (other.heightOf(p) < 0.F || uniform(random) > part.share) continue;
        rows_.insert(rows_.end(), p, p + 3);
      }
    }
  }

  PointView view() const { return {rows_.data(), 3, rows_.size() / 3}; }

  bool facesOutward(const float* p, const float* n) const {
    const bool is_head = std::fabs(parts_[1].heightOf(p)) < std::fabs(parts_[0].heightOf(p));
    const Part& part = parts_[is_head ? 1 : 0];
    float sum = 0.F;
    for (std::size_t a = 0; a < 3; ++a) {
      sum += n[a] * (p[a] - part.middle[a]) / (part.radii[a] * part.radii[a]);
    }
    return sum > 0.F;
  }

 private:
  std::array<Part, 2> parts_{Part{{0.F, 0.F, 0.F}, {1.08F, 0.75F, 0.99F}, 1.F / 7.F},
                             Part{{0.1F, 0.09F, 1.39F}, {0.73F, 0.62F, 0.57F}, 1.F}};
  std::vector<float> rows_;
};

TEST(SeenWithin, ABodyPartOfWhichIsDenserFacesOutward) {
  const Bust bust;
  const PointView points = bust.view();
  const SensorReport report = findSensors(points);
  EXPECT_EQ(report.why.find("it was seen from within"), std::string::npos) << report.why;
  const OrientedCloud cloud = orientCloud(points, nullptr, {});
  std::size_t outward = 0;
  for (std::size_t i = 0; i < points.size; ++i) {
    outward += bust.facesOutward(points[i], &cloud.normals[4 * i]) ? 1 : 0;
  }
  EXPECT_GT(static_cast<double>(outward), 0.99 * static_cast<double>(points.size));
}

// A ball with spikes, which hide each other.
class SpikedBall {
 public:
  explicit SpikedBall(unsigned seed) : random_(seed) {
    for (int i = 0; i < 30; ++i) spikes_.push_back(anywhere());
  }

  /// Its image from some place three units away, and what errors are common then.
  void addImage(int width, std::vector<float>& rows) {
    const Vector from = anywhere();
    const Vector right = across(from, anywhere());
    const Vector up = across(from, right, 1.0);
    std::normal_distribution<double> error;
    for (int i = 0; i < width * width; ++i) {
      const double u = (i % width + 0.5) / width - 0.5;
      const double v = (i / width + 0.5) / width - 0.5;
      Vector ray{};
      for (std::size_t a = 0; a < 3; ++a) ray[a] = -from[a] + 0.9 * (u * right[a] + v * up[a]);
      const double length = std::sqrt(product(ray, ray));
      double t = 0.0;
      double near = 1.0;
      while (t < 6.0 && near > 1e-4) {
        Vector p{};
        for (std::size_t a = 0; a < 3; ++a) p[a] = 3.0 * from[a] + t * ray[a] / length;
        near = distance(p);
        t += 0.8 * near;
        if (near > 1e-4) continue;
        for (const double x : p) rows.push_back(static_cast<float>(x + 0.005 * error(random_)));
      }
    }
  }

 private:
  static double product(const Vector& a, const Vector& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  }
  static Vector across(const Vector& a, const Vector& b, double length = 0.0) {
    Vector out{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    if (length == 0.0) length = std::sqrt(product(out, out));
    for (double& v : out) v /= length;
    return out;
  }
  Vector anywhere() {
    std::normal_distribution<double> normal;
    Vector out{normal(random_), normal(random_), normal(random_)};
    const double length = std::sqrt(product(out, out));
    for (double& v : out) v /= length;
    return out;
  }
  double distance(const Vector& p) const {
    const double squares = product(p, p);
    double out = std::sqrt(squares) - 0.45;
    for (const Vector& spike : spikes_) {
      const double t = product(p, spike);
      const double width = std::max(0.0, 0.11 * (1.0 - t / 1.05));
      const double off = std::sqrt(std::max(0.0, squares - t * t)) - width;
      out = std::min(out, std::max(off, -t));
    }
    return out;
  }

  std::mt19937 random_;
  std::vector<Vector> spikes_;
};

TEST(SeenWithin, SpikesWereSeenFromAround) {
  for (const unsigned seed : {2U, 4U}) {
    SpikedBall ball(seed);
    std::vector<float> rows;
    for (int image = 0; image < 2; ++image) ball.addImage(210, rows);
    const SensorReport report = findSensors({rows.data(), 3, rows.size() / 3});
    // Shadows may have it for a room, until its surface is known: see boundBodies().
    EXPECT_EQ(report.why.find("it was seen from within"), std::string::npos) << report.why;
  }
}

// Boxes that stand one on another, each sampled at random all over: there are two layers where they
// touch, so that density is uneven without a sensor.
std::vector<float> stackedBoxes(int count, int per_box, double noise) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::uniform_int_distribution<std::size_t> face(0, 5);
  std::normal_distribution<double> error(0.0, noise * std::sqrt(6.0 / per_box));
  std::vector<float> xyz;
  for (int box = 0; box < count; ++box) {
    for (int i = 0; i < per_box; ++i) {
      const std::size_t on = face(random);
      Vector p{unit(random), unit(random), unit(random)};
      p[on / 2] = static_cast<double>(on % 2);
      p[2] += static_cast<double>(box);
      for (const double v : p) xyz.push_back(static_cast<float>(v + error(random)));
    }
  }
  return xyz;
}

TEST(SeenWithin, LayersInContactAreNoSensorsDensity) {
  for (const double noise : {0.1, 0.3, 0.4}) {
    for (const int count : {3, 5}) {
      const std::vector<float> xyz = stackedBoxes(count, 8000, noise);
      const SensorReport report = findSensors({xyz.data(), 3, xyz.size() / 3});
      EXPECT_TRUE(report.sensors.empty()) << report.why;
      EXPECT_TRUE(report.directions.empty())
          << count << " boxes, noise " << noise << ": " << report.why;
    }
  }
}

struct Block {
  Vector low;
  Vector high;
  bool has(const Vector& p) const {
    for (std::size_t a = 0; a < 3; ++a) {
      if (p[a] < low[a] - 1e-9 || p[a] > high[a] + 1e-9) return false;
    }
    return true;
  }
};

// The outer surface of two blocks in contact, ten times denser at the edges of their faces.
std::vector<float> denseAtEdges(const std::array<Block, 2>& blocks, double reach) {
  constexpr double kTimes = 10.0;
  constexpr double kPerArea = 6000.0;
  std::mt19937 random(8);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::vector<float> xyz;
  for (std::size_t k = 0; k < 2; ++k) {
    const Block& block = blocks[k];
    for (std::size_t face = 0; face < 6; ++face) {
      const std::size_t a = face / 2;
      const std::size_t b = (a + 1) % 3;
      const std::size_t c = (a + 2) % 3;
      const double width = block.high[b] - block.low[b];
      const double height = block.high[c] - block.low[c];
      for (int i = 0; i < static_cast<int>(kPerArea * width * height); ++i) {
        const double u = width * unit(random);
        const double v = height * unit(random);
        const double edge = std::min({u, width - u, v, height - v});
        if (kTimes * unit(random) > 1.0 + (kTimes - 1.0) * std::exp(-edge / reach)) continue;
        Vector p{};
        p[a] = face % 2 == 0 ? block.low[a] : block.high[a];
        p[b] = block.low[b] + u;
        p[c] = block.low[c] + v;
        if (blocks[1 - k].has(p)) continue;
        for (const double x : p) xyz.push_back(static_cast<float>(x));
      }
    }
  }
  return xyz;
}

TEST(SeenWithin, DenseEdgesAreNoSensorsDensity) {
  const std::vector<std::pair<std::array<Block, 2>, double>> bodies{
      {{Block{{-0.67, -0.54, 0.0}, {0.87, 0.72, 0.32}},
        Block{{-0.77, -0.9, 0.32}, {0.93, 0.68, 0.69}}},
       0.08},
      {{Block{{-0.82, -0.62, 0.0}, {0.99, 0.41, 0.2}},
        Block{{-0.81, -0.68, 0.2}, {0.85, 0.68, 0.69}}},
       0.07},
      {{Block{{-0.53, -0.67, 0.0}, {0.76, 0.49, 0.43}},
        Block{{-0.97, -0.64, 0.43}, {0.87, 0.85, 0.61}}},
       0.22}};
  for (const auto& [blocks, reach] : bodies) {
    const std::vector<float> xyz = denseAtEdges(blocks, reach);
    const SensorReport report = findSensors({xyz.data(), 3, xyz.size() / 3});
    EXPECT_TRUE(report.sensors.empty()) << report.why;
    EXPECT_TRUE(report.directions.empty()) << reach << ": " << report.why;
  }
}

}  // namespace
}  // namespace segorient
