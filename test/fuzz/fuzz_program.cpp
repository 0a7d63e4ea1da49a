// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "byte_reader.h"
#include "commands/commands.h"
#include "io/readers.h"
#include "scratch_directory.h"
#include "targets.h"

namespace segorient::test {
namespace {

using program::CloudTable;
using program::FileError;

using Run = int (*)(const std::vector<std::string>&);

struct Command {
  Run run;
  const char* output;
};

constexpr std::array<Command, 5> kCommands{
    Command{program::runOrient, "out.pcd"}, Command{program::runOrient, "out.ply"},
    Command{program::runNormals, "out.ply"}, Command{program::runSegment, "out.pcd"},
    Command{program::runTriangulate, "out.ply"}};
constexpr std::array<const char*, 6> kInputs{"in.pcd", "in.ply", "in.obj",
                                             "in.xyz", "in.csv", "in.PCD"};

bool sameNumber(double a, double b) {
  return a == b || (std::isnan(a) && std::isnan(b));
}

void checkOutput(const CloudTable& in, const CloudTable& out) {
  expectProperty(out.size == in.size, "as many points as in the input");
  expectProperty(out.hasNormals(), "the output has normals");
  for (std::size_t i = 0; i < in.size; ++i) {
    for (std::size_t a = 0; a < 3; ++a) {
      expectProperty(sameNumber(in.position(i)[a], out.position(i)[a]), "points stay as they are");
    }
  }
  for (const program::Field& field : in.fields) {
    // Taken for the copy of `label` that CloudCompare wants, where it says the same.
    const bool copy = field.name == "scalar_label" && out.find("label") != nullptr;
    const bool kept = out.find(field.name) != nullptr || field.count != 1 || copy;
    expectProperty(kept, "fields are kept");
  }
}

}  // namespace

void fuzzProgram(const std::uint8_t* data, std::size_t size) {
  static const ScratchDirectory directory;
  ByteReader reader(data, size);
  const std::string in = directory.file(kInputs[reader.below(kInputs.size())]);
  const Command& command = kCommands[reader.below(kCommands.size())];
  const std::string out = directory.file(command.output);
  std::string content;
  while (!reader.empty()) content += static_cast<char>(reader.byte());
  std::ofstream(in, std::ios::binary) << content;

  bool refused = false;
  try {
    command.run({in, out, "--quiet", "--threads=1"});
  } catch (const FileError& error) {
    refused = true;
    const std::string text = error.what();
    expectProperty(text.find('\n') == std::string::npos, "a reason in one line");
    expectProperty(text.compare(0, in.size(), in) == 0, "a reason that names the file");
  }
  expectProperty(std::filesystem::exists(out) == !refused, "an output unless there is an error");
  if (!refused) checkOutput(program::readCloud(in), program::readCloud(out));
  std::filesystem::remove(in);
  std::filesystem::remove(out);
  expectProperty(directory.entries() == 0, "nothing else is left");
}

}  // namespace segorient::test
