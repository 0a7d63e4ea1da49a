// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <pcl/PCLPointCloud2.h>

#include <string>
#include <vector>

#include "scratch_directory.h"

namespace segorient::test {

/// A small file of every kind that the program reads, all written by PCL where PCL can.
struct SampleFile {
  std::string name;   ///< file name
  bool text = false;  ///< a cut in the last number cannot be told from a shorter number
};

/// The cloud that the files hold: `size` points with fields x, y, z, intensity, and for PCD a ring
/// of 16 bits.
pcl::PCLPointCloud2 sampleCloud(std::size_t size);

/// Writes one file of each kind into the directory.
std::vector<SampleFile> writeSampleFiles(const ScratchDirectory& directory, std::size_t size);

}  // namespace segorient::test
