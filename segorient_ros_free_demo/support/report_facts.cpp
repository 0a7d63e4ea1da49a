// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "support/report_facts.h"

#include <boost/property_tree/json_parser.hpp>
#include <boost/property_tree/ptree.hpp>
#include <cmath>
#include <sstream>

#include "io/errors.h"
#include "io/file_endings.h"
#include "io/input_file.h"
#include "io/readers.h"

namespace segorient::program {
namespace {

using Tree = boost::property_tree::ptree;

// Labels are numbers of segments: more than this many are no report of ours.
constexpr std::size_t kMostSegments = 100'000'000;

Tree readTree(const std::string& path) {
  InputFile file(path);
  std::string text;
  for (std::string_view line; file.line(line);) {
    text += line;
    text += '\n';
  }
  std::istringstream stream(text);
  Tree tree;
  boost::property_tree::read_json(stream, tree);
  return tree;
}

std::array<double, 3> place(const Tree& tree) {
  std::array<double, 3> out{};
  if (const auto position = tree.get_child_optional("position")) {
    std::size_t a = 0;
    for (const auto& [key, value] : *position) {
      if (a < 3) out[a++] = value.get_value<double>();
    }
    if (a == 3) return out;
  }
  return {tree.get<double>("x"), tree.get<double>("y"), tree.get<double>("z")};
}

void readSegments(const Tree& report, Facts& facts) {
  const auto segments = report.get_child_optional("segments");
  std::vector<std::string> components;
  if (const auto list = report.get_child_optional("components")) {
    for (const auto& [key, c] : *list) components.push_back(c.get<std::string>("oriented_by", ""));
  }
  const auto of = [&](std::size_t label) -> SegmentFact& {
    if (label >= facts.segments.size()) facts.segments.resize(label + 1);
    return facts.segments[label];
  };
  if (segments) {
    const std::size_t most = std::min(kMostSegments, segments->size());
    for (const auto& [key, s] : *segments) {
      const auto label = s.get<std::size_t>("label");
      if (label >= most) continue;
      SegmentFact& fact = of(label);
      fact.confidence = s.get<float>("confidence", -1.F);
      fact.kind = s.get<std::string>("kind", "");
      fact.oriented_by = s.get<std::string>("oriented_by", "");
      const auto component = s.get<std::size_t>("component", components.size());
      if (component < components.size()) fact.component_by = components[component];
    }
  }
  for (const auto& [key, label] : report.get_child("hard_segments")) {
    const auto number = label.get_value<std::size_t>();
    if (number >= kMostSegments) throw boost::property_tree::ptree_error("no label");
    of(number).hard = true;
  }
}

}  // namespace

Facts readReport(const std::string& path) {
  Facts facts;
  try {
    const Tree report = readTree(path);
    readSegments(report, facts);
    if (const auto places = report.get_child_optional("contradictions")) {
      for (const auto& [key, c] : *places) facts.contradictions.push_back(place(c));
    }
  } catch (const boost::property_tree::ptree_error&) {
    throw FileError(path, "is not a report of segorient orient");
  }
  return facts;
}

std::vector<std::array<double, 3>> readSensors(const std::string& path, std::size_t* explained) {
  std::vector<std::array<double, 3>> out;
  if (fileEnding(path) == ".json") {
    try {
      const Tree tree = readTree(path);
      for (const auto& [key, s] : tree.get_child("sensors")) {
        out.push_back(place(s));
        if (explained != nullptr && s.get<bool>("sure", false)) {
          *explained += s.get<std::size_t>("points", 0);
        }
      }
    } catch (const boost::property_tree::ptree_error&) {
      throw FileError(path, "has no list of sensors");
    }
  } else {
    const CloudTable table = readUsableCloud(path);
    for (std::size_t i = 0; i < table.size; ++i) out.push_back(table.position(i));
  }
  for (const auto& s : out) {
    if (!std::isfinite(s[0]) || !std::isfinite(s[1]) || !std::isfinite(s[2])) {
      throw FileError(path, "has a sensor whose place is no number");
    }
  }
  return out;
}

}  // namespace segorient::program
