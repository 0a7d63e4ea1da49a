// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include "io/cloud_writer.h"
#include "io/las_layout.h"

namespace segorient::program {

/// A LAS file that is written block by block, after all of them were summed up.
class LasWriter {
 public:
  /// Writes what stands before the points; warns of those that are left out.
  /// \param block any part of the cloud
  LasWriter(const OutputCloud& block, const LasSummary& summary, OutputFile& file);
  void add(const OutputCloud& block);
  /// Writes what stands behind the points.
  void end();

 private:
  LasLayout layout_;
  OutputFile& file_;
};

}  // namespace segorient::program
