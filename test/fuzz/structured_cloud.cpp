// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "structured_cloud.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

namespace segorient::test {
namespace {

using Limits = std::numeric_limits<float>;

constexpr std::array<float, 16> kExtremes{0.F,
                                          -0.F,
                                          1.F,
                                          1e-30F,
                                          1e30F,
                                          -1e30F,
                                          1e-41F,
                                          1e-20F,
                                          1e18F,
                                          1e20F,
                                          4.5e6F,
                                          0.1F,
                                          Limits::max(),
                                          Limits::lowest(),
                                          Limits::quiet_NaN(),
                                          Limits::infinity()};

// Pieces; each adds at most as many points as there is room for.
class Maker {
 public:
  Maker(ByteReader& reader, std::size_t most) : reader_(reader), most_(most) {}

  StructuredCloud make() {
    while (!reader_.empty() && cloud_.size() < most_) piece(reader_.below(10));
    return std::move(cloud_);
  }

 private:
  void piece(std::size_t kind) {
    switch (kind) {
      case 0:
        return add(reader_.whole(), reader_.whole(), reader_.whole());
      case 1:
        return add(reader_.any(), reader_.any(), reader_.any());
      case 2:
        return add(extreme(), extreme(), extreme());
      case 3:
        return grid();
      case 4:
        return line();
      case 5:
        return patch();
      case 6:
        return ball();
      case 7:
        return repeat();
      case 8:
        return secondSheet();
      default:
        return transform();
    }
  }

  void add(float x, float y, float z) {
    if (cloud_.size() < most_) cloud_.add(x, y, z);
  }
  float extreme() { return kExtremes[reader_.below(kExtremes.size())]; }
  float random() { return std::uniform_real_distribution<float>(-1.F, 1.F)(random_); }

  void grid() {
    const std::size_t nx = 1 + reader_.below(8);
    const std::size_t ny = 1 + reader_.below(8);
    const std::size_t nz = 1 + reader_.below(4);
    for (std::size_t z = 0; z < nz; ++z) {
      for (std::size_t y = 0; y < ny; ++y) {
        for (std::size_t x = 0; x < nx; ++x) {
          add(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z));
        }
      }
    }
  }
  void line() {
    const float d[3] = {reader_.whole(), reader_.whole(), reader_.whole()};
    const std::size_t count = reader_.below(32);
    for (std::size_t i = 0; i < count; ++i) {
      const auto t = static_cast<float>(i);
      add(t * d[0], t * d[1], t * d[2]);
    }
  }
  // Random points of a plane, with noise on some.
  void patch() {
    random_.seed(reader_.byte());
    const float noise = reader_.below(2) == 0 ? 0.F : 0.05F;
    const std::size_t count = reader_.below(64);
    for (std::size_t i = 0; i < count; ++i) add(random(), random(), noise * random());
  }
  void ball() {
    random_.seed(reader_.byte());
    const std::size_t count = reader_.below(64);
    for (std::size_t i = 0; i < count; ++i) {
      const float x = random();
      const float y = random();
      const float z = random();
      const float r = std::max(std::sqrt(x * x + y * y + z * z), 0.01F);
      add(x / r, y / r, z / r);
    }
  }
  // Some of the points so far once more.
  void repeat() {
    const std::size_t from = reader_.byte();
    const std::size_t count = reader_.below(32);
    for (std::size_t i = 0; i < count && from < cloud_.size(); ++i) {
      const float* p = &cloud_.xyz[4 * from];
      add(p[0], p[1], p[2]);
    }
  }
  // All points so far once more, moved by a little.
  void secondSheet() {
    const float offset = std::ldexp(reader_.whole(), -8);
    const std::size_t count = cloud_.size();
    for (std::size_t i = 0; i < count; ++i) {
      const float* p = &cloud_.xyz[4 * i];
      add(p[0], p[1], p[2] + offset);
    }
  }
  // All points so far, scaled or moved.
  void transform() {
    const std::size_t axis = reader_.below(4);
    const bool scale = reader_.below(2) == 0;
    const float by = scale ? std::ldexp(1.F, static_cast<int>(reader_.whole())) : extreme();
    for (std::size_t i = 0; i < cloud_.size(); ++i) {
      for (std::size_t a = 0; a < 3; ++a) {
        float& v = cloud_.xyz[4 * i + a];
        if (axis == 3 || axis == a) v = scale ? v * by : v + by;
      }
    }
  }

  ByteReader& reader_;
  std::size_t most_;
  StructuredCloud cloud_;
  std::minstd_rand random_;
};

}  // namespace

StructuredCloud readCloud(ByteReader& reader, std::size_t most) {
  return Maker(reader, most).make();
}

std::vector<std::size_t> shuffledRows(std::size_t size, std::uint32_t seed) {
  std::vector<std::size_t> rows(size);
  std::iota(rows.begin(), rows.end(), std::size_t{0});
  std::shuffle(rows.begin(), rows.end(), std::minstd_rand(seed));
  return rows;
}

}  // namespace segorient::test
