// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// What our readers make of good files, against PCL, which wrote them.
#include <gtest/gtest.h>
#include <pcl/conversions.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <cmath>
#include <cstring>

#include "io/errors.h"
#include "io/readers.h"
#include "sample_files.h"

namespace segorient::test {
namespace {

using program::CloudTable;
using program::Field;
using program::readCloud;

TEST(Readers, EveryKindHoldsThePointsThatPclWrote) {
  const ScratchDirectory directory;
  const std::size_t size = 5000;
  pcl::PointCloud<pcl::PointXYZI> expected;
  pcl::fromPCLPointCloud2(sampleCloud(size), expected);
  for (const SampleFile& sample : writeSampleFiles(directory, size)) {
    SCOPED_TRACE(sample.name);
    const CloudTable table = readCloud(directory.file(sample.name));
    ASSERT_EQ(table.size, size);
    const Field* intensity = table.find("intensity");
    EXPECT_EQ(intensity == nullptr, sample.name == "vertices.obj");
    for (std::size_t i = 0; i < size; ++i) {
      const auto p = table.position(i);
      // PCL writes six digits in a PLY of text, whatever it is asked for.
      const double tolerance = sample.name == "ascii.ply" ? 1e-5 : 0.0;
      ASSERT_NEAR(p[0], static_cast<double>(expected[i].x), tolerance) << i;
      ASSERT_NEAR(p[1], static_cast<double>(expected[i].y), tolerance) << i;
      ASSERT_NEAR(p[2], static_cast<double>(expected[i].z), tolerance) << i;
      if (intensity == nullptr) continue;
      ASSERT_EQ(table.value(*intensity, i), expected[i].intensity) << i;
    }
  }
}

TEST(Readers, PcdKeepsTypesCountsOrganisationAndViewpointAndDropsPadding) {
  const ScratchDirectory directory;
  const std::string path = directory.write(
      "a.pcd",
      "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z _ ring histogram stamp\nSIZE 4 4 4 1 2 4 8\n"
      "TYPE F F F U U F F\nCOUNT 1 1 1 4 1 3 1\nWIDTH 2\nHEIGHT 2\nVIEWPOINT 1 2 3 0 1 0 0\n"
      "POINTS 4\nDATA ascii\n"
      "0 1 2 0 0 0 0 65535 .5 .25 .125 1e300\r\n\n1 1 2 0 0 0 0 1 1 2 3 -1\n"
      "nan nan nan 0 0 0 0 2 1 2 3 4\n-inf 1 2 0 0 0 0 3 1 2 3 4");
  const CloudTable table = readCloud(path);
  EXPECT_EQ(table.size, 4U);
  EXPECT_EQ(table.width, 2U);
  EXPECT_EQ(table.height, 2U);
  EXPECT_EQ(table.viewpoint[1], 2.0);
  EXPECT_EQ(table.viewpoint[4], 1.0);
  EXPECT_EQ(table.find("_"), nullptr);
  EXPECT_EQ(table.row_bytes, 12U + 2U + 12U + 8U);
  EXPECT_EQ(table.value(*table.find("ring"), 0), 65535.0);
  EXPECT_EQ(table.value(*table.find("histogram"), 0, 2), 0.125);
  EXPECT_EQ(table.value(*table.find("stamp"), 0), 1e300);
  EXPECT_TRUE(std::isnan(table.position(2)[0]));
  EXPECT_TRUE(std::isinf(table.position(3)[0]));
}

TEST(Readers, APcdsViewpointThatIsNowhereIsNone) {
  const ScratchDirectory directory;
  const std::string path = directory.write(
      "a.pcd",
      "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 1\nHEIGHT 1\nVIEWPOINT nan 2 3 1 0 0 0\n"
      "DATA ascii\n0 1 2\n");
  EXPECT_EQ(readCloud(path).viewpoint, CloudTable().viewpoint);
}

TEST(Readers, BinaryPcdWithPaddingIsRepacked) {
  const ScratchDirectory directory;
  std::string content =
      "VERSION 0.7\nFIELDS x y z _ label\nSIZE 4 4 4 1 4\nTYPE F F F U U\nCOUNT 1 1 1 4 1\n"
      "WIDTH 2\nHEIGHT 1\nPOINTS 2\nDATA binary\n";
  for (int i = 0; i < 2; ++i) {
    const float xyz[3] = {1.F, 2.F, 3.F + static_cast<float>(i)};
    const std::uint32_t label[2] = {0xdeadbeefU, 7U + static_cast<std::uint32_t>(i)};
    content.append(reinterpret_cast<const char*>(xyz), 12);
    content.append(reinterpret_cast<const char*>(label), 8);
  }
  const CloudTable table = readCloud(directory.write("a.pcd", content));
  EXPECT_EQ(table.position(1)[2], 4.0);
  EXPECT_EQ(table.value(*table.find("label"), 1), 8.0);
}

TEST(Readers, PlyOfEitherByteOrderWithColoursFacesAndOtherElements) {
  const ScratchDirectory directory;
  const std::string header =
      "ply\r\nformat binary_big_endian 1.0\ncomment by hand\nelement strip 1\n"
      "property list uchar short parts\nelement vertex 3\nproperty double x\nproperty double y\n"
      "property double z\nproperty float nx\nproperty float ny\nproperty float nz\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\nelement face 1\n"
      "property list uchar int vertex_indices\nend_header\n";
  std::string body("\x02\x00\x01\x00\x02", 5);
  const auto put = [&](auto v) {
    char bytes[sizeof(v)];
    std::memcpy(bytes, &v, sizeof(v));
    for (std::size_t i = sizeof(v); i-- > 0;) body += bytes[i];
  };
  for (int i = 0; i < 3; ++i) {
    put(500000.125 + i);
    put(5.0e6);
    put(0.0625);
    for (const float n : {0.F, 0.F, 1.F}) put(n);
    body += std::string("\x10\x20\x30", 3);
  }
  body += '\x03';
  for (const std::int32_t v : {2, 1, 0}) put(v);
  const CloudTable table = readCloud(directory.write("a.ply", header + body));
  ASSERT_EQ(table.size, 3U);
  EXPECT_EQ(table.position(2)[0], 500002.125);
  EXPECT_TRUE(table.hasNormals());
  EXPECT_EQ(table.value(*table.find("normal_z"), 1), 1.0);
  std::uint32_t rgb = 0;
  std::memcpy(&rgb, table.at(*table.find("rgb"), 0), 4);
  EXPECT_EQ(rgb, 0x102030U);
  ASSERT_EQ(table.triangles.size(), 1U);
  EXPECT_EQ(table.triangles[0], (program::Triangle{2, 1, 0}));
}

TEST(Readers, ListsOfVerticesAreLeftOut) {
  const ScratchDirectory directory;
  const std::string header =
      "element vertex 2\nproperty float x\nproperty list uchar float weights\nproperty float y\n"
      "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
  const std::string ascii =
      "ply\nformat ascii 1.0\n" + header + "1 2 0.5 0.25 2 3\n4 0 5 6\n3 0 1 0\n";
  std::string binary = "ply\nformat binary_little_endian 1.0\n" + header;
  const auto put = [&](auto v) { binary.append(reinterpret_cast<const char*>(&v), sizeof(v)); };
  put(1.F);
  binary += '\x02';
  for (const float v : {0.5F, 0.25F, 2.F, 3.F, 4.F}) put(v);
  binary += '\x00';
  for (const float v : {5.F, 6.F}) put(v);
  binary += '\x03';
  for (const std::int32_t v : {0, 1, 0}) put(v);
  for (const std::string& content : {ascii, binary}) {
    const CloudTable table = readCloud(directory.write("a.ply", content));
    ASSERT_EQ(table.size, 2U);
    EXPECT_EQ(table.fields.size(), 3U);
    EXPECT_EQ(table.dropped, std::vector<std::string>{"weights"});
    EXPECT_EQ(table.position(0), (std::array<double, 3>{1.0, 2.0, 3.0}));
    EXPECT_EQ(table.position(1), (std::array<double, 3>{4.0, 5.0, 6.0}));
    EXPECT_EQ(table.triangles.size(), 1U);
  }
  // A list that claims more than the file holds.
  const std::string cut = binary.substr(0, binary.find("end_header") + 11) + std::string(5, '\xff');
  EXPECT_THROW(readCloud(directory.write("cut.ply", cut)), program::FileError);
}

TEST(Readers, WholeNumbersAsCoordinatesBecomeReal) {
  const ScratchDirectory directory;
  const std::string pcd = "FIELDS x ring y z\nSIZE 4 2 4 2\nTYPE I U U I\nPOINTS 2\nDATA ascii\n";
  const CloudTable near = readCloud(directory.write("a.pcd", pcd + "-7 65535 8 9\n1 2 3 -4\n"));
  EXPECT_EQ(near.position(0), (std::array<double, 3>{-7.0, 8.0, 9.0}));
  EXPECT_EQ(near.position(1), (std::array<double, 3>{1.0, 3.0, -4.0}));
  EXPECT_EQ(near.value(*near.find("ring"), 0), 65535.0);
  for (const Field* f : near.xyz()) EXPECT_EQ(f->type, 'F');
  EXPECT_EQ(near.find("x")->size, 4U);
  EXPECT_EQ(near.find("ring")->type, 'U');
  // Millimetres of a map: a float would lose digits.
  const CloudTable far = readCloud(
      directory.write("b.pcd", pcd + "500000001 0 4000000001 1\n500000002 0 4000000002 1\n"));
  EXPECT_EQ(far.position(0), (std::array<double, 3>{500000001.0, 4000000001.0, 1.0}));
  const CloudTable ply = readCloud(
      directory.write("a.ply",
                      "ply\nformat ascii 1.0\nelement vertex 1\nproperty short x\nproperty int y\n"
                      "property uchar z\nend_header\n-1 2 3\n"));
  EXPECT_EQ(ply.position(0), (std::array<double, 3>{-1.0, 2.0, 3.0}));
}

TEST(Readers, TimesInTextKeepTheirDigits) {
  const ScratchDirectory directory;
  const CloudTable table = readCloud(directory.write(
      "a.txt", "x y z time nx ny nz\n0 0 0 1700000000.125 0 0 1\n1 1 1 1700000001.25 0 0 1\n"));
  EXPECT_EQ(table.value(*table.find("time"), 0), 1700000000.125);
  EXPECT_EQ(table.find("x")->size, 4U);
  EXPECT_EQ(table.find("normal_z")->size, 4U);
}

TEST(Readers, NormalsOfAPcdMayBeNamedAsInPly) {
  const ScratchDirectory directory;
  const CloudTable table = readCloud(
      directory.write("a.pcd", "FIELDS x y z nx ny nz\nPOINTS 1\nDATA ascii\n1 2 3 0 0.6 -0.8\n"));
  ASSERT_TRUE(table.hasNormals());
  const auto normal = table.triple(table.normals(), 0);
  EXPECT_FLOAT_EQ(static_cast<float>(normal[1]), 0.6F);
  EXPECT_FLOAT_EQ(static_cast<float>(normal[2]), -0.8F);
}

TEST(Readers, TextWithNamesCountLineSeparatorsAndComments) {
  const ScratchDirectory directory;
  const CloudTable named = readCloud(directory.write("a.csv", "X,Y,Z,nx,ny,nz,t\n1,2,3,0,0,1,9\n"));
  EXPECT_TRUE(named.hasNormals());
  EXPECT_EQ(named.value(*named.find("t"), 0), 9.0);
  const CloudTable counted = readCloud(directory.write("a.pts", "2\n1 2 3 4\n5;6;7;8\n"));
  EXPECT_EQ(counted.size, 2U);
  EXPECT_EQ(counted.value(*counted.find("intensity"), 1), 8.0);
  const CloudTable normals =
      readCloud(directory.write("a.xyz", "// x\n1 2 3 0 0 1\n\n+1 2 3 1 0 0\n"));
  EXPECT_TRUE(normals.hasNormals());
  EXPECT_EQ(normals.size, 2U);
  const CloudTable plain = readCloud(directory.write("b.xyz", "1 2 3 0 0 255\n1 2 4 0 0 9\n"));
  EXPECT_FALSE(plain.hasNormals());
}

TEST(Readers, TextMayBeginWithAByteOrderMark) {
  const ScratchDirectory directory;
  const std::string mark = "\xef\xbb\xbf";
  const CloudTable named =
      readCloud(directory.write("a.csv", mark + "X,Y,Z,nx,ny,nz\n1,2,3,0,0,1\n"));
  EXPECT_TRUE(named.hasNormals());
  for (const std::string name : {"a.xyz", "a.pts"}) {
    const CloudTable table = readCloud(directory.write(name, mark + "1 2 3\n4 5 6\n"));
    EXPECT_EQ(table.size, 2U) << name;
    EXPECT_EQ(table.position(0)[0], 1.0) << name;
  }
}

TEST(Readers, TextFarFromTheOriginStaysInDouble) {
  const ScratchDirectory directory;
  const std::string lines = "500000.0625 5400000.03125 100\n500010.125 5400000.0625 101\n";
  for (const std::string name : {"a.xyz", "a.obj"}) {
    std::string content = lines;
    if (name == "a.obj") {
      content = "v " + lines;
      content.insert(content.find('\n') + 1, "v ");
    }
    const CloudTable table = readCloud(directory.write(name, content));
    EXPECT_EQ(table.find("x")->size, 8U) << name;
    EXPECT_EQ(table.position(0)[1], 5400000.03125) << name;
  }
  EXPECT_EQ(readCloud(directory.write("near.xyz", "0 0 0\n1 1 1\n")).find("x")->size, 4U);
}

TEST(LocalPoints, MovesFarCloudsInDoubleAndViewsNearOnesInPlace) {
  const ScratchDirectory directory;
  const CloudTable far =
      readCloud(directory.write("far.xyz", "500000.001 5400000 0\n500000.002 5400001 0\n"));
  const program::LocalPoints moved(far);
  EXPECT_NEAR(moved.view()[1][0] - moved.view()[0][0], 0.001F, 1e-6F);
  EXPECT_NEAR(static_cast<double>(moved.view()[0][1]) + moved.origin()[1], 5400000.0, 1e-6);
  const CloudTable near = readCloud(directory.write("near.xyz", "0 0 0\n1 1 1\nnan 1 1\n"));
  const program::LocalPoints viewed(near);
  EXPECT_EQ(reinterpret_cast<const std::uint8_t*>(viewed.view().data), near.rows.data());
  EXPECT_EQ(viewed.finite(), 2U);
  EXPECT_EQ(viewed.extent(), 1.0);
}

}  // namespace
}  // namespace segorient::test
