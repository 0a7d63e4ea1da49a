// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "common/dot.h"
#include "orientation/mirrored_agreement.h"

namespace segorient::detail {

using Vec3 = std::array<float, 3>;

inline float dot(const Vec3& a, const Vec3& b) {
  return segorient::dot(a.data(), b.data());
}

/// Points of one label on one sheet: mean offset from somewhere, in spacings, and mean signed
/// normal.
struct SheetGroup {
  std::int32_t label = -1;
  bool wall = false;
  float count = 0.F;
  Vec3 mean{0.F, 0.F, 0.F};
  Vec3 normal{0.F, 0.F, 0.F};

  void add(const Vec3& offset, const float* n, float sign) {
    count += 1.F;
    for (std::size_t a = 0; a < 3; ++a) {
      mean[a] += offset[a];
      normal[a] += sign * n[a];
    }
  }
  void finish() {
    const float l = std::sqrt(dot(normal, normal));
    for (std::size_t a = 0; a < 3; ++a) {
      mean[a] /= count;
      normal[a] = l > 0.F ? normal[a] / l : 0.F;
    }
  }
  /// Whether two finished groups agree, -1 to 1; see borderVotes().
  float compare(const SheetGroup& other) const {
    if (other.wall) return -dot(normal, other.normal);
    const Vec3 chord{other.mean[0] - mean[0], other.mean[1] - mean[1], other.mean[2] - mean[2]};
    // A quarter of a squared spacing: chords shorter than that have no direction.
    const float square = dot(chord, chord) + 0.25F;
    if (!(square < std::numeric_limits<float>::max())) return 0.F;  // as many spacings long
    return mirroredAgreement(normal.data(), other.normal.data(), chord.data(), square);
  }
  /// Whether one of two finished groups lies above the other and is parallel to it, as the walls of
  /// a plate or the turns of a roll; or as noise within one sheet, whose votes are no better.
  bool isAbove(const SheetGroup& other) const {
    constexpr float kSameGroup = 0.9F;  // within 26 degrees
    const Vec3 chord{other.mean[0] - mean[0], other.mean[1] - mean[1], other.mean[2] - mean[2]};
    const float half = 0.5F * dot(chord, chord);  // nearer to the normal than to the surface
    const float along = dot(normal, chord);
    const float other_along = dot(other.normal, chord);
    return along * along > half && other_along * other_along > half &&
           std::fabs(dot(normal, other.normal)) > kSameGroup;
  }
};

}  // namespace segorient::detail
