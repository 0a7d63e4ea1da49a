// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// What we write, read back by PCL and by our own readers.
#include <gtest/gtest.h>
#include <pcl/conversions.h>
#include <pcl/io/pcd_io.h>
#include <pcl/io/ply_io.h>
#include <pcl/io/vtk_lib_io.h>
#include <pcl/point_types.h>

#include <cstring>

#include "io/cloud_writer.h"
#include "io/readers.h"
#include "sample_files.h"

namespace segorient::test {
namespace {

using program::CloudTable;
using program::OutputCloud;
using program::OutputFile;
using program::readCloud;

// The cloud in `path` with normals, colours and labels, written to `out`.
class Writers : public testing::Test {
 protected:
  void write(const CloudTable& table, const std::string& out,
             const std::vector<program::Triangle>* triangles = nullptr) {
    normals_.assign(4 * table.size, 0.25F);
    for (std::size_t i = 0; i < table.size; ++i) normals_[4 * i + 2] = static_cast<float>(i);
    colors_.assign(table.size, 0x102030U);
    labels_.assign(table.size, 5U);
    labels_.back() = 0xffffffffU;
    kinds_.assign(table.size, 2);
    OutputCloud cloud(table);
    cloud.triangles = triangles;
    cloud.add("normal_x", normals_.data(), 4);
    cloud.add("normal_y", normals_.data() + 1, 4);
    cloud.add("normal_z", normals_.data() + 2, 4);
    cloud.add("curvature", normals_.data() + 3, 4);
    cloud.add("rgb", reinterpret_cast<const float*>(colors_.data()), 1);
    cloud.add("label", labels_.data());
    cloud.add("segment_kind", kinds_.data());
    cloud.addRest(table);
    OutputFile file(out);
    program::writeCloud(cloud, file);
    file.commit();
  }
  void expectWritten(const pcl::PCLPointCloud2& blob, std::size_t size) {
    pcl::PointCloud<pcl::PointXYZRGBNormal> normals;
    pcl::PointCloud<pcl::PointXYZI> points;
    pcl::PointCloud<pcl::PointXYZL> labels;
    pcl::fromPCLPointCloud2(blob, normals);
    pcl::fromPCLPointCloud2(blob, points);
    pcl::fromPCLPointCloud2(blob, labels);
    pcl::PointCloud<pcl::PointXYZI> expected;
    pcl::fromPCLPointCloud2(sampleCloud(size), expected);
    ASSERT_EQ(normals.size(), size);
    for (std::size_t i = 0; i < size; ++i) {
      EXPECT_EQ(points[i].getVector3fMap(), expected[i].getVector3fMap());
      EXPECT_EQ(points[i].intensity, expected[i].intensity);
      EXPECT_EQ(normals[i].normal_x, 0.25F);
      EXPECT_EQ(normals[i].normal_z, static_cast<float>(i));
      EXPECT_EQ(normals[i].curvature, 0.25F);
      EXPECT_EQ(normals[i].r, 0x10);
      EXPECT_EQ(normals[i].b, 0x30);
      EXPECT_EQ(labels[i].label, i + 1 == size ? 0xffffffffU : 5U);
    }
  }

