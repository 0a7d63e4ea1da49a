// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
//
// Clouds of any size whose normals are known: a plant of tanks, spheres, boxes, rings and long
// pipes, of one density. Written and checked point by point.
//   large_cloud make FILE.ply POINTS [scattered]   in the order of the parts, or in none
//   large_cloud check RESULT.ply POINTS [scattered] the share of normals that point outward
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iostream>
#include <string>
#include <vector>

namespace {

using Vec = std::array<double, 3>;

constexpr double kTurn = 6.283185307179586;
constexpr double kPitch = 12.0;  // from part to part
constexpr double kPointsPerPart = 40000.0;

// Numbers in [0, 1) that depend on the point and on which of its numbers it is.
double uniform(std::uint64_t point, std::uint64_t number) {
  std::uint64_t x = point * 8 + number + 0x9e3779b97f4a7c15ULL;
  x = (x ^ x >> 33) * 0xff51afd7ed558ccdULL;
  x = (x ^ x >> 33) * 0xc4ceb9fe1a85ec53ULL;
  return static_cast<double>((x ^ x >> 33) >> 11) * 0x1.0p-53;
}

struct Sample {
  Vec place;
  Vec normal;
};

Sample onSphere(double radius, double u, double v) {
  const double z = 2.0 * u - 1.0;
  const double r = std::sqrt(1.0 - z * z);
  const Vec n{r * std::cos(kTurn * v), r * std::sin(kTurn * v), z};
  return {{radius * n[0], radius * n[1], radius * n[2]}, n};
}

Sample onBox(const Vec& half, double u, double v, double which) {
  const Vec area{half[1] * half[2], half[0] * half[2], half[0] * half[1]};
  double at = which * (area[0] + area[1] + area[2]);
  std::size_t a = 0;
  while (a < 2 && at >= area[a]) at -= area[a++];
  const double side = at < 0.5 * area[a] ? -1.0 : 1.0;
  Sample s{};
  s.normal[a] = side;
  s.place[a] = side * half[a];
  s.place[(a + 1) % 3] = (2.0 * u - 1.0) * half[(a + 1) % 3];
  s.place[(a + 2) % 3] = (2.0 * v - 1.0) * half[(a + 2) % 3];
  return s;
}

// With lids, along z.
Sample onCylinder(double radius, double half, double u, double v, double which) {
  const double lids = radius;
  const double mantle = 2.0 * half;
  const double at = which * (lids + mantle);
  const double c = std::cos(kTurn * v);
  const double s = std::sin(kTurn * v);
  if (at < mantle) return {{radius * c, radius * s, (2.0 * u - 1.0) * half}, {c, s, 0.0}};
  const double side = at < mantle + 0.5 * lids ? -1.0 : 1.0;
  const double r = radius * std::sqrt(u);
  return {{r * c, r * s, side * half}, {0.0, 0.0, side}};
}

Sample onRing(double radius, double tube, double u, double v) {
  // By area: the outer half has more.
  double angle = kTurn * u;
  for (int i = 0; i < 20; ++i) {
    angle -= (angle + tube / radius * std::sin(angle) - kTurn * u) /
             (1.0 + tube / radius * std::cos(angle));
  }
  const Vec n{std::cos(angle) * std::cos(kTurn * v), std::cos(angle) * std::sin(kTurn * v),
              std::sin(angle)};
  return {{(radius + tube * std::cos(angle)) * std::cos(kTurn * v),
           (radius + tube * std::cos(angle)) * std::sin(kTurn * v), tube * std::sin(angle)},
          n};
}

// All kinds have about 100 square units of surface but pipes, which run through 16 parts' places.
class Plant {
 public:
  explicit Plant(std::uint64_t points) : points_(points) {
    parts_ = std::max<std::uint64_t>(
        1, static_cast<std::uint64_t>(static_cast<double>(points) / kPointsPerPart));
    side_ = static_cast<std::uint64_t>(std::ceil(std::sqrt(static_cast<double>(parts_))));
  }

  Sample at(std::uint64_t row, bool scattered) const {
    const std::uint64_t part =
        scattered ? static_cast<std::uint64_t>(uniform(row, 7) * static_cast<double>(parts_))
                  : row * parts_ / points_;
    const double u = uniform(row, 0);
    const double v = uniform(row, 1);
    const double which = uniform(row, 2);
    Sample s{};
    switch (part % 5) {
      case 0:
        s = onSphere(2.8, u, v);
        break;
      case 1:
        s = onBox({2.0, 2.5, 1.7}, u, v, which);
        break;
      case 2:
        s = onCylinder(2.0, 3.0, u, v, which);
        break;
      case 3:
        s = onRing(3.0, 0.85, u, v);
        break;
      default:  // a pipe, turned to lie along x, above all others
        s = onCylinder(0.18, 44.0, u, v, which);
        for (Vec* x : {&s.place, &s.normal}) *x = {(*x)[2], (*x)[0], (*x)[1]};
        s.place[2] += 6.0;
    }
    s.place[0] += kPitch * static_cast<double>(part % side_);
    s.place[1] += kPitch * static_cast<double>(part / side_);
    return s;
  }

 private:
  std::uint64_t points_;
  std::uint64_t parts_;
  std::uint64_t side_;
};

int make(const std::string& path, std::uint64_t points, bool scattered) {
  const Plant plant(points);
  std::ofstream file(path, std::ios::binary);
  file << "ply\nformat binary_little_endian 1.0\nelement vertex " << points
       << "\nproperty float x\nproperty float y\nproperty float z\nend_header\n";
  std::vector<float> block;
  for (std::uint64_t row = 0; row < points; ++row) {
    for (const double x : plant.at(row, scattered).place) block.push_back(static_cast<float>(x));
    if (block.size() < 196608 && row + 1 < points) continue;
    file.write(reinterpret_cast<const char*>(block.data()),
               static_cast<std::streamsize>(4 * block.size()));
    block.clear();
  }
  file.flush();
  return file ? 0 : 1;
}

// Binary PLY as segorient writes it: floats x y z nx ny nz first.
int check(const std::string& path, std::uint64_t points, bool scattered) {
  const Plant plant(points);
  std::ifstream file(path, std::ios::binary);
  std::size_t bytes = 0;
  for (std::string line; std::getline(file, line) && line != "end_header";) {
    if (line.rfind("property ", 0) != 0) continue;
    bytes += line.rfind("property uchar", 0) == 0 ? 1 : 4;
  }
  std::vector<char> row_bytes(bytes);
  std::uint64_t right = 0;
  for (std::uint64_t row = 0; row < points; ++row) {
    if (!file.read(row_bytes.data(), static_cast<std::streamsize>(bytes))) return 1;
    float xyzn[6];
    std::memcpy(xyzn, row_bytes.data(), sizeof(xyzn));
    const Vec n = plant.at(row, scattered).normal;
    double dot = 0.0;
    for (std::size_t a = 0; a < 3; ++a) dot += n[a] * static_cast<double>(xyzn[3 + a]);
    right += dot > 0.0 ? 1 : 0;
  }
  std::printf("outward %.5f %%\n",
              100.0 * static_cast<double>(right) / static_cast<double>(points));
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> words(argv + 1, argv + argc);
  if (words.size() < 3 || (words[0] != "make" && words[0] != "check")) {
    std::cerr << "large_cloud make|check FILE.ply POINTS [scattered]\n";
    return 2;
  }
  const std::uint64_t points = std::stoull(words[2]);
  const bool scattered = words.size() > 3;
  return words[0] == "make" ? make(words[1], points, scattered)
                            : check(words[1], points, scattered);
}
