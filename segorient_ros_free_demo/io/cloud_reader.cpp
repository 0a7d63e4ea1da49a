// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <algorithm>
#include <cctype>
#include <cmath>

#include "io/file_endings.h"
#include "io/readers.h"
#include "support/command_line.h"

namespace segorient::program {
namespace {

// All coordinates are floating point numbers afterwards; some scanners write whole ones.
void checkCoordinates(const InputFile& file, CloudTable& table) {
  bool real = true;
  for (const Field* f : table.xyz()) {
    if (f == nullptr) file.fail("has no fields x, y, z");
    if (f->count != 1) file.fail("field " + f->name + " is not a single number");
    real = real && f->type == 'F';
  }
  if (!real) table.makeReal({"x", "y", "z"});
}

}  // namespace

std::string fileEnding(const std::string& path) {
  const std::size_t slash = path.find_last_of('/');
  const std::size_t dot = path.find_last_of('.');
  if (dot == std::string::npos || (slash != std::string::npos && dot < slash)) return {};
  std::string ending = path.substr(dot);
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending;
}

void allocateRows(const InputFile& file, CloudTable& table, std::uint64_t size,
                  std::uint64_t least_bytes) {
  // One byte more: the end of a text file's last line may be missing.
  if (size > (file.remaining() + 1) / std::max<std::uint64_t>(1, least_bytes)) {
    file.fail("is cut short: it is too small for its " + std::to_string(size) + " points");
  }
  table.size = static_cast<std::size_t>(size);
  table.rows.resize(table.size * table.row_bytes);
}

CloudTable readCloud(const std::string& path) {
  InputFile file(path);
  const std::string ending = fileEnding(path);
  CloudTable table;
  if (ending == ".pcd") {
    table = readPcd(file);
  } else if (ending == ".ply") {
    table = readPly(file);
  } else if (ending == ".obj") {
    table = readObj(file);
  } else if (ending == ".xyz" || ending == ".txt" || ending == ".asc" || ending == ".csv") {
    table = readText(file);
  } else if (ending == ".pts") {
    table = readPts(file);
  } else if (ending == ".ptx") {
    table = readPtx(file);
  } else if (ending == ".las" || ending == ".laz") {
    table = readLas(file);
  } else {
    file.fail(
        "is of a kind not known by its ending (known: .pcd .ply .las .obj .ptx .pts .xyz .txt .asc "
        ".csv)");
  }
  checkCoordinates(file, table);
  for (const std::string& name : table.dropped) {
    warn(path + ": the lists '" + name + "' of its points are left out");
  }
  for (const std::string& note : table.notes) warn(path + ": " + note);
  if (table.size == 0) file.fail("has no points");
  return table;
}

CloudTable readUsableCloud(const std::string& path) {
  CloudTable table = readCloud(path);
  for (std::size_t i = 0; i < table.size; ++i) {
    const auto p = table.position(i);
    if (std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2])) return table;
  }
  throw FileError(path, "has no point with finite coordinates");
}

}  // namespace segorient::program
