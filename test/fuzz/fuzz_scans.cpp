// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// Files of scanners: read, joined, written as LAS, and read again.
#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "byte_reader.h"
#include "io/cloud_writer.h"
#include "io/join_clouds.h"
#include "io/las_format.h"
#include "io/readers.h"
#include "scratch_directory.h"
#include "targets.h"

namespace segorient::test {
namespace {

using program::CloudTable;
using program::FileError;

constexpr std::array<const char*, 5> kInputs{"in.ptx", "in.pts", "in.las", "in.laz", "path.txt"};

bool isFinite(const std::array<double, 3>& p) {
  return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
}

void checkTable(const CloudTable& table, std::size_t file_size) {
  expectProperty(table.rows.size() == table.size * table.row_bytes, "rows are whole");
  expectProperty(table.width * table.height == table.size, "width times height");
  // A point takes a byte of the file at least, and a field of eight bytes comes from one.
  expectProperty(table.size <= file_size, "no more points than bytes");
}

void checkJoint(const CloudTable& table) {
  const CloudTable joint = program::joinClouds({table, table}, {"a", "b"}, true);
  expectProperty(joint.size == 2 * table.size, "all points of both");
  const program::Field* scan = joint.find("scan");
  for (std::size_t i = 0; i < table.size; ++i) {
    for (std::size_t a = 0; a < 3; ++a) {
      const double before = table.position(i)[a];
      const double after = joint.position(table.size + i)[a];
      expectProperty(before == after || (std::isnan(before) && std::isnan(after)), "same places");
    }
    expectProperty(joint.value(*scan, i) < joint.value(*scan, table.size + i),
                   "scans are told apart");
  }
}

// As LAS, positions differ by half a step at most, and what is not finite is gone.
void checkLas(const CloudTable& table, const std::string& path) {
  program::OutputCloud cloud(table);
  cloud.addRest(table);
  {
    program::OutputFile file(path);
    writeCloud(cloud, file);
    file.commit();
  }
  std::size_t finite = 0;
  for (std::size_t i = 0; i < table.size; ++i) finite += isFinite(table.position(i)) ? 1U : 0U;
  if (finite > 0) {
    const CloudTable back = program::readCloud(path);
    expectProperty(back.size == finite, "all points that have a place");
  }
  std::filesystem::remove(path);
}

}  // namespace

void fuzzScans(const std::uint8_t* data, std::size_t size) {
  static const ScratchDirectory directory;
  ByteReader reader(data, size);
  const std::string name = kInputs[reader.below(kInputs.size())];
  const std::string in = directory.file(name);
  std::string content;
  while (!reader.empty()) content += static_cast<char>(reader.byte());
  std::ofstream(in, std::ios::binary) << content;
  try {
    if (name == "path.txt") {
      const Trajectory trajectory = program::readTrajectory(in);
      expectProperty(trajectory.size() > 0, "poses, or an error");
      const TrajectoryJoin join = joinTrajectory(
          trajectory, {trajectory.begin(), trajectory.end(), 0.0, 1e300, std::nan("")});
      expectProperty(join.joined >= 2, "its own times are in it");
      explainNoOverlap(trajectory, join);
    } else {
      const CloudTable table = program::readCloud(in);
      checkTable(table, content.size());
      checkJoint(table);
      checkLas(table, directory.file("out.las"));
    }
  } catch (const FileError& error) {
    const std::string text = error.what();
    expectProperty(text.find('\n') == std::string::npos, "a reason in one line");
    expectProperty(text.compare(0, in.size(), in) == 0, "a reason that names the file");
  }
  std::filesystem::remove(in);
  expectProperty(directory.entries() == 0, "nothing else is left");
}

}  // namespace segorient::test
