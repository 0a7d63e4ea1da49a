// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "run_program.h"

#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>

namespace segorient::test {
namespace {

std::string quoted(const std::string& word) {
  std::string out = "'";
  for (const char c : word) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

}  // namespace

Outcome runProgram(const std::vector<std::string>& words, const std::string& program) {
  const ScratchDirectory directory;
  std::string command = quoted(program.empty() ? SEGORIENT_PROGRAM : program);
  for (const std::string& word : words) command += " " + quoted(word);
  command += " > " + directory.file("out") + " 2> " + directory.file("err") + " < /dev/null";
  const int status = std::system(command.c_str());
  Outcome run;
  run.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  run.out = readFile(directory.file("out"));
  run.err = readFile(directory.file("err"));
  return run;
}

bool isOneLine(const std::string& text) {
  return !text.empty() && text.back() == '\n' && std::count(text.begin(), text.end(), '\n') == 1;
}

std::string fandisk() {
  return std::string(SEGORIENT_TEST_DATA) + "/fandisk_16475.pcd";
}

}  // namespace segorient::test
