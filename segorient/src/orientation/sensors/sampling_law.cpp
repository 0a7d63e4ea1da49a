// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/sensors/sampling_law.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "orientation/sensors/simplex.h"

namespace segorient::detail {
namespace {

// What is seen at more than 88 degrees from its normal is noise.
constexpr float kGrazing = 0.03F;
// A grid of angles is not finer than this towards its poles: scanners' heads are in the way.
constexpr float kPole = 0.01F;
// A pinhole camera sees no more than 84 degrees from its axis.
constexpr float kWidest = 0.1F;

// Natural logarithm of a positive normal number to 1e-5, which loops can do several at a time: a
// polynomial for the mantissa (Chebyshev nodes on 1 to 2).
inline float fastLog(float v) {
  std::uint32_t bits = 0;
  std::memcpy(&bits, &v, sizeof(bits));
  const auto exponent = static_cast<float>(static_cast<std::int32_t>(bits >> 23U) - 127);
  bits = (bits & 0x007fffffU) | 0x3f800000U;
  float m = 0.F;
  std::memcpy(&m, &bits, sizeof(m));
  const float polynomial =
      -1.93675974F +
      m * (3.5140873F +
           m * (-2.44002976F + m * (1.11609003F + m * (-0.283826848F + m * 0.0304490045F))));
  return 0.693147181F * exponent + polynomial;
}

// What the place leaves on each piece.
template <SamplingLaw law>
void lawAt(const DensityPatches& patches, const Place& place, float* out) {
  const auto px = static_cast<float>(place.position[0]);
  const auto py = static_cast<float>(place.position[1]);
  const auto pz = static_cast<float>(place.position[2]);
  const auto ax = static_cast<float>(place.axis[0]);
  const auto ay = static_cast<float>(place.axis[1]);
  const auto az = static_cast<float>(place.axis[2]);
  const std::size_t n = patches.size();
#pragma omp simd
  for (std::size_t i = 0; i < n; ++i) {
    const float vx = px - patches.x[i];
    const float vy = py - patches.y[i];
    const float vz = pz - patches.z[i];
    const float d2 = std::max(vx * vx + vy * vy + vz * vz, 1e-12F);
    const float d = std::sqrt(d2);
    const float along = std::fabs(vx * patches.nx[i] + vy * patches.ny[i] + vz * patches.nz[i]);
    const float facing = std::max(along, kGrazing * d);  // times d
    float law_density = 0.F;
    if constexpr (law == SamplingLaw::SOLID_ANGLE) {
      law_density = facing / (d * d2);
    } else {
      const float height = vx * ax + vy * ay + vz * az;
      if constexpr (law == SamplingLaw::ANGLE_GRID) {
        law_density = facing / (d2 * std::sqrt(std::max(d2 - height * height, kPole * d2)));
      } else {
        const float depth = std::max(-height, kWidest * d);
        law_density = facing / (depth * depth * depth);
      }
    }
    out[i] = std::max(law_density, 1e-30F);
  }
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
  switch (place.law) {
    case SamplingLaw::SOLID_ANGLE:
      lawAt<SamplingLaw::SOLID_ANGLE>(patches, place, out.data());
      break;
    case SamplingLaw::ANGLE_GRID:
      lawAt<SamplingLaw::ANGLE_GRID>(patches, place, out.data());
      break;
    case SamplingLaw::PINHOLE:
      lawAt<SamplingLaw::PINHOLE>(patches, place, out.data());
      break;
  }
}

}  // namespace

void takeLogs(std::vector<float>& values) {
  float* v = values.data();
  const std::size_t n = values.size();
#pragma omp simd
  for (std::size_t i = 0; i < n; ++i) v[i] = fastLog(std::max(v[i], 1e-30F));
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
