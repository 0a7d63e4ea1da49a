// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <pcl/point_types.h>
#include <pcl/impl/instantiate.hpp>
#include <segorient/features/impl/normal_recomputation.hpp>

// The usual types; others are instantiated where they are used, with PCL_NO_PRECOMPILE.
#define SEGORIENT_INPUT_TYPES                                                           \
  (pcl::PointXYZ)(pcl::PointXYZI)(pcl::PointXYZL)(pcl::PointXYZRGB)(pcl::PointXYZRGBA)( \
      pcl::PointNormal)(pcl::PointXYZRGBNormal)(pcl::PointXYZINormal)

PCL_INSTANTIATE_PRODUCT(NormalRecomputation, (SEGORIENT_INPUT_TYPES)(PCL_NORMAL_POINT_TYPES))
