// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/neighborhoods.h>
#include <segorient/common/point_view.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace segorient {

/// How well the winding number w fits to the points, which all lie on the surface, where it is 1/2.
struct FieldFit {
  /// f that makes f w least different from 1/2: areas need not be known, which noise makes too
  /// large. 0 and less where w says that the surface has its other side outward, or nothing.
  float factor = 0.F;
  /// Mean square of f w - 1/2, (1 - mean(w)^2 / mean(w^2)) / 4: 1/4 where w says nothing.
  float spread = 0.25F;
};

/// Oriented normals that agree with the field of all points.
///
/// Dipoles m, in units of area, minimise one convex sum over points with areas a:
///
///     sum a (S w - 1/2)^2 + sum a weight |m - f n|^2
///
/// with w the winding number of the dipoles, S a mean over a point and its neighbours, as noise
/// takes points to both sides of the surface, n normals that are evidence and f their factor.
/// Without S and n this is PGR (Lin, Xiao, Shi and Wang 2022, "Surface reconstruction from point
/// clouds without normals by parametrizing the Gauss formula"). Normals are arrays of 4 floats a
/// point, of which three count.
class FieldSolver {
 public:
  /// \param points an even set, finite, near ones side by side; must outlive this
  /// \param neighborhoods of them, themselves first \param areas one a point
  /// \param radius of the smoothing
  FieldSolver(const PointView& points, const Neighborhoods& neighborhoods,
              const std::vector<float>& areas, float radius, int threads);

  /// \param weights of the evidence, one a point
  /// \return directions in which the field of the solution falls; unit
  std::vector<float> solve(const std::vector<float>& evidence,
                           const std::vector<float>& weights) const;

  FieldFit fit(const std::vector<float>& normals) const;

  /// What the means S w are off 1/2: 1/2 - factor S w. One a point.
  std::vector<float> lackOf(const std::vector<float>& normals, float factor) const;

  /// The means S w that some of the points make alone.
  /// \param rows those points, ascending
  /// \param near points that are asked for, ascending \return one a point, 0 at all others
  std::vector<float> meansNear(const std::vector<float>& normals,
                               const std::vector<std::uint32_t>& rows,
                               const std::vector<std::uint32_t>& near) const;

 private:
  std::vector<float> windingOf(const std::vector<float>& normals) const;
  std::vector<float> growthOf(const std::vector<float>& lack) const;
  float meanAround(const std::vector<float>& values, std::size_t i) const;
  std::vector<float> meansOf(std::vector<float> values) const;
  std::vector<float> sharesOf(std::vector<float> values) const;
  FieldFit fitOf(const std::vector<float>& winding) const;
  double squaresOf(const std::vector<float>& values,
                   const std::vector<float>* weights = nullptr) const;

  PointView points_;
  const Neighborhoods& neighborhoods_;
  const std::vector<float>& areas_;
  float radius_;
  int threads_;
};

}  // namespace segorient
