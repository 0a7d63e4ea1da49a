// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
//
// Found before PCL's own, whose index size cannot be set from outside.
#pragma once

#include_next <pcl/pcl_config.h>

#undef PCL_INDEX_SIZE
#define PCL_INDEX_SIZE 64
