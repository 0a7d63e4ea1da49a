// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <cstddef>
#include <cstdint>

namespace segorient::test {

// What is fuzzed: each function makes its input from the bytes, and ends the process where a
// property does not hold. libFuzzer calls them (see fuzzer_main.cpp), and so does the test that
// replays the corpus.

/// MedianHashIndex against brute force.
void fuzzSearch(const std::uint8_t* data, std::size_t size);

/// orientCloud() and the triangulation of its segments, against what they promise: sizes, unit
/// normals, the same for shuffled rows and for more threads.
void fuzzPipeline(const std::uint8_t* data, std::size_t size);

/// A file through the program's commands: refused without a trace, or a readable result with the
/// same points.
void fuzzProgram(const std::uint8_t* data, std::size_t size);

/// Files of scanners (PTX, PTS, LAS, trajectories): read, joined, written, read again.
void fuzzScans(const std::uint8_t* data, std::size_t size);

/// Says what does not hold and ends the process unless `holds`.
void expectProperty(bool holds, const char* what);

}  // namespace segorient::test
