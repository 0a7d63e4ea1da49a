// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "io/readers.h"
#include "io/text_numbers.h"
#include "io/value_range.h"

namespace segorient::program {
namespace {

// Numbers of a text file, row by row.
struct Numbers {
  std::size_t columns = 0;
  std::vector<double> values;
  std::size_t rows() const { return columns == 0 ? 0 : values.size() / columns; }
  double at(std::size_t row, std::size_t column) const { return values[row * columns + column]; }
};

// Whether columns need doubles, as map coordinates and times do. Up to three are looked at
// together.
bool needDouble(const Numbers& numbers, const std::vector<std::size_t>& columns) {
  return program::needDouble(numbers.rows(), [&](std::size_t row) {
    std::array<double, 3> p{0.0, 0.0, 0.0};
    for (std::size_t c = 0; c < std::min<std::size_t>(columns.size(), 3); ++c) {
      p[c] = numbers.at(row, columns[c]);
    }
    return p;
  });
}

// Six columns without names are taken for x y z and a normal if all those are of unit length.
bool endsInNormals(const Numbers& numbers) {
  if (numbers.columns != 6 || numbers.rows() == 0) return false;
  for (std::size_t i = 0; i < numbers.rows(); ++i) {
    const double length = std::hypot(numbers.at(i, 3), numbers.at(i, 4), numbers.at(i, 5));
    if (!(std::abs(length - 1.0) < 1e-2)) return false;
  }
  return true;
}

// Columns that PCL has as floats.
bool isFloatInPcl(const std::string& name) {
  static const std::array<const char*, 6> kNames{"normal_x",  "normal_y",  "normal_z",
                                                 "curvature", "intensity", "rgb"};
  return std::find(kNames.begin(), kNames.end(), name) != kNames.end();
}

CloudTable makeTable(const Numbers& numbers, const std::vector<std::string>& names) {
  CloudTable table;
  std::vector<std::size_t> xyz;
  for (std::size_t c = 0; c < numbers.columns; ++c) {
    if (names[c] == "x" || names[c] == "y" || names[c] == "z") xyz.push_back(c);
  }
  const bool far = needDouble(numbers, xyz);
  for (std::size_t c = 0; c < numbers.columns; ++c) {
    const bool coordinate = std::find(xyz.begin(), xyz.end(), c) != xyz.end();
    const bool wide = coordinate ? far : !isFloatInPcl(names[c]) && needDouble(numbers, {c});
    table.addField(names[c], 'F', wide ? 8 : 4);
  }
  table.size = numbers.rows();
  table.width = table.size;
  table.rows.resize(table.size * table.row_bytes);
  for (std::size_t i = 0; i < table.size; ++i) {
    for (std::size_t c = 0; c < numbers.columns; ++c) {
      const Field& f = table.fields[c];
      const double v = numbers.at(i, c);
      const auto single = static_cast<float>(v);
      std::memcpy(table.at(f, i), f.size == 8 ? static_cast<const void*>(&v) : &single, f.size);
    }
  }
  return table;
}

std::vector<std::string> columnNames(const Numbers& numbers,
                                     const std::vector<std::string>& header) {
  if (header.size() == numbers.columns) return header;
  std::vector<std::string> names{"x", "y", "z"};
  const bool normals = endsInNormals(numbers);
  for (std::size_t c = 3; c < numbers.columns; ++c) {
    static const char* const kNormal[] = {"normal_x", "normal_y", "normal_z"};
    names.push_back(normals ? kNormal[c - 3] : "column_" + std::to_string(c + 1));
  }
  return names;
}

// Names of columns, if the line has any that we know.
std::vector<std::string> parseNames(std::string_view line) {
  std::vector<std::string> names;
  bool known = false;
  for (auto word = nextWord(line, kTextSeparators); !word.empty();
       word = nextWord(line, kTextSeparators)) {
    std::string name;
    for (const char c : word) {
      if (c != '"' && c != '#' && c != '/') name += c;
    }
    if (name.empty()) continue;
    if (name == "X" || name == "Y" || name == "Z") name[0] = static_cast<char>(name[0] - 'A' + 'a');
    known = known || name == "x";
    names.push_back(pclName(std::move(name)));
  }
  return known ? names : std::vector<std::string>{};
}

// A row with more numbers than there are names would give them to the wrong columns.
void requireNames(const InputFile& file, const std::string& header, std::size_t names,
                  std::string_view line, std::size_t numbers) {
  if (header.empty() || names >= numbers) return;
  const bool decimal_commas =
      header.find(',') == std::string::npos && line.find(',') != std::string_view::npos;
  file.failLine("has " + std::to_string(numbers) + " numbers, and the header has " +
                std::to_string(names) + " names" +
                (decimal_commas ? ": are its commas decimal ones? Points are read" : ""));
}

bool isComment(std::string_view line) {
  const std::size_t first = line.find_first_not_of(" \t");
  return first == std::string_view::npos || line[first] == '#' || line.compare(first, 2, "//") == 0;
}

}  // namespace

CloudTable readText(InputFile& file) {
  Numbers numbers;
  std::vector<std::string> header;
  std::string header_line;  // of a header that is no comment: those may be prose
  std::vector<double> row;
  std::string_view line;
  while (file.line(line)) {
    if (isComment(line)) {
      if (numbers.columns == 0 && header.empty()) header = parseNames(line);
      continue;
    }
    const bool is_row = parseNumbers(line, row);
    if (numbers.columns == 0) {
      // Before the points there may be one line of names, or of their number.
      if (!is_row && header.empty()) {
        header = parseNames(line);
        header_line = line;
        if (!header.empty()) continue;
      }
      if (is_row && row.size() == 1 && file.lineNumber() == 1) continue;
      if (!is_row || row.size() < 3) file.failLine("does not begin with x y z");
      requireNames(file, header_line, header.size(), line, row.size());
      numbers.columns = row.size();
    }
    if (!is_row || row.size() != numbers.columns) {
      file.failLine("is not of " + std::to_string(numbers.columns) + " numbers as those before it");
    }
    numbers.values.insert(numbers.values.end(), row.begin(), row.end());
  }
  if (numbers.columns == 0) numbers.columns = 3;
  return makeTable(numbers, columnNames(numbers, header));
}

CloudTable readObj(InputFile& file) {
  Numbers numbers;
  numbers.columns = 3;
  std::vector<double> row;
  std::string_view line;
  while (file.line(line)) {
    if (nextWord(line) != "v") continue;
    if (!parseNumbers(line, row) || row.size() < 3) file.failLine("is no vertex");
    numbers.values.insert(numbers.values.end(), row.begin(), row.begin() + 3);
  }
  if (numbers.values.empty()) file.fail("has no vertices");
  return makeTable(numbers, {"x", "y", "z"});
}

}  // namespace segorient::program
