// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "support/stage_options.h"

#include <array>
#include <cstdio>

namespace segorient::program {
namespace po = boost::program_options;
namespace {

constexpr double kDegree = 0.017453292519943295;

struct EstimatorName {
  const char* name;
  NormalEstimator estimator;
};
constexpr std::array kEstimators{EstimatorName{"auto", NormalEstimator::AUTO},
                                 EstimatorName{"plane", NormalEstimator::PLANE},
                                 EstimatorName{"lct", NormalEstimator::LCT},
                                 EstimatorName{"ldt", NormalEstimator::LDT},
                                 EstimatorName{"awas", NormalEstimator::AWAS_QUADRATIC},
                                 EstimatorName{"awas3", NormalEstimator::AWAS_CUBIC}};

constexpr std::array kSharedAngles{"alpha", "beta", "gamma", "delta", "epsilon"};

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
  return "auto";
}

void StageOptions::addMethod(CommandLine& line) {
  // Segments are those of the orientation.
  auto options = ends_with_ == LastStage::NORMALS ? line.unlisted() : line.options();
  options("method", po::value(&method_)->default_value("auto"),
          "of orientation: auto (the best known), propagation, boundary, combined or extremal\n"
          "(the paper's), hoppe (the classical tree over points)")(
      "gamma", po::value(&gamma_),
      "degrees: angles between segments up to this decide; 35 (the paper's methods)");
}

void StageOptions::add(CommandLine& line, LastStage last, const std::string& usual_k) {
  const bool orients = last == LastStage::ORIENTATION;
  const std::string k = !usual_k.empty() ? usual_k
                        : orients ? "32 for method auto, else 12, 18 or 30 by the cloud's noise"
                                  : "12, and more for --normals auto where there is noise";
  const std::string normals =
      orients ? "; method auto has its own way and does not look at this" : "";
  const std::string recompute = orients ? "; method auto does so in its own way" : "";
  ends_with_ = last;
  line.options()("neighbors,k", po::value(&k_), ("neighbours of a point; left out: " + k).c_str());
  addMethod(line);
  line.options()(
      "normals", po::value(&normals_)->default_value("auto"),
      ("auto (chosen from the cloud itself), plane, lct, ldt, awas or awas3" + normals).c_str())(
      "alpha", po::value(&alpha_),
      "degrees: largest angle between normals of neighbours in a segment; about 20")(
      "beta", po::value(&beta_), "degrees: largest angle between a normal and its segment's; 30")(
      "delta", po::value(&delta_),
      "degrees: normals that differ so much across a border make it a sharp one for --recompute, "
      "which then follows the paper's rule instead of fitting surfaces to one side")(
      "epsilon", po::value(&epsilon_), "degrees: by how much the clean-up may exceed beta; 10")(
      "recompute", po::value(&recomputations_)->default_value(0),
      ("rounds of finding the normals at sharp edges again" + recompute).c_str())(
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
  require(recomputations_ >= 0 && recomputations_ <= 100, "--recompute must be 0 to 100");
  options.recomputations = recomputations_;
  bool known = false;
  for (const EstimatorName& e : kEstimators) {
    if (normals_ != e.name) continue;
    options.normals.estimator = e.estimator;
    known = true;
  }
  require(known, "--normals is one of auto plane lct ldt awas awas3");
  setAngle(line, "alpha", alpha_, options.segmentation.alpha);
  setAngle(line, "alpha", alpha_, options.orientation.automatic.alpha);
  setAngle(line, "beta", beta_, options.segmentation.beta);
  setAngle(line, "beta", beta_, options.orientation.automatic.beta);
  setAngle(line, "epsilon", epsilon_, options.segmentation.epsilon);
  setAngle(line, "epsilon", epsilon_, options.orientation.automatic.epsilon);
  setAngle(line, "gamma", gamma_, options.orientation.gamma);
  setAngle(line, "delta", delta_, options.recomputation.delta);
  if (line.given("delta")) {
    options.recomputation.rule = RecomputationRule::MODIFIED_NEIGHBORHOODS;
  }
  require(fromString(method_, options.orientation.method),
          "--method is one of auto propagation boundary combined extremal hoppe");
}

bool choosesNormals(const PipelineOptions& options) {
  return options.normals.estimator == NormalEstimator::AUTO && options.k <= 0;
}

void StageOptions::warnOfUnused(const CommandLine& line, const CommonOptions& common,
                                const PipelineOptions& options) const {
  if (common.quiet) return;
  const auto name = [&line](const std::vector<const char*>& names, const std::string& reason) {
    nameUnused(line, names, reason);
  };
  const bool automatic = options.orientation.method == OrientationMethod::AUTO;
  const bool recomputes = options.recomputations > 0;
  switch (ends_with_) {
    case LastStage::NORMALS:
      name({"method", "gamma"}, "of normals that are not oriented; see segorient orient");
      if (!recomputes) name({"alpha", "beta", "epsilon", "delta"}, "without --recompute");
      return;
    case LastStage::SEGMENTS: {
      const bool own =
          automatic && (options.normals.estimator != NormalEstimator::AUTO || recomputes);
      if (automatic) name({"gamma"}, "with method auto; the others (--method combined) look at it");
      if (!recomputes) name({"delta"}, "without --recompute");
      if (own) {
        const char* reason = "of segments that are made by --normals or --recompute alone";
        name({"viewpoint", "trajectory", "up", "closed", "open", "seeds", "keep-orientation"},
             reason);
        if (!choosesNormals(options)) name({"no-sensors"}, reason);
      }
      if (!automatic) name({"faces"}, "without method auto: the others' segments are not united");
      return;
    }
    case LastStage::ORIENTATION:
      if (automatic) {
        name({"normals", "gamma", "delta", "recompute"},
             "with method auto; the others (--method combined) look at it");
      } else if (!recomputes) {
        name({"delta"}, "without --recompute");
      }
      if (options.orientation.method == OrientationMethod::HOPPE) {
        name({"gamma"}, "with method hoppe, which has no segments");
      }
  }
}

void takeSharedOptions(CommandLine& line, bool with_k) {
  for (const char* name : kSharedAngles) line.unlisted()(name, po::value<double>());
  line.unlisted()("seed", po::value<unsigned>());
  if (with_k) line.unlisted()("neighbors,k", po::value<int>());
}

void warnOfSharedOptions(const CommandLine& line, const CommonOptions& common, bool with_k) {
  if (common.quiet) return;
  nameUnused(line, {kSharedAngles.begin(), kSharedAngles.end()}, "of this command");
  if (with_k && line.given("neighbors")) warn("-k changes nothing of this command");
}

std::string timesText(const std::vector<StageTime>& times) {
  std::string text;
  for (const StageTime& t : times) {
    char part[64];
    std::snprintf(part, sizeof(part), "%s%s %.2f", text.empty() ? "" : "  ", t.stage.c_str(),
                  t.seconds);
    text += part;
  }
  return text;
}

}  // namespace segorient::program
