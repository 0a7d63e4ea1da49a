// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// The library's own includes: data flows one way, public headers do without private ones.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace segorient::test {
namespace {

namespace fs = std::filesystem;

// A file of the library as others include it: "search/median_hash.h".
struct Source {
  std::string name;
  std::string room;  // its folder
  bool is_public = false;
  std::vector<std::string> includes;  // of the library, as above
  std::vector<std::string> private_includes;
};

std::string folderOf(const std::string& name) {
  std::string folder = fs::path(name).parent_path().generic_string();
  const std::string templates = "/impl";  // bodies of the templates next to them
  if (folder.size() > templates.size() &&
      folder.compare(folder.size() - templates.size(), templates.size(), templates) == 0) {
    folder.resize(folder.size() - templates.size());
  }
  return folder;
}

Source read(const fs::path& path, const fs::path& root, bool is_public) {
  Source source;
  source.name = fs::relative(path, root).generic_string();
  source.room = folderOf(source.name);
  source.is_public = is_public;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    const std::string angle = "#include <segorient/";
    const std::string quote = "#include \"";
    if (line.rfind(angle, 0) == 0) {
      source.includes.push_back(line.substr(angle.size(), line.find('>') - angle.size()));
    } else if (line.rfind(quote, 0) == 0) {
      const std::string name = line.substr(quote.size(), line.rfind('"') - quote.size());
      source.includes.push_back(name);
      source.private_includes.push_back(name);
    }
  }
  return source;
}

std::vector<Source> library() {
  const fs::path root = SEGORIENT_LIBRARY;
  std::vector<Source> out;
  for (const auto& [folder, is_public] :
       {std::pair<fs::path, bool>{root / "include/segorient", true}, {root / "src", false}}) {
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
      if (entry.is_regular_file()) out.push_back(read(entry.path(), folder, is_public));
    }
  }
  return out;
}

// What each room may include beside itself: all that is below it.
const std::map<std::string, std::set<std::string>>& below() {
  static const std::map<std::string, std::set<std::string>> rooms{
      {"common", {}},
      {"search", {"common"}},
      {"features", {"common", "search"}},
      {"segmentation", {"common", "search", "features"}},
      {"surface", {"common", "search", "segmentation"}},
      // What the rooms of orientation share; its entrances, .cpp files, include the rooms.
      {"orientation", {"common", "search", "features", "segmentation", "surface"}},
      {"orientation/winding", {"common", "search", "segmentation", "orientation"}},
      {"orientation/sensors", {"common", "search", "features", "segmentation", "orientation"}},
      {"orientation/checks", {"common", "search", "segmentation", "orientation"}},
      {"orientation/paper",
       {"common", "search", "segmentation", "surface", "orientation", "orientation/winding"}},
      {"orientation/automatic",
       {"common", "search", "features", "segmentation", "orientation", "orientation/winding",
        "orientation/sensors"}},
      {"tiles",
       {"common", "search", "features", "segmentation", "orientation", "orientation/automatic",
        "orientation/sensors"}}};
  return rooms;
}

bool isHeader(const std::string& name) {
  return fs::path(name).extension() != ".cpp";
}

// Includes that lead upward or sideways.
std::vector<std::string> wrongIncludes(const std::vector<Source>& sources) {
  std::vector<std::string> wrong;
  for (const Source& source : sources) {
    const auto room = below().find(source.room);
    if (room == below().end()) {
      wrong.push_back(source.name + " is in no room");
      continue;
    }
    for (const std::string& included : source.includes) {
      const std::string other = folderOf(included);
      if (other == source.room || room->second.count(other) > 0) continue;
      const bool entrance = source.room == "orientation" && !isHeader(source.name) &&
                            other.rfind("orientation/", 0) == 0;
      // Options and results of the rooms' own that the entrances hand on.
      const bool shared =
          source.room == "orientation" && !source.is_public && other == "orientation/sensors";
      if (!entrance && !shared) wrong.push_back(source.name + " includes " + included);
    }
  }
  return wrong;
}

// The body of a template includes its declaration, and the other way round.
bool isBodyOf(const std::string& body, const std::string& header) {
  return fs::path(body).extension() == ".hpp" && folderOf(body) == folderOf(header) &&
         fs::path(body).stem() == fs::path(header).stem();
}

