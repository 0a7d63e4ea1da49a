// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
//
// The kernels for one instruction set, after what takes the nearest out of a block.

#include "kernels_sort.inl"

#include "kernels_groups.inl"

#include "kernels_all_points.inl"

constexpr Kernels kKernels{kName,          collect,     collectRegion,   gatherAround,
                           nearestInBlock, sortNearest, nearestInRegion, withinInRegion};
