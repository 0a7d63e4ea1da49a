// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include "io/cloud_writer.h"

namespace segorient::program {

void writePlyHeader(const OutputCloud& cloud, OutputFile& file);
void writePlyRows(const OutputCloud& cloud, OutputFile& file, int threads = 1);

}  // namespace segorient::program
