// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <segorient/features/impl/local_normal_estimation.hpp>

#include "common/input_types.h"

PCL_INSTANTIATE_PRODUCT(LocalNormalEstimation, (SEGORIENT_INPUT_TYPES)(PCL_NORMAL_POINT_TYPES))
