// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/features/awas_normal_estimation.h>
#include <segorient/features/lct_normal_estimation.h>
#include <segorient/features/ldt_normal_estimation.h>
#include <segorient/features/normal_recomputation.h>
#include <segorient/features/plane_normal_estimation.h>
#include <segorient/orientation/oriented_normal_estimation.h>
#include <segorient/orientation/segment_orientation.h>
#include <segorient/search/median_hash.h>
#include <segorient/segmentation/normal_segmentation.h>

#include <memory>
#include <string>
#include <vector>

#include "class_clouds.h"

namespace segorient::test {

/// What a class says of the points of a cloud, by row.
struct ClassResult {
  std::string name;
  bool oriented = false;                 ///< else the sign of a normal means nothing
  pcl::PointCloud<pcl::Normal> normals;  ///< empty if the class has none
  std::vector<std::int32_t> labels;      ///< empty if the class has none
};

using XyzCloud = pcl::PointCloud<pcl::PointXYZ>;
using NormalCloud = pcl::PointCloud<pcl::Normal>;

/// A cube beside a sphere: edges, a round face, two components.
inline XyzCloud shapes(std::size_t n = 1500) {
  XyzCloud out = *toPcl(sample("sphere", {sphere({0, 0, 0}, 1)}, n, 3));
  const XyzCloud::Ptr beside = toPcl(sample("cube", cube(), n, 4));
  for (pcl::PointXYZ& p : *beside) p.x += 5.F;
  out += *beside;
  return out;
}

inline float dotOf(const pcl::Normal& a, const pcl::Normal& b) {
  return a.normal_x * b.normal_x + a.normal_y * b.normal_y + a.normal_z * b.normal_z;
}

inline bool isSame(const pcl::Normal& a, const pcl::Normal& b) {
  return a.normal_x == b.normal_x && a.normal_y == b.normal_y && a.normal_z == b.normal_z;
}

template <typename EstimationT>
ClassResult runEstimation(const std::string& name, const XyzCloud::Ptr& cloud) {
  ClassResult out{name, false, {}, {}};
  EstimationT estimation;
  estimation.setInputCloud(cloud);
  estimation.setKSearch(13);
  estimation.compute(out.normals);
  return out;
}

inline ClassResult runMethod(OrientationMethod method, const XyzCloud::Ptr& cloud) {
  ClassResult out{std::string("OrientedNormalEstimation, ") + toString(method), true, {}, {}};
  OrientedNormalEstimation<pcl::PointXYZ, pcl::Normal> estimation;
  estimation.setMethod(method);
  estimation.setInputCloud(cloud);
  estimation.compute(out.normals);
  out.labels = estimation.getLabels();
  return out;
}

inline ClassResult runSegmentation(const std::string& name, const XyzCloud::Ptr& cloud,
                                   const NormalCloud& normals,
                                   const std::shared_ptr<const Neighborhoods>& table,
                                   Segmentation* segmentation = nullptr) {
  ClassResult out{name, false, {}, {}};
  NormalSegmentation<pcl::PointXYZ, pcl::Normal> segmenter;
  segmenter.setInputCloud(cloud);
  segmenter.setInputNormals(normals.makeShared());
  segmenter.setNeighborhoods(table);
  std::vector<pcl::PointIndices> faces;
  segmenter.extract(faces);
  out.labels = segmenter.getLabels();
  if (segmentation != nullptr) *segmentation = segmenter.getPlanarSegmentation();
  return out;
}

inline ClassResult runRecomputation(const XyzCloud::Ptr& cloud, const NormalCloud& normals,
                                    const Segmentation& segmentation) {
  ClassResult out{"NormalRecomputation", false, {}, {}};
  std::vector<std::uint8_t> regular;
  for (const Segment& s : segmentation.segments) regular.push_back(s.kind == SegmentKind::REGULAR);
  NormalRecomputation<pcl::PointXYZ, pcl::Normal> recomputation;
  recomputation.setInputCloud(cloud);
  recomputation.setInputNormals(normals.makeShared());
  recomputation.setLabels(segmentation.labels, regular);
  recomputation.compute(out.normals);
  return out;
}

/// Every class that says something of points, with its defaults.
inline std::vector<ClassResult> runEveryClass(const XyzCloud::Ptr& cloud) {
  std::vector<ClassResult> out;
  for (const OrientationMethod method :
       {OrientationMethod::AUTO, OrientationMethod::PROPAGATION, OrientationMethod::BOUNDARY,
        OrientationMethod::COMBINED, OrientationMethod::EXTREMAL, OrientationMethod::HOPPE}) {
    out.push_back(runMethod(method, cloud));
  }
  using pcl::Normal;
  using pcl::PointXYZ;
  out.push_back(runEstimation<PlaneNormalEstimation<PointXYZ, Normal>>("plane", cloud));
  const NormalCloud normals = out.back().normals;
  out.push_back(runEstimation<LCTNormalEstimation<PointXYZ, Normal>>("lct", cloud));
  out.push_back(runEstimation<LDTNormalEstimation<PointXYZ, Normal>>("ldt", cloud));
  out.push_back(runEstimation<AwASNormalEstimation<PointXYZ, Normal>>("awas", cloud));
  Segmentation segmentation;
  out.push_back(runSegmentation("NormalSegmentation", cloud, normals, nullptr, &segmentation));
  out.push_back(runRecomputation(cloud, normals, segmentation));
  ClassResult oriented{"SegmentOrientation", true, {}, {}};
  SegmentOrientation<PointXYZ, Normal> orientation;
  orientation.setInputCloud(cloud);
  orientation.setInputNormals(normals.makeShared());
  orientation.compute(oriented.normals);
  out.push_back(oriented);
  return out;
}

}  // namespace segorient::test
