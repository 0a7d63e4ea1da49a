// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/export.h>
#include <segorient/common/point_view.h>

#include <array>
#include <vector>

#include "orientation/sensors/flat_points.h"

namespace segorient::detail {

/// What a place says about steps of depth: about points on a surface that have a nearer surface
/// beside or before them as seen from there, and nothing in between.
///
/// What a sensor saw ends at the shadow of what is nearer; a surface that was not seen from there
/// goes on behind it. Unlike densities, that is the same in thinned clouds.
struct Shadows {
  float steps = 0.F;    ///< such points, of those on surfaces; 0 where they are too few to tell
  float covered = 0.F;  ///< with nearer points all around that are on surfaces, too
  /// With nearer points all around, whether on surfaces or not: in noise few show to be.
  float hidden = 0.F;

  float open = 1.F;  ///< of all directions, those where there is nothing; 1 if nobody looked
  /// Whether the place across the middle says as much: of a landscape that something far above it
  /// saw, steps look much alike from far below.
  bool better_across = false;

  float coveredOfSteps() const { return steps > 0.F ? covered / steps : 0.F; }
  /// Whether surfaces end where a sensor in that place would have it.
  bool confirm() const;
  /// Whether that is so where nobody said that there was a sensor, and the place is not enclosed
  /// by what is there: bodies are seen whole from some places inside.
  bool reveal() const;
  /// Whether the place is enclosed, but for openings: where nothing was seen below a tripod, or
  /// through a window.
  bool inARoom() const;
  /// Whether there is something in all directions, but for .005 of them, and it hides nothing: as
  /// in a body, unlike in a room with something in it.
  bool enclose() const;
  /// Whether they go on.
  bool deny() const;
  /// Whether more of them go on, however few they are, than as seen from where a sensor stood: of a
  /// place that densities tell of.
  bool contradict() const;
  /// Whether there is a surface in all directions, and nothing of it hides anything: as in a body,
  /// or in an empty room, which has walls.
  bool hideNothing(bool has_walls) const;
  /// Whether it looks as from within a body: there is a surface in all directions, and nothing of
  /// it hides anything, as no tripod leaves a room, or what should be hidden is there; or as from
  /// beside one, all of which is there.
  /// \param has_walls as rooms have: one may be empty, and seen by two scanners
  /// \param is_one_of_several places that sensors were found in: in a room each of them saw what is
  ///        hidden from others
  bool asOfABody(bool has_walls, bool is_one_of_several = false) const;
  /// Whether there are steps enough, and they do not deny it.
  bool allow() const;
  /// Whether there are steps enough that do not contradict it, and half of all directions are
  /// empty, as of scenes that were seen from some places close together.
  bool suit() const;
  /// Whether points that lie behind others from there are no more than errors at steps, and the
  /// place is not enclosed.
  bool excuse() const;
};

/// Whether places that sensors were found in are in one body, or beside it: each looks like it, or
/// from most of them nothing hides anything, and there is something all around. Those of a sensor
/// on its way are at a body that hides nothing, too, unless it has walls and is around them: an
/// empty street is, true ones had .03 of the points or more beside what is nearer.
bool areAtOneBody(const std::vector<Shadows>& places, bool has_walls, bool on_its_way);

/// \param place in the points' unit
SEGORIENT_ORIENTATION_EXPORT Shadows findShadows(const PointView& points,
                                                 const std::array<float, 3>& place, int threads);

/// The same of what several places are asked of.
/// \param to_reveal whether it only matters that they reveal a sensor: of places that are enclosed,
///        as most in bodies are, it is known without a look at any step that they do not
Shadows findShadows(const FlatPoints& flat, const std::array<float, 3>& place, int threads,
                    bool to_reveal = false);

}  // namespace segorient::detail
