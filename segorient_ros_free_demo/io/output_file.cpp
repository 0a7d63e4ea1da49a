// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "io/output_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <climits>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <memory>

#include "io/errors.h"

namespace segorient::program {
namespace {

// Names of the files to remove if a signal ends the program. A handler may neither lock nor
// allocate: fixed room, and a flag that is set last.
struct Slot {
  std::array<char, PATH_MAX> path;
  std::atomic<bool> used{false};
};
std::array<Slot, 8> slots;

void keepTrack(const std::string& path) {
  for (Slot& slot : slots) {
    if (slot.used || path.size() >= slot.path.size()) continue;
    std::memcpy(slot.path.data(), path.c_str(), path.size() + 1);
    slot.used = true;
    return;
  }
}

void loseTrack(const std::string& path) {
  for (Slot& slot : slots) {
    if (slot.used && path == slot.path.data()) slot.used = false;
  }
}

void removeAndEnd(int signal_number) {
  for (const Slot& slot : slots) {
    if (slot.used) unlink(slot.path.data());
  }
  std::signal(signal_number, SIG_DFL);
  std::raise(signal_number);
}

std::string resolved(const std::string& path) {
  const std::unique_ptr<char, decltype(&std::free)> real(realpath(path.c_str(), nullptr),
                                                         &std::free);
  return real == nullptr ? path : std::string(real.get());
}

// Permissions as if the file had been opened for writing, not the tight ones of mkstemp.
mode_t permissions(const std::string& target) {
  struct stat info {};
  if (stat(target.c_str(), &info) == 0) return info.st_mode & 0777;
  const mode_t mask = umask(0);
  umask(mask);
  return 0666 & ~mask;
}

}  // namespace

OutputFile::OutputFile(std::string path) : path_(std::move(path)), target_(resolved(path_)) {
  if (path_.empty()) throw FileError("''", "is no name of a file");
  struct stat info {};
  if (stat(target_.c_str(), &info) == 0 && !S_ISREG(info.st_mode)) {
    throw FileError(path_, S_ISDIR(info.st_mode) ? "is a directory" : "is not a regular file");
  }
  if (stat(target_.c_str(), &info) == 0 && access(target_.c_str(), W_OK) != 0) fail(errno);
  std::string name = target_ + ".XXXXXX";
  const int descriptor = mkstemp(name.data());
  if (descriptor < 0) fail(errno);
  temporary_ = name;
  keepTrack(temporary_);
  fchmod(descriptor, permissions(target_));
  file_ = fdopen(descriptor, "wb");
  if (file_ == nullptr) {
    const int error = errno;
    close(descriptor);
    unlink(temporary_.c_str());
    loseTrack(temporary_);
    fail(error);
  }
}

OutputFile::~OutputFile() {
  if (file_ != nullptr) std::fclose(file_);
  if (temporary_.empty()) return;
  unlink(temporary_.c_str());
  loseTrack(temporary_);
}

void OutputFile::fail(int error) {
  throw FileError(path_, std::string("cannot be written: ") + std::strerror(error));
}

void OutputFile::write(const void* data, std::size_t bytes) {
  if (bytes > 0 && std::fwrite(data, 1, bytes, file_) != bytes) fail(errno);
}

void OutputFile::finish() {
  if (file_ == nullptr) return;
  if (std::fflush(file_) != 0 || fsync(fileno(file_)) != 0) fail(errno);
  std::FILE* file = file_;
  file_ = nullptr;
  if (std::fclose(file) != 0) fail(errno);
}

void OutputFile::commit() {
  finish();
  if (std::rename(temporary_.c_str(), target_.c_str()) != 0) fail(errno);
  loseTrack(temporary_);
  temporary_.clear();
}

void installSignalHandlers() {
  for (const int s : {SIGINT, SIGTERM, SIGHUP}) std::signal(s, removeAndEnd);
  std::signal(SIGXFSZ, SIG_IGN);
  std::signal(SIGPIPE, SIG_IGN);
}

}  // namespace segorient::program
