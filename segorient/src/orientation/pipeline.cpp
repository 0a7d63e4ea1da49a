// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <segorient/common/compact_cloud.h>
#include <segorient/features/automatic_normals.h>
#include <segorient/orientation/pipeline.h>
#include <segorient/search/median_hash_index.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <iomanip>
#include <limits>
#include <sstream>

#include "auto_stages.h"
#include "cloud_scale.h"
#include "segment_members.h"
#include "unoriented_normals.h"

namespace segorient {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

// Says which stage is running, and keeps the time of each. A stage may be taken up again.
class Stages {
 public:
  Stages(const PipelineProgress& progress, PipelineReport& report)
      : progress_(progress), report_(report) {}

  // Also called as a stage goes on.
  void begin(const char* stage, double fraction) {
    if (stage_ != nullptr && std::strcmp(stage_, stage) == 0) {
      if (progress_) progress_(stage, fraction);
      return;
    }
    end();
    stage_ = stage;
    start_ = Clock::now();
    if (progress_) progress_(stage, fraction);
  }

  void end() {
    if (stage_ == nullptr) return;
    const double seconds = std::chrono::duration<double>(Clock::now() - start_).count();
    const auto same = std::find_if(report_.stages.begin(), report_.stages.end(),
                                   [this](const StageTime& s) { return s.stage == stage_; });
    if (same == report_.stages.end()) {
      report_.stages.push_back({stage_, seconds});
    } else {
      same->seconds += seconds;
    }
    report_.seconds += seconds;
    stage_ = nullptr;
  }

 private:
  using Clock = std::chrono::steady_clock;
  const PipelineProgress& progress_;
  PipelineReport& report_;
  const char* stage_ = nullptr;
  Clock::time_point start_;
};

// The distinct points with all that the stages find out about them.
struct Working {
  CompactCloud cloud;
  search::MedianHashIndex index;
  Neighborhoods neighborhoods;
  std::vector<float> normals;
  Segmentation segmentation;
  OrientationResult orientation;

