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

// What follows x y z, by the numbers of a row.
struct Layout {
  std::size_t columns = 0;
  bool intensity = false;  // the fourth number
  std::size_t color = 0;   // first of three numbers, 0: there is none
  std::size_t normal = 0;  // the same
};

bool areColors(const std::vector<double>& row, std::size_t first) {
  return std::all_of(row.begin() + static_cast<std::ptrdiff_t>(first),
                     row.begin() + static_cast<std::ptrdiff_t>(first + 3),
                     [](double v) { return v >= 0.0 && v <= 255.0 && v == std::floor(v); });
}

Layout layoutOf(const InputFile& file, const std::vector<double>& row) {
  Layout out;
  out.columns = row.size();
  out.intensity = row.size() == 4 || row.size() == 7 || row.size() == 10;
  if (row.size() == 6) (areColors(row, 3) ? out.color : out.normal) = 3;
  if (row.size() >= 7) out.color = 4;
  if (row.size() == 10) out.normal = 7;
  const bool known = row.size() == 3 || row.size() == 6 || out.intensity;
  if (!known) file.failLine("is no point: x y z, intensity, red green blue, normal");
  return out;
}

CloudTable tableOf(const std::vector<double>& values, const Layout& layout,
                   const std::vector<std::size_t>& starts) {
  CloudTable table;
  table.size = values.size() / layout.columns;
  table.width = table.size;
  const bool wide = needDouble(table.size, [&](std::size_t i) -> std::array<double, 3> {
    const double* row = &values[i * layout.columns];
    return {row[0], row[1], row[2]};
  });
  for (const char* name : {"x", "y", "z"}) table.addField(name, 'F', wide ? 8 : 4);
  if (layout.intensity) table.addField("intensity", 'F', 4);
  if (layout.normal > 0) {
    for (const char* name : {"normal_x", "normal_y", "normal_z"}) table.addField(name, 'F', 4);
  }
  if (layout.color > 0) table.addField("rgb", 'F', 4);
  if (starts.size() > 1) table.addField("scan", 'U', 4);
  table.rows.resize(table.size * table.row_bytes);
  std::uint32_t scan = 0;
  for (std::size_t i = 0; i < table.size; ++i) {
    const double* row = &values[i * layout.columns];
    for (std::size_t c = 0; c < 3; ++c) table.setReal(*table.xyz()[c], i, row[c]);
    if (layout.intensity) table.setReal(*table.find("intensity"), i, row[3]);
    for (std::size_t c = 0; c < 3 && layout.normal > 0; ++c) {
      table.setReal(*table.normals()[c], i, row[layout.normal + c]);
    }
    if (layout.color > 0) {
      std::uint32_t rgb = 0;
      for (std::size_t c = 0; c < 3; ++c) {
        const double v = row[layout.color + c];
        rgb = rgb << 8 |
              static_cast<std::uint32_t>(std::isfinite(v) ? std::clamp(v, 0.0, 255.0) : 0.0);
      }
      std::memcpy(table.at(*table.find("rgb"), i), &rgb, sizeof(rgb));
    }
    if (starts.size() < 2) continue;
    while (scan + 1 < starts.size() && i >= starts[scan + 1]) ++scan;
    std::memcpy(table.at(*table.find("scan"), i), &scan, sizeof(scan));
  }
  return table;
}

}  // namespace

CloudTable readPts(InputFile& file) {
  Layout layout;
  std::vector<double> values;
  std::vector<std::size_t> starts;  // first row of each scan
  std::uint64_t expected = 0;       // rows of all scans so far
  std::vector<double> row;
  std::string_view line;
  while (file.line(line)) {
    std::string_view rest = line;
    const std::string_view word = nextWord(rest, kTextSeparators);
    if (word.empty() || word.front() == '#' || word.substr(0, 2) == "//") continue;
    if (!parseNumbers(line, row)) file.failLine("is not of numbers");
    const std::size_t rows = layout.columns == 0 ? 0 : values.size() / layout.columns;
    if (row.size() == 1) {
      std::uint64_t count = 0;
      if (!parseNumber(word, count)) file.failLine("is not a number of points");
      if (rows < expected) {
        file.failLine("begins a scan before the " + std::to_string(expected) +
                      " points that were said to come are there");
      }
      if (count > (file.remaining() + 1) / 6) {  // "0 0 0" and the line's end
        file.fail("is cut short: it is too small for its " + std::to_string(count) + " points");
      }
      expected = rows + count;
      starts.push_back(rows);
      continue;
    }
    if (layout.columns == 0) layout = layoutOf(file, row);
    if (row.size() != layout.columns) {
      file.failLine("is not of " + std::to_string(layout.columns) + " numbers as those before it");
    }
    values.insert(values.end(), row.begin(), row.end());
  }
  if (layout.columns == 0) file.fail("has no points");
  CloudTable table = tableOf(values, layout, starts);
  if (table.size < expected) {
    file.fail("is cut short: it ends before point " + std::to_string(table.size) + " of " +
              std::to_string(expected));
  }
  if (!starts.empty() && table.size > expected) {
    table.notes.push_back("has more points than the " + std::to_string(expected) + " that it says");
  }
  return table;
}

}  // namespace segorient::program