  ScratchDirectory directory_;
  std::vector<float> normals_;
  std::vector<std::uint32_t> colors_;
  std::vector<std::uint32_t> labels_;
  std::vector<std::uint8_t> kinds_;
};

TEST_F(Writers, PclReadsOurPcdAndPly) {
  const std::size_t size = 5000;  // more than one block
  writeSampleFiles(directory_, size);
  const CloudTable table = readCloud(directory_.file("binary.pcd"));
  pcl::PCLPointCloud2 blob;
  write(table, directory_.file("out.pcd"));
  ASSERT_EQ(pcl::io::loadPCDFile(directory_.file("out.pcd"), blob), 0);
  expectWritten(blob, size);
  write(table, directory_.file("out.ply"));
  ASSERT_EQ(pcl::io::loadPLYFile(directory_.file("out.ply"), blob), 0);
  expectWritten(blob, size);
}

TEST_F(Writers, WeReadOurOwnFilesBackToTheLastBit) {
  const std::string text =
      "VERSION 0.7\nFIELDS x y z time ring h stamp\nSIZE 8 8 8 8 2 4 8\nTYPE F F F F U F U\n"
      "COUNT 1 1 1 1 1 2 1\nWIDTH 1\nHEIGHT 2\nVIEWPOINT 1 2 3 1 0 0 0\nPOINTS 2\nDATA ascii\n"
      "500000.123456789 5400000.987654321 101.1 1.25e9 7 1 2 1234567890123\n"
      "500001.123456789 5400001.987654321 102.1 1.25e9 8 3 4 5\n";
  const CloudTable table = readCloud(directory_.write("in.pcd", text));
  for (const std::string name : {"out.pcd", "out.ply"}) {
    SCOPED_TRACE(name);
    write(table, directory_.file(name));
    const CloudTable back = readCloud(directory_.file(name));
    ASSERT_EQ(back.size, 2U);
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_EQ(back.position(i), table.position(i));
      EXPECT_EQ(back.value(*back.find("time"), i), 1.25e9);
      EXPECT_EQ(back.value(*back.find("ring"), i), 7.0 + static_cast<double>(i));
      EXPECT_EQ(back.value(*back.find("stamp"), i), i == 0 ? 1234567890123.0 : 5.0);
      EXPECT_EQ(back.value(*back.find("segment_kind"), i), 2.0);
    }
    EXPECT_EQ(back.find("scalar_label"), nullptr);
  }
  const CloudTable pcd = readCloud(directory_.file("out.pcd"));
  EXPECT_EQ(pcd.height, 2U);
  EXPECT_EQ(pcd.viewpoint[2], 3.0);
  EXPECT_EQ(pcd.find("h")->count, 2U);
}

// A field of the name that CloudCompare wants for the label, with or without news in it.
TEST_F(Writers, AScalarLabelOfOnesOwnStays) {
  const std::string header =
      "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n"
      "property float z\nproperty uint label\nproperty float scalar_label\n"
      "property float w\nend_header\n";
  const CloudTable same =
      readCloud(directory_.write("same.ply", header + "1 2 3 7 7 8\n4 5 6 4294967295 -1 9\n"));
  EXPECT_EQ(same.find("scalar_label"), nullptr);
  EXPECT_EQ(same.value(*same.find("w"), 1), 9.0);
  const CloudTable own =
      readCloud(directory_.write("own.ply", header + "1 2 3 7 7 8\n4 5 6 4294967295 0.5 9\n"));
  ASSERT_NE(own.find("scalar_label"), nullptr);
  for (const std::string name : {"out.pcd", "out.ply"}) {
    write(own, directory_.file(name));
    const CloudTable back = readCloud(directory_.file(name));
    ASSERT_NE(back.find("scalar_label"), nullptr) << name;
    EXPECT_EQ(back.value(*back.find("scalar_label"), 0), 7.0);
    EXPECT_EQ(back.value(*back.find("scalar_label"), 1), 0.5);
    EXPECT_EQ(back.value(*back.find("w"), 1), 9.0);
  }
}

TEST_F(Writers, PlyIsWhatCloudCompareTakes) {
  writeSampleFiles(directory_, 3);
  write(readCloud(directory_.file("binary.pcd")), directory_.file("out.ply"));
  const std::string content = readFile(directory_.file("out.ply"));
  EXPECT_NE(content.find("property float scalar_label\n"), std::string::npos);
  EXPECT_EQ(content.find("camera"), std::string::npos);
  float last = 0.F;  // no label is -1: intensity follows it, then the row ends
  std::memcpy(&last, content.data() + content.size() - 4 - 1 - 4, 4);
  EXPECT_EQ(last, -1.F);
}

TEST_F(Writers, MeshesOpenInPclAsPlyAndVtk) {
  writeSampleFiles(directory_, 9);
  const CloudTable table = readCloud(directory_.file("binary.pcd"));
  const std::vector<program::Triangle> triangles{{0, 1, 2}, {6, 7, 8}};
  for (const std::string name : {"out.ply", "out.vtk"}) {
    SCOPED_TRACE(name);
    write(table, directory_.file(name), &triangles);
    pcl::PolygonMesh mesh;
    pcl::io::loadPolygonFile(directory_.file(name), mesh);
    ASSERT_EQ(mesh.polygons.size(), 2U);
    EXPECT_EQ(mesh.polygons[1].vertices, (pcl::Indices{6, 7, 8}));
    pcl::PointCloud<pcl::PointXYZRGB> cloud;
    pcl::fromPCLPointCloud2(mesh.cloud, cloud);
    ASSERT_EQ(cloud.size(), 9U);
    EXPECT_EQ(cloud[8].x, static_cast<float>(table.position(8)[0]));
    EXPECT_EQ(cloud[8].r, 0x10);
    EXPECT_EQ(cloud[8].b, 0x30);
  }
}

}  // namespace
}  // namespace segorient::test
