// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// LAS files: every point format is read and comes back as it was; what is not whole is an error.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "io/cloud_writer.h"
#include "io/las_format.h"
#include "io/readers.h"
#include "las_sample.h"
#include "scratch_directory.h"

namespace segorient::test {
namespace {

using program::CloudTable;
using program::Field;
using program::FileError;
using program::OutputCloud;
using program::OutputFile;
using program::readCloud;

constexpr int kPoints = 7;

double valueOf(const CloudTable& table, const std::string& name, std::size_t row) {
  const Field* field = table.find(name);
  EXPECT_NE(field, nullptr) << name;
  return field == nullptr ? NAN : table.value(*field, row);
}

std::string outcome(const std::string& path) {
  try {
    readCloud(path);
    return "read";
  } catch (const FileError& e) {
    return e.what();
  }
}

void writeAs(const CloudTable& table, const std::string& path,
             const std::vector<float>* normals = nullptr) {
  OutputCloud out(table);
  if (normals != nullptr) {
    out.add("normal_x", normals->data(), 4);
    out.add("normal_y", normals->data() + 1, 4);
    out.add("normal_z", normals->data() + 2, 4);
    out.add("curvature", normals->data() + 3, 4);
  }
  out.addRest(table);
  OutputFile file(path);
  writeCloud(out, file);
  file.commit();
}

TEST(Las, EveryPointFormat) {
  const ScratchDirectory directory;
  for (int format = 0; format <= 10; ++format) {
    SCOPED_TRACE(format);
    const CloudTable table =
        readCloud(directory.write("a.las", lasSample(format, kPoints).bytes()));
    ASSERT_EQ(table.size, 7U);
    const int i = 5;
    EXPECT_EQ(table.find("x")->size, 8U);
    const auto p = table.position(i);
    EXPECT_DOUBLE_EQ(p[0], 500000.0 + 5.0);
    EXPECT_DOUBLE_EQ(p[1], 5400000.0 - 0.035);
    EXPECT_DOUBLE_EQ(p[2], 100.0 + 0.025);
    EXPECT_EQ(valueOf(table, "intensity", i), 105);
    EXPECT_EQ(valueOf(table, "return_number", i), 3);
    EXPECT_EQ(valueOf(table, "number_of_returns", i), 3);
    EXPECT_EQ(valueOf(table, "scan_direction_flag", i), 1);
    EXPECT_EQ(valueOf(table, "edge_of_flight_line", i), 1);
    EXPECT_EQ(valueOf(table, "classification", i), 5);
    EXPECT_EQ(valueOf(table, "classification_flags", i), 5);
    EXPECT_EQ(valueOf(table, "user_data", i), 205);
    EXPECT_EQ(valueOf(table, "point_source_id", i), 7005);
    EXPECT_NEAR(valueOf(table, "scan_angle", i), format >= 6 ? -30.0 : -5.0, 1e-4);
    const bool time = format == 1 || format >= 3;
    EXPECT_EQ(table.find("gps_time") != nullptr, time);
    if (time) {
      EXPECT_EQ(valueOf(table, "gps_time", i), 1239.5);
    }
    const bool color =
        format == 2 || format == 3 || format == 5 || format == 7 || format == 8 || format == 10;
    EXPECT_EQ(table.find("rgb") != nullptr, color);
    if (color) {
      EXPECT_EQ(valueOf(table, "green16", i), 256 * 51 + 5);
      std::uint32_t rgb = 0;
      std::memcpy(&rgb, table.at(*table.find("rgb"), i), 4);
      EXPECT_EQ(rgb, 50U << 16 | 51U << 8 | 52U);
    }
    if (format == 8 || format == 10) {
      EXPECT_EQ(valueOf(table, "infrared", i), 905);
    }
    if (format >= 6) {
      EXPECT_EQ(valueOf(table, "scanner_channel", i), 1);
    }
  }
}

// What is read and written is byte for byte the points that were there.
TEST(Las, ComesBackAsItWas) {
  const ScratchDirectory directory;
  for (const int format : {0, 1, 2, 3, 6, 7, 8}) {
    SCOPED_TRACE(format);
    LasSample sample = lasSample(format, kPoints);
    sample.records = lasRecord("LASF_Projection", 2112, "COORDINATES OF SOMEWHERE");
    sample.record_count = 1;
    const CloudTable table = readCloud(directory.write("a.las", sample.bytes()));
    writeAs(table, directory.file("b.las"));
    const std::string back = readFile(directory.file("b.las"));
    std::string points;
    for (const std::string& p : sample.points) points += p;
    ASSERT_GE(back.size(), points.size());
    EXPECT_TRUE(back.compare(back.size() - points.size(), points.size(), points) == 0);
    EXPECT_NE(back.find("COORDINATES OF SOMEWHERE"), std::string::npos);
    EXPECT_EQ(back[25], static_cast<char>(sample.minor));
    EXPECT_EQ(back[104], static_cast<char>(format));
    EXPECT_EQ(back.compare(26, 9, "a scanner"), 0);
    EXPECT_EQ(back.compare(131, 48, sample.bytes(), 131, 48), 0) << "scale and offset";
  }
}

// Formats with waveforms come back as those without.
TEST(Las, WaveformsAreLeftOut) {
  const ScratchDirectory directory;
  for (const auto& [format, without] : {std::pair{4, 1}, {5, 3}, {9, 6}, {10, 8}}) {
    const CloudTable table =
        readCloud(directory.write("a.las", lasSample(format, kPoints).bytes()));
    ASSERT_EQ(table.notes.size(), 1U);
    writeAs(table, directory.file("b.las"));
    EXPECT_EQ(readFile(directory.file("b.las"))[104], static_cast<char>(without));
    EXPECT_EQ(readCloud(directory.file("b.las")).rows, table.rows);
  }
}

TEST(Las, HeaderCountsAndBounds) {
  const ScratchDirectory directory;
  for (const int format : {3, 7}) {
    const CloudTable table =
        readCloud(directory.write("a.las", lasSample(format, kPoints).bytes()));
    writeAs(table, directory.file("b.las"));
    const std::string h = readFile(directory.file("b.las"));
    double bounds[6];
    std::memcpy(bounds, &h[179], sizeof(bounds));
    EXPECT_DOUBLE_EQ(bounds[0], 500006.0);
    EXPECT_DOUBLE_EQ(bounds[1], 500000.0);
    EXPECT_DOUBLE_EQ(bounds[4], 100.036);
    std::uint32_t legacy[6];
    std::memcpy(legacy, &h[107], sizeof(legacy));
    EXPECT_EQ(legacy[0], format == 3 ? 7U : 0U);
    if (format == 3) {
      EXPECT_EQ(legacy[1], 3U) << "first returns";
      EXPECT_EQ(legacy[2], 2U);
    } else {
      std::uint64_t counts[3];
      std::memcpy(counts, &h[247], sizeof(counts));
      EXPECT_EQ(counts[0], 7U);
      EXPECT_EQ(counts[1], 3U);
      EXPECT_EQ(counts[2], 2U);
    }
  }
}

TEST(Las, NormalsAreExtraBytes) {
  const ScratchDirectory directory;
  const CloudTable table = readCloud(directory.write("a.las", lasSample(1, 3).bytes()));
  const std::vector<float> normals{0, 0, 1, 0.1F, 0, 1, 0, 0.2F, -1, 0, 0, 0.3F};
  writeAs(table, directory.file("b.las"), &normals);
  const std::string bytes = readFile(directory.file("b.las"));
  EXPECT_NE(bytes.find("NormalX"), std::string::npos);
  const CloudTable back = readCloud(directory.file("b.las"));
  EXPECT_TRUE(back.hasNormals());
  EXPECT_EQ(valueOf(back, "normal_x", 2), -1.0);
  EXPECT_EQ(valueOf(back, "curvature", 1), static_cast<double>(0.2F));
  EXPECT_EQ(valueOf(back, "gps_time", 2), 1236.5);
  writeAs(back, directory.file("c.las"));
  EXPECT_EQ(readFile(directory.file("c.las")), bytes) << "and once more";
}

TEST(Las, ExtraBytesOfAllTypes) {
  const ScratchDirectory directory;
  LasSample sample = lasSample(0, 2);
  sample.records = lasRecord("LASF_Spec", 4,
                             lasExtra("height", 4, 8 | 16, 0.01, 100.0) + lasExtra("a name", 10) +
                                 lasExtra("intensity", 1) + lasExtra("", 3) +
                                 lasExtra("pad", 0, 3) + lasExtra("pair", 15));
  sample.record_count = 1;
  for (std::string& p : sample.points) {
    std::string extra;
    putAt(extra, 0, std::int16_t{-250});
    putAt(extra, 2, 2.5);
    putAt(extra, 10, std::uint8_t{9});
    putAt(extra, 11, std::uint16_t{77});
    putAt(extra, 13, std::uint16_t{0});
    putAt(extra, 15, std::uint8_t{0});
    putAt(extra, 16, std::uint32_t{5});
    putAt(extra, 20, std::uint32_t{6});
    p += extra + "rest";
  }
  const CloudTable table = readCloud(directory.write("a.las", sample.bytes()));
  EXPECT_DOUBLE_EQ(valueOf(table, "height", 1), 97.5);
  EXPECT_EQ(valueOf(table, "a_name", 1), 2.5);
  EXPECT_EQ(valueOf(table, "intensity", 1), 101);
  EXPECT_EQ(valueOf(table, "intensity_extra", 1), 9);
  EXPECT_EQ(valueOf(table, "extra_3", 1), 77);
  const Field* pair = table.find("pair");
  ASSERT_NE(pair, nullptr);
  EXPECT_EQ(pair->count, 2U);
  EXPECT_EQ(table.value(*pair, 1, 1), 6);
  ASSERT_EQ(table.notes.size(), 1U) << "the last four bytes";
}

// A cloud that was no LAS: the finest steps that 32 bits hold, whatever its units.
TEST(Las, OtherCloudsKeepTheirPrecision) {
  const ScratchDirectory directory;
  for (const double unit : {1e-30, 1e-3, 1.0, 1e6, 1e30}) {
    SCOPED_TRACE(unit);
    std::ostringstream text;
    text.precision(17);
    text << "ply\nformat ascii 1.0\nelement vertex 4\nproperty double x\nproperty double y\n"
            "property double z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
            "property int tag\nend_header\n";
    const double rows[4][3] = {{0, 0, 0}, {1, 2, 3}, {-5, 0.123456789, 7}, {4, 4.5, -1}};
    for (const auto& r : rows) {
      text << unit * r[0] << ' ' << unit * r[1] << ' ' << unit * r[2] << " 255 0 7 -3\n";
    }
    const CloudTable table = readCloud(directory.write("a.ply", text.str()));
    writeAs(table, directory.file("b.las"));
    const CloudTable back = readCloud(directory.file("b.las"));
    ASSERT_EQ(back.size, 4U);
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t a = 0; a < 3; ++a) {
        EXPECT_NEAR(back.position(i)[a], unit * rows[i][a], 5e-9 * 9.0 * unit);
      }
    }
    std::uint32_t rgb = 0;
    std::memcpy(&rgb, back.at(*back.find("rgb"), 0), 4);
    EXPECT_EQ(rgb, 0xff0007U);
    EXPECT_EQ(valueOf(back, "tag", 2), -3);
    EXPECT_EQ(valueOf(back, "return_number", 0), 1);
  }
}

