// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// triangulate, knn, compare and view on the shipped Fandisk.
#include <gtest/gtest.h>
#include <boost/property_tree/json_parser.hpp>
#include <boost/property_tree/ptree.hpp>

#include <cmath>
#include <cstdlib>
#include <sstream>
#include <string>
#include <vector>

#include "io/readers.h"
#include "run_program.h"

namespace segorient::test {
namespace {

using program::CloudTable;

std::vector<double> labelsOf(const std::string& path) {
  const CloudTable table = program::readCloud(path);
  std::vector<double> out;
  const program::Field* label = table.find("label");
  for (std::size_t i = 0; label != nullptr && i < table.size; ++i) {
    out.push_back(table.value(*label, i));
  }
  return out;
}

TEST(Segment, HasTheSegmentsOfOrientAndTriangulate) {
  const ScratchDirectory directory;
  const std::string out = directory.file("out.ply");
  for (const std::string method : {"auto", "combined"}) {
    std::vector<std::vector<double>> labels;
    for (const std::string command : {"segment", "orient", "triangulate"}) {
      const Outcome run = runProgram({command, fandisk(), out, "--method", method, "--beta", "25"});
      ASSERT_EQ(run.status, 0) << run.err;
      labels.push_back(labelsOf(out));
    }
    ASSERT_FALSE(labels[0].empty());
    EXPECT_EQ(labels[0], labels[1]) << method;
    EXPECT_EQ(labels[0], labels[2]) << method;
  }
}

// Fronts of the mesh must look outward: its triangles agree with the true normals of their corners.
TEST(Triangulate, IsOneMeshWithItsFrontsOutward) {
  const ScratchDirectory directory;
  const std::string out = directory.file("mesh.ply");
  const Outcome run = runProgram({"triangulate", fandisk(), out});
  ASSERT_EQ(run.status, 0) << run.err;
  const CloudTable mesh = program::readCloud(out);
  const CloudTable truth = program::readCloud(fandisk());
  ASSERT_EQ(mesh.size, truth.size);
  ASSERT_GT(mesh.triangles.size(), 20000U);
  std::size_t agreeing = 0;
  for (const program::Triangle& t : mesh.triangles) {
    const auto a = mesh.position(t[0]);
    const auto b = mesh.position(t[1]);
    const auto c = mesh.position(t[2]);
    const double u[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
    const double v[3] = {c[0] - a[0], c[1] - a[1], c[2] - a[2]};
    const double n[3] = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
                         u[0] * v[1] - u[1] * v[0]};
    const auto m = truth.triple(truth.normals(), t[0]);
    if (n[0] * m[0] + n[1] * m[1] + n[2] * m[2] > 0.0) ++agreeing;
  }
  EXPECT_GT(static_cast<double>(agreeing), 0.99 * static_cast<double>(mesh.triangles.size()));
  EXPECT_EQ(runProgram({"triangulate", fandisk(), directory.file("mesh.vtk"), "-q"}).status, 0);
  EXPECT_EQ(readFile(directory.file("mesh.vtk")).compare(0, 5, "# vtk"), 0);
}

// An image of three walls by a camera at (1, 2, 3) that looks along z.
std::string organisedView() {
  std::ostringstream out;
  out << "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 40\nHEIGHT 30\n"
         "VIEWPOINT 0 0 0 1 0 0 0\nPOINTS 1200\nDATA ascii\n";
  for (int v = 0; v < 30; ++v) {
    for (int u = 0; u < 40; ++u) {
      const double depth = (u < 15 ? 2.0 : 3.0) + 0.02 * v;
      out << 1.0 + depth * (u - 20) / 50.0 << " " << 2.0 + depth * (v - 15) / 50.0 << " "
          << 3.0 + depth << "\n";
    }
  }
  return out.str();
}

TEST(Sensors, SaysWhatIsGivenAndWhatIsFound) {
  const ScratchDirectory directory;
  const std::string path = directory.file("sensors.json");
  const Outcome none = runProgram({"sensors", fandisk(), path});
  ASSERT_EQ(none.status, 0) << none.err;
  EXPECT_NE(none.out.find("given           none"), std::string::npos) << none.out;
  boost::property_tree::ptree json;
  boost::property_tree::read_json(path, json);
  EXPECT_EQ(json.get<std::size_t>("points"), 16475U);
  EXPECT_TRUE(json.get_child("sensors").empty());
  EXPECT_NE(json.get<std::string>("why"), "");

  const Outcome one = runProgram({"sensors", directory.write("view.pcd", organisedView()), path});
  ASSERT_EQ(one.status, 0) << one.err;
  boost::property_tree::read_json(path, json);
  ASSERT_EQ(json.get_child("sensors").size(), 1U) << one.out;
  const auto& camera = json.get_child("sensors").front().second;
  EXPECT_EQ(camera.get<std::string>("kind"), "camera");
  EXPECT_EQ(camera.get<std::string>("evidence"), "image");
  EXPECT_NEAR(camera.get<double>("x"), 1.0, 1e-2);
  EXPECT_NEAR(camera.get<double>("y"), 2.0, 1e-2);
  EXPECT_NEAR(camera.get<double>("z"), 3.0, 1e-2);
  EXPECT_TRUE(camera.get<bool>("sure"));

  const std::string seen =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty "
      "float y\nproperty float z\nproperty float vp_x\nproperty float "
      "vp_y\nproperty float vp_z\nend_header\n";
  const std::string given =
      directory.write("given.ply", seen + "0 0 0 5 6 7\n1 0 0 5 6 7\n0 1 0 8 8 8\n");
  ASSERT_EQ(runProgram({"sensors", given, path, "-q"}).status, 0);
  boost::property_tree::read_json(path, json);
  ASSERT_EQ(json.get_child("given").size(), 2U);
  EXPECT_EQ(json.get_child("given").front().second.get<double>("y"), 6.0);
  EXPECT_EQ(json.get_child("given").front().second.get<int>("points"), 2);
  EXPECT_EQ(runProgram({"sensors", given, directory.file("sensors.txt")}).status, 2);
}

// Every segment and component says how it was oriented; the shipped Fandisk leaves few questions.
TEST(Orient, ReportTellsHowEachSegmentWasOriented) {
  const ScratchDirectory directory;
  for (const std::string method : {"combined", "hoppe", "auto"}) {
    const std::string path = directory.file("report.json");
    const Outcome run = runProgram({"orient", fandisk(), directory.file("out.pcd"), "--method",
                                    method, "--report", path, "-q"});
    ASSERT_EQ(run.status, 0) << run.err;
    boost::property_tree::ptree report;
    boost::property_tree::read_json(path, report);
    EXPECT_EQ(report.get<std::string>("method"), method);
    std::size_t points = 0;
    std::size_t hard = 0;
    for (const auto& [key, segment] : report.get_child("segments")) {
      points += segment.get<std::size_t>("points");
      EXPECT_EQ(std::abs(segment.get<int>("sign")), 1);
      EXPECT_GE(segment.get<float>("confidence"), 0.F);
      EXPECT_LE(segment.get<float>("confidence"), 1.F);
      EXPECT_NE(segment.get<std::string>("oriented_by"), "");
      EXPECT_GE(segment.get<int>("component"), 0);
      EXPECT_LE(std::abs(segment.get<float>("extremal_agreement")), 1.F);
      hard += segment.get<bool>("hard") ? 1 : 0;
    }
    EXPECT_EQ(points, 16475U) << method;
    EXPECT_EQ(report.get_child("hard_segments").size(), hard);
    EXPECT_EQ(report.get<std::size_t>("segments_by_kind.hard"), hard);
    const auto& component = report.get_child("components").front().second;
    EXPECT_EQ(std::abs(component.get<int>("sign")), 1);
    EXPECT_GT(component.get<float>("confidence"), 0.8F) << method;
    EXPECT_LT(component.get<float>("contradiction"), 0.1F) << method;
    // and a picture takes the report
    const Outcome picture =
        runProgram({"render", directory.file("out.pcd"), directory.file("out.png"), "--color",
                    "orientation", "--report", path, "--width", "64", "--height", "32"});
    EXPECT_EQ(picture.status, 0) << picture.err;
  }
}

TEST(Knn, AgreesWithPclAndWritesEveryNeighbour) {
  const ScratchDirectory directory;
  const std::string out = directory.file("neighbors.csv");
  const Outcome run = runProgram({"knn", fandisk(), out, "-k", "3"});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_NE(run.out.find(" 0 distances differ"), std::string::npos) << run.out;
  const CloudTable cloud = program::readCloud(fandisk());
  std::istringstream lines(readFile(out));
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(line, "point,rank,neighbor,distance");
  std::size_t count = 0;
  while (std::getline(lines, line)) {
    std::size_t point = 0;
    std::size_t rank = 0;
    std::size_t neighbor = 0;
    double distance = -1.0;
    ASSERT_EQ(std::sscanf(line.c_str(), "%zu,%zu,%zu,%lf", &point, &rank, &neighbor, &distance), 4);
    ASSERT_EQ(point, count / 3);
    ASSERT_EQ(rank, count % 3);
    const auto p = cloud.position(point);
    const auto q = cloud.position(neighbor);
    ASSERT_NEAR(distance, std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]), 1e-6);
    ++count;
  }
  EXPECT_EQ(count, 3 * cloud.size);
}

