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

// What a file without a name can be given one by, while it is open.
std::string openedAs(int descriptor) {
  return "/proc/self/fd/" + std::to_string(descriptor);
}

// A file without a name goes with the process, however that ends. -1 where the system has none.
int openWithoutName(const std::string& target) {
#ifdef O_TMPFILE
  const std::size_t end = target.rfind('/');
  const std::string folder = end == std::string::npos ? "." : target.substr(0, end + 1);
  const int descriptor = open(folder.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0600);
  if (descriptor < 0 || access(openedAs(descriptor).c_str(), F_OK) == 0) return descriptor;
  close(descriptor);
#endif
  return -1;
}

}  // namespace

OutputFile::OutputFile(std::string path) : path_(std::move(path)), target_(resolved(path_)) {
  if (path_.empty()) throw FileError("''", "is no name of a file");
  struct stat info {};
  if (stat(target_.c_str(), &info) == 0 && !S_ISREG(info.st_mode)) {
    throw FileError(path_, S_ISDIR(info.st_mode) ? "is a directory" : "is not a regular file");
  }
  if (stat(target_.c_str(), &info) == 0 && access(target_.c_str(), W_OK) != 0) fail(errno);
  int descriptor = openWithoutName(target_);
  if (descriptor < 0) {
    std::string name = target_ + ".XXXXXX";
    descriptor = mkstemp(name.data());
    if (descriptor < 0) fail(errno);
    temporary_ = name;
    keepTrack(temporary_);
  }
  fchmod(descriptor, permissions(target_));
  file_ = fdopen(descriptor, "wb");
  if (file_ == nullptr) {
    const int error = errno;
    close(descriptor);
    removeTemporary();
    fail(error);
  }
}

OutputFile::~OutputFile() {
  if (file_ != nullptr) std::fclose(file_);
  removeTemporary();
}

void OutputFile::removeTemporary() {
  if (temporary_.empty()) return;
  unlink(temporary_.c_str());
  loseTrack(temporary_);
  temporary_.clear();
}

// A file that has no name yet gets one that nobody has: only that can then be moved over another.
void OutputFile::nameTemporary() {
  for (int i = 0; temporary_.empty(); ++i) {
    const std::string name = target_ + '.' + std::to_string(getpid()) + '-' + std::to_string(i);
    if (linkat(AT_FDCWD, openedAs(fileno(file_)).c_str(), AT_FDCWD, name.c_str(),
               AT_SYMLINK_FOLLOW) == 0) {
      temporary_ = name;
    } else if (errno != EEXIST) {
      fail(errno);
    }
  }
  keepTrack(temporary_);
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
  if (temporary_.empty()) nameTemporary();
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

void requireWritable(const std::string& path) {
  const OutputFile file(path);
}

void installSignalHandlers() {
  for (const int s : {SIGINT, SIGTERM, SIGHUP}) std::signal(s, removeAndEnd);
  std::signal(SIGXFSZ, SIG_IGN);
  std::signal(SIGPIPE, SIG_IGN);
}

}  // namespace segorient::program
