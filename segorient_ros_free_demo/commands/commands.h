// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <string>
#include <vector>

namespace segorient::program {

// One function a command: reads its words, does it, and returns the exit status. They throw
// FileError and UsageError.
int runOrient(const std::vector<std::string>& words);
int runTiles(const std::vector<std::string>& words);
int runNormals(const std::vector<std::string>& words);
int runSegment(const std::vector<std::string>& words);
int runTriangulate(const std::vector<std::string>& words);
int runSensors(const std::vector<std::string>& words);
int runKnn(const std::vector<std::string>& words);
int runCompare(const std::vector<std::string>& words);
int runCheck(const std::vector<std::string>& words);
int runEvaluate(const std::vector<std::string>& words);
int runRender(const std::vector<std::string>& words);
int runView(const std::vector<std::string>& words);

}  // namespace segorient::program
