// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "support/silence.h"

#include <fcntl.h>
#include <unistd.h>

#include <cstdio>

namespace segorient::program {
namespace {

constexpr std::array<int, 2> kStreams{STDOUT_FILENO, STDERR_FILENO};

void flush() {
  std::fflush(stdout);
  std::fflush(stderr);
}

}  // namespace

Silence::Silence() {
  flush();
  const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
  if (nowhere < 0) return;
  for (std::size_t i = 0; i < kStreams.size(); ++i) {
    kept_[i] = fcntl(kStreams[i], F_DUPFD_CLOEXEC, 0);
    if (kept_[i] >= 0) dup2(nowhere, kStreams[i]);
  }
  close(nowhere);
}

Silence::~Silence() {
  flush();
  for (std::size_t i = 0; i < kStreams.size(); ++i) {
    if (kept_[i] < 0) continue;
    dup2(kept_[i], kStreams[i]);
    close(kept_[i]);
  }
}

}  // namespace segorient::program
