// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "support/command_line.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>

#include "io/file_endings.h"

namespace segorient::program {
namespace po = boost::program_options;
namespace fs = std::filesystem;
namespace {

// Absolute first: a name of nothing that is there would else stay as it is.
fs::path resolved(const std::string& path) {
  const fs::path whole = fs::absolute(path).lexically_normal();
  std::error_code error;
  const fs::path real = fs::weakly_canonical(whole, error);
  return error ? whole : real;
}

}  // namespace

CommandLine::CommandLine(std::string usage, std::string purpose, std::string example)
    : usage_(std::move(usage)), purpose_(std::move(purpose)), example_(std::move(example)) {
  options()("help,h", "this text");
}

void CommandLine::arguments(std::vector<std::string> names, std::size_t optional) {
  arguments_ = std::move(names);
  optional_ = optional;
}

void CommandLine::argumentsMany(const std::string& inputs, const std::string& output) {
  many_ = inputs;
  arguments_ = {output};
}

bool CommandLine::parse(const std::vector<std::string>& words) {
  if (std::any_of(words.begin(), words.end(),
                  [](const std::string& w) { return w == "--help" || w == "-h"; })) {
    std::cout << "Usage: segorient " << usage_ << "\n\n"
              << purpose_ << "\n\n"
              << options_ << "\nExample:\n  " << example_ << "\n";
    return false;
  }
  po::options_description all = options_;
  all.add(unlisted_);
  po::positional_options_description positions;
  if (!many_.empty()) {
    all.add_options()(many_.c_str(), po::value<std::vector<std::string>>());
    positions.add(many_.c_str(), -1);
  }
  for (const std::string& name : arguments_) {
    if (!many_.empty()) break;
    all.add_options()(name.c_str(), po::value<std::string>());
    positions.add(name.c_str(), 1);
  }
  // No guessing: an abbreviation that works today would break when an option is added.
  const int style = po::command_line_style::unix_style & ~po::command_line_style::allow_guessing;
  try {
    po::store(po::command_line_parser(words).options(all).positional(positions).style(style).run(),
              values_);
    po::notify(values_);
  } catch (const po::error& e) {
    throw UsageError(e.what());
  }
  if (!many_.empty()) {
    if (has(many_)) inputs_ = get<std::vector<std::string>>(many_);
    require(!inputs_.empty(), many_ + " is missing: segorient " + usage_);
    output_ = inputs_.back();
    inputs_.pop_back();
    require(!inputs_.empty(), arguments_[0] + " is missing: segorient " + usage_);
    return true;
  }
  for (std::size_t i = 0; i + optional_ < arguments_.size(); ++i) {
    require(has(arguments_[i]), arguments_[i] + " is missing: segorient " + usage_);
  }
  return true;
}

std::string CommandLine::argument(const std::string& name) const {
  if (!many_.empty()) return output_;
  return has(name) ? get<std::string>(name) : std::string();
}

void require(bool condition, const std::string& text) {
  if (!condition) throw UsageError(text);
}

void warn(const std::string& text) {
  std::cerr << "segorient: " << text << "\n";
}

void nameUnused(const CommandLine& line, const std::vector<const char*>& names,
                const std::string& reason) {
  for (const char* name : names) {
    if (line.given(name)) warn("--" + std::string(name) + " changes nothing " + reason);
  }
}

void requireEnding(const std::string& path, const std::vector<std::string>& endings) {
  std::string known;
  for (const std::string& e : endings) known += " " + e;
  require(std::find(endings.begin(), endings.end(), fileEnding(path)) != endings.end(),
          path + ": an output file must end in one of" + known);
}

void requireFinite(const CommandLine& line, const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    require(std::isfinite(line.get<double>(name)), "--" + name + " must be a finite number");
  }
}

void requireOwnReport(const std::string& report, const std::string& path, const std::string& name) {
  if (report.empty() || path.empty()) return;
  require(resolved(report) != resolved(path), "--report and " + name + " are the same file");
}

void CommonOptions::add(CommandLine& line, const char* details) {
  line.options()("threads", po::value(&threads)->default_value(0),
                 "threads; 0 = as many as the work is worth, at most all cores")(
      "quiet,q", po::bool_switch(&quiet), "no summary and no progress");
  auto others = details != nullptr ? line.options() : line.unlisted();
  others("verbose,v", po::bool_switch(&verbose), details != nullptr ? details : "");
}

void CommonOptions::take(CommandLine& line) {
  line.unlisted()("threads", po::value(&threads)->default_value(0))(
      "quiet,q", po::bool_switch(&quiet))("verbose,v", po::bool_switch(&verbose));
}

void CommonOptions::check() const {
  require(threads >= 0, "--threads must not be negative");
}

}  // namespace segorient::program