TEST(Compare, ShowsWhatTheViewpointGetsWrong) {
  const ScratchDirectory directory;
  const Outcome run = runProgram({"compare", fandisk(), "--picture", directory.file("compare.png"),
                                  "--poisson", directory.file("poisson"), "--depth", "5"});
  ASSERT_EQ(run.status, 0) << run.err;
  double pcl_share = 0.0;
  double our_share = 0.0;
  const std::size_t pcl_line = run.out.find("\n  PCL ");
  const std::size_t our_line = run.out.find("\n  segorient ");
  ASSERT_NE(pcl_line, std::string::npos) << run.out;
  ASSERT_NE(our_line, std::string::npos) << run.out;
  ASSERT_EQ(std::sscanf(run.out.c_str() + pcl_line, " PCL %lf", &pcl_share), 1);
  ASSERT_EQ(std::sscanf(run.out.c_str() + our_line, " segorient %lf", &our_share), 1);
  EXPECT_LT(pcl_share, 80.0);
  EXPECT_GT(our_share, 99.5);
  for (const std::string name : {"compare.png", "poisson.png"}) {
    EXPECT_EQ(readFile(directory.file(name)).compare(1, 3, "PNG"), 0) << name;
  }
  const CloudTable ours = program::readCloud(directory.file("poisson_ours.ply"));
  EXPECT_GT(ours.triangles.size(), 1000U);
  EXPECT_GT(program::readCloud(directory.file("poisson_pcl.ply")).size, 1000U);
}

