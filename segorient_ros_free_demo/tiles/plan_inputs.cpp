// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "tiles/plan_inputs.h"

#include <sys/stat.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <utility>

#include "io/cloud_stream.h"
#include "io/cloud_writer.h"
#include "io/file_endings.h"
#include "io/readers.h"
#include "support/command_line.h"
#include "support/memory.h"
#include "tiles/checksum.h"
#include "tiles/input_state.h"

namespace segorient::program {
namespace fs = std::filesystem;
namespace {

bool isCloud(const std::string& name) {
  static const std::set<std::string> kEndings{".pcd", ".ply", ".las", ".laz",
                                              ".obj", ".ptx", ".pts"};
  return kEndings.count(fileEnding(name)) > 0;
}

bool isText(const std::string& name) {
  static const std::set<std::string> kEndings{".xyz", ".txt", ".asc", ".csv"};
  return kEndings.count(fileEnding(name)) > 0;
}

// Files of a folder that have such a name; hidden ones are nobody's clouds.
std::vector<std::string> cloudsIn(const std::string& folder, bool (*is_cloud)(const std::string&)) {
  std::vector<std::string> out;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const bool hidden = entry.path().filename().string().front() == '.';
    if (!hidden && entry.is_regular_file() && is_cloud(entry.path().string())) {
      out.push_back(entry.path().string());
    }
  }
  return out;
}

bool isWritable(const std::string& name) {
  const std::string ending = fileEnding(name);
  return ending == ".ply" || ending == ".pcd" || ending == ".las";
}

// Files by what they are, whatever their names.
using FileId = std::pair<dev_t, ino_t>;

FileId idOf(const fs::path& path) {
  struct stat info {};
  return stat(path.c_str(), &info) == 0 ? FileId(info.st_dev, info.st_ino) : FileId();
}

// What is written would take the place of what is still to be read.
void requireNoInput(const fs::path& output, const std::set<FileId>& inputs) {
  if (inputs.size() < 2 || inputs.count(idOf(output)) == 0) return;
  throw FileError(output.string(),
                  "is an input and would be an output: name another folder for these");
}

void addOutputs(const std::string& output, Plan& plan) {
  if (!fs::is_directory(output)) {
    require(isWritable(output), output +
                                    ": tile by tile, an output file must end in .pcd, .ply or "
                                    ".las; or name a folder that is there");
    requireWritable(output);
    plan.outputs.push_back({fs::absolute(output).lexically_normal().string(), 0,
                            static_cast<std::uint32_t>(plan.inputs.size())});
    return;
  }
  std::set<FileId> inputs;
  for (const PlanInput& in : plan.inputs) inputs.insert(idOf(in.path));
  std::set<std::string> names;
  for (std::size_t i = 0; i < plan.inputs.size(); ++i) {
    fs::path name = fs::path(plan.inputs[i].path).filename();
    if (!isWritable(name.string())) name.replace_extension(".ply");
    if (!names.insert(name.string()).second) {
      throw FileError(plan.inputs[i].path,
                      "has the name of another input, for which there is one "
                      "place in the folder of outputs");
    }
    const fs::path to = fs::absolute(fs::path(output) / name).lexically_normal();
    requireNoInput(to, inputs);
    requireWritable(to.string());
    plan.outputs.push_back({to.string(), static_cast<std::uint32_t>(i), 1});
  }
}

// What a run is for: steps take no files of other runs.
std::uint64_t runOf(const TileRequest& request, const Plan& plan) {
  Checksum sum;
  const auto text = [&](const std::string& s) {
    sum.addValue(s.size());
    sum.add(s.data(), s.size());
  };
  text(SEGORIENT_VERSION);
  for (const PlanInput& in : plan.inputs) {
    text(in.path);
    for (const std::uint64_t v : {in.bytes, in.head}) sum.addValue(v);
    sum.addValue(in.time);
  }
  for (const PlanOutput& out : plan.outputs) text(out.path);
  sum.addValue(request.memory);
  sum.addValue(request.tile_points);
  sum.addValue(request.k);
  sum.addValue(request.viewpoint);
  for (const bool b : {request.has_viewpoint, request.up, request.closed, request.open,
                       request.find_sensors, request.keep_orientation}) {
    sum.addValue(b);
  }
  for (const float v : {request.alpha, request.beta, request.epsilon}) sum.addValue(v);
  for (const std::string& path : {request.seeds, request.trajectory}) {
    text(path);
    if (path.empty()) continue;
    const InputState state = stateOf(path);
    for (const std::uint64_t v : {state.bytes, state.head}) sum.addValue(v);
    sum.addValue(state.time);
  }
  return std::max<std::uint64_t>(1, sum.value());
}

// A copy of a cloud that has to be read as a whole.
void convert(const PlanInput& in) {
  warn(in.path + ": can't be read point by point, and is converted first");
  requireMemory(in.path, 2 * in.bytes, availableMemory());
  const CloudTable table = readCloud(in.path);
  OutputFile file(in.streamed);
  OutputCloud cloud(table);
  cloud.addRest(table);
  writeCloud(cloud, file);
  file.commit();
}

void requireSameFields(const CloudTable& first, const CloudTable& other, const std::string& path) {
  bool same = first.fields.size() == other.fields.size();
  for (std::size_t f = 0; same && f < first.fields.size(); ++f) {
    const Field& a = first.fields[f];
    const Field& b = other.fields[f];
    same = a.name == b.name && a.type == b.type && a.size == b.size && a.count == b.count;
  }
  if (!same) {
    throw FileError(path,
                    "has other fields than the first input: for outputs of their own, name a "
                    "folder that is there");
  }
}

}  // namespace