// A circle of headers, as a text; empty where there is none.
std::string circle(const std::vector<Source>& sources) {
  std::map<std::string, const Source*> by_name;
  for (const Source& source : sources) {
    if (isHeader(source.name)) by_name[source.name] = &source;
  }
  std::map<std::string, int> state;  // 1 on the way, 2 done
  std::vector<std::string> way;
  std::string found;
  const auto visit = [&](const auto& self, const std::string& name) -> void {
    if (by_name.count(name) == 0 || state[name] == 2 || !found.empty()) return;
    way.push_back(name);
    if (state[name] == 1) {
      for (const std::string& step : way) found += step + " > ";
      return;
    }
    state[name] = 1;
    for (const std::string& next : by_name[name]->includes) {
      if (!isBodyOf(next, name)) self(self, next);
    }
    state[name] = 2;
    way.pop_back();
  };
  for (const auto& [name, source] : by_name) visit(visit, name);
  return found;
}

TEST(Layers, NoRoomIncludesOneAboveIt) {
  const std::vector<Source> sources = library();
  ASSERT_GT(sources.size(), 100U);
  for (const std::string& wrong : wrongIncludes(sources)) ADD_FAILURE() << wrong;
}

TEST(Layers, NoCircles) {
  EXPECT_EQ(circle(library()), "");
}

TEST(Layers, PublicHeadersDoWithoutPrivateOnes) {
  for (const Source& source : library()) {
    if (!source.is_public) continue;
    for (const std::string& name : source.private_includes) {
      ADD_FAILURE() << source.name << " includes " << name;
    }
  }
}

// What users include: classes, their options and their results. All else belongs below src/, or,
// where the bodies of templates need it, below impl/.
TEST(Layers, PublicHeadersAreThese) {
  const std::set<std::string> expected{"common/export.h",
                                       "common/neighborhoods.h",
                                       "common/point_view.h",
                                       "features/awas_normal_estimation.h",
                                       "features/lct_normal_estimation.h",
                                       "features/ldt_normal_estimation.h",
                                       "features/local_normal_estimation.h",
                                       "features/normal_options.h",
                                       "features/normal_recomputation.h",
                                       "features/plane_normal_estimation.h",
                                       "orientation/check_normals.h",
                                       "orientation/first_stages.h",
                                       "orientation/orientation_hints.h",
                                       "orientation/orientation_options.h",
                                       "orientation/orientation_result.h",
                                       "orientation/oriented_normal_estimation.h",
                                       "orientation/pipeline.h",
                                       "orientation/segment_orientation.h",
                                       "orientation/sensors.h",
                                       "orientation/trajectory.h",
                                       "search/median_hash.h",
                                       "search/median_hash_index.h",
                                       "segmentation/normal_segmentation.h",
                                       "segmentation/segmentation.h",
                                       "surface/segment_mesh.h",
                                       "surface/segment_triangulation.h"};
  std::set<std::string> found;
  for (const Source& source : library()) {
    if (!source.is_public) continue;
    const bool body = source.name.find("/impl/") != std::string::npos;
    EXPECT_EQ(fs::path(source.name).extension(), body ? ".hpp" : ".h") << source.name;
    if (!body) found.insert(source.name);
  }
  EXPECT_EQ(found, expected);
}

TEST(Layers, AtMostFiveRoomsDeep) {
  for (const Source& source : library()) {
    EXPECT_LE(std::count(source.name.begin(), source.name.end(), '/'), 3) << source.name;
  }
}

// The checks themselves: each finds what it is to find.
TEST(Layers, WhatIsWrongIsFound) {
  const Source up{"search/a.h", "search", true, {"features/b.h"}, {}};
  const Source sideways{
      "orientation/paper/c.cpp", "orientation/paper", false, {"orientation/automatic/d.h"}, {}};
  const Source fine{"features/b.h", "features", true, {"search/a.h"}, {}};
  EXPECT_EQ(wrongIncludes({up, sideways, fine}).size(), 2U);
  EXPECT_NE(circle({up, fine}), "");
  EXPECT_EQ(circle({fine, sideways}), "");
}

}  // namespace
}  // namespace segorient::test
