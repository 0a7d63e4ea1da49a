// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <segorient/orientation/check_normals.h>
#include <segorient/orientation/orientation_options.h>
#include <segorient/orientation/orientation_result.h>
#include <segorient/orientation/sensors.h>

#include <array>
#include <cstddef>

namespace segorient {
namespace {

template <std::size_t N>
using Names = std::array<const char*, N>;  ///< in the order of an enum's values

constexpr Names<6> kMethods{"auto", "propagation", "boundary", "combined", "extremal", "hoppe"};
constexpr Names<9> kDecidedBy{"nothing",   "seed",         "propagation", "boundary", "extremal",
                              "enclosure", "surroundings", "global",      "hints"};
constexpr Names<4> kSensorKinds{"station", "camera", "moving", "above"};
constexpr Names<5> kSensorEvidence{"density", "layers", "image", "shadows", "woods"};
constexpr Names<4> kNormalFaults{"none", "sensor", "surface", "inside_out"};

template <std::size_t N, typename Enum>
const char* nameOf(const Names<N>& names, Enum value) {
  const auto i = static_cast<std::size_t>(value);
  return i < N ? names[i] : "unknown";
}

}  // namespace

const char* toString(OrientationMethod method) {
  return nameOf(kMethods, method);
}

const char* toString(DecidedBy by) {
  return nameOf(kDecidedBy, by);
}

const char* toString(SensorKind kind) {
  return nameOf(kSensorKinds, kind);
}

const char* toString(SensorEvidence evidence) {
  return nameOf(kSensorEvidence, evidence);
}

const char* toString(NormalFault fault) {
  return nameOf(kNormalFaults, fault);
}

bool fromString(const std::string& name, OrientationMethod& method) {
  for (std::size_t i = 0; i < kMethods.size(); ++i) {
    if (name != kMethods[i]) continue;
    method = static_cast<OrientationMethod>(i);
    return true;
  }
  return false;
}

}  // namespace segorient