  NormalView normalView() const { return {normals.data(), 4, cloud.size()}; }
};

std::size_t peakMemory() {
  rusage usage{};
  if (getrusage(RUSAGE_SELF, &usage) != 0) return 0;
  return static_cast<std::size_t>(usage.ru_maxrss) * 1024;
}

void findNeighbors(const PipelineOptions& options, Working& work, PipelineReport& report) {
  search::MedianHashIndex::Options search_options;
  search_options.threads = options.threads;
  work.index.build(work.cloud.view(), nullptr, search_options);
  const CloudScale scale = measureScale(work.cloud.view(), work.index);
  report.spacing = scale.spacing;
  report.noise = scale.noise;
  const int wanted = options.k > 0 ? options.k : neighborsForNoise(scale.noise);
  // More than there are would only cost memory.
  const std::size_t others = work.cloud.size() > 0 ? work.cloud.size() - 1 : 0;
  report.k = static_cast<int>(std::min(static_cast<std::size_t>(wanted), others));
  work.index.nearestKAll(report.k + 1, work.neighborhoods);
}

void findSegments(const PipelineOptions& options, Working& work) {
  SegmentationOptions segmentation_options = options.segmentation;
  segmentation_options.neighbors = 0;
  segmentation_options.threads = options.threads;
  // A point of a thin part that is given to the other side's segment is turned over with it.
  segmentation_options.settle_edges = false;
  work.segmentation = segmentByNormals(work.cloud.view(), work.normalView(), work.neighborhoods,
                                       segmentation_options);
}

// Normals near sharp edges anew from one side only, and the segments that follow from them.
void recompute(const PipelineOptions& options, Working& work) {
  RecomputationOptions recomputation = options.recomputation;
  recomputation.estimator = options.normals.estimator;
  recomputation.k = 0;
  recomputation.threads = options.threads;
  for (int round = 0; round < options.recomputations; ++round) {
    std::vector<std::uint8_t> regular;
    for (const Segment& segment : work.segmentation.segments) {
      regular.push_back(segment.kind == SegmentKind::Regular ? 1 : 0);
    }
    std::vector<std::int32_t> labels = work.segmentation.labels;
    recomputeNormals(work.cloud.view(), work.neighborhoods, regular, recomputation, labels,
                     work.normals);
    findSegments(options, work);
  }
}

void findOrientation(const PipelineOptions& options, Working& work) {
  OrientationOptions orientation_options = options.orientation;
  orientation_options.threads = options.threads;
  const SegmentGraph graph = buildSegmentGraph(work.segmentation, work.neighborhoods);
  work.orientation = orientSegments(work.cloud.view(), work.normalView(), work.neighborhoods,
                                    work.segmentation, graph, orientation_options);
}

// Turns the distinct points' normals and segments as they were oriented. The normals' own signs now
// say it all, so a point's sign in its segment is what is left: -1 where it disagrees with it.
void applyOrientation(Working& work) {
  const OrientationResult& orientation = work.orientation;
  for (std::size_t i = 0; i < work.cloud.size(); ++i) {
    const auto sign = static_cast<float>(orientation.point_signs[i]);
    for (std::size_t a = 0; a < 3; ++a) work.normals[4 * i + a] *= sign == 0.F ? kNaN : sign;
    if (sign == 0.F) work.normals[4 * i + 3] = kNaN;
    const std::int32_t label = work.segmentation.labels[i];
    if (label < 0) continue;
    const int segment_sign = orientation.segments[static_cast<std::size_t>(label)].sign;
    work.segmentation.signs[i] = static_cast<std::int8_t>(
        work.segmentation.signs[i] * orientation.point_signs[i] * segment_sign);
  }
  for (std::size_t s = 0; s < work.segmentation.segments.size(); ++s) {
    for (float& c : work.segmentation.segments[s].reference_normal) {
      c *= static_cast<float>(orientation.segments[s].sign);
    }
  }
}

// What the default method chose, and why.
std::string sheetChoice(const detail::AutoStages& stages) {
  std::ostringstream text;
  text << std::setprecision(2) << "noise " << stages.noise << " of the spacing, "
       << (stages.denoised ? "too much to see the surface by few points, so positions were smoothed"
                           : "so positions stay as they are")
       << "; planes of one sheet each, of as few of " << stages.k
       << " neighbours as the noise allows";
  return text.str();
}

// The default method brings its own stages; its normals come out oriented.
void runAutomatic(const PipelineOptions& options, const PointHints& hints, Stages& stages,
                  Working& work, PipelineReport& report) {
  detail::AutoStages result = detail::runAutoStages(
      work.cloud, options, hints,
      [&stages](const char* stage, double fraction) { stages.begin(stage, fraction); });
  report.k = result.k;
  report.spacing = result.spacing;
  report.noise = result.noise;
  report.denoised = result.denoised;
  report.normals_chosen = sheetChoice(result);
  report.contradictions = std::move(result.orientation.contradictions);
  report.clusters = std::move(result.orientation.clusters);
  work.normals = std::move(result.normals);
  work.segmentation = std::move(result.segmentation);
  work.orientation.segments = std::move(result.segments);
  work.orientation.components = std::move(result.orientation.result.components);
  work.orientation.point_confidences = std::move(result.confidences);
  work.orientation.point_components = std::move(result.components);
}

// Lengths back to the input's units.
void restoreUnit(Working& work, PipelineReport& report) {
  const float unit = work.cloud.unit;
  report.spacing *= unit;
  for (Contradiction& c : report.contradictions) {
    for (float& v : c.where) v *= unit;
  }
  for (Segment& s : work.segmentation.segments) {
    for (float& v : s.centroid) v *= unit;
    s.area *= unit * unit;
    s.rms *= unit;
  }
}

// From distinct points to input rows.
void scatter(const Working& work, OrientedCloud& out) {
  const std::size_t rows = work.cloud.row_of.size();
  out.normals.assign(4 * rows, kNaN);
  out.confidences.assign(rows, 0.F);
  out.components.assign(rows, -1);
  out.segmentation.labels.assign(rows, -1);
  out.segmentation.signs.assign(rows, 0);
  const pcl::index_t* row_of = work.cloud.row_of.data();
  constexpr std::size_t kAhead = 16;  // the input may be in any order
  for (std::size_t row = 0; row < rows; ++row) {
    if (row + kAhead < rows && row_of[row + kAhead] >= 0) {
      const auto next = static_cast<std::size_t>(row_of[row + kAhead]);
      __builtin_prefetch(&work.normals[4 * next]);
      __builtin_prefetch(&work.orientation.point_confidences[next]);
      __builtin_prefetch(&work.orientation.point_components[next]);
      __builtin_prefetch(&work.segmentation.labels[next]);
      __builtin_prefetch(&work.segmentation.signs[next]);
    }
    if (row_of[row] < 0) continue;
    const auto i = static_cast<std::size_t>(row_of[row]);
    std::copy_n(&work.normals[4 * i], 4, &out.normals[4 * row]);
    out.confidences[row] = work.orientation.point_confidences[i];
    out.components[row] = work.orientation.point_components[i];
    out.segmentation.labels[row] = work.segmentation.labels[i];
    out.segmentation.signs[row] = work.segmentation.signs[i];
  }
  out.segmentation.segments = work.segmentation.segments;
  collectMembers(out.segmentation);
  out.segments = work.orientation.segments;
}

void fillReport(const Working& work, const OrientedCloud& cloud, PipelineReport& report) {
  report.points = work.cloud.row_of.size();
  report.non_finite = static_cast<std::size_t>(
      std::count(work.cloud.row_of.begin(), work.cloud.row_of.end(), pcl::index_t{-1}));
  report.duplicates = report.points - report.non_finite - work.cloud.size();
  for (std::size_t row = 0; row < report.points; ++row) {
    if (!std::isfinite(cloud.normals[4 * row])) ++report.without_normal;
  }
  for (std::size_t s = 0; s < cloud.segments.size(); ++s) {
    switch (cloud.segmentation.segments[s].kind) {
      case SegmentKind::Regular:
        ++report.regular_segments;
        break;
      case SegmentKind::Connected:
        ++report.connected_segments;
        break;
      case SegmentKind::Isolated:
        ++report.isolated_segments;
        break;
    }
    if (cloud.segments[s].hard) ++report.hard_segments;
  }
  report.components = work.orientation.components;
  report.peak_memory = peakMemory();
}

}  // namespace

