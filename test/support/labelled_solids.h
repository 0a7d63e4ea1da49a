// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <cstddef>
#include <functional>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace segorient::test {

/// A cloud of which it is known to which face each point belongs.
struct LabelledCloud {
  std::string name;
  std::vector<float> xyz;      ///< 4 floats a point
  std::vector<float> normals;  ///< true outward normal and curvature 0, 4 floats a point
  std::vector<int> face;
  double spacing = 0;  ///< side of the square that one point stands for
  double area = 0;
  std::size_t size() const { return face.size(); }
};

/// A face: random points of it, uniform by area.
struct Face {
  double area = 0;
  std::function<void(std::mt19937&, Eigen::Vector3d&, Eigen::Vector3d&)> draw;
};

using Points2 = std::vector<std::pair<double, double>>;
struct Hole {
  double x, y, r;
};

inline Face parallelogram(const Eigen::Vector3d& o, const Eigen::Vector3d& u,
                          const Eigen::Vector3d& v) {
  const Eigen::Vector3d normal = u.cross(v);
  return {normal.norm(), [=](std::mt19937& rng, Eigen::Vector3d& p, Eigen::Vector3d& n) {
            std::uniform_real_distribution<double> unit(0, 1);
            const double s = unit(rng);
            p = o + s * u + unit(rng) * v;
            n = normal.normalized();
          }};
}

/// Side of a cylinder around z; outward < 0 for the wall of a hole.
inline Face cylinderSide(double x, double y, double r, double z0, double z1, double outward) {
  return {2 * M_PI * r * (z1 - z0), [=](std::mt19937& rng, Eigen::Vector3d& p, Eigen::Vector3d& n) {
            std::uniform_real_distribution<double> unit(0, 1);
            const double t = 2 * M_PI * unit(rng);
            n = outward * Eigen::Vector3d(std::cos(t), std::sin(t), 0);
            p = Eigen::Vector3d(x + r * std::cos(t), y + r * std::sin(t),
                                z0 + (z1 - z0) * unit(rng));
          }};
}

inline bool insidePolygon(const Points2& polygon, double x, double y) {
  bool inside = false;
  for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
    const auto& [ax, ay] = polygon[i];
    const auto& [bx, by] = polygon[j];
    if ((ay > y) != (by > y) && x < (bx - ax) * (y - ay) / (by - ay) + ax) inside = !inside;
  }
  return inside;
}

inline double polygonArea(const Points2& polygon) {
  double twice = 0;
  for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
    twice += polygon[j].first * polygon[i].second - polygon[i].first * polygon[j].second;
  }
  return std::abs(twice) / 2;
}

/// Polygon at height z without round holes, facing up or down.
inline Face lid(const Points2& polygon, const std::vector<Hole>& holes, double z, double up) {
  double area = polygonArea(polygon);
  for (const Hole& h : holes) area -= M_PI * h.r * h.r;
  double low[2] = {1e30, 1e30};
  double high[2] = {-1e30, -1e30};
  for (const auto& [x, y] : polygon) {
    low[0] = std::min(low[0], x);
    low[1] = std::min(low[1], y);
    high[0] = std::max(high[0], x);
    high[1] = std::max(high[1], y);
  }
  return {area, [=](std::mt19937& rng, Eigen::Vector3d& p, Eigen::Vector3d& n) {
            std::uniform_real_distribution<double> dx(low[0], high[0]);
            std::uniform_real_distribution<double> dy(low[1], high[1]);
            for (bool found = false; !found;) {
              p = Eigen::Vector3d(dx(rng), dy(rng), z);
              found = insidePolygon(polygon, p.x(), p.y());
              for (const Hole& h : holes) {
                if (std::hypot(p.x() - h.x, p.y() - h.y) < h.r) found = false;
              }
            }
            n = Eigen::Vector3d(0, 0, up);
          }};
}