double rms(const std::string& normals) {
  double value = 0.0;
  const Outcome run = runProgram({"evaluate", fandisk(), normals});
  const std::size_t at = run.out.find("rms ");
  if (at != std::string::npos) std::sscanf(run.out.c_str() + at, "rms %lf", &value);
  return value;
}

TEST(Normals, RecomputationSharpensEdges) {
  const ScratchDirectory directory;
  const std::string plain = directory.file("plain.pcd");
  const std::string once = directory.file("once.pcd");
  const std::string paper = directory.file("paper.pcd");
  ASSERT_EQ(runProgram({"normals", fandisk(), plain}).status, 0);
  ASSERT_EQ(runProgram({"normals", fandisk(), once, "--recompute", "1"}).status, 0);
  ASSERT_EQ(runProgram({"normals", fandisk(), paper, "--recompute", "1", "--delta", "40"}).status,
            0);
  EXPECT_GT(rms(plain), 9.0);
  EXPECT_LT(rms(once), 0.6 * rms(plain));
  EXPECT_LT(rms(paper), 0.9 * rms(plain));
}

TEST(View, SaysThatThereIsNoScreen) {
  unsetenv("DISPLAY");
  const Outcome run = runProgram({"view", fandisk()});
  EXPECT_EQ(run.status, 1);
  EXPECT_TRUE(isOneLine(run.err)) << run.err;
}

}  // namespace
}  // namespace segorient::test
