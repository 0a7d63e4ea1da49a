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

}  // namespace

Trajectory readTrajectory(const std::string& path) {
  InputFile file(path);
  std::vector<Trajectory::Pose> poses;
  Columns columns{0, 1, 2, 3};
  bool first = true;
  std::vector<double> row;
  std::string_view line;
  while (file.line(line)) {
    if (isComment(line)) continue;
    const bool numbers = parseNumbers(line, row);
    if (first && !numbers) {
      columns = columnsByName(file, line);
    } else if (!numbers || row.size() <= *std::max_element(columns.begin(), columns.end())) {
      file.failLine("is not time x y z");
    } else {
      poses.push_back({row[columns[0]], {row[columns[1]], row[columns[2]], row[columns[3]]}});
    }
    first = false;
  }
  Trajectory trajectory(std::move(poses));
  if (trajectory.size() == 0) file.fail("has no poses: time x y z, a line each");
  return trajectory;
}

}  // namespace segorient::program
