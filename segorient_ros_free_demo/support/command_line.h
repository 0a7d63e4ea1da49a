// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <boost/program_options.hpp>
#include <string>
#include <vector>

#include "io/errors.h"

namespace segorient::program {

/// Options of one command, read with Boost.Program_options.
class CommandLine {
 public:
  /// \param usage "orient IN OUT [options]"
  /// \param purpose what the command does, one or more lines
  /// \param example a whole command line
  CommandLine(std::string usage, std::string purpose, std::string example);

  /// For the command's own options: `options ()("name", value, "text")`.
  boost::program_options::options_description_easy_init options() { return options_.add_options(); }
  /// For options that are taken but not listed in the help.
  boost::program_options::options_description_easy_init unlisted() {
    return unlisted_.add_options();
  }
  /// Names of the arguments that are no options, in order; the last `optional` of them may be
  /// missing.
  void arguments(std::vector<std::string> names, std::size_t optional = 0);

  /// One or more inputs, and an output behind them.
  void argumentsMany(const std::string& inputs, const std::string& output);

  /// False if help was asked for, which is then printed. Throws UsageError.
  bool parse(const std::vector<std::string>& words);

  bool has(const std::string& name) const { return values_.count(name) > 0; }
  /// Whether the option was given rather than left at its default.
  bool given(const std::string& name) const { return has(name) && !values_[name].defaulted(); }
  template <typename T>
  const T& get(const std::string& name) const {
    return values_[name].as<T>();
  }
  /// The argument of this name, empty if it is missing.
  std::string argument(const std::string& name) const;
  /// The inputs of argumentsMany().
  const std::vector<std::string>& inputs() const { return inputs_; }

 private:
  std::string usage_;
  std::string purpose_;
  std::string example_;
  boost::program_options::options_description options_{"Options"};
  boost::program_options::options_description unlisted_;
  std::vector<std::string> arguments_;
  std::size_t optional_ = 0;
  std::string many_;  // name of the inputs if there may be several
  std::vector<std::string> inputs_;
  std::string output_;
  boost::program_options::variables_map values_;
};

/// Throws a UsageError with this text unless the condition holds.
void require(bool condition, const std::string& text);
/// One line on standard error, about something that works otherwise than it was perhaps meant.
void warn(const std::string& text);
/// warn() of each of these options that was given: it changes nothing, for this reason.
void nameUnused(const CommandLine& line, const std::vector<const char*>& names,
                const std::string& reason);
/// Throws a UsageError unless the ending of an output file is one of these.
void requireEnding(const std::string& path, const std::vector<std::string>& endings);
/// Throws a UsageError unless the values of these options, doubles all, are finite.
void requireFinite(const CommandLine& line, const std::vector<std::string>& names);
/// Throws a UsageError where --report is the same file as `path`, whatever way they are written:
/// one of the two would be lost. \param name of `path` in the message; empty paths are no files
void requireOwnReport(const std::string& report, const std::string& path, const std::string& name);

/// What most commands take.
struct CommonOptions {
  int threads = 0;       ///< see resolveThreads()
  bool quiet = false;    ///< no summary, no progress
  bool verbose = false;  ///< more of both

  /// \param details what --verbose adds to the summary; null: nothing, and it is not listed
  void add(CommandLine& line, const char* details = nullptr);
  /// Takes them without listing any, for a command that they change nothing of.
  void take(CommandLine& line);
  void check() const;
};

}  // namespace segorient::program
