// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/orientation/pipeline.h>

#include <string>
#include <vector>

#include "support/command_line.h"

namespace segorient::program {

/// Whether normals are chosen from the cloud, scans among others: sensors are looked for then by
/// all methods.
bool choosesNormals(const PipelineOptions& options);

/// How far a command goes.
enum class LastStage { NORMALS, SEGMENTS, ORIENTATION };

/// Parameters of the stages, as options with angles in degrees. All commands that run stages take
/// all of them, whether or not they come to the stage that an option is for.
class StageOptions {
 public:
  /// \param last what only the stages after this one look at is taken but not listed
  /// \param k what -k is if it is left out, where that is not as usual
  void add(CommandLine& line, LastStage last, const std::string& k = {});

  /// Checks the values and sets those that were given; the others keep the library's defaults.
  void apply(const CommandLine& line, const CommonOptions& common, PipelineOptions& options);

  /// Names those of the options given that nothing looks at.
  void warnOfUnused(const CommandLine& line, const CommonOptions& common,
                    const PipelineOptions& options) const;

 private:
  void addMethod(CommandLine& line);

  LastStage ends_with_ = LastStage::ORIENTATION;
  int k_ = 0;
  int recomputations_ = 0;
  std::string normals_;
  std::string method_;
  double alpha_ = 0.0;
  double beta_ = 0.0;
  double gamma_ = 0.0;
  double delta_ = 0.0;
  double epsilon_ = 0.0;
  unsigned seed_ = 0;
};

/// For commands that run no stage: takes the options that all commands share, so that a script need
/// not tell commands apart, and does nothing with them.
/// \param with_k whether -k is among them
void takeSharedOptions(CommandLine& line, bool with_k = true);
/// Names those of them that were given. The seed is not named: its page says that nothing is
/// random.
void warnOfSharedOptions(const CommandLine& line, const CommonOptions& common, bool with_k = true);

/// auto, plane, lct, ldt, awas, awas3.
const char* estimatorName(NormalEstimator estimator);
/// "search 0.12  normals 0.03": one line of a summary.
std::string timesText(const std::vector<StageTime>& times);

}  // namespace segorient::program
