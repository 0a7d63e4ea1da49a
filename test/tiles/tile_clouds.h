// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include "io/readers.h"

namespace segorient::test {

/// A sphere of radius 1 with a cavity of radius 1/2, closed, around a place. Every fifth point is
/// on the cavity.
inline std::vector<double> hollowSphere(std::size_t n, double x, double y, double z) {
  std::vector<double> out;
  const auto add = [&](std::size_t i, std::size_t count, double radius) {
    const double h = 1.0 - 2.0 * (static_cast<double>(i) + 0.5) / static_cast<double>(count);
    const double r = std::sqrt(1.0 - h * h);
    const double angle = 2.399963229728653 * static_cast<double>(i);
    out.push_back(x + radius * r * std::cos(angle));
    out.push_back(y + radius * r * std::sin(angle));
    out.push_back(z + radius * h);
  };
  const std::size_t in_cavity = n / 5;
  for (std::size_t i = 0; i < n; ++i) {
    if (i % 5 == 4) {
      add(i / 5, in_cavity, 0.5);
    } else {
      add(i - i / 5, n - in_cavity, 1.0);
    }
  }
  return out;
}

/// Boxes one on the other, each 1 wide and deep and .5 high, the next a fifth farther out along x
/// and y: faces in contact, with steps and overhangs around them.
inline std::vector<double> stackOfBoxes(std::size_t boxes, std::size_t points_each) {
  std::mt19937 engine(7);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  const double size[3] = {1.0, 1.0, 0.5};
  std::vector<double> out;
  for (std::size_t b = 0; b < boxes; ++b) {
    for (std::size_t i = 0; i < points_each; ++i) {
      const double face = 4.0 * uniform(engine);  // by area: two of 1, four of 1/2
      const std::size_t axis = face < 2.0 ? 2 : (face < 3.0 ? 0 : 1);
      double p[3];
      for (std::size_t a = 0; a < 3; ++a) p[a] = size[a] * uniform(engine);
      p[axis] = uniform(engine) < 0.5 ? 0.0 : size[axis];
      const double shift = 0.2 * static_cast<double>(b);
      out.insert(out.end(), {p[0] + shift, p[1] + shift, p[2] + 0.5 * static_cast<double>(b)});
    }
  }
  return out;
}

/// A binary PLY of doubles.
inline std::string writeDoubles(const std::string& path, const std::vector<double>& xyz) {
  std::ofstream file(path, std::ios::binary);
  file << "ply\nformat binary_little_endian 1.0\nelement vertex " << xyz.size() / 3
       << "\nproperty double x\nproperty double y\nproperty double z\nend_header\n";
  file.write(reinterpret_cast<const char*>(xyz.data()),
             static_cast<std::streamsize>(sizeof(double) * xyz.size()));
  return path;
}

/// A binary PLY with any fields of doubles, row by row.
inline std::string writeFields(const std::string& path, const std::vector<std::string>& names,
                               const std::vector<double>& values) {
  std::ofstream file(path, std::ios::binary);
  file << "ply\nformat binary_little_endian 1.0\nelement vertex " << values.size() / names.size()
       << '\n';
  for (const std::string& name : names) file << "property double " << name << '\n';
  file << "end_header\n";
  file.write(reinterpret_cast<const char*>(values.data()),
             static_cast<std::streamsize>(sizeof(double) * values.size()));
  return path;
}

/// How many normals of `a` are turned as those of `b`; both have the same points.
inline std::size_t sameSides(const std::string& a, const std::string& b) {
  const program::CloudTable x = program::readCloud(a);
  const program::CloudTable y = program::readCloud(b);
  std::size_t same = 0;
  for (std::size_t i = 0; i < x.size && x.size == y.size; ++i) {
    const auto n = x.triple(x.normals(), i);
    const auto m = y.triple(y.normals(), i);
    same += n[0] * m[0] + n[1] * m[1] + n[2] * m[2] > 0.0 ? 1 : 0;
  }
  return same;
}

}  // namespace segorient::test
