// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "support/stage_options.h"

#include <array>
#include <cmath>

namespace segorient::program {
namespace po = boost::program_options;
namespace {

constexpr double kDegree = 0.017453292519943295;

struct EstimatorName {
  const char* name;
  NormalEstimator estimator;
};
constexpr std::array kEstimators{EstimatorName{"plane", NormalEstimator::Plane},
                                 EstimatorName{"lct", NormalEstimator::LCT},
                                 EstimatorName{"ldt", NormalEstimator::LDT},
                                 EstimatorName{"awas", NormalEstimator::AwASQuadratic},
                                 EstimatorName{"awas3", NormalEstimator::AwASCubic}};

// Default values to show are the library's own, in degrees.
double degrees(float radians) {
  return std::round(1e3 * static_cast<double>(radians) / kDegree) / 1e3;
}

void setAngle(const CommandLine& line, const std::string& name, double value, float& out) {
  if (!line.given(name)) return;
  require(value > 0.0 && value <= 180.0, "--" + name + " must be above 0 and at most 180 degrees");
  out = static_cast<float>(value * kDegree);
}

}  // namespace

const char* estimatorName(NormalEstimator estimator) {
  for (const EstimatorName& e : kEstimators) {
    if (e.estimator == estimator) return e.name;
  }
  return "plane";
}

const char* kindName(SegmentKind kind) {
  switch (kind) {
    case SegmentKind::Regular:
      return "regular";
    case SegmentKind::Connected:
      return "connected";
    case SegmentKind::Isolated:
      return "isolated";
  }
  return "regular";
}

void StageOptions::addNormals(CommandLine& line) {
  line.options()("neighbors,k", po::value(&k_),
                 "neighbours of a point; left out: from the cloud's noise")(
      "normals", po::value(&normals_)->default_value("plane"), "plane, lct, ldt, awas or awas3");
}

void StageOptions::addSegmentation(CommandLine& line) {
  const SegmentationOptions defaults;
  line.options()("alpha", po::value(&alpha_)->default_value(degrees(defaults.alpha)),
                 "degrees: largest angle between the normals of neighbours in a segment")(
      "beta", po::value(&beta_)->default_value(degrees(defaults.beta)),
      "degrees: largest angle between a normal and its segment's")(
      "epsilon", po::value(&epsilon_)->default_value(degrees(defaults.epsilon)),
      "degrees: by how much the clean-up may exceed beta");
}

void StageOptions::addOrientation(CommandLine& line) {
  const OrientationOptions defaults;
  line.options()("method", po::value(&method_)->default_value("auto"),
                 "auto (the best known), propagation, boundary, combined or extremal")(
      "gamma", po::value(&gamma_)->default_value(degrees(defaults.gamma)),
      "degrees: angles between segments up to this decide");
}

void StageOptions::apply(const CommandLine& line, const CommonOptions& common,
                         PipelineOptions& options) const {
  options.threads = common.threads;
  if (line.given("neighbors")) {
    require(k_ > 0 && k_ <= 1000, "-k must be 1 to 1000");
    options.k = k_;
  }
  bool known = normals_.empty();
  for (const EstimatorName& e : kEstimators) {
    if (normals_ != e.name) continue;
    options.normals.estimator = e.estimator;
    known = true;
  }
  require(known, "--normals is one of plane lct ldt awas awas3");
  setAngle(line, "alpha", alpha_, options.segmentation.alpha);
  setAngle(line, "beta", beta_, options.segmentation.beta);
  setAngle(line, "epsilon", epsilon_, options.segmentation.epsilon);
  setAngle(line, "gamma", gamma_, options.orientation.gamma);
  require(method_.empty() || fromString(method_, options.orientation.method),
          "--method is one of auto propagation boundary combined extremal");
}

}  // namespace segorient::program
