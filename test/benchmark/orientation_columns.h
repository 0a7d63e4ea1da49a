// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/orientation/pipeline.h>

#include <functional>
#include <string>
#include <vector>

#include "orientation_peers.h"

namespace segorient::benchmark {

/// One way from points to oriented normals.
struct Column {
  std::string title;
  std::function<std::vector<float>(const PointView&)> orient;  // 4 floats a point
};

inline Column own(const std::string& title, const PipelineOptions& options) {
  return {title, [options](const PointView& points) {
            return orientCloud(points, nullptr, options).normals;
          }};
}

inline Column own(const std::string& title, const OrientationOptions& orientation) {
  PipelineOptions options;
  options.orientation = orientation;
  return own(title, options);
}

inline std::vector<Column> peers() {
  std::vector<Column> out;
  out.push_back({"PCL, viewpoint", orientWithPcl});
#ifdef SEGORIENT_HAVE_CGAL
  out.push_back({"CGAL, spanning tree", orientWithCgal});
#endif
  return out;
}

/// The paper's methods one by one, and Hoppe's tree over points.
inline std::vector<Column> paperMethods() {
  std::vector<Column> out;
  OrientationOptions o;
  o.method = OrientationMethod::HOPPE;
  out.push_back(own("hoppe", o));
  o.method = OrientationMethod::PROPAGATION;
  out.push_back(own("propagation", o));
  o.angle = SegmentAngle::REFERENCE_NORMALS;
  out.push_back(own("propagation (reference)", o));
  o = {};
  o.method = OrientationMethod::BOUNDARY;
  out.push_back(own("boundary", o));
  o.boundary = BoundaryTest::TRIANGULATED;
  out.push_back(own("boundary (triangulated)", o));
  o = {};
  o.method = OrientationMethod::EXTREMAL;
  out.push_back(own("extremal", o));
  o.method = OrientationMethod::COMBINED;
  out.push_back(own("combined", o));
  return out;
}

/// The default method with one of its steps switched off at a time.
inline std::vector<Column> withoutSteps() {
  const auto without = [](const char* step, const std::function<void(PipelineOptions&)>& off) {
    PipelineOptions options;
    off(options);
    return own(step, options);
  };
  return {
      without("denoising", [](PipelineOptions& o) { o.orientation.automatic.denoise = false; }),
      without("wall split",
              [](PipelineOptions& o) { o.orientation.automatic.split_walls = false; }),
      without("dominant plane",
              [](PipelineOptions& o) { o.orientation.automatic.dominant_plane = false; }),
      without("support",
              [](PipelineOptions& o) { o.orientation.automatic.require_support = false; }),
      without("clean-up", [](PipelineOptions& o) { o.orientation.automatic.clean_up = false; }),
      without("contraction",
              [](PipelineOptions& o) { o.orientation.automatic.contract_certain = false; }),
      without("loose parts",
              [](PipelineOptions& o) { o.orientation.automatic.turn_loose_parts = false; }),
      without("winding number",
              [](PipelineOptions& o) { o.orientation.automatic.wind_components = false; }),
      without("coarse levels",
              [](PipelineOptions& o) { o.orientation.automatic.coarse_levels = false; }),
      without("winding normals",
              [](PipelineOptions& o) { o.orientation.automatic.winding_normals = false; }),
      without("wedges", [](PipelineOptions& o) { o.orientation.automatic.filter_wedges = false; }),
      without("filter", [](PipelineOptions& o) { o.orientation.automatic.filter_rounds = 0; })};
}

inline Column automatic() {
  return own("auto", OrientationOptions{});
}

}  // namespace segorient::benchmark