TEST(Las, PointsWithoutPlaceAreLeftOut) {
  const ScratchDirectory directory;
  const CloudTable table = readCloud(directory.write("a.xyz", "1 2 3\nnan 0 0\n4 5 6\n"));
  writeAs(table, directory.file("b.las"));
  EXPECT_EQ(readCloud(directory.file("b.las")).size, 2U);
}

// Classes above 31 have no place in the old formats.
TEST(Las, NewFormatWhereTheOldOneHasNoRoom) {
  const ScratchDirectory directory;
  const CloudTable table =
      readCloud(directory.write("a.ply",
                                "ply\nformat ascii 1.0\nelement vertex 1\nproperty float "
                                "x\nproperty float y\nproperty float z\n"
                                "property uchar classification\nend_header\n1 2 3 200\n"));
  writeAs(table, directory.file("b.las"));
  EXPECT_EQ(readFile(directory.file("b.las"))[104], 6);
  EXPECT_EQ(valueOf(readCloud(directory.file("b.las")), "classification", 0), 200);
}

TEST(Las, ExtendedRecordsComeBack) {
  const ScratchDirectory directory;
  LasSample sample = lasSample(6, 2);
  std::string bytes = sample.bytes();
  putAt(bytes, 235, static_cast<std::uint64_t>(bytes.size()));
  putAt(bytes, 243, std::uint32_t{1});
  std::string record(60, '\0');
  std::memcpy(&record[2], "somebody", 8);
  putAt(record, 20, std::uint64_t{4});
  bytes += record + "data";
  const CloudTable table = readCloud(directory.write("a.las", bytes));
  writeAs(table, directory.file("b.las"));
  const std::string back = readFile(directory.file("b.las"));
  EXPECT_EQ(back.substr(back.size() - 64), record + "data");
  std::uint64_t begin = 0;
  std::memcpy(&begin, &back[235], sizeof(begin));
  EXPECT_EQ(begin, back.size() - 64);
}

