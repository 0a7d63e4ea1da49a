// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "support/stage_options.h"

#include <array>

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

void StageOptions::add(CommandLine& line) {
  line.options()("neighbors,k", po::value(&k_),
                 "neighbours of a point; left out: from the cloud's noise")(
      "method", po::value(&method_)->default_value("auto"),
      "of orientation: auto (the best known), propagation, boundary, combined or extremal")(
      "normals", po::value(&normals_)->default_value("plane"),
      "plane, lct, ldt, awas or awas3; orientation by auto has its own")(
      "alpha", po::value(&alpha_),
      "degrees: largest angle between normals of neighbours in a segment; about 20")(
      "beta", po::value(&beta_), "degrees: largest angle between a normal and its segment's; 30")(
      "gamma", po::value(&gamma_),
      "degrees: angles between segments up to this decide (propagation, combined, extremal); 35")(
      "delta", po::value(&delta_),
      "degrees: normals that differ so much across a border make it a sharp one (recomputation)")(
      "epsilon", po::value(&epsilon_), "degrees: by how much the clean-up may exceed beta; 10")(
      "seed", po::value(&seed_)->default_value(0),
      "of random choices; no stage makes any, so results do not depend on it");
}

void StageOptions::apply(const CommandLine& line, const CommonOptions& common,
                         PipelineOptions& options) {
  options.threads = common.threads;
  if (line.given("neighbors")) {
    require(k_ > 0 && k_ <= 1000, "-k must be 1 to 1000");
    options.k = k_;
  }
  bool known = false;
  for (const EstimatorName& e : kEstimators) {
    if (normals_ != e.name) continue;
    options.normals.estimator = e.estimator;
    known = true;
  }
  require(known, "--normals is one of plane lct ldt awas awas3");
  setAngle(line, "alpha", alpha_, options.segmentation.alpha);
  setAngle(line, "alpha", alpha_, options.sheets.alpha);
  setAngle(line, "beta", beta_, options.segmentation.beta);
  setAngle(line, "beta", beta_, options.sheets.beta);
  setAngle(line, "epsilon", epsilon_, options.segmentation.epsilon);
  setAngle(line, "epsilon", epsilon_, options.sheets.epsilon);
  setAngle(line, "gamma", gamma_, options.orientation.gamma);
  setAngle(line, "delta", delta_, delta_given_);
  require(fromString(method_, options.orientation.method),
          "--method is one of auto propagation boundary combined extremal");
}

}  // namespace segorient::program
