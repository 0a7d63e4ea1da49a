// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// Every public class as a PCL program uses it, against the installed package: names, life cycle,
// getters for setters, sizes of what comes out. Ends with 0 if all is as promised.
#include <pcl/features/normal_3d.h>
#include <pcl/point_types.h>
#include <pcl/surface/reconstruction.h>
#include <segorient/common/neighborhoods.h>
#include <segorient/features/awas_normal_estimation.h>
#include <segorient/features/lct_normal_estimation.h>
#include <segorient/features/ldt_normal_estimation.h>
#include <segorient/features/normal_recomputation.h>
#include <segorient/features/plane_normal_estimation.h>
#include <segorient/orientation/oriented_normal_estimation.h>
#include <segorient/orientation/segment_orientation.h>
#include <segorient/search/median_hash.h>
#include <segorient/segmentation/normal_segmentation.h>
#include <segorient/surface/segment_triangulation.h>

#include <cmath>
#include <iostream>
#include <memory>
#include <type_traits>

namespace {

using Point = pcl::PointXYZ;
using Cloud = pcl::PointCloud<Point>;
using Normals = pcl::PointCloud<pcl::Normal>;

int wrong = 0;

void expect(bool good, const char* what) {
  if (good) return;
  std::cerr << "not as promised: " << what << "\n";
  ++wrong;
}

// A cube of side 1 with 17 x 17 points on each face.
Cloud::Ptr cube() {
  Cloud::Ptr cloud(new Cloud);
  for (int face = 0; face < 6; ++face) {
    for (int i = 0; i < 17; ++i) {
      for (int j = 0; j < 17; ++j) {
        float v[3];
        v[face / 2] = static_cast<float>(face % 2);
        v[(face / 2 + 1) % 3] = (static_cast<float>(i) + 0.5F) / 17.F;
        v[(face / 2 + 2) % 3] = (static_cast<float>(j) + 0.5F) / 17.F;
        cloud->push_back(Point(v[0], v[1], v[2]));
      }
    }
  }
  return cloud;
}

std::shared_ptr<segorient::Neighborhoods> search(const Cloud::Ptr& cloud) {
  segorient::search::MedianHash<Point>::Ptr tree(new segorient::search::MedianHash<Point>);
  static_assert(
      std::is_base_of_v<pcl::search::KdTree<Point>, segorient::search::MedianHash<Point>>);
  tree->setEpsilon(0.F);
  tree->setRegionSize(512);
  tree->setNumberOfThreads(2);
  expect(
      tree->getEpsilon() == 0.F && tree->getRegionSize() == 512 && tree->getNumberOfThreads() == 2,
      "getters of MedianHash");
  tree->setInputCloud(cloud);
  auto table = std::make_shared<segorient::Neighborhoods>();
  tree->nearestKSearchAll(13, *table);
  expect(table->size() == cloud->size() && table->k() == 13, "size of the table");
  for (std::size_t i = 0; i < table->size(); ++i) {
    expect(table->count(i) == 13 && table->indices(i)[0] == static_cast<pcl::index_t>(i) &&
               table->sqrDistances(i)[0] == 0.F,
           "rows begin with the point itself");
  }
  return table;
}

template <typename Estimation>
Normals::Ptr estimate(const Cloud::Ptr& cloud, const char* what) {
  typename Estimation::Ptr estimation(new Estimation);
  estimation->setNumberOfThreads(2);
  estimation->setInputCloud(cloud);
  estimation->setSearchMethod(
      segorient::search::MedianHash<Point>::Ptr(new segorient::search::MedianHash<Point>));
  estimation->setKSearch(13);
  expect(estimation->getKSearch() == 13 && estimation->getNumberOfThreads() == 2, what);
  pcl::NormalEstimation<Point, pcl::Normal>& base = *estimation;  // goes wherever PCL's goes
  Normals::Ptr normals(new Normals);
  base.compute(*normals);
  expect(normals->size() == cloud->size() && normals->is_dense, what);
  return normals;
}

void segmentAndOrient(const Cloud::Ptr& cloud, const Normals::Ptr& normals) {
  using Segmentation = segorient::NormalSegmentation<Point, pcl::Normal>;
  Segmentation::Ptr segmentation(new Segmentation);
  segmentation->setInputCloud(cloud);
  segmentation->setInputNormals(normals);
  segmentation->setSmoothnessThreshold(0.3F);
  segmentation->setNumberOfNeighbours(12);
  expect(
      segmentation->getSmoothnessThreshold() == 0.3F && segmentation->getNumberOfNeighbours() == 12,
      "getters of NormalSegmentation");
  std::vector<pcl::PointIndices> clusters;
  segmentation->extract(clusters);
  expect(clusters.size() == 6, "a cube has six faces");
  expect(segmentation->getLabels().size() == cloud->size(), "labels of NormalSegmentation");
  expect(segmentation->getSegments().size() == 6, "segments of NormalSegmentation");
  expect(segmentation->getConfidences().size() == cloud->size(), "confidences");

  std::vector<std::uint8_t> regular;
  for (const segorient::Segment& s : segmentation->getPlanarSegmentation().segments) {
    regular.push_back(s.kind == segorient::SegmentKind::REGULAR ? 1 : 0);
  }
  segorient::NormalRecomputation<Point, pcl::Normal> recomputation;
  recomputation.setInputCloud(cloud);
  recomputation.setInputNormals(normals);
  recomputation.setLabels(segmentation->getPlanarSegmentation().labels, regular);
  Normals sharper;
  recomputation.compute(sharper);
  expect(sharper.size() == cloud->size(), "normals of NormalRecomputation");

  using Orientation = segorient::SegmentOrientation<Point, pcl::Normal>;
  for (const Orientation::Method method :
       {Orientation::AUTO, Orientation::PROPAGATION, Orientation::BOUNDARY, Orientation::COMBINED,
        Orientation::EXTREMAL, Orientation::HOPPE}) {
    Orientation::Ptr orientation(new Orientation);
    orientation->setInputCloud(cloud);
    orientation->setInputNormals(normals);
    orientation->setSegmentation(
        std::make_shared<const segorient::Segmentation>(segmentation->getPlanarSegmentation()));
    orientation->setMethod(method);
    expect(orientation->getMethod() == method, "method of SegmentOrientation");
    Normals oriented;
    orientation->compute(oriented);
    expect(oriented.size() == cloud->size(), "normals of SegmentOrientation");
  }
}

}  // namespace

