// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
//
// The kernels for one instruction set, after what takes the nearest out of a block.

#include "search/kernels_sort.inl"

#include "search/kernels_groups.inl"

#include "search/kernels_all_points.inl"

#include "search/kernels_boxes.inl"

constexpr Kernels kKernels{kName,           collect,        collectRegion,
                           gatherAround,    nearestInBlock, sortNearest,
                           nearestInRegion, withinInRegion, nearestInBoxes};
