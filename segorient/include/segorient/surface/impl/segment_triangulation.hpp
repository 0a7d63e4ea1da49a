// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <pcl/console/print.h>
#include <pcl/conversions.h>
#include <segorient/common/export.h>
#include <segorient/surface/segment_triangulation.h>
#include <segorient/common/impl/cloud_access.hpp>
#include <segorient/surface/impl/cloud_triangulation.hpp>

#include <array>
#include <unordered_map>

namespace segorient {

template <typename PointNT>
bool SegmentTriangulation<PointNT>::usable(const char* what) const {
  // The base class reads the cloud's header before it looks whether there is a cloud.
  if (input_ && !input_->empty()) return true;
  PCL_ERROR("[segorient::SegmentTriangulation::%s] no input cloud\n", what);
  return false;
}

template <typename PointNT>
void SegmentTriangulation<PointNT>::reconstruct(pcl::PolygonMesh& output) {
  output = pcl::PolygonMesh();
  meshes_.clear();
  if (usable("reconstruct")) Base::reconstruct(output);
}

template <typename PointNT>
void SegmentTriangulation<PointNT>::reconstruct(std::vector<pcl::Vertices>& polygons) {
  polygons.clear();
  meshes_.clear();
  if (usable("reconstruct")) Base::reconstruct(polygons);
}

template <typename PointNT>
void SegmentTriangulation<PointNT>::performReconstruction(pcl::PolygonMesh& output) {
  performReconstruction(output.polygons);
}

template <typename PointNT>
void SegmentTriangulation<PointNT>::performReconstruction(std::vector<pcl::Vertices>& polygons) {
  polygons.clear();
  triangulated_ = input_;
  const CloudPoints<PointNT> points(*input_);
  CloudNormals<PointNT> normals;
  if (segmentation_.labels.empty()) normals.assign(*input_);
  const pcl::Indices* indices = fake_indices_ ? nullptr : indices_.get();
  if (!triangulateCloud(points.view(), normals.view(), segmentation_, indices, options_, all_,
                        meshes_)) {
    PCL_ERROR("[segorient::SegmentTriangulation] the segmentation is not of this cloud\n");
    return;
  }
  for (const SegmentMesh& mesh : meshes_) {
    for (const auto& triangle : mesh.triangles) {
      polygons.emplace_back();
      polygons.back().vertices.assign(triangle.begin(), triangle.end());
    }
  }
}

template <typename PointNT>
bool SegmentTriangulation<PointNT>::getSegmentMesh(std::size_t segment,
                                                   pcl::PolygonMesh& output) const {
  output = pcl::PolygonMesh();
  if (segment >= meshes_.size() || meshes_[segment].triangles.empty()) return false;
  pcl::PointCloud<PointNT> cloud;
  cloud.header = triangulated_->header;
  std::unordered_map<pcl::index_t, pcl::index_t> row;
  for (const auto& triangle : meshes_[segment].triangles) {
    output.polygons.emplace_back();
    for (const pcl::index_t p : triangle) {
      const auto [it, is_new] = row.try_emplace(p, static_cast<pcl::index_t>(cloud.size()));
      if (is_new) cloud.push_back(triangulated_->at(static_cast<std::size_t>(p)));
      output.polygons.back().vertices.push_back(static_cast<pcl::index_t>(it->second));
    }
  }
  pcl::toPCLPointCloud2(cloud, output.cloud);
  output.header = triangulated_->header;
  return true;
}

}  // namespace segorient

#define PCL_INSTANTIATE_SegmentTriangulation(T) \
  template class SEGORIENT_SURFACE_EXPORT segorient::SegmentTriangulation<T>;
