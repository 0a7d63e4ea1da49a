// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/export.h>
#include <segorient/common/neighborhoods.h>
#include <segorient/common/point_view.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace segorient {

/// Most neighbours of a point that sheet estimation looks at.
constexpr int kSheetNeighbors = 32;

/// Neighbourhoods that planes are tried for: half as many again each time, two rings to four.
constexpr std::array<int, 4> kSheetScales{8, 12, 18, kSheetNeighbors};

/// How noisy a cloud is; 0 where no neighbourhood has a plane.
struct NoiseLevel {
  /// Median rms distance from a plane over 8 neighbours, in spacings. In a thin cloud over 8 of the
  /// point's own wall, and of points whose walls can be told apart: somewhat low, as noise that is
  /// large hides walls.
  float fine = 0.F;
  float coarse = 0.F;  ///< the same over 32, whatever walls they are of
  /// Few neighbours make no plane (`fine` would be .13 or more), and a tenth of the points or more
  /// see two walls up to two spacings apart: it is the other wall as much as noise.
  bool thin = false;
};

/// Up to this noise, in spacings, a fitted surface is nearer than any mean with its surroundings:
/// it turns the normal of ten neighbours by half a degree.
constexpr float kCleanFit = 0.05F;

/// What estimateSheetNormals() measures of a whole cloud; for a part of one it is told instead.
struct SheetTraits {
  NoiseLevel noise;
  float residual = 0.F;      ///< see SheetNormals::residual
  bool scan_scales = false;  ///< whether many points ask for the planes that scans need
  bool lines = false;        ///< whether the neighbours of many points are of one line

  /// Whether the noise of this scan is one that only many neighbours show. Steps of depth, rings
  /// and rough ground hide from few what they are to many: normals err alike side by side.
  bool onlyManyShowNoise() const {
    // Of the residuals of 32 neighbours and of 8: noise from point to point makes them the same,
    // what a plane does not follow grows with the neighbours, to four times. Halfway.
    constexpr float kSeenByFew = 2.F;
    return scan_scales && noise.coarse >= std::max(kCleanFit, kSeenByFew * noise.fine);
  }
};

/// Options of estimateSheetNormals(). Each step can be switched off to see what it is worth.
struct SheetNormalOptions {
  bool split_walls = true;     ///< keep the points of a parallel wall nearby out of the fit
  bool dominant_plane = true;  ///< at edges, fit the plane that most neighbours lie on
  int threads = 0;             ///< see resolveThreads()
  /// For what sensors saw: where noise and rings ask for larger neighbourhoods than the cloud's
  /// median does, up to 60. Not for solids, whose thin walls it takes for noise.
  bool scan_scales = false;
  /// The same where the points look like a scan's: they lie on lines, or in noise their spacing
  /// varies much. See showsScanLines() and isUneven().
  bool scan_lines = true;
  /// Of the cloud that the points are part of; none = measured, and scan_scales as it says.
  std::optional<SheetTraits> known;
};

/// Normals that each come from one sheet of the surface (one wall of a plate, one face at an edge),
/// with what is known about that sheet around each point. All arrays have one entry a point.
///
/// A neighbour q of p lies on p's sheet, as far as p can tell, if its offset (q - p) . n is between
/// `below` and `above`; points of another wall fall outside.
struct SheetNormals {
  std::vector<float> normals;  ///< 4 floats: unoriented unit normal, rms residual in spacings; NaN
                               ///< where the neighbourhood has no plane
  std::vector<float> curvature;  ///< smallest variance in the sum of all three, as in PCL; NaN
  std::vector<float> spacing;    ///< h: mean distance to the 6 nearest
  std::vector<float> below;  ///< lower end of the offsets of p's own sheet, in the cloud's unit;
                             ///< -infinity where there is no wall below
  std::vector<float> above;  ///< upper end; infinity where there is none above
  std::vector<std::uint8_t> reliable;  ///< 1 where the fit is central and as good as most
  float residual = 0.F;                ///< median residual of the final fits, in spacings
  SheetTraits traits;                  ///< as measured, or as told
};

namespace detail {
class MoreNeighbors;

/// From here on, noise hides what the smallest neighbourhoods could tell. A plane leaves .13 of
/// eight neighbours and the point with noise of s = .17, which tilts it by sqrt(2) s / (3 * .75),
/// .75 being their extent along an axis: by 6 degrees, and by 15 in 2.5 standard deviations.
constexpr float kFewTellNothing = 0.13F;
/// The first of kSheetScales that noise leaves.
int smallestNeighbors(float noise);
}  // namespace detail

/// Estimates sheet normals.
///
/// For each point: planes over 8, 12, 18 and 32 neighbours, from the largest down a smaller one
/// where it is clearly flatter; at edges the plane through the point that most of its neighbours
/// lie on; then twice: Otsu's threshold on the offsets along the normal tells two walls apart, and
/// the plane is fitted again to the point's own. Walls more than 1.25 spacings apart (2 in thin
/// clouds, see NoiseLevel) are no walls to it.
/// In clouds of lines, neighbours on a conic have no say: the plane of a contour is not that of the
/// surface, see tellsSlope().
///
/// With scan_scales, points that ask for clearly larger neighbourhoods than that, as in scans near
/// their sensor and between rings, have planes of up to 60 neighbours, if there are many of them.
/// So they do with scan_lines in clouds that look like scans.
///
/// \param points distinct finite points
/// \param neighborhoods their neighbours: kSheetNeighbors beside the point itself, or as many
///        as there are
/// \param more of the same points, for scan_scales; null = sought here
SEGORIENT_FEATURES_EXPORT SheetNormals estimateSheetNormals(const PointView& points,
                                                            const Neighborhoods& neighborhoods,
                                                            const SheetNormalOptions& options = {},
                                                            detail::MoreNeighbors* more = nullptr);

/// Measures the noise at some thousand of a cloud's points.
/// \param points distinct finite points
/// \param neighborhoods their neighbours, as for estimateSheetNormals()
/// \param threads see resolveThreads(); the result does not depend on it
SEGORIENT_FEATURES_EXPORT NoiseLevel measureNoise(const PointView& points,
                                                  const Neighborhoods& neighborhoods,
                                                  int threads = 0);

}  // namespace segorient
