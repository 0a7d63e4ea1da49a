// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/neighborhoods.h>
#include <segorient/common/point_view.h>

#include <cstdint>
#include <vector>

namespace segorient {

/// What speaks against oriented normals of an even subset, whatever way they came from.
struct FieldEnergy {
  /// How unequal the winding number w is at the points, which all lie on the surface, where it is
  /// 1/2: (1 - mean(w)^2 / mean(w^2)) / 4, least mean square of f w - 1/2 over all factors f. So
  /// areas need not be known, which noise makes too large. 1/4 where w says nothing.
  float spread = 0.25F;
  /// Mean of min(f |w|, 1/2) in front of the points: an open surface pays no more than for 1/2. As
  /// its sign is arbitrary, the less of that and of the same with all normals turned over.
  float outside = 0.F;
  /// Mean over neighbours of max(0, -n.m).
  float opposed = 0.F;
};

/// Oriented normals that agree with the field of all points.
///
/// On a surface the winding number is 1/2, and its field falls along the normal. From any start,
/// dipoles take a step of least squares towards 1/2, and then the direction of the field, each the
/// size of its area: the iteration of WNNC (Lin, Shi and Liu 2024, "Fast and globally consistent
/// normal orientation based on the winding number normal consistency"), here at one width.
/// Normals are arrays of 4 floats a point, of which three count.
class FieldSolver {
 public:
  /// \param points an even set, finite, near ones side by side; must outlive this
  /// \param neighborhoods of them \param areas one a point \param radius of the smoothing
  FieldSolver(const PointView& points, const Neighborhoods& neighborhoods,
              const std::vector<float>& areas, float radius, int threads);

  /// \param normals start, all 0 for none
  std::vector<float> relax(std::vector<float> normals, int rounds) const;

  FieldEnergy energy(const std::vector<float>& normals) const;

  /// The winding number at all points. \param rows points that have dipoles, ascending; null = all
  std::vector<float> windingOf(const std::vector<float>& normals,
                               const std::vector<std::uint32_t>* rows = nullptr) const;

  /// See FieldEnergy::spread. \param factor may be null
  float spreadOf(const std::vector<float>& winding, float* factor = nullptr) const;

  /// Normals times areas, and areas.
  std::vector<float> dipolesOf(const std::vector<float>& normals) const;

 private:
  float outside(const std::vector<float>& normals, float way, float factor) const;
  void step(std::vector<float>& dipoles, bool is_first) const;

  PointView points_;
  const Neighborhoods& neighborhoods_;
  const std::vector<float>& areas_;
  float radius_;
  int threads_;
};

}  // namespace segorient
