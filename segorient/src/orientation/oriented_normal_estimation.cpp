// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <segorient/orientation/impl/oriented_normal_estimation.hpp>

#include "common/input_types.h"

PCL_INSTANTIATE_PRODUCT(OrientedNormalEstimation, (SEGORIENT_INPUT_TYPES)(PCL_NORMAL_POINT_TYPES))
