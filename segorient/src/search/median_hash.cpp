// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <pcl/point_types.h>
#include <pcl/impl/instantiate.hpp>
#include <segorient/search/impl/median_hash.hpp>

PCL_INSTANTIATE(MedianHash, PCL_XYZ_POINT_TYPES)
