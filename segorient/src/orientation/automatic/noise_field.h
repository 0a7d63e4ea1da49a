// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/export.h>
#include <segorient/common/neighborhoods.h>
#include <segorient/common/point_view.h>

#include <cstdint>
#include <optional>
#include <vector>

#include "orientation/automatic/orient_points.h"

namespace segorient::detail {

/// 45 degrees: normals of layers that are farther off what all layers make were fitted across them.
constexpr float kAcross = 0.7F;

/// Sizes in mean distances to the six nearest points.
struct FieldScale {
  float cell;    ///< that points are averaged over
  float smooth;  ///< of the field that is solved for
  float last;    ///< of the one that points are turned by

  FieldScale times(float factor) const { return {factor * cell, factor * smooth, factor * last}; }
};
/// In noise, and smaller where there is less: cells of some four points, whose mean has half the
/// noise. Noise of a spacing is no more to the field than to its cells; at last less than that, as
/// cells have averaged some of the noise, and fine parts are lost to a wide one.
constexpr FieldScale kNoisyField{1.5F, 2.F, 1.5F};
/// Without noise: nearly each point is a cell of its own, so that the sides of walls of a spacing
/// are apart, and the field is as smooth as its dipoles are apart.
constexpr FieldScale kFineField{0.4F, 0.8F, 0.8F};

/// Where noise hides which way sheets go on, the field of all points knows more than borders do: an
/// even subset of these, with normals that agree with it.
struct NoiseField {
  std::vector<float> places;   ///< 4 floats a cell: mean position
  std::vector<float> dipoles;  ///< 4 floats a cell: normal times area, area
  float radius = 0.F;          ///< of the smoothing
  float factor = 0.F;          ///< that makes its winding number 1/2 on the surface
  float most = 1.F;            ///< confidence of any point
  /// Whether no neighbours face each other: only the field contradicts the normals' signs.
  bool consistent = false;
  /// Whether something is so thin, as pairs of neighbours tell, that the field is as fine as the
  /// noise allows.
  bool fine = false;
  /// Cosine below which normals are averaged with the field's direction: all of them, unless it is
  /// coarser than what the points themselves tell; with 0 it tells only their sides.
  float averaged_below = 1.F;
  /// One a cell, whether its normals were surely the wrong way: to turn its points may tear a
  /// sheet. Empty where none is.
  std::vector<std::uint8_t> turns;
  /// Where only parts of the cloud can be looked at: one a cell, whether to turn its points would
  /// tear a sheet. Else empty.
  std::vector<std::uint8_t> keeps;

  bool empty() const { return places.empty(); }
  PointView points() const { return {places.data(), 4, places.size() / 4}; }
};

/// Of the cloud that points are part of, see NoiseField.
struct KnownField {
  bool consistent = false;
  bool fine = false;
};

/// On an even subset with averaged positions, normals are found that agree with the winding
/// number's field (FieldSolver), with the oriented normals as they are for evidence, which weighs
/// more the more noise leaves of that number.
///
/// \param points positions as measured, finite, near ones side by side
/// \param neighborhoods of them, six at least
/// \param normals 4 floats a point, oriented
/// \param confidences of their signs, looked at where these contradict each other; empty = all
/// alike \param known none = measured
SEGORIENT_ORIENTATION_EXPORT NoiseField findNoiseField(
    const PointView& points, const Neighborhoods& neighborhoods, const std::vector<float>& normals,
    int threads, const std::vector<float>& confidences = {}, std::optional<KnownField> known = {},
    FieldScale scale = kNoisyField);

/// Finds NoiseField::keeps, for parts of the cloud that see only parts of what would be turned.
/// \param points those of the field \param normals those that it was found with
SEGORIENT_ORIENTATION_EXPORT void findWhatSheetsKeep(const PointView& points,
                                                     const Neighborhoods& neighborhoods,
                                                     const std::vector<float>& normals, int threads,
                                                     NoiseField& field);

/// Each point's normal is averaged with the direction of the field where the point was measured,
/// and turned over where that falls the other way. Where only the field says so, it tears no sheet:
/// keepSheetsWhole().
/// \param points those of the field, or some of them
/// \param found normals and confidences may change
SEGORIENT_ORIENTATION_EXPORT void takeNoiseField(const PointView& points,
                                                 const Neighborhoods& neighborhoods,
                                                 const NoiseField& field, int threads,
                                                 AutoNormals& found);

/// Where sensors tell the sides: the field's direction in the place of each normal that is across
/// it (kAcross), as planes through both faces of an edge are. No normal is turned over.
/// \param points those of the field
/// \param normals 4 floats a point, oriented
SEGORIENT_ORIENTATION_EXPORT void takeFieldLines(const PointView& points, const NoiseField& field,
                                                 int threads, std::vector<float>& normals);

/// The same as takeNoiseField() without noise, where signs contradict each other on parts hardly
/// thicker than points are apart: from a field as fine as the points. It is taken where the surface
/// is closed and the energy of the signs (SignJudge) is less.
/// \param points finite, near ones side by side
/// \param neighborhoods eight at least
/// \param found normals and confidences may change
/// \return what was taken; often nothing
SEGORIENT_ORIENTATION_EXPORT NoiseField takeFineField(const PointView& points,
                                                      const Neighborhoods& neighborhoods,
                                                      int threads, AutoNormals& found);

}  // namespace segorient::detail