/// Polygon (counter-clockwise) raised along z, with round through holes.
inline std::vector<Face> prism(const Points2& polygon, double height,
                               const std::vector<Hole>& holes = {}) {
  std::vector<Face> faces{lid(polygon, holes, height, 1), lid(polygon, holes, 0, -1)};
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const auto& [ax, ay] = polygon[i];
    const auto& [bx, by] = polygon[(i + 1) % polygon.size()];
    faces.push_back(parallelogram({ax, ay, 0}, {bx - ax, by - ay, 0}, {0, 0, height}));
  }
  for (const Hole& h : holes) faces.push_back(cylinderSide(h.x, h.y, h.r, 0, height, -1));
  return faces;
}

inline Points2 rectangle(double a, double b) {
  return {{0, 0}, {a, 0}, {a, b}, {0, b}};
}

inline std::vector<Face> cube() {
  return prism(rectangle(1, 1), 1);
}

inline std::vector<Face> octagonalPrism() {
  Points2 polygon;
  for (int i = 0; i < 8; ++i) polygon.emplace_back(std::cos(i * M_PI / 4), std::sin(i * M_PI / 4));
  return prism(polygon, 1.2);
}

/// A staircase of three steps.
inline std::vector<Face> steppedSolid() {
  return prism({{0, 0}, {1.5, 0}, {1.5, 0.4}, {1, 0.4}, {1, 0.8}, {0.5, 0.8}, {0.5, 1.2}, {0, 1.2}},
               1);
}

/// A block with two round through holes.
inline std::vector<Face> holedSolid() {
  return prism(rectangle(1.6, 1), 0.5, {{0.45, 0.5, 0.2}, {1.15, 0.5, 0.25}});
}

inline std::vector<Face> bracket() {
  return prism({{0, 0}, {1.2, 0}, {1.2, 0.3}, {0.3, 0.3}, {0.3, 1.2}, {0, 1.2}}, 0.8);
}

inline std::vector<Face> cylinder() {
  Points2 polygon;
  for (int i = 0; i < 720; ++i)
    polygon.emplace_back(0.5 * std::cos(i * M_PI / 360), 0.5 * std::sin(i * M_PI / 360));
  return {lid(polygon, {}, 1.2, 1), lid(polygon, {}, 0, -1), cylinderSide(0, 0, 0.5, 0, 1.2, 1)};
}

/// A plate whose thickness is that many spacings at n points.
inline std::vector<Face> plate(double spacings, std::size_t n) {
  double thickness = 0;
  for (int i = 0; i < 20; ++i) {
    thickness = spacings * std::sqrt((2 * 2 * 1.4 + 2 * 3.4 * thickness) / static_cast<double>(n));
  }
  return prism(rectangle(2, 1.4), thickness);
}

/// Random points, uniform by area.
/// \param sigma standard deviation of Gaussian noise, in spacings
inline LabelledCloud sample(const std::string& name, const std::vector<Face>& faces, std::size_t n,
                            unsigned seed, double sigma = 0) {
  std::mt19937 rng(seed);
  LabelledCloud cloud;
  cloud.name = name;
  std::vector<double> areas;
  areas.reserve(faces.size());
  for (const Face& f : faces) areas.push_back(f.area);
  for (const double a : areas) cloud.area += a;
  cloud.spacing = std::sqrt(cloud.area / static_cast<double>(n));
  std::discrete_distribution<int> choose(areas.begin(), areas.end());
  std::normal_distribution<double> noise(0, 1);
  for (std::size_t i = 0; i < n; ++i) {
    const int face = choose(rng);
    Eigen::Vector3d p;
    Eigen::Vector3d normal;
    faces[static_cast<std::size_t>(face)].draw(rng, p, normal);
    if (sigma > 0) p += sigma * cloud.spacing * Eigen::Vector3d(noise(rng), noise(rng), noise(rng));
    for (int c = 0; c < 3; ++c) cloud.xyz.push_back(static_cast<float>(p[c]));
    for (int c = 0; c < 3; ++c) cloud.normals.push_back(static_cast<float>(normal[c]));
    cloud.xyz.push_back(0);
    cloud.normals.push_back(0);
    cloud.face.push_back(face);
  }
  return cloud;
}

}  // namespace segorient::test
