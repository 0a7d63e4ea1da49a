// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "tiles/input_state.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <regex>
#include <vector>

#include "io/input_file.h"
#include "tiles/checksum.h"

namespace segorient::program {
namespace fs = std::filesystem;
namespace {

// Names of files that steps write, and of such files before they are moved to their places.
bool isOurs(const std::string& name, bool unfinished_only) {
  static const std::regex kFinished(
      "plan|join|field|labels|lock|input-[0-9]+\\.(ply|pcd)|"
      "tile-[0-9]+\\.(points|rows|share|ties|signs|rows2|ties2|patches)");
  static const std::regex kUnfinished(
      "(plan|join|field|labels|input-[0-9]+\\.(ply|pcd)|"
      "tile-[0-9]+\\.(points|rows|share|ties|signs|rows2|ties2|patches))"
      "\\.([A-Za-z0-9]{6}|[0-9]+-[0-9]+|part)");
  return std::regex_match(name, kUnfinished) ||
         (!unfinished_only && std::regex_match(name, kFinished));
}

constexpr const char* kPlan = "plan";
constexpr const char* kLock = "lock";

// But for the lock.
std::vector<fs::path> filesOfOurs(const std::string& folder, bool unfinished_only) {
  std::vector<fs::path> out;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (name != kLock && isOurs(name, unfinished_only)) out.push_back(entry.path());
  }
  return out;
}

void removeFiles(const std::string& folder, bool unfinished_only) {
  std::error_code ignored;
  if (!unfinished_only) fs::remove(fs::path(folder) / kPlan, ignored);
  for (const fs::path& path : filesOfOurs(folder, unfinished_only)) fs::remove(path, ignored);
}

}  // namespace

InputState stateOf(const std::string& path) {
  InputFile file(path);
  struct stat info {};
  if (stat(path.c_str(), &info) != 0) file.fail(std::strerror(errno));
  InputState state;
  state.bytes = static_cast<std::uint64_t>(info.st_size);
  state.time = std::int64_t{info.st_mtim.tv_sec} * 1000000000 + info.st_mtim.tv_nsec;
  constexpr std::uint64_t kHead = 65536;
  std::vector<char> head(static_cast<std::size_t>(std::min(kHead, file.remaining())));
  file.read(head.data(), head.size());
  Checksum sum;
  sum.add(head.data(), head.size());
  state.head = sum.value();
  return state;
}

WorkFolder::WorkFolder(std::string path, bool alone) : path_(std::move(path)) {
  std::error_code error;
  fs::create_directories(path_, error);
  if (error) throw FileError(path_, "cannot be made: " + error.message());
  const std::string name = path_ + "/" + kLock;
  was_one_ = fs::exists(name);
  lock_ = open(name.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (lock_ < 0) throw FileError(name, std::strerror(errno));
  if (flock(lock_, (alone ? LOCK_EX : LOCK_SH) | LOCK_NB) != 0) {
    const bool busy = errno == EWOULDBLOCK;
    close(lock_);
    throw FileError(path_, busy ? "is in use by another run" : std::strerror(errno));
  }
}

WorkFolder::~WorkFolder() {
  if (lock_ >= 0) close(lock_);
}

void WorkFolder::removeUnfinished() const {
  if (was_one_) {
    removeFiles(path_, fs::exists(fs::path(path_) / kPlan));
  } else if (!filesOfOurs(path_, false).empty()) {
    std::error_code ignored;
    fs::remove(fs::path(path_) / kLock, ignored);
    throw FileError(path_,
                    "is no work folder, and has files that are named as those of one: name another "
                    "folder");
  }
}

void WorkFolder::remove() {
  removeFiles(path_, false);
  std::error_code not_empty;
  fs::remove(fs::path(path_) / kLock, not_empty);
  fs::remove(path_, not_empty);
}

}  // namespace segorient::program
