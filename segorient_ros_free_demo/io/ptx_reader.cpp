// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <Eigen/Core>
#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include "io/readers.h"
#include "io/text_numbers.h"
#include "io/value_range.h"

namespace segorient::program {
namespace {

using Vector = std::array<double, 3>;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

struct Point {
  Vector position{kNaN, kNaN, kNaN};
  float intensity = 0.F;
  std::uint32_t rgb = 0;
};

struct Scan {
  std::size_t columns = 0;
  std::size_t rows = 0;
  std::array<std::array<double, 4>, 4> pose{};  // p' = p pose, p a row vector
  Vector scanner{0.0, 0.0, 0.0};
  std::vector<Point> points;
};

// A line of numbers; false at the end of the file. Blank lines are passed over.
bool numbersOf(InputFile& file, std::vector<double>& out) {
  std::string_view line;
  do {
    if (!file.line(line)) return false;
    if (!parseNumbers(line, out)) file.failLine("is not of numbers");
  } while (out.empty());
  return true;
}

std::vector<double> headerLine(InputFile& file, std::size_t count) {
  std::vector<double> out;
  if (!numbersOf(file, out)) file.fail("is cut short: it ends in a scan's header");
  const bool finite =
      std::all_of(out.begin(), out.end(), [](double v) { return std::isfinite(v); });
  if (out.size() != count || !finite) {
    file.failLine("of a scan's header is not of " + std::to_string(count) + " numbers");
  }
  return out;
}

std::size_t gridSize(const InputFile& file, const std::vector<double>& line) {
  constexpr double kMost = 1e9;
  if (line.size() != 1 || !(line[0] >= 0.0 && line[0] <= kMost) || line[0] != std::floor(line[0])) {
    file.failLine("is not the size of a scan's grid");
  }
  return static_cast<std::size_t>(line[0]);
}

bool isIdentity(const std::array<std::array<double, 4>, 4>& m) {
  for (std::size_t r = 0; r < 4; ++r) {
    for (std::size_t c = 0; c < 4; ++c) {
      if (m[r][c] != (r == c ? 1.0 : 0.0)) return false;
    }
  }
  return true;
}

// Whether the matrix leaves no volume, or none that is a number.
bool flattens(const std::array<std::array<double, 4>, 4>& m) {
  constexpr double kRounding = 1e-9;
  const Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>> pose(m[0].data());
  const Eigen::Matrix3d axes = pose.topLeftCorner<3, 3>();
  return !(std::fabs(axes.determinant()) > kRounding * axes.rowwise().norm().prod());
}

// Scanner's place and axes, then the matrix that brings the points to where they belong. Both say
// the same but where a program has moved the points already and left the matrix empty.
void readPose(InputFile& file, std::size_t number, Scan& scan) {
  const std::vector<double> place = headerLine(file, 3);
  for (int axis = 0; axis < 3; ++axis) headerLine(file, 3);
  for (auto& row : scan.pose) {
    const std::vector<double> line = headerLine(file, 4);
    std::copy(line.begin(), line.end(), row.begin());
  }
  auto& m = scan.pose;
  if (flattens(m)) {
    file.fail("has a pose that would flatten all points of scan " + std::to_string(number));
  }
  const bool last_row = m[3][0] == 0.0 && m[3][1] == 0.0 && m[3][2] == 0.0;
  const bool last_column = m[0][3] == 0.0 && m[1][3] == 0.0 && m[2][3] == 0.0;
  if (last_row && !last_column) {  // written for column vectors
    for (std::size_t r = 0; r < 4; ++r) {
      for (std::size_t c = 0; c < r; ++c) std::swap(m[r][c], m[c][r]);
    }
  }
  scan.scanner =
      isIdentity(m) ? Vector{place[0], place[1], place[2]} : Vector{m[3][0], m[3][1], m[3][2]};
}

std::uint32_t colorOf(const std::vector<double>& row) {
  std::uint32_t out = 0;
  for (std::size_t c = 4; c < 7; ++c) {
    const double v = std::isfinite(row[c]) ? std::clamp(row[c], 0.0, 255.0) : 0.0;
    out = out << 8 | static_cast<std::uint32_t>(std::lround(v));
  }
  return out;
}

// False at the end of the file.
bool readScan(InputFile& file, std::size_t number, std::size_t& numbers_a_point, Scan& scan) {
  std::vector<double> row;
  if (!numbersOf(file, row)) return false;
  scan.columns = gridSize(file, row);
  if (!numbersOf(file, row)) file.fail("is cut short: it ends in a scan's header");
  scan.rows = gridSize(file, row);
  readPose(file, number, scan);
  const std::uint64_t size = std::uint64_t{scan.columns} * scan.rows;
  constexpr std::uint64_t kLeastBytes = 6;  // "0 0 0" and the line's end
  if (size > (file.remaining() + 1) / kLeastBytes) {
    file.fail("is cut short: it is too small for the " + std::to_string(size) + " points of scan " +
              std::to_string(number));
  }
  scan.points.resize(static_cast<std::size_t>(size));
  for (Point& p : scan.points) {
    if (!numbersOf(file, row)) {
      file.fail("is cut short: it ends within scan " + std::to_string(number));
    }
    const bool known = row.size() == 3 || row.size() == 4 || row.size() == 7;
    if (!known) file.failLine("is no point: x y z, intensity, and perhaps red green blue");
    // Scans with colours and without may stand in one file.
    numbers_a_point = std::max(numbers_a_point, row.size());
    p.intensity = row.size() > 3 ? static_cast<float>(row[3]) : 0.F;
    p.rgb = row.size() == 7 ? colorOf(row) : 0;
    if (row[0] == 0.0 && row[1] == 0.0 && row[2] == 0.0) continue;  // nothing was seen
    for (std::size_t c = 0; c < 3; ++c) {
      p.position[c] = row[0] * scan.pose[0][c] + row[1] * scan.pose[1][c] +
                      row[2] * scan.pose[2][c] + scan.pose[3][c];
    }
  }
  return true;
}

bool isSeen(const Point& p) {
  return !std::isnan(p.position[0]);
}

bool farFromOrigin(const std::vector<Scan>& scans) {
  std::vector<std::size_t> ends;
  std::size_t size = 0;
  for (const Scan& scan : scans) ends.push_back(size += scan.points.size());
  return needDouble(size, [&](std::size_t i) {
    const auto end = std::upper_bound(ends.begin(), ends.end(), i);
    const Scan& scan = scans[static_cast<std::size_t>(end - ends.begin())];
    return scan.points[i + scan.points.size() - *end].position;
  });
}

CloudTable tableOf(const std::vector<Scan>& scans, bool colors) {
  CloudTable table;
  const std::uint32_t real = farFromOrigin(scans) ? 8 : 4;
  for (const char* name : {"x", "y", "z"}) table.addField(name, 'F', real);
  table.addField("intensity", 'F', 4);
  if (colors) table.addField("rgb", 'F', 4);
  for (const char* name : {"vp_x", "vp_y", "vp_z"}) table.addField(name, 'F', real);
  const bool several = scans.size() > 1;
  if (several) table.addField("scan", 'U', 4);
  std::size_t unseen = 0;
  for (const Scan& scan : scans) {
    const auto seen = std::count_if(scan.points.begin(), scan.points.end(), isSeen);
    unseen += scan.points.size() - static_cast<std::size_t>(seen);
    table.size += several ? static_cast<std::size_t>(seen) : scan.points.size();
  }
  if (several && unseen > 0) {
    table.notes.push_back(std::to_string(unseen) +
                          " places of its grids where nothing was seen are left out");
  }
  table.rows.resize(table.size * table.row_bytes);
  std::size_t row = 0;
  for (std::size_t s = 0; s < scans.size(); ++s) {
    for (const Point& p : scans[s].points) {
      if (several && !isSeen(p)) continue;
      for (std::size_t c = 0; c < 3; ++c) {
        table.setReal(*table.xyz()[c], row, p.position[c]);
        table.setReal(*table.viewpoints()[c], row, scans[s].scanner[c]);
      }
      table.setReal(*table.find("intensity"), row, static_cast<double>(p.intensity));
      if (colors) std::memcpy(table.at(*table.find("rgb"), row), &p.rgb, sizeof(p.rgb));
      const auto number = static_cast<std::uint32_t>(s);
      if (several) std::memcpy(table.at(*table.find("scan"), row), &number, sizeof(number));
      ++row;
    }
  }
  const bool grid = !several && scans[0].columns > 1 && scans[0].rows > 1;
  table.width = grid ? scans[0].rows : table.size;
  table.height = grid ? scans[0].columns : 1;
  return table;
}

}  // namespace

CloudTable readPtx(InputFile& file) {
  std::vector<Scan> scans;
  std::size_t numbers_a_point = 0;
  for (;;) {
    Scan scan;
    if (!readScan(file, scans.size(), numbers_a_point, scan)) break;
    scans.push_back(std::move(scan));
  }
  if (scans.empty()) file.fail("has no scans");
  return tableOf(scans, numbers_a_point == 7);
}

}  // namespace segorient::program
