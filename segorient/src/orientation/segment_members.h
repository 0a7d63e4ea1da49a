// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/segmentation/segmentation.h>

namespace segorient {

/// Fills in members, and each segment's place and size among them, from the labels.
void collectMembers(Segmentation& segmentation);

}  // namespace segorient