std::vector<std::string> listClouds(const std::vector<std::string>& names) {
  std::vector<std::string> out;
  for (const std::string& name : names) {
    if (!fs::is_directory(name)) {
      out.push_back(name);
      continue;
    }
    std::vector<std::string> inside = cloudsIn(name, isCloud);
    if (inside.empty()) inside = cloudsIn(name, isText);
    if (inside.empty()) throw FileError(name, "has no clouds in it");
    std::sort(inside.begin(), inside.end());
    out.insert(out.end(), inside.begin(), inside.end());
  }
  return out;
}

void warnOfTextLeftOut(const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    if (!fs::is_directory(name) || cloudsIn(name, isCloud).empty()) continue;
    const std::size_t left_out = cloudsIn(name, isText).size();
    if (left_out == 0) continue;
    warn(name + ": text files beside its clouds are left out: " + std::to_string(left_out));
  }
}

void planFiles(const TileRequest& request, Plan& plan) {
  for (const std::string& path : listClouds(request.inputs)) {
    const InputState state = stateOf(path);
    PlanInput in;
    in.path = in.streamed = fs::absolute(path).lexically_normal().string();
    in.bytes = state.bytes;
    in.time = state.time;
    in.head = state.head;
    plan.inputs.push_back(std::move(in));
  }
  addOutputs(request.output, plan);
  plan.run = runOf(request, plan);
}

void addSeeds(const std::string& path, Plan& plan) {
  if (path.empty()) return;
  const CloudTable cloud = readUsableCloud(path);
  if (!cloud.hasNormals()) throw FileError(path, "has no normals");
  for (std::size_t i = 0; i < cloud.size; ++i) {
    plan.seeds.push_back({cloud.position(i), cloud.triple(cloud.normals(), i)});
  }
}

void openInputs(const std::string& folder, Plan& plan) {
  CloudTable first;
  std::size_t with_viewpoint = 0;
  std::array<double, 3> viewpoint{0, 0, 0};
  for (std::size_t i = 0; i < plan.inputs.size(); ++i) {
    PlanInput& in = plan.inputs[i];
    if (!CloudStream::canRead(in.path)) {
      in.streamed = folder + "/input-" + std::to_string(i) + ".pcd";
      convert(in);
    }
    const CloudStream stream(in.streamed);
    const CloudTable& layout = stream.layout();
    for (const std::string& note : layout.notes) warn(in.path + ": " + note);
    if (i == 0) first = layout;
    if (plan.outputs.size() == 1) requireSameFields(first, layout, in.path);
    in.first_row = plan.rows;
    in.rows = stream.size();
    plan.rows += in.rows;
    plan.has_viewpoints = plan.has_viewpoints || layout.hasViewpoints();
    if (plan.keep_orientation && !layout.hasNormals()) {
      throw FileError(in.path, "has no normals whose orientation to keep");
    }
    const std::array<double, 3> here{layout.viewpoint[0], layout.viewpoint[1], layout.viewpoint[2]};
    if (here == std::array<double, 3>{0, 0, 0}) continue;
    viewpoint = here;
    ++with_viewpoint;
  }
  // One output of several inputs says which point is whose, and where its sensor was.
  plan.adds_scans = plan.outputs.size() == 1 && plan.inputs.size() > 1;
  const bool headers = !plan.has_viewpoint && !plan.up && with_viewpoint > 0;
  plan.adds_viewpoints = plan.adds_scans && (plan.has_viewpoints || headers);
  if (!plan.trajectory.empty()) plan.has_viewpoints = true;
  if (!headers) return;
  if (plan.inputs.size() == 1) {
    plan.has_viewpoint = true;
    plan.viewpoint = viewpoint;
  } else {
    plan.has_viewpoints = true;  // each file its own
  }
}

}  // namespace segorient::program
