// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
//
// All methods of orientation side by side, as a Markdown table, worst cloud of the default method
// first.
//   orientation_benchmark DIRECTORY [CLOUD.ply ...]
// DIRECTORY has manifest.tsv (name, points, closed or open, ...) and clouds with true normals:
// binary little-endian PLY of float x y z nx ny nz. Closed clouds: share of points that agree with
// the true normal, without any flip; open ones: the better sign of each connected part.
#include <segorient/common/neighborhoods.h>
#include <segorient/orientation/pipeline.h>
#include <segorient/search/median_hash_index.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>
#include <numeric>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "orientation_peers.h"

namespace {

using segorient::OrientationMethod;

struct TrueCloud {
  std::string name;
  bool closed = false;
  std::vector<float> rows;  // x y z nx ny nz

  std::size_t size() const { return rows.size() / 6; }
  segorient::PointView points() const { return {rows.data(), 6, size()}; }
  const float* normal(std::size_t i) const { return &rows[6 * i + 3]; }
};

bool readPly(const std::string& path, TrueCloud& cloud) {
  std::ifstream file(path, std::ios::binary);
  std::string line;
  std::size_t points = 0;
  while (std::getline(file, line) && line != "end_header") {
    if (line.rfind("element vertex ", 0) == 0) points = std::stoul(line.substr(15));
  }
  cloud.rows.resize(6 * points);
  file.read(reinterpret_cast<char*>(cloud.rows.data()),
            static_cast<std::streamsize>(cloud.rows.size() * sizeof(float)));
  return file.good() && points > 0;
}

// Connected parts of the true surface: neighbours that lie along each other's true tangent plane.
std::vector<std::size_t> connectedParts(const TrueCloud& cloud) {
  segorient::search::MedianHashIndex index;
  index.build(cloud.points(), nullptr, {});
  segorient::Neighborhoods neighbors;
  index.nearestKAll(11, neighbors);
  std::vector<std::size_t> root(cloud.size());
  std::iota(root.begin(), root.end(), std::size_t{0});
  const auto find = [&](std::size_t i) {
    while (root[i] != i) i = root[i] = root[root[i]];
    return i;
  };
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    for (int j = 1; j < neighbors.count(i); ++j) {
      const auto q = static_cast<std::size_t>(neighbors.indices(i)[j]);
      float along = 0.F;
      float squared = 0.F;
      for (std::size_t a = 0; a < 3; ++a) {
        const float d = cloud.points()[q][a] - cloud.points()[i][a];
        along += d * cloud.normal(i)[a];
        squared += d * d;
      }
      if (along * along <= 0.5F * squared) root[find(i)] = find(q);
    }
  }
  for (std::size_t i = 0; i < cloud.size(); ++i) root[i] = find(i);
  return root;
}

// Percentage of points on the right side.
double score(const TrueCloud& cloud, const std::vector<float>& normals) {
  std::vector<std::array<std::size_t, 2>> counts(cloud.size());
  const std::vector<std::size_t> part =
      cloud.closed ? std::vector<std::size_t>(cloud.size(), 0) : connectedParts(cloud);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const float* n = &normals[4 * i];
    const float* t = cloud.normal(i);
    const float agree = n[0] * t[0] + n[1] * t[1] + n[2] * t[2];
    if (agree > 0.F) ++counts[part[i]][0];
    if (agree < 0.F) ++counts[part[i]][1];
  }
  std::size_t right = 0;
  for (const auto& count : counts) {
    right += cloud.closed ? count[0] : std::max(count[0], count[1]);
  }
  return 100.0 * static_cast<double>(right) / static_cast<double>(cloud.size());
}

struct Column {
  const char* title;
  std::function<std::vector<float>(const segorient::PointView&)> orient;  // 4 floats a point
};

Column own(const char* title, const segorient::OrientationOptions& orientation) {
  return {title, [orientation](const segorient::PointView& points) {
            segorient::PipelineOptions options;
            options.orientation = orientation;
            return orientCloud(points, nullptr, options).normals;
          }};
}

