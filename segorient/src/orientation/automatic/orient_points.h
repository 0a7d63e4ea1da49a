// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/export.h>
#include <segorient/common/neighborhoods.h>
#include <segorient/common/point_view.h>
#include <segorient/orientation/orientation_options.h>

#include <cstdint>
#include <functional>
#include <vector>

#include "features/automatic_normals.h"
#include "features/more_neighbors.h"
#include "features/sheet_normals.h"
#include "orientation/automatic/orient_sheets.h"
#include "orientation/sensors/point_hints.h"

namespace segorient::detail {

/// What the sheet around a point is like.
enum Around : std::uint8_t {
  ONE_PLANE = 1,    ///< an exact plane, and so are its surroundings
  ON_A_FACE = 2,    ///< a plane as well as data without noise have them
  SECOND_WALL = 4,  ///< another wall is near
};

/// Oriented normals of points whose neighbours are known.
struct AutoNormals {
  std::vector<float> normals;            ///< 4 floats a point: oriented normal, curvature; or NaN
  std::vector<float> confidences;        ///< of the orientation, 0 to 1
  std::vector<std::int32_t> components;  ///< -1 where there is no normal
  std::vector<std::uint8_t> around;      ///< what is around each point: bits of Around
  /// Whether a final normal comes from a surface that leaves no more of the points around than the
  /// noise explains, and that agrees with the filtered one; empty where no surfaces were fitted.
  std::vector<std::uint8_t> sure;
  AutoOrientation orientation;      ///< of the sheets' segments
  float spacing = 0.F;              ///< median
  float level = 0.F;                ///< see followCoarserLevels()
  std::vector<ScaleEnergy> scales;  ///< see PipelineReport
  SheetTraits sheets;               ///< of the cloud, as measured or as told
  SheetTraits level_sheets;         ///< of the level's subset, where there is one
};

/// For what takes the outside to be where the winding number has it: turns the components over that
/// hints turned (AutoOrientation::inside_out), and a second time back again.
SEGORIENT_ORIENTATION_EXPORT void turnInsideOut(AutoNormals& found);

/// What fitFinalNormals() measures of a whole cloud; for a part of one it is told.
struct FinalTraits {
  AutomaticNormalTraits surfaces;
  bool edges = false;          ///< whether there are sharp ones
  bool edges_sampled = false;  ///< and points on them, as vertices of meshes are
};

/// For a cloud that is part of a larger one: what is known of that, and what it needs to know.
struct SheetRecord {
  SheetTraits traits;           ///< of the whole
  FinalTraits final_traits;     ///< of the whole
  float typical_offset = -1.F;  ///< of the whole, see FinishedSegments
  bool denoise = false;         ///< whether the whole asks for smoothed positions
  /// One a point: whose votes are kept, see borderVotes().
  const std::vector<std::uint8_t>* voters = nullptr;
  /// One a point: within what distance all is there. Points with neighbours farther away have no
  /// normal, and are neighbours only.
  const std::vector<float>* whole = nullptr;
  /// The orientation of the part's sheet segments as it was found for the whole; none where the
  /// part has to do with signs of its own.
  std::function<AutoOrientation(const Segmentation& pieces, const std::vector<float>& spacing)>
      known;
  /// Called with the part's oriented normals, where the whole asks for a coarser scale.
  std::function<void(const PointView&, AutoNormals&)> coarser;
  /// Called with the part's oriented normals in the place of what the field of all points tells
  /// about them; may be empty.
  std::function<void(const PointView&, AutoNormals&)> field;

  SheetNormals sheets;  ///< found: normals not oriented
  Segmentation segments;
  std::vector<BorderVote> votes;
  std::vector<float> smoothed;  ///< 4 floats a point: positions, where they were smoothed
};

/// Sheet normals, sheet segments, their orientation, and the filter that makes the final normals;
/// at a coarser scale as well where points contradict each other, see followCoarserLevels().
/// \param more the points, and more neighbours than those of the table for who needs them
/// \param begin called with a stage's name and the fraction of the work done before it; may be
///        empty
/// \param record null unless the cloud is part of a larger one
/// \param finished where not null: the sheets' segments as a user wants to see them, their signs
///        those of the sheets' normals, which are not known any more; see segmentSheets()
SEGORIENT_ORIENTATION_EXPORT AutoNormals
orientPoints(MoreNeighbors& more, const Neighborhoods& neighborhoods,
             const AutomaticOptions& settings, const PointHints& hints, int threads,
             const std::function<void(const char*, double)>& begin = {},
             SheetRecord* record = nullptr, FinishedSegments* finished = nullptr);

}  // namespace segorient::detail