TEST(BadLas, TruncatedAtEveryByte) {
  const ScratchDirectory directory;
  LasSample sample = lasSample(7, 3);
  sample.records = lasRecord("LASF_Spec", 4, lasExtra("height", 4));
  sample.record_count = 1;
  for (std::string& p : sample.points) p += "ab";
  const std::string whole = sample.bytes();
  ASSERT_EQ(outcome(directory.write("whole.las", whole)), "read");
  for (std::size_t length = 0; length < whole.size(); ++length) {
    const std::string path = directory.write("cut.las", whole.substr(0, length));
    const std::string result = outcome(path);
    EXPECT_EQ(result.compare(0, path.size() + 2, path + ": "), 0) << length << ": " << result;
  }
}

TEST(BadLas, EveryByteDamaged) {
  const ScratchDirectory directory;
  LasSample sample = lasSample(8, 2);
  sample.records = lasRecord("LASF_Spec", 4, lasExtra("height", 4) + lasExtra("pair", 15));
  sample.record_count = 1;
  for (std::string& p : sample.points) p += std::string(10, 'a');
  const std::string whole = sample.bytes();
  for (std::size_t at = 0; at < whole.size(); ++at) {
    for (const char damage : {'\0', '\x7f', '\xff'}) {
      std::string content = whole;
      content[at] = damage;
      outcome(directory.write("damaged.las", content));  // must come back
    }
  }
}

