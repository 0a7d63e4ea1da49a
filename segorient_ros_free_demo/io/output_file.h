// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <cstddef>
#include <cstdio>
#include <string>
#include <string_view>

namespace segorient::program {

/// A file that is there whole or not at all: written without a name and moved to its place by
/// commit(). Without commit(), on any error and however the program ends, what was there before
/// stays, and nothing is left beside it. On file systems that have no files without a name it is
/// written under another name beside its place, which is left if the program is killed.
///
/// Every failure is a FileError that names the file. Construct it before the work whose result it
/// is to hold, so that a place that cannot be written is known at once.
class OutputFile {
 public:
  explicit OutputFile(std::string path);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  const std::string& path() const { return path_; }
  void write(const void* data, std::size_t bytes);
  void write(std::string_view text) { write(text.data(), text.size()); }
  /// Brings all of it onto the disk, under another name: whatever else may go wrong with
  /// what was written does so here. Where two files belong together, both are finished before
  /// either is committed.
  void finish();
  /// finish(), and moves it to its place.
  void commit();

 private:
  [[noreturn]] void fail(int error);
  void nameTemporary();
  void removeTemporary();

  std::string path_;
  std::string target_;     // path_, symbolic links resolved
  std::string temporary_;  // empty while it has no name, and once committed
  std::FILE* file_ = nullptr;
};

/// For work so long that the file is made after it: throws what an OutputFile of this name would,
/// and leaves nothing.
void requireWritable(const std::string& path);

/// Makes Ctrl-C and the like remove the temporary files of all OutputFiles before the program ends,
/// and a full disk or a file size limit an error of write().
void installSignalHandlers();

}  // namespace segorient::program
