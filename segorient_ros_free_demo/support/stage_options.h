// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/orientation/pipeline.h>

#include <string>

#include "support/command_line.h"

namespace segorient::program {

/// Parameters of the stages, as options with angles in degrees: -k, --normals, --alpha, --beta,
/// --gamma, --epsilon.
class StageOptions {
 public:
  /// Adds the options of each stage that the command has.
  void addNormals(CommandLine& line);
  void addSegmentation(CommandLine& line);
  void addOrientation(CommandLine& line);

  /// Checks the values and sets those that were given; the others keep the library's defaults.
  void apply(const CommandLine& line, const CommonOptions& common, PipelineOptions& options) const;

 private:
  int k_ = 0;
  std::string normals_;
  std::string method_;
  double alpha_ = 0.0;
  double beta_ = 0.0;
  double gamma_ = 0.0;
  double epsilon_ = 0.0;
};

/// plane, lct, ldt, awas, awas3.
const char* estimatorName(NormalEstimator estimator);
const char* kindName(SegmentKind kind);

}  // namespace segorient::program