OrientedCloud orientCloud(const PointView& points, const std::vector<pcl::index_t>* indices,
                          const PipelineOptions& options, const PipelineProgress& progress) {
  OrientedCloud out;
  out.report.method = options.orientation.method;
  out.report.estimator = options.normals.estimator;
  Stages stages(progress, out.report);
  Working work;
  // Fractions: shares of the time on clouds of a million points.
  stages.begin("search", 0.0);
  work.cloud = compactCloud(points, indices, options.threads);
  normalizeUnit(work.cloud);
  if (options.orientation.method == OrientationMethod::AUTO) {
    PointHints hints;
    if (options.orientation.hints) {
      hints = resolveHints(*options.orientation.hints, work.cloud, indices, options.threads);
    }
    runAutomatic(options, hints, stages, work, out.report);
  } else {
    findNeighbors(options, work, out.report);
    stages.begin("normals", 0.4);
    out.report.normals_chosen = detail::findUnorientedNormals(
        work.cloud.view(), work.index, work.neighborhoods, options, work.normals);
    stages.begin("segmentation", 0.5);
    findSegments(options, work);
    if (options.recomputations > 0) stages.begin("recomputation", 0.65);
    recompute(options, work);
    stages.begin("orientation", 0.8);
    findOrientation(options, work);
  }
  stages.begin("output", 0.95);
  if (options.orientation.method != OrientationMethod::AUTO) applyOrientation(work);
  restoreUnit(work, out.report);
  scatter(work, out);
  fillReport(work, out, out.report);
  stages.end();
  if (progress) progress("output", 1.0);
  return out;
}

std::size_t expectedMemory(std::size_t points, const PipelineOptions& options) {
  const bool automatic = options.orientation.method == OrientationMethod::AUTO;
  constexpr int kMostByNoise = 30;
  const auto k = static_cast<std::size_t>(options.k > 0 ? options.k
                                          : automatic   ? kSheetNeighbors
                                                        : kMostByNoise);
  // The table of neighbours, with distances where the paper's methods want them, and all else, as
  // measured on clouds of one to ten million points.
  const std::size_t entry = automatic ? sizeof(pcl::index_t) : sizeof(pcl::index_t) + sizeof(float);
  constexpr std::size_t kElse = 150;
  // Automatic normals of noisy clouds have neighbours of their own for a while.
  const bool wider =
      !automatic && options.k <= 0 && options.normals.estimator == NormalEstimator::Automatic;
  const std::size_t wide =
      wider ? sizeof(pcl::index_t) * static_cast<std::size_t>(kMostAutomaticNeighbors + 1) : 0;
  return points * (entry * (k + 1) + wide + kElse);
}

OrientedCloud selectRows(const OrientedCloud& cloud, const std::vector<pcl::index_t>& rows) {
  OrientedCloud out;
  out.report = cloud.report;
  out.segments = cloud.segments;
  out.segmentation.segments = cloud.segmentation.segments;
  out.normals.assign(4 * rows.size(), kNaN);
  out.confidences.assign(rows.size(), 0.F);
  out.components.assign(rows.size(), -1);
  out.segmentation.labels.assign(rows.size(), -1);
  out.segmentation.signs.assign(rows.size(), 0);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i] < 0 || static_cast<std::size_t>(rows[i]) >= cloud.confidences.size()) continue;
    const auto row = static_cast<std::size_t>(rows[i]);
    std::copy_n(&cloud.normals[4 * row], 4, &out.normals[4 * i]);
    out.confidences[i] = cloud.confidences[row];
    out.components[i] = cloud.components[row];
    out.segmentation.labels[i] = cloud.segmentation.labels[row];
    out.segmentation.signs[i] = cloud.segmentation.signs[row];
  }
  collectMembers(out.segmentation);
  return out;
}

}  // namespace segorient
