// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/neighborhoods.h>
#include <segorient/common/point_view.h>
#include <segorient/search/median_hash_index.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <numeric>
#include <sstream>
#include <string>
#include <vector>

namespace segorient::benchmark {

/// A cloud with true normals.
struct TrueCloud {
  std::string name;
  bool closed = false;
  std::vector<float> rows;         // x y z nx ny nz
  std::vector<std::int32_t> part;  // connected part of the surface, where the file tells

  std::size_t size() const { return rows.size() / 6; }
  PointView points() const { return {rows.data(), 6, size()}; }
  const float* normal(std::size_t i) const { return &rows[6 * i + 3]; }
};

/// Reads a binary little-endian PLY whose vertices have float x y z nx ny nz, in any order and
/// beside other scalars; "part" tells the connected parts. A comment "closed=1" or "closed=0" in
/// the file says which it is.
inline bool readPly(const std::string& path, TrueCloud& cloud) {
  const std::map<std::string, std::size_t> sizes{
      {"char", 1},  {"uchar", 1},   {"int8", 1},   {"uint8", 1},  {"short", 2}, {"ushort", 2},
      {"int16", 2}, {"uint16", 2},  {"int", 4},    {"uint", 4},   {"int32", 4}, {"uint32", 4},
      {"float", 4}, {"float32", 4}, {"double", 8}, {"float64", 8}};
  std::ifstream file(path, std::ios::binary);
  std::string line;
  std::size_t points = 0;
  std::size_t stride = 0;
  std::map<std::string, std::size_t> offsets;
  while (std::getline(file, line) && line != "end_header") {
    std::istringstream words(line);
    std::string word;
    std::string type;
    std::string name;
    words >> word >> type >> name;
    if (word == "element" && type == "vertex") points = std::stoul(name);
    if (word == "property") {
      if (sizes.count(type) == 0) return false;
      offsets[name] = stride;
      stride += sizes.at(type);
    }
    if (line.find("closed=1") != std::string::npos) cloud.closed = true;
  }
  cloud.rows.resize(6 * points);
  const auto part = offsets.find("part");
  if (part != offsets.end()) cloud.part.resize(points);
  std::vector<char> vertex(stride);
  for (std::size_t i = 0; i < points; ++i) {
    if (!file.read(vertex.data(), static_cast<std::streamsize>(stride))) return false;
    float* row = &cloud.rows[6 * i];
    for (const char* name : {"x", "y", "z", "nx", "ny", "nz"}) {
      const auto offset = offsets.find(name);
      if (offset == offsets.end()) return false;
      std::memcpy(row++, &vertex[offset->second], sizeof(float));
    }
    if (part != offsets.end()) std::memcpy(&cloud.part[i], &vertex[part->second], sizeof(float));
  }
  return points > 0;
}

/// Names of clouds in a directory, and whether they are closed: from its manifest.tsv (name,
/// points, closed or open, ...), or all .ply files where there is none.
inline std::map<std::string, bool> listClouds(const std::string& directory) {
  std::map<std::string, bool> clouds;
  std::ifstream manifest(directory + "/manifest.tsv");
  std::string line;
  std::getline(manifest, line);
  while (std::getline(manifest, line)) {
    std::istringstream fields(line);
    std::string name;
    std::string points;
    std::string kind;
    std::getline(fields, name, '\t');
    std::getline(fields, points, '\t');
    std::getline(fields, kind, '\t');
    clouds[name] = kind.rfind("closed", 0) == 0;
  }
  if (!clouds.empty()) return clouds;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(directory, error)) {
    if (entry.path().extension() == ".ply") clouds[entry.path().filename().string()] = false;
  }
  return clouds;
}

/// Connected parts of the true surface, as indices below the number of points: as the file tells,
/// else by neighbours that lie along each other's true tangent plane.
inline std::vector<std::size_t> connectedParts(const TrueCloud& cloud) {
  if (!cloud.part.empty()) {
    std::map<std::int32_t, std::size_t> first;
    std::vector<std::size_t> parts;
    for (const std::int32_t p : cloud.part)
      parts.push_back(first.emplace(p, parts.size()).first->second);
    return parts;
  }
  search::MedianHashIndex index;
  index.build(cloud.points(), nullptr, {});
  Neighborhoods neighbors;
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

/// Percentage of all points whose normal points the true way: closed clouds without any flip, open
/// ones by the better sign of each connected part.
/// \param normals 4 floats a point
inline double score(const TrueCloud& cloud, const std::vector<float>& normals) {
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

}  // namespace segorient::benchmark
