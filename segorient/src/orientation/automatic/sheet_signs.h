// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/neighborhoods.h>
#include <segorient/common/point_view.h>
#include <segorient/orientation/orientation_options.h>
#include <segorient/segmentation/segmentation.h>
#include <segorient/common/impl/fast_vector.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/at.h"
#include "orientation/automatic/border_votes.h"
#include "orientation/automatic/orient_sheets.h"
#include "orientation/automatic/segment_clusters.h"
#include "orientation/sensors/hint_votes.h"
#include "orientation/sensors/known_sensors.h"
#include "orientation/sensors/point_hints.h"
#include "orientation/winding/winding_components.h"
#include "segmentation/sheet_segmentation.h"

namespace segorient::detail {

/// Residual of the winding number of clean closed clouds: they have .00 to .03.
constexpr float kClosedResidual = 0.03F;
/// Noise of half a spacing adds .045 on a plane of even points and .06 on one of random points,
/// more noise .07 at most.
constexpr float kOpenResidual = 0.1F;
/// For a spacing of noise, up to half a one: as it adds to planes.
constexpr float kResidualOfNoise = 0.1F;
/// Evidence of less is that of a plane, or of an isolated point: nothing tells in from out.
constexpr float kNoEvidence = 0.01F;
constexpr float kClearly = 0.6F;  ///< four of five votes
/// Agreement of borders, as votes for less votes against: what is known of single points, and what
/// patches show as a whole, outweighs all that are not as firm as the first, and what could merely
/// have been seen those that are not as sure as the second (three of four).
constexpr float kFirmBorders = 0.9F;
constexpr float kSureBorders = 0.5F;

/// Segments while the stages of orientSheets() turn them over: what is known of them, their signs
/// so far, and what several stages ask.
struct SheetSigns {
  /// Signs by the borders' votes, relative to each other within each component. The parameters are
  /// those of orientSheets(); all but the votes must outlive this.
  SheetSigns(const PointView& all, const Neighborhoods& neighborhoods,
             const SheetField& sheet_field, const Segmentation& segments,
             std::vector<BorderVote> border_votes, std::size_t count,
             const AutomaticOptions& settings, const PointHints& known, int most_threads);

  /// Finds which way each component is outward, by the winding number.
  void windComponents();

  /// The sign of a point's normal so far, 0 without a segment.
  float pointSign(std::size_t i) const {
    const std::int32_t s = segmentation.labels[i];
    return s < 0 ? 0.F
                 : static_cast<float>(segmentation.signs[i] * signs[static_cast<std::size_t>(s)]);
  }
  /// The component of a point, -1 without a segment.
  std::int32_t componentOf(std::size_t i) const {
    const std::int32_t s = segmentation.labels[i];
    return s < 0 ? -1 : component_of[at(s)];
  }
  /// The points of each component that are here: of tiles, its result counts others.
  std::vector<std::size_t> componentSizes() const;
  /// The component of each cluster, -1 for names of none.
  std::vector<std::int32_t> componentsOfClusters() const;
  /// 4 floats a point: normal times area and area; 0 without one.
  FastVector<float> dipoles() const;
  /// What is known of segments, one a point; -1 without a segment.
  std::vector<std::int32_t> ofPoints(const std::vector<std::int32_t>& of_segments) const;
  /// Whether a component is told or known to be closed. \param residual most of the winding
  /// number's
  bool isClosed(std::size_t component, float residual) const;
  /// Whether the winding number tells that it is, ground or not.
  bool looksClosed(std::size_t component, float residual) const {
    return options.wind_components && hints.surface != SurfaceKind::OPEN &&
           windings[component].residual <= residual;
  }
  /// What that is where everything is closed, in this noise.
  float closedResidual() const;
  /// Clusters that nearly all of the ballot is against, unless their borders know better.
  std::vector<bool> outvoted(const std::vector<Ballot>& ballots, float sure_borders) const;
  void turnClusters(const std::vector<bool>& chosen);

  const PointView& points;
  std::size_t cloud_points;  ///< of the cloud, which a point may stand for several of
  const SheetField& field;
  const Segmentation& segmentation;
  const AutomaticOptions& options;
  const PointHints& hints;
  int threads;
  std::vector<HintVotes> hint_votes;  ///< of each segment
  KnownSensors sensors;
  std::vector<float> facing;  ///< of each point's sensor, see facingOf()
  std::vector<BorderVote> votes;
  SegmentClusters clusters;
  std::vector<std::int8_t> signs;          ///< of each segment
  std::vector<std::int32_t> component_of;  ///< of each segment, 0.. by descending size
  std::vector<ComponentWinding> windings;  ///< of each component
  /// Components that are ground, so that nothing closes in them; none before turnComponentsOut().
  std::vector<bool> ground;
  AutoOrientation found;

 private:
  void numberComponents();
};

}  // namespace segorient::detail
