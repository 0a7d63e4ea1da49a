// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <pcl/types.h>
#include <segorient/common/export.h>
#include <segorient/common/point_view.h>
#include <segorient/features/normal_options.h>
#include <segorient/orientation/orientation_options.h>
#include <segorient/orientation/orientation_result.h>
#include <segorient/orientation/sensors.h>
#include <segorient/segmentation/segmentation.h>

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace segorient {

/// What version 1.0 called some of AutomaticOptions in PipelineOptions. Those that are set take the
/// place of the others; they go with the next version.
struct FormerSheetNormalOptions {
  std::optional<bool> split_walls;
  std::optional<bool> dominant_plane;
};
struct FormerSheetOptions {
  std::optional<float> alpha;
  std::optional<float> beta;
  std::optional<float> epsilon;
  std::optional<bool> require_support;
  std::optional<bool> clean_up;
};
struct FormerAutomaticOptions {
  std::optional<bool> contract_certain;
  std::optional<bool> flip_clusters;  ///< has no effect: none are turned over any more
  std::optional<bool> wind_components;
  std::optional<bool> turn_loose_parts;
  std::optional<bool> infer_viewpoint;  ///< has no effect: nothing is inferred any more
};

/// Settings of orientCloud(). The defaults need no tuning.
struct SEGORIENT_ORIENTATION_EXPORT PipelineOptions {
  /// Neighbours of a point, itself not counted; <= 0 = 32 for OrientationMethod::AUTO, 12 for
  /// FirstStages, and 12, 18 or 30 by the cloud's noise for the paper's methods.
  int k = 0;
  /// How normals are estimated, by default as the cloud asks for. Not for OrientationMethod::AUTO.
  NormalSettings normals{NormalEstimator::AUTO};
  /// OrientationMethod::AUTO grows by AutomaticOptions and takes from here what is about the
  /// clean-up; of the paper's methods the segments that are oriented are of all neighbours, are not
  /// united and have no edges settled, those of recomputation may.
  SegmentationSettings segmentation;
  /// How often normals near sharp edges are found anew (paper, 2.3.1), each time by the segments
  /// that the normals then make. Not for OrientationMethod::AUTO.
  int recomputations = 0;
  RecomputationSettings recomputation;
  OrientationSettings orientation;
  int threads = 0;  ///< of all stages: 0 = all cores; the result does not depend on it

  // As version 1.0 had them.
  [[deprecated("orientation.automatic")]] FormerSheetNormalOptions sheet_normals{};
  [[deprecated("orientation.automatic")]] FormerSheetOptions sheets{};
  [[deprecated("orientation.automatic")]] FormerAutomaticOptions automatic{};
  [[deprecated("orientation.automatic.denoise")]] std::optional<bool> denoise{};
  [[deprecated("orientation.automatic.filter_rounds")]] std::optional<int> filter_rounds{};
  [[deprecated("orientation.automatic.filter_wedges")]] std::optional<bool> filter_wedges{};
  [[deprecated("orientation.automatic.winding_normals")]] std::optional<bool> winding_normals{};

  // Not written by the compiler where they are used: it would warn there of the above.
  PipelineOptions();
  PipelineOptions(const PipelineOptions& other);
  PipelineOptions(PipelineOptions&& other) noexcept;
  PipelineOptions& operator=(const PipelineOptions& other);
  PipelineOptions& operator=(PipelineOptions&& other) noexcept;
  ~PipelineOptions();
};

/// The paper to the letter, all stages: planes through the neighbours, segments that gaps and thin
/// walls do not keep apart and whose edges are not settled, one round of recomputation by the
/// paper's rule with delta between reference normals, and paperOptions(). The paper leaves the
/// number of neighbours open; so does this.
SEGORIENT_ORIENTATION_EXPORT PipelineOptions
paperPipelineOptions(OrientationMethod method = OrientationMethod::COMBINED);

/// Names of all settings that were changed from their defaults and that the method does not look
/// at, such as "orientation.gamma" with OrientationMethod::AUTO. The classes warn of them.
SEGORIENT_ORIENTATION_EXPORT std::vector<std::string> settingsWithoutEffect(
    const PipelineOptions& options);

/// Called when a stage begins and as it goes on, from the calling thread.
/// \param stage search, normals, segmentation, recomputation, orientation or output; one that ended
///        may be taken up again
/// \param fraction of the whole work that is done, 0 to 1
using PipelineProgress = std::function<void(const char* stage, double fraction)>;

struct StageTime {
  std::string stage;  ///< each once, in the order in which they began
  double seconds = 0.0;
};

/// What orientCloud() did.
struct PipelineReport {
  std::size_t points = 0;  ///< input rows
  std::size_t non_finite =
      0;  ///< rows with NaN or infinite coordinates, strays beyond floats, invalid indices
  std::size_t duplicates = 0;  ///< rows that repeat another one's coordinates
  std::size_t without_normal =
      0;  ///< rows that got none: all non-finite, or without a plane around
  std::size_t regular_segments = 0;
  std::size_t connected_segments = 0;
  std::size_t isolated_segments = 0;
  std::size_t hard_segments = 0;  ///< regular ones that no method decided
  int k = 0;                      ///< neighbours used, the point itself not counted
  NormalEstimator estimator = NormalEstimator::AUTO;  ///< as asked for
  std::string normals_chosen;  ///< how normals were found and, where nothing was asked for, why so
  OrientationMethod method = OrientationMethod::AUTO;
  float spacing = 0.F;  ///< h: median over points of the mean distance to the 6 nearest
  /// In spacings: of AUTO the standard deviation of positions across the surface, of the other
  /// methods the median rms distance of 18 neighbours from their plane.
  float noise = 0.F;
  bool denoised = false;  ///< whether neighbours were sought after smoothing the positions
  /// Borders where sure evidence had to be overruled, in input coordinates; a surface without two
  /// sides has some.
  std::vector<Contradiction> contradictions;
  std::vector<ClusterOrientationResult> clusters;  ///< of AUTO
  /// Of AUTO: the scales that were compared, the points' own first; empty where no other was tried,
  /// as the points do not contradict each other or their sensors decide.
  std::vector<ScaleEnergy> scales;
  std::vector<KnownSensor> known_sensors;  ///< of AUTO: what became of known sensors
  std::size_t seeds_left_out = 0;          ///< of AUTO: seeds that count for no point
  /// What AUTO found where no sensor was given, or none that was given is believed; empty
  /// otherwise. sensor_of is by input row, and empty where no sensor was found.
  SensorReport sensors;
  std::vector<StageTime> stages;
  double seconds = 0.0;                                ///< all stages
  std::size_t peak_memory = 0;                         ///< of the process so far, bytes
  std::vector<ComponentOrientationResult> components;  ///< by descending size, in distinct points
};

/// A segmented, oriented cloud; everything is by input row (by position in the indices, if given).
struct OrientedCloud {
  std::vector<float> normals;  ///< 4 floats a row: oriented normal, curvature; NaN where none
  Segmentation segmentation;   ///< label -1 where there is no normal; signs as `normals` has them
  std::vector<float> confidences;        ///< of the orientation, 0 to 1
  std::vector<std::int32_t> components;  ///< connected component, -1 where there is no normal
  std::vector<SegmentOrientationResult> segments;  ///< how each segment was oriented, by label
  PipelineReport report;
};

/// The whole way: distinct points, neighbours, normals, segments, orientation (paper, sections 2
/// and 3). Rows that repeat a point get that point's result. The result does not depend on the
/// order of the rows nor on the number of threads.
///
/// \param indices rows to use, or null for all
/// \param progress may be empty
/// \return rows of NaN where there is nothing to go by (fewer than three distinct points, all in a
///         line); empty vectors for an empty cloud
SEGORIENT_ORIENTATION_EXPORT OrientedCloud orientCloud(const PointView& points,
                                                       const std::vector<pcl::index_t>* indices,
                                                       const PipelineOptions& options,
                                                       const PipelineProgress& progress = {});

/// The segments of a cloud: those of orientCloud() with the same options. Where these name an
/// estimator or recomputations, which OrientationMethod::AUTO does not look at, those of
/// FirstStages.
/// \return as orientCloud(), but normals agree within each segment: all signs are 1
SEGORIENT_ORIENTATION_EXPORT OrientedCloud segmentCloud(const PointView& points,
                                                        const PipelineOptions& options,
                                                        const PipelineProgress& progress = {});

/// Bytes that orientCloud() takes beside its input at most, or a little more: linear in the points.
/// Clouds without noise take half of it.
SEGORIENT_ORIENTATION_EXPORT std::size_t expectedMemory(std::size_t points,
                                                        const PipelineOptions& options);

/// The result for some rows of a cloud. Segments keep their labels and data; their members are
/// those among `rows`, so sizes may be 0. Invalid rows get NaN.
SEGORIENT_ORIENTATION_EXPORT OrientedCloud selectRows(const OrientedCloud& cloud,
                                                      const std::vector<pcl::index_t>& rows);

}  // namespace segorient
