// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// Files that are not whole: an error that names the file, never a crash, never memory that the
// file's size cannot account for.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <unistd.h>
#include <cmath>
#include <limits>

#include "io/readers.h"
#include "sample_files.h"

namespace segorient::test {
namespace {

using program::FileError;
using program::readCloud;

// The error's text, or "read" if there was none.
std::string outcome(const std::string& path) {
  try {
    readCloud(path);
    return "read";
  } catch (const FileError& e) {
    return e.what();
  }
}

std::string pcd(const std::string& fields, const std::string& size, const std::string& type,
                const std::string& rest) {
  return "VERSION 0.7\nFIELDS " + fields + "\nSIZE " + size + "\nTYPE " + type + "\n" + rest;
}

TEST(BadFiles, TruncatedAtEveryByte) {
  const ScratchDirectory directory;
  for (const SampleFile& sample : writeSampleFiles(directory, 6)) {
    SCOPED_TRACE(sample.name);
    const std::string whole = readFile(directory.file(sample.name));
    const auto rows = readCloud(directory.file(sample.name)).rows;
    const bool counted = sample.name != "vertices.obj" && sample.name != "text.xyz";
    for (std::size_t length = 0; length < whole.size(); ++length) {
      const std::string path = directory.write("cut_" + sample.name, whole.substr(0, length));
      const std::string result = outcome(path);
      if (result != "read") {
        EXPECT_EQ(result.compare(0, path.size() + 2, path + ": "), 0) << result;
        EXPECT_EQ(result.find('\n'), std::string::npos) << result;
      } else if (sample.text && counted) {
        // Only a text's last number may be cut without trace.
        EXPECT_GT(length + 16, whole.size());
        EXPECT_EQ(readCloud(path).size, 6U);
      } else if (counted) {
        // What is missing was padding behind the data.
        EXPECT_EQ(readCloud(path).rows, rows) << "cut at " << length << " of " << whole.size();
      }
    }
  }
}

TEST(BadFiles, EveryByteDamaged) {
  const ScratchDirectory directory;
  for (const SampleFile& sample : writeSampleFiles(directory, 6)) {
    const std::string whole = readFile(directory.file(sample.name));
    for (std::size_t at = 0; at < whole.size(); ++at) {
      for (const char damage : {'\0', '9', '\xff'}) {
        std::string content = whole;
        content[at] = damage;
        outcome(directory.write("damaged_" + sample.name, content));  // must come back
      }
    }
  }
}

// Line ends of Windows in every kind of text, header included.
TEST(BadFiles, CarriageReturnsDoNotMatter) {
  const ScratchDirectory directory;
  for (const SampleFile& sample : writeSampleFiles(directory, 6)) {
    if (!sample.text) continue;
    SCOPED_TRACE(sample.name);
    std::string windows;
    for (const char c : readFile(directory.file(sample.name))) {
      windows += c == '\n' ? std::string("\r\n") : std::string(1, c);
    }
    const program::CloudTable table = readCloud(directory.write("windows_" + sample.name, windows));
    EXPECT_EQ(table.rows, readCloud(directory.file(sample.name)).rows);
  }
}

TEST(BadFiles, NumbersThatAreNone) {
  const ScratchDirectory directory;
  const std::string text = "nan NaN -nan\ninf -Inf infinity\n1e999 -1e999 1e-999\n1 2 3\n";
  const std::vector<std::string> paths{
      directory.write("a.xyz", text),
      directory.write("a.pcd", pcd("x y z", "4 4 4", "F F F", "POINTS 4\nDATA ascii\n" + text)),
      directory.write("a.ply",
                      "ply\nformat ascii 1.0\nelement vertex 4\nproperty double x\n"
                      "property double y\nproperty double z\nend_header\n" +
                          text)};
  for (const std::string& path : paths) {
    SCOPED_TRACE(path);
    const program::CloudTable table = readCloud(path);
    ASSERT_EQ(table.size, 4U);
    for (const double v : table.position(0)) EXPECT_TRUE(std::isnan(v));
    for (const double v : table.position(1)) EXPECT_TRUE(std::isinf(v));
    EXPECT_EQ(table.position(2)[1], -std::numeric_limits<double>::infinity());
    EXPECT_EQ(table.position(2)[2], 0.0);
    EXPECT_EQ(table.position(3)[2], 3.0);
  }
}

// Time and memory stay those of the file's size.
TEST(BadFiles, HugeHeaders) {
  const ScratchDirectory directory;
  std::string comments;
  while (comments.size() < 3000000) comments += "# nothing to see here\n";
  const std::string xyz = pcd("x y z", "4 4 4", "F F F", "POINTS 1\nDATA ascii\n1 2 3\n");
  EXPECT_EQ(outcome(directory.write("comments.pcd", comments + xyz)), "read");
  constexpr int kFields = 20000;
  std::string names = "x y z";
  std::string sizes = "4 4 4";
  std::string types = "F F F";
  std::string row = "1 2 3";
  std::string properties;
  for (int i = 3; i < kFields; ++i) {
    names += " f" + std::to_string(i);
    sizes += " 4";
    types += " F";
    row += " 0";
    properties += "property float f" + std::to_string(i) + "\n";
  }
  EXPECT_EQ(outcome(directory.write(
                "fields.pcd", pcd(names, sizes, types, "POINTS 1\nDATA ascii\n" + row + "\n"))),
            "read");
  EXPECT_EQ(outcome(directory.write("fields.ply",
                                    "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\n"
                                    "property float y\nproperty float z\n" +
                                        properties + "end_header\n" + row + "\n")),
            "read");
}

struct BadFile {
  const char* name;
  std::string content;
  const char* reason;  // part of the error
};

class BadFileTest : public testing::TestWithParam<BadFile> {};

TEST_P(BadFileTest, IsRefusedWithAReason) {
  const ScratchDirectory directory;
  const std::string path = directory.write(GetParam().name, GetParam().content);
  const std::string result = outcome(path);
  EXPECT_EQ(result.compare(0, path.size() + 2, path + ": "), 0) << result;
  EXPECT_NE(result.find(GetParam().reason), std::string::npos) << result;
}

const std::string kXyz = "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\n";
const std::string kPlyXyz = "property float x\nproperty float y\nproperty float z\nend_header\n";

INSTANTIATE_TEST_SUITE_P(
    Files, BadFileTest,
    testing::Values(
        BadFile{"empty.pcd", "", "is empty"}, BadFile{"empty.ply", "", "is empty"},
        BadFile{"points.e57", "ASTM-E57", "not known by its ending"},
        BadFile{"none", "1 2 3\n", "not known by its ending"},
        BadFile{"many.pcd",
                kXyz + "WIDTH 4000000000\nHEIGHT 1\nPOINTS 4000000000\nDATA binary\n0123",
                "too small for its 4000000000 points"},
        BadFile{"many_ascii.pcd",
                kXyz + "WIDTH 4000000000\nHEIGHT 1\nPOINTS 4000000000\nDATA ascii\n0", "too small"},
        BadFile{"many_compressed.pcd",
                kXyz + "WIDTH 4000000000\nHEIGHT 1\nPOINTS 4000000000\nDATA binary_compressed\n" +
                    std::string(8, '\0') + "xx",
                "POINTS does not agree"},
        BadFile{"bomb.pcd",
                kXyz + "WIDTH 300000000\nHEIGHT 1\nPOINTS 300000000\nDATA binary_compressed\n" +
                    std::string("\x02\x00\x00\x00\x00\xa4\x93\xd6", 8) + "xx",
                "damaged"},
        BadFile{"overflow.pcd", kXyz + "WIDTH 18446744073709551615\nHEIGHT 2\nDATA binary\n0123",
                "out of range"},
        BadFile{"huge.pcd", kXyz + "POINTS 99999999999999999999999\nDATA ascii\n", "whole number"},
        BadFile{"negative.pcd", kXyz + "WIDTH -1\nHEIGHT 1\nPOINTS -1\nDATA ascii\n",
                "whole number"},
        BadFile{"disagree.pcd", kXyz + "WIDTH 2\nHEIGHT 2\nPOINTS 3\nDATA ascii\n1 2 3\n",
                "not WIDTH times HEIGHT"},
        BadFile{"zero.pcd", kXyz + "WIDTH 0\nHEIGHT 1\nPOINTS 0\nDATA ascii\n", "no points"},
        BadFile{"fields.pcd", pcd("a b c", "4 4 4", "F F F", "POINTS 1\nDATA ascii\n1 2 3\n"),
                "no fields x, y, z"},
        BadFile{"no_z.pcd", pcd("x y", "4 4", "F F", "POINTS 1\nDATA ascii\n1 2\n"),
                "no fields x, y, z"},
        BadFile{"vector.pcd",
                pcd("x y z", "4 4 4", "F F F", "COUNT 2 1 1\nPOINTS 1\nDATA ascii\n1 2 3 4\n"),
                "field x is not a single number"},
        BadFile{"odd_size.pcd", pcd("x y z", "3 4 4", "F F F", "POINTS 1\nDATA ascii\n1 2 3\n"),
                "no known type"},
        BadFile{"odd_type.pcd", pcd("x y z", "4 4 4", "Q F F", "POINTS 1\nDATA ascii\n1 2 3\n"),
                "no known type"},
        BadFile{"columns.pcd", pcd("x y z", "4 4", "F F", "POINTS 1\nDATA ascii\n1 2 3\n"),
                "one entry for each of FIELDS"},
        BadFile{
            "count.pcd",
            pcd("x y z h", "4 4 4 4", "F F F F", "COUNT 1 1 1 4000000000\nPOINTS 1\nDATA ascii\n1"),
            "out of range"},
        BadFile{"word.pcd", kXyz + "POINTS 1\nDATA ascii\n1 two 3\n", "'two' is not a number"},
        BadFile{"short_row.pcd", kXyz + "POINTS 2\nDATA ascii\n1 2\n10000 20000 3\n",
                "line 8: has fewer"},
        BadFile{"data.pcd", kXyz + "POINTS 1\nDATA zipped\n1 2 3\n", "not known"},
        BadFile{"no_data.pcd", kXyz + "POINTS 1\n", "no DATA"},
        BadFile{"picture.pcd", "\x89PNG\r\n\x1a\n" + std::string(2000000, 'x'), "PCD header"},
        BadFile{"one_line.pcd", std::string(3000000, '#'), "a line of more than a megabyte"},
        BadFile{"not.ply", "solid cube\n", "not a PLY"},
        BadFile{"many.ply",
                "ply\nformat ascii 1.0\nelement vertex 4000000000\n" + kPlyXyz + "1 2 3\n",
                "too small for its 4000000000"},
        BadFile{
            "many_faces.ply",
            "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
            "property float z\nelement face 4000000000\nproperty list uchar int vertex_indices\n"
            "end_header\n1 2 3\n",
            "face rows"},
        BadFile{"corner.ply",
                "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
                "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
                "end_header\n1 2 3\n3 0 0 1\n",
                "no such vertex"},
        BadFile{"type.ply",
                "ply\nformat ascii 1.0\nelement vertex 1\nproperty text x\nend_header\n",
                "no type of a PLY"},
        BadFile{"format.ply", "ply\nelement vertex 1\n" + kPlyXyz + "1 2 3\n", "name a format"},
        BadFile{"vertices.ply", "ply\nformat ascii 1.0\nelement face 0\nend_header\n",
                "no vertices"},
        BadFile{"words.xyz", "hello world\n", "does not begin with x y z"},
        BadFile{"two.xyz", "1 2\n", "does not begin with x y z"},
        BadFile{"ragged.xyz", "1 2 3\n1 2\n", "line 2"},
        BadFile{"names.csv", "x,y,z\n1,2,3,4\n",
                "line 2: has 4 numbers, and the header has 3 names"},
        BadFile{"commas.csv", "x;y;z\n1,5;2,5;3,5\n",
                "6 numbers, and the header has 3 names: are its"},
        BadFile{"comments.xyz", "# nothing\n", "no points"},
        BadFile{"faces.obj", "f 1 2 3\n", "no vertices"},
        BadFile{"vertex.obj", "v 1 2\n", "is no vertex"}),
    [](const testing::TestParamInfo<BadFile>& bad_file) {
      std::string name = bad_file.param.name;
      for (char& c : name) {
        if (c == '.') c = '_';
      }
      return name;
    });

TEST(BadFiles, WhatIsNoRegularFile) {
  const ScratchDirectory directory;
  EXPECT_NE(outcome(directory.file("")).find("is a directory"), std::string::npos);
  EXPECT_NE(outcome(directory.file("missing.pcd")).find("No such file"), std::string::npos);
  EXPECT_NE(outcome("/dev/null").find("not a regular file"), std::string::npos);
  EXPECT_NE(outcome("").find("No such file"), std::string::npos);
}

// Ends the process: 0 if the file was refused to somebody who is not root.
[[noreturn]] void readWithoutPermission(const std::string& path) {
  constexpr uid_t kNobody = 65534;
  if (geteuid() == 0 && seteuid(kNobody) != 0) std::_Exit(2);
  std::_Exit(outcome(path) == path + ": Permission denied" ? 0 : 1);
}

TEST(BadFiles, WithoutPermission) {
  const ScratchDirectory directory;
  std::filesystem::permissions(directory.file(""), std::filesystem::perms::all);
  const std::string path = directory.write("secret.xyz", "1 2 3\n");
  std::filesystem::permissions(path, std::filesystem::perms::none);
  EXPECT_EXIT(readWithoutPermission(path), testing::ExitedWithCode(0), "");
}

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kShadowMemory = true;  // terabytes of address space
#else
constexpr bool kShadowMemory = false;
#endif

// Ends the process: 0 if the file was refused within 1 GB of address space.
[[noreturn]] void readInLittleMemory(const std::string& path) {
  const rlimit limit{rlim_t{1} << 30, rlim_t{1} << 30};
  setrlimit(RLIMIT_AS, &limit);
  std::_Exit(outcome(path).find("too small") != std::string::npos ? 0 : 1);
}

TEST(BadFiles, CountsAreCheckedBeforeMemoryIsTaken) {
  if (kShadowMemory) GTEST_SKIP() << "a sanitizer needs more address space than the limit";
  const ScratchDirectory directory;
  const std::string path = directory.write(
      "a.pcd", kXyz + "WIDTH 2000000000\nHEIGHT 1\nPOINTS 2000000000\nDATA binary\n0123");
  EXPECT_EXIT(readInLittleMemory(path), testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace segorient::test