std::vector<Column> columns() {
  std::vector<Column> out;
  out.push_back({"PCL, viewpoint", segorient::benchmark::orientWithPcl});
#ifdef SEGORIENT_HAVE_CGAL
  out.push_back({"CGAL, spanning tree", segorient::benchmark::orientWithCgal});
#endif
  segorient::OrientationOptions o;
  o.method = OrientationMethod::PROPAGATION;
  o.point_tree = true;
  out.push_back(own("point tree", o));
  o.point_tree = false;
  out.push_back(own("propagation", o));
  o.angle = segorient::SegmentAngle::REFERENCE_NORMALS;
  out.push_back(own("propagation (reference)", o));
  o = {};
  o.method = OrientationMethod::BOUNDARY;
  out.push_back(own("boundary", o));
  o.boundary = segorient::BoundaryTest::TRIANGULATED;
  out.push_back(own("boundary (triangulated)", o));
  o = {};
  o.method = OrientationMethod::EXTREMAL;
  out.push_back(own("extremal", o));
  o.method = OrientationMethod::COMBINED;
  out.push_back(own("combined", o));
  o.method = OrientationMethod::AUTO;
  out.push_back(own("auto", o));
  return out;
}

struct Row {
  std::string name;
  bool closed = false;
  std::vector<double> scores;
  std::vector<double> seconds;
};

Row measure(const TrueCloud& cloud, const std::vector<Column>& methods) {
  Row row;
  row.name = cloud.name;
  row.closed = cloud.closed;
  for (const Column& column : methods) {
    const auto start = std::chrono::steady_clock::now();
    const std::vector<float> normals = column.orient(cloud.points());
    row.seconds.push_back(
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    row.scores.push_back(score(cloud, normals));
  }
  return row;
}

// Each cell: share right in percent, seconds.
void print(std::vector<Row> rows, const std::vector<Column>& methods) {
  std::stable_sort(rows.begin(), rows.end(),
                   [](const Row& l, const Row& r) { return l.scores.back() < r.scores.back(); });
  std::printf("| cloud | |");
  for (const Column& column : methods) std::printf(" %s |", column.title);
  std::printf("\n|---|---|");
  for (std::size_t i = 0; i < methods.size(); ++i) std::printf("---|");
  std::printf("\n");
  for (const Row& row : rows) {
    std::printf("| %s | %s |", row.name.c_str(), row.closed ? "closed" : "open");
    for (std::size_t m = 0; m < methods.size(); ++m) {
      std::printf(" %.2f (%.2f) |", row.scores[m], row.seconds[m]);
    }
    std::printf("\n");
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: orientation_benchmark DIRECTORY [CLOUD.ply ...]\n");
    return 2;
  }
  const std::string directory = argv[1];
  const std::set<std::string> wanted(argv + 2, argv + argc);
  std::ifstream manifest(directory + "/manifest.tsv");
  if (!manifest) {
    std::fprintf(stderr, "%s/manifest.tsv: cannot be read\n", directory.c_str());
    return 1;
  }
  std::string line;
  std::getline(manifest, line);
  std::vector<Row> rows;
  while (std::getline(manifest, line)) {
    std::istringstream fields(line);
    TrueCloud cloud;
    std::string points;
    std::string kind;
    std::getline(fields, cloud.name, '\t');
    std::getline(fields, points, '\t');
    std::getline(fields, kind, '\t');
    cloud.closed = kind.rfind("closed", 0) == 0;
    if (!wanted.empty() && wanted.count(cloud.name) == 0) continue;
    if (!readPly(directory + "/" + cloud.name, cloud)) {
      std::fprintf(stderr, "%s: cannot be read\n", cloud.name.c_str());
      return 1;
    }
    rows.push_back(measure(cloud, columns()));
  }
  print(std::move(rows), columns());
  return 0;
}
