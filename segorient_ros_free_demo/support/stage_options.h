// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/orientation/pipeline.h>

#include <string>

#include "support/command_line.h"

namespace segorient::program {

/// Parameters of the stages, as options with angles in degrees. All commands that run stages take
/// all of them, whether or not they come to the stage that an option is for.
class StageOptions {
 public:
  void add(CommandLine& line);

  /// Checks the values and sets those that were given; the others keep the library's defaults.
  void apply(const CommandLine& line, const CommonOptions& common, PipelineOptions& options);

  /// Delta in radians if it was given, else 0.
  float delta() const { return delta_given_; }

 private:
  int k_ = 0;
  std::string normals_;
  std::string method_;
  double alpha_ = 0.0;
  double beta_ = 0.0;
  double gamma_ = 0.0;
  double delta_ = 0.0;
  double epsilon_ = 0.0;
  unsigned seed_ = 0;
  float delta_given_ = 0.F;
};

/// plane, lct, ldt, awas, awas3.
const char* estimatorName(NormalEstimator estimator);
const char* kindName(SegmentKind kind);

}  // namespace segorient::program
