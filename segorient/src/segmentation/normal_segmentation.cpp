// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <pcl/point_types.h>
#include <pcl/impl/instantiate.hpp>
#include <segorient/segmentation/impl/normal_segmentation.hpp>

// The types that clouds and normals come in; others need PCL_NO_PRECOMPILE.
#define SEGORIENT_CLOUD_TYPES                                                           \
  (pcl::PointXYZ)(pcl::PointXYZI)(pcl::PointXYZL)(pcl::PointXYZRGB)(pcl::PointXYZRGBA)( \
      pcl::PointXYZRGBL)(pcl::PointNormal)(pcl::PointXYZRGBNormal)
#define SEGORIENT_NORMAL_TYPES (pcl::Normal)(pcl::PointNormal)(pcl::PointXYZRGBNormal)

PCL_INSTANTIATE_PRODUCT(NormalSegmentation, (SEGORIENT_CLOUD_TYPES)(SEGORIENT_NORMAL_TYPES))
