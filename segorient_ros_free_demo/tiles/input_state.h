// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <cstdint>
#include <string>

namespace segorient::program {

/// What tells one state of a file from another without reading all of it.
struct InputState {
  std::uint64_t bytes = 0;
  std::int64_t time = 0;   ///< of its last change, nanoseconds
  std::uint64_t head = 0;  ///< checksum of its first bytes, the header among them
};

/// Throws FileError where there is no such file.
InputState stateOf(const std::string& path);

/// A folder that steps work in, held against other runs for as long as this object is there; made
/// if there is none.
class WorkFolder {
 public:
  /// \param alone whether nothing else may be done in it; otherwise others of the same kind may
  WorkFolder(std::string path, bool alone);
  ~WorkFolder();
  WorkFolder(const WorkFolder&) = delete;
  WorkFolder& operator=(const WorkFolder&) = delete;

  const std::string& path() const { return path_; }
  /// Removes what steps that were killed left unfinished, and all that a run left whose removal was
  /// interrupted, as it has no plan any more; only where it is held alone. Throws FileError if it
  /// was no work folder before and has files of such names: they are somebody else's.
  void removeUnfinished() const;
  /// Removes all files that steps write, and the folder if nothing else is in it. The plan goes
  /// first and the lock last: what is interrupted leaves a folder that a run begins anew in.
  void remove();

 private:
  std::string path_;
  bool was_one_ = false;  // it had a lock before
  int lock_ = -1;
};

}  // namespace segorient::program
