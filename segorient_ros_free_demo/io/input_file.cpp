// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "io/input_file.h"

#include <fcntl.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace segorient::program {
namespace {

constexpr std::size_t kBuffer = std::size_t{1} << 20;

}  // namespace

InputFile::InputFile(std::string path, std::size_t buffer) : path_(std::move(path)) {
  struct stat info {};
  if (stat(path_.c_str(), &info) != 0) fail(std::strerror(errno));
  if (S_ISDIR(info.st_mode)) fail("is a directory");
  if (!S_ISREG(info.st_mode)) fail("is not a regular file");
  file_.reset(std::fopen(path_.c_str(), "rb"));
  if (file_ == nullptr) fail(std::strerror(errno));
  size_ = static_cast<std::uint64_t>(info.st_size);
  if (size_ == 0) fail("is empty");
  std::setvbuf(file_.get(), nullptr, _IONBF, 0);  // buffered here
  buffer_.resize(static_cast<std::size_t>(std::min<std::uint64_t>(size_, buffer)));
}

bool InputFile::fill() {
  if (begin_ > 0) {
    std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
    end_ -= begin_;
    begin_ = 0;
  }
  const std::size_t got = std::fread(buffer_.data() + end_, 1, buffer_.size() - end_, file_.get());
  if (got == 0 && std::ferror(file_.get()) != 0) fail(std::strerror(errno));
  end_ += got;
  return got > 0;
}

// Editors on Windows begin a text with the mark of its encoding, which is no part of a word.
void InputFile::skipByteOrderMark() {
  constexpr std::string_view kMark = "\xef\xbb\xbf";
  while (end_ < kMark.size() && fill()) continue;
  if (std::string_view(buffer_.data(), end_).substr(0, kMark.size()) != kMark) return;
  begin_ = position_ = kMark.size();
}

bool InputFile::line(std::string_view& out) {
  if (position_ == 0) skipByteOrderMark();
  std::size_t searched = 0;
  for (;;) {
    const char* from = buffer_.data() + begin_ + searched;
    const auto* newline =
        static_cast<const char*>(std::memchr(from, '\n', end_ - begin_ - searched));
    if (newline != nullptr) {
      const char* first = buffer_.data() + begin_;
      out = std::string_view(first, static_cast<std::size_t>(newline - first));
      break;
    }
    searched = end_ - begin_;
    if (searched == kBuffer) fail("has a line of more than a megabyte: not the format it claims");
    if (!fill()) {
      if (begin_ == end_) return false;
      out = std::string_view(buffer_.data() + begin_, end_ - begin_);
      break;
    }
  }
  const std::size_t used = std::min(out.size() + 1, end_ - begin_);
  begin_ += used;
  position_ += used;
  ++line_number_;
  if (!out.empty() && out.back() == '\r') out.remove_suffix(1);
  return true;
}

void InputFile::read(void* out, std::size_t bytes) {
  auto* to = static_cast<char*>(out);
  const std::size_t buffered = std::min(bytes, end_ - begin_);
  if (buffered > 0) std::memcpy(to, buffer_.data() + begin_, buffered);
  begin_ += buffered;
  const std::size_t rest = bytes - buffered;
  if (rest >= buffer_.size() || (sought_ && rest > 0)) {
    if (std::fread(to + buffered, 1, rest, file_.get()) != rest) fail("is cut short");
  } else if (rest > 0) {
    while (end_ - begin_ < rest) {
      if (!fill()) fail("is cut short");
    }
    std::memcpy(to + buffered, buffer_.data() + begin_, rest);
    begin_ += rest;
  }
  position_ += bytes;
}

void InputFile::skip(std::uint64_t bytes) {
  if (bytes > remaining()) fail("is cut short");
  std::vector<char> sink(static_cast<std::size_t>(std::min<std::uint64_t>(bytes, kBuffer / 2)));
  while (bytes > 0) {
    const auto step = static_cast<std::size_t>(std::min<std::uint64_t>(bytes, sink.size()));
    read(sink.data(), step);
    bytes -= step;
  }
}

void InputFile::seek(std::uint64_t position) {
  if (position > size_) fail("is cut short");
  if (fseeko(file_.get(), static_cast<off_t>(position), SEEK_SET) != 0) fail(std::strerror(errno));
  position_ = position;
  begin_ = end_ = 0;
  sought_ = true;
}

}  // namespace segorient::program
