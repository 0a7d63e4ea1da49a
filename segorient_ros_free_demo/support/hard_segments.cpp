// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "support/hard_segments.h"

#include <algorithm>
#include <boost/property_tree/json_parser.hpp>
#include <boost/property_tree/ptree.hpp>
#include <sstream>

#include "io/errors.h"
#include "io/input_file.h"

namespace segorient::program {
namespace {

std::string readText(const std::string& path) {
  InputFile file(path);
  std::string text;
  for (std::string_view line; file.line(line);) {
    text += line;
    text += '\n';
  }
  return text;
}

}  // namespace

std::vector<std::uint32_t> readHardSegments(const std::string& path) {
  std::istringstream text(readText(path));
  boost::property_tree::ptree report;
  std::vector<std::uint32_t> labels;
  try {
    boost::property_tree::read_json(text, report);
    for (const auto& [key, label] : report.get_child("hard_segments")) {
      labels.push_back(label.get_value<std::uint32_t>());
    }
  } catch (const boost::property_tree::ptree_error&) {
    throw FileError(path, "is not a report of segorient orient");
  }
  std::sort(labels.begin(), labels.end());
  return labels;
}

}  // namespace segorient::program