TEST(BadLas, CompressedFilesNameTheToolThatUnpacks) {
  const ScratchDirectory directory;
  std::string bytes = lasSample(3, 2).bytes();
  bytes[104] = static_cast<char>(3 | 0x80);
  for (const char* name : {"a.laz", "a.las"}) {
    const std::string result = outcome(directory.write(name, bytes));
    EXPECT_NE(result.find("laszip -i"), std::string::npos) << result;
  }
}

// What a header does not count is not read, which is said: other programs may have written less
// than they meant to.
TEST(BadLas, WhatTheHeaderDoesNotCountIsNamed) {
  const ScratchDirectory directory;
  std::string bytes = lasSample(0, 7).bytes();
  EXPECT_TRUE(readCloud(directory.write("a.las", bytes)).notes.empty());
  putAt(bytes, 107, std::uint32_t{4});
  const CloudTable few = readCloud(directory.write("a.las", bytes));
  EXPECT_EQ(few.size, 4U);
  ASSERT_EQ(few.notes.size(), 1U);
  EXPECT_NE(few.notes[0].find("3 more points"), std::string::npos) << few.notes[0];
  std::string beyond = lasSample(6, 2).bytes();
  putAt(beyond, 235, std::uint64_t{1} << 40);
  putAt(beyond, 243, std::uint32_t{1});
  const CloudTable whole = readCloud(directory.write("b.las", beyond));
  EXPECT_EQ(whole.size, 2U);
  ASSERT_EQ(whole.notes.size(), 1U);
  EXPECT_NE(whole.notes[0].find("not there"), std::string::npos) << whole.notes[0];
}

TEST(BadLas, HeadersThatLie) {
  const ScratchDirectory directory;
  const std::string good = lasSample(0, 2).bytes();
  const auto changed = [&](std::size_t at, auto value) {
    std::string bytes = good;
    putAt(bytes, at, value);
    return outcome(directory.write("a.las", bytes));
  };
  EXPECT_NE(changed(107, std::uint32_t{4000000000U}).find("too small for its"), std::string::npos);
  EXPECT_NE(changed(96, std::uint32_t{4000000000U}).find("cut short"), std::string::npos);
  EXPECT_NE(changed(96, std::uint32_t{10}).find("contradicts itself"), std::string::npos);
  EXPECT_NE(changed(100, std::uint32_t{1}).find("variable length"), std::string::npos);
  EXPECT_NE(changed(104, std::uint8_t{11}).find("format"), std::string::npos);
  EXPECT_NE(changed(105, std::uint16_t{19}).find("too short"), std::string::npos);
  EXPECT_NE(changed(131, 0.0).find("scale"), std::string::npos);
  EXPECT_NE(changed(155, std::nan("")).find("offset"), std::string::npos);
  EXPECT_NE(changed(25, std::uint8_t{5}).find("version"), std::string::npos);
  EXPECT_NE(changed(107, std::uint32_t{0}).find("no points"), std::string::npos);
}

}  // namespace
}  // namespace segorient::test
