// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <algorithm>
#include <array>
#include <cctype>

#include "io/readers.h"
#include "io/text_numbers.h"

namespace segorient::program {
namespace {

using Columns = std::array<std::size_t, 4>;  // of time, x, y, z

bool isComment(std::string_view line) {
  const std::string_view word = nextWord(line, kTextSeparators);
  return word.empty() || word.front() == '#' || word.front() == '%' || word.substr(0, 2) == "//";
}

// The columns by a line of their names.
Columns columnsByName(const InputFile& file, std::string_view line) {
  constexpr std::size_t kMissing = ~std::size_t{0};
  Columns out{kMissing, kMissing, kMissing, kMissing};
  std::size_t column = 0;
  for (auto word = nextWord(line, kTextSeparators); !word.empty();
       word = nextWord(line, kTextSeparators), ++column) {
    std::string name;
    for (const char c : word) {
      if (c != '"' && c != '_') {
        name += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
      }
    }
    if (name == "time" || name == "t" || name == "timestamp" || name == "gpstime") out[0] = column;
    for (std::size_t a = 0; a < 3; ++a) {
      if (name.size() == 1 && name[0] == "xyz"[a]) out[a + 1] = column;
    }
  }
  if (std::find(out.begin(), out.end(), kMissing) != out.end()) {
    file.failLine("is neither time x y z nor the names of such columns");
  }
  return out;
}

// What these columns of a line say; false where one is missing or no number. The others may be
// anything.
bool parsePose(std::string_view line, const Columns& columns, Trajectory::Pose& out) {
  std::size_t found = 0;
  std::size_t column = 0;
  for (auto word = nextWord(line, kTextSeparators); !word.empty();
       word = nextWord(line, kTextSeparators), ++column) {
    for (std::size_t c = 0; c < columns.size(); ++c) {
      if (columns[c] != column) continue;
      if (!parseNumber(word, c == 0 ? out.time : out.position[c - 1])) return false;
      ++found;
    }
  }
  return found == columns.size();
}

}  // namespace

Trajectory readTrajectory(const std::string& path) {
  InputFile file(path);
  std::vector<Trajectory::Pose> poses;
  Columns columns{0, 1, 2, 3};
  bool first = true;
  std::string_view line;
  while (file.line(line)) {
    if (isComment(line)) continue;
    Trajectory::Pose pose;
    if (parsePose(line, columns, pose)) {
      poses.push_back(pose);
    } else if (first) {
      columns = columnsByName(file, line);
    } else {
      file.failLine("is not time x y z");
    }
    first = false;
  }
  Trajectory trajectory(std::move(poses));
  if (trajectory.size() == 0) file.fail("has no poses: time x y z, a line each");
  return trajectory;
}

}  // namespace segorient::program