int main() {
  const Cloud::Ptr cloud = cube();
  const auto table = search(cloud);
  const Normals::Ptr normals =
      estimate<segorient::PlaneNormalEstimation<Point, pcl::Normal>>(cloud, "Plane");
  estimate<segorient::LCTNormalEstimation<Point, pcl::Normal>>(cloud, "LCT");
  estimate<segorient::LDTNormalEstimation<Point, pcl::Normal>>(cloud, "LDT");
  estimate<segorient::AwASNormalEstimation<Point, pcl::Normal>>(cloud, "AwAS");
  segmentAndOrient(cloud, normals);

  using Estimation = segorient::OrientedNormalEstimation<Point, pcl::PointNormal>;
  static_assert(std::is_base_of_v<pcl::NormalEstimation<Point, pcl::PointNormal>, Estimation>);
  Estimation::Ptr estimation(new Estimation);
  estimation->setInputCloud(cloud);
  pcl::PointCloud<pcl::PointNormal>::Ptr oriented(new pcl::PointCloud<pcl::PointNormal>);
  estimation->compute(*oriented);
  expect(oriented->size() == cloud->size(), "normals of OrientedNormalEstimation");
  expect(estimation->getLabels().size() == cloud->size() && !estimation->getSegments().empty() &&
             estimation->getConfidences().size() == cloud->size(),
         "labels, segments and confidences of OrientedNormalEstimation");
  for (std::size_t i = 0; i < oriented->size(); ++i) {
    const pcl::PointNormal& p = (*oriented)[i];
    const bool outward =
        (p.x - 0.5F) * p.normal_x + (p.y - 0.5F) * p.normal_y + (p.z - 0.5F) * p.normal_z > 0.F;
    expect(outward && p.x == (*cloud)[i].x, "outward normals, and x, y, z beside them");
  }

  segorient::SegmentTriangulation<pcl::PointNormal> triangulation;
  triangulation.setInputCloud(oriented);
  pcl::MeshConstruction<pcl::PointNormal>& construction = triangulation;
  pcl::PolygonMesh mesh;
  construction.reconstruct(mesh);
  expect(!mesh.polygons.empty(), "triangles of SegmentTriangulation");
  std::cout << (wrong == 0 ? "every class is as promised\n" : "see above\n");
  return wrong == 0 ? 0 : 1;
}
