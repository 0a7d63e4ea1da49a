// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/sensors/sampling_law.h"

#include <algorithm>
#include <cmath>

#include "common/compiler.h"
#include "common/vectors.h"
#include "common/widest.h"
#include "orientation/sensors/simplex.h"

namespace segorient::detail {
namespace {

// A grid of angles is not finer than this towards its poles: scanners' heads are in the way.
constexpr float kPole = 0.01F;
// Where rays end, in sines of elevations: a piece is about as wide as that, seen from a tripod.
constexpr float kFade = 0.05F;
// A pinhole camera sees no more than 84 degrees from its axis.
constexpr float kWidest = 0.1F;

// A place and an axis as floats, and pieces as arrays.
struct Sight {
  Sight(const DensityPatches& patches, const Place& place)
      : x(patches.x.data()),
        y(patches.y.data()),
        z(patches.z.data()),
        nx(patches.nx.data()),
        ny(patches.ny.data()),
        nz(patches.nz.data()),
        count(patches.size()),
        at(toFloat(place.position)),
        axis(toFloat(place.axis)),
        lowest(place.lowest) {}

  const float* x;
  const float* y;
  const float* z;
  const float* nx;
  const float* ny;
  const float* nz;
  std::size_t count;
  std::array<float, 3> at;
  std::array<float, 3> axis;
  float lowest;
};

}  // namespace

#define SEGORIENT_KERNELS "orientation/sensors/density_lanes.inl"
#include "common/each_width.inl"
#undef SEGORIENT_KERNELS

namespace {

struct Kernels {
  using Law = void (*)(const Sight&, float*);
  Law solid_angle = SEGORIENT_WIDEST(leave<SamplingLaw::SOLID_ANGLE>);
  Law angle_grid = SEGORIENT_WIDEST(leave<SamplingLaw::ANGLE_GRID>);
  Law pinhole = SEGORIENT_WIDEST(leave<SamplingLaw::PINHOLE>);
  void (*logs)(float*, std::size_t) = SEGORIENT_WIDEST(logs);
};

const Kernels& kernels() {
  static const Kernels chosen;
  return chosen;
}

std::array<double, 3> unit(const std::array<double, 3>& v) {
  const double length = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
  if (!(length > 1e-9)) return {0.0, 0.0, 1.0};
  return {v[0] / length, v[1] / length, v[2] / length};
}

// Two directions across an axis.
std::array<std::array<double, 3>, 2> across(const std::array<double, 3>& axis) {
  std::array<double, 3> other{0.0, 0.0, 0.0};
  other[std::fabs(axis[0]) < 0.7 ? 0 : 1] = 1.0;
  const std::array<double, 3> a =
      unit({axis[1] * other[2] - axis[2] * other[1], axis[2] * other[0] - axis[0] * other[2],
            axis[0] * other[1] - axis[1] * other[0]});
  const std::array<double, 3> b{axis[1] * a[2] - axis[2] * a[1], axis[2] * a[0] - axis[0] * a[2],
                                axis[0] * a[1] - axis[1] * a[0]};
  return {a, b};
}

void densitiesAt(const DensityPatches& patches, const Place& place, std::vector<float>& out) {
  out.resize(patches.size());
  const Sight sight(patches, place);
  switch (place.law) {
    case SamplingLaw::SOLID_ANGLE:
      kernels().solid_angle(sight, out.data());
      break;
    case SamplingLaw::ANGLE_GRID:
      kernels().angle_grid(sight, out.data());
      break;
    case SamplingLaw::PINHOLE:
      kernels().pinhole(sight, out.data());
      break;
  }
}

}  // namespace

void takeLogs(std::vector<float>& values) {
  kernels().logs(values.data(), values.size());
}

void residuals(const DensityPatches& patches, const Place& place, std::vector<float>& out) {
  densitiesAt(patches, place, out);
  takeLogs(out);
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = patches.log_density[i] - out[i];
}

void ratios(const DensityPatches& patches, const Place& place, std::vector<float>& out) {
  densitiesAt(patches, place, out);
  for (std::size_t i = 0; i < out.size(); ++i) out[i] *= patches.sparsity[i];
}

float costOf(const DensityPatches& patches, const Place& place, std::vector<float>& scratch) {
  // A search may run away; floats must be able to square the distance.
  constexpr double kFar = 1e6;
  if (patches.size() == 0) return 0.F;
  const double first[3] = {static_cast<double>(patches.x[0]), static_cast<double>(patches.y[0]),
                           static_cast<double>(patches.z[0])};
  for (std::size_t a = 0; a < 3; ++a) {
    if (!(std::fabs(place.position[a] - first[a]) < kFar)) return kDeviationCut;
  }
  residuals(patches, place, scratch);
  return deviation(scratch);
}

std::array<double, 3> meanView(const DensityPatches& patches, const std::array<double, 3>& from) {
  const auto px = static_cast<float>(from[0]);
  const auto py = static_cast<float>(from[1]);
  const auto pz = static_cast<float>(from[2]);
  float sum[3] = {0.F, 0.F, 0.F};
  for (std::size_t i = 0; i < patches.size(); ++i) {
    const float v[3] = {patches.x[i] - px, patches.y[i] - py, patches.z[i] - pz};
    const float d = std::sqrt(std::max(v[0] * v[0] + v[1] * v[1] + v[2] * v[2], 1e-12F));
    for (int a = 0; a < 3; ++a) sum[a] += v[a] / d;
  }
  return unit(
      {static_cast<double>(sum[0]), static_cast<double>(sum[1]), static_cast<double>(sum[2])});
}

float refinePlace(const DensityPatches& patches, double step, bool free_axis, int evaluations,
                  Place& place) {
  constexpr double kTilt = 0.1;  // radians, at first
  const bool has_axis = place.law != SamplingLaw::SOLID_ANGLE;
  if (place.law == SamplingLaw::PINHOLE) place.axis = meanView(patches, place.position);
  const Place start = place;
  const std::array<std::array<double, 3>, 2> sideways = across(start.axis);
  std::vector<double> values;
  std::vector<double> steps;
  if (step > 0.0) {
    values.insert(values.end(), start.position.begin(), start.position.end());
    steps.assign(3, step);
  }
  if (has_axis && free_axis) {
    values.insert(values.end(), 2, 0.0);
    steps.insert(steps.end(), 2, kTilt);
  }
  const auto placeAt = [&](const std::vector<double>& v) {
    Place out = start;
    std::size_t next = 0;
    if (step > 0.0) {
      for (std::size_t a = 0; a < 3; ++a) out.position[a] = v[next++];
    }
    if (has_axis && free_axis) {
      for (std::size_t a = 0; a < 3; ++a) {
        out.axis[a] += v[next] * sideways[0][a] + v[next + 1] * sideways[1][a];
      }
      out.axis = unit(out.axis);
    } else if (place.law == SamplingLaw::PINHOLE && step > 0.0) {
      out.axis = meanView(patches, out.position);
    }
    return out;
  };
  std::vector<float> scratch;
  if (values.empty()) return costOf(patches, place, scratch);
  const auto cost = [&](const std::vector<double>& v) {
    return static_cast<double>(costOf(patches, placeAt(v), scratch));
  };
  const double least = minimize(cost, steps, evaluations, values);
  place = placeAt(values);
  return static_cast<float>(least);
}

}  // namespace segorient::detail
