// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <segorient/common/export.h>
#include <segorient/orientation/pipeline.h>
#include <segorient/orientation/impl/oriented_segmentation.hpp>

#include "orientation/pipeline_stages.h"

namespace segorient {
namespace {

// Collects the names of settings that differ from their defaults.
class Changed {
 public:
  explicit Changed(std::string prefix) : prefix_(std::move(prefix)) {}

  template <typename T>
  void add(const char* name, const T& value, const T& standard) {
    if (!(value == standard)) names_.push_back(prefix_ + name);
  }
  void addAll(const char* room, const std::vector<std::string>& names) {
    for (const std::string& name : names) names_.push_back(prefix_ + room + name);
  }
  std::vector<std::string> names() { return std::move(names_); }

 private:
  std::string prefix_;
  std::vector<std::string> names_;
};

std::vector<std::string> changed(const TriangulationSettings& s) {
  const TriangulationSettings standard;
  Changed out("triangulation.");
  out.add("kappa1", s.kappa1, standard.kappa1);
  out.add("kappa2", s.kappa2, standard.kappa2);
  out.add("critical_factor", s.critical_factor, standard.critical_factor);
  out.add("bins", s.bins, standard.bins);
  out.add("fill_gaps", s.fill_gaps, standard.fill_gaps);
  return out.names();
}

// But for angles of segments, see changedAngles().
// \param finds_sensors normals ask for them, too
std::vector<std::string> changed(const AutomaticOptions& s, bool finds_sensors) {
  const AutomaticOptions standard;
  Changed out("automatic.");
  out.add("denoise", s.denoise, standard.denoise);
  out.add("split_walls", s.split_walls, standard.split_walls);
  out.add("dominant_plane", s.dominant_plane, standard.dominant_plane);
  out.add("require_support", s.require_support, standard.require_support);
  out.add("clean_up", s.clean_up, standard.clean_up);
  out.add("contract_certain", s.contract_certain, standard.contract_certain);
  out.add("wind_components", s.wind_components, standard.wind_components);
  out.add("turn_loose_parts", s.turn_loose_parts, standard.turn_loose_parts);
  out.add("coarse_levels", s.coarse_levels, standard.coarse_levels);
  if (!finds_sensors) out.add("find_sensors", s.find_sensors, standard.find_sensors);
  out.add("filter_rounds", s.filter_rounds, standard.filter_rounds);
  out.add("filter_wedges", s.filter_wedges, standard.filter_wedges);
  out.add("winding_normals", s.winding_normals, standard.winding_normals);
  out.add("fit_normals", s.fit_normals, standard.fit_normals);
  return out.names();
}

// Angles go hand in hand with those of the segments that are returned: they are named where they
// were changed by themselves.
std::vector<std::string> changedAngles(const AutomaticOptions& s,
                                       const SegmentationSettings& segments) {
  const AutomaticOptions standard;
  const SegmentationSettings usual;
  Changed out("automatic.");
  if (segments.alpha == usual.alpha) out.add("alpha", s.alpha, standard.alpha);
  if (segments.beta == usual.beta) out.add("beta", s.beta, standard.beta);
  if (segments.epsilon == usual.epsilon) out.add("epsilon", s.epsilon, standard.epsilon);
  return out.names();
}

// Those of the rule that is not followed, or all where there is no recomputation.
std::vector<std::string> unusedOf(const RecomputationSettings& s, bool recomputes) {
  const RecomputationSettings standard;
  Changed out("recomputation.");
  const bool one_sided = s.rule == RecomputationRule::ONE_SIDED;
  if (!recomputes) out.add("rule", s.rule, standard.rule);
  if (!recomputes || !one_sided) out.add("edge_angle", s.edge_angle, standard.edge_angle);
  if (!recomputes || one_sided) {
    out.add("delta", s.delta, standard.delta);
    out.add("delta_between_references", s.delta_between_references,
            standard.delta_between_references);
  }
  return out.names();
}

// Those of growing, which the default method does by AutomaticOptions. Uniting looks at two of
// them, too.
std::vector<std::string> changedOfGrowing(const SegmentationSettings& s) {
  const SegmentationSettings standard;
  Changed out("segmentation.");
  out.add("max_gap", s.max_gap, standard.max_gap);
  out.add("max_offset", s.max_offset, standard.max_offset);
  out.add("max_residual", s.max_residual, standard.max_residual);
  if (s.unite_smooth) return out.names();
  out.add("max_curvature", s.max_curvature, standard.max_curvature);
  out.add("compare_with_seed", s.compare_with_seed, standard.compare_with_seed);
  return out.names();
}

std::vector<std::string> changed(const SegmentationSettings& s) {
  const SegmentationSettings standard;
  Changed out("segmentation.");
  out.add("alpha", s.alpha, standard.alpha);
  out.add("beta", s.beta, standard.beta);
  out.add("epsilon", s.epsilon, standard.epsilon);
  out.add("small_size", s.small_size, standard.small_size);
  out.add("neighbor_share", s.neighbor_share, standard.neighbor_share);
  out.add("max_gap", s.max_gap, standard.max_gap);
  out.add("max_offset", s.max_offset, standard.max_offset);
  out.add("max_curvature", s.max_curvature, standard.max_curvature);
  out.add("max_residual", s.max_residual, standard.max_residual);
  out.add("compare_with_seed", s.compare_with_seed, standard.compare_with_seed);
  out.add("absorb_small", s.absorb_small, standard.absorb_small);
  out.add("extract_edges", s.extract_edges, standard.extract_edges);
  out.add("settle_edges", s.settle_edges, standard.settle_edges);
  out.add("unite_smooth", s.unite_smooth, standard.unite_smooth);
  out.add("connect_small", s.connect_small, standard.connect_small);
  return out.names();
}

// What is known beforehand and was said on purpose: fields of points say some of it unasked.
bool saysSomething(const OrientationHints& hints) {
  return hints.surface != SurfaceKind::UNKNOWN || hints.has_viewpoint || hints.has_direction ||
         !hints.seeds.empty() || !hints.normals.empty() || !hints.scans.empty();
}

// \param finds_sensors as above
std::vector<std::string> unusedByMethod(const OrientationSettings& settings, bool finds_sensors) {
  using Method = OrientationMethod;
  const OrientationSettings standard;
  const Method method = settings.method;
  Changed out("");
  const bool by_segments = method != Method::AUTO && method != Method::HOPPE;
  if (!by_segments) {
    out.add("gamma", settings.gamma, standard.gamma);
    out.add("boundary", settings.boundary, standard.boundary);
    out.add("max_box_points", settings.max_box_points, standard.max_box_points);
  }
  if (!by_segments || method == Method::PROPAGATION) {
    out.add("check_borders", settings.check_borders, standard.check_borders);
  }
  if (!by_segments || method == Method::BOUNDARY) {
    out.add("angle", settings.angle, standard.angle);
  }
  if (!by_segments || method == Method::PROPAGATION) {
    out.add("min_margin", settings.min_margin, standard.min_margin);
  }
  if (!by_segments || settings.boundary != BoundaryTest::TRIANGULATED) {
    out.addAll("", changed(settings.triangulation));
  }
  if (method == Method::HOPPE) {
    out.add("turn_outward", settings.turn_outward, standard.turn_outward);
  }
  if (method != Method::AUTO) {
    out.addAll("", changed(settings.automatic, finds_sensors));
    out.add("hints", settings.hints && saysSomething(*settings.hints), false);
  }
  return out.names();
}

SEGORIENT_DEPRECATED_BEGIN
// Of version 1.0, and without a place today.
std::vector<std::string> formerSettings(const PipelineOptions& options) {
  Changed out("");
  out.add("automatic.flip_clusters", options.automatic.flip_clusters.has_value(), false);
  out.add("automatic.infer_viewpoint", options.automatic.infer_viewpoint.has_value(), false);
  return out.names();
}
SEGORIENT_DEPRECATED_END

}  // namespace

std::vector<std::string> settingsWithoutEffect(const OrientationSettings& settings) {
  Changed out("");
  out.addAll("", unusedByMethod(settings, false));
  if (settings.method == OrientationMethod::AUTO) {  // sensors are looked for by orientCloud()
    out.add("automatic.find_sensors", settings.automatic.find_sensors,
            AutomaticOptions().find_sensors);
  }
  return out.names();
}

std::vector<std::string> settingsWithoutEffect(const SegmentationSettings& segmentation,
                                               const OrientationSettings& orientation,
                                               bool segments_are_given) {
  Changed out("");
  if (orientation.method == OrientationMethod::AUTO) {  // it has segments of its own in any case
    out.addAll("", changedOfGrowing(segmentation));
  } else {
    if (segments_are_given) {
      out.addAll("", changed(segmentation));
    } else {
      out.add("segmentation.unite_smooth", segmentation.unite_smooth, false);
    }
    out.addAll("", changedAngles(orientation.automatic, segmentation));
  }
  out.addAll("", settingsWithoutEffect(orientation));
  return out.names();
}

std::vector<std::string> settingsWithoutEffect(const PipelineOptions& given) {
  const PipelineOptions standard;
  const PipelineOptions options = detail::withFormerSettings(given);
  Changed out("");
  out.addAll("", formerSettings(given));
  // The paper's methods look for sensors where normals and their neighbours are chosen for them.
  const bool chooses = options.normals.estimator == NormalEstimator::AUTO && options.k <= 0;
  out.addAll("orientation.", unusedByMethod(options.orientation, chooses));
  const bool automatic = options.orientation.method == OrientationMethod::AUTO;
  if (!automatic) {
    out.addAll("orientation.", changedAngles(options.orientation.automatic, options.segmentation));
  }
  if (automatic) {
    out.add("orientation.turn_outward", options.orientation.turn_outward,
            standard.orientation.turn_outward);
  }
  const bool surfaces = options.normals.estimator == NormalEstimator::AWAS_QUADRATIC ||
                        options.normals.estimator == NormalEstimator::AWAS_CUBIC;
  const bool recomputes = !automatic && options.recomputations > 0;
  const SegmentationSettings& segments = options.segmentation;
  if (automatic) {
    out.add("normals.estimator", options.normals.estimator, standard.normals.estimator);
    out.add("recomputations", options.recomputations, standard.recomputations);
    out.addAll("", changedOfGrowing(segments));
  } else {
    if (!recomputes) {
      out.add("segmentation.settle_edges", segments.settle_edges,
              standard.segmentation.settle_edges);
    }
    out.add("segmentation.unite_smooth", segments.unite_smooth, standard.segmentation.unite_smooth);
  }
  if (automatic || !surfaces) {
    out.add("normals.first_guess", options.normals.first_guess, standard.normals.first_guess);
  }
  out.addAll("", unusedOf(options.recomputation, recomputes));
  return out.names();
}

}  // namespace segorient
