// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include "io/cloud_table.h"
#include "io/input_file.h"

#include <segorient/orientation/trajectory.h>

#include <string>

namespace segorient::program {

// Readers of our own: PCL's crash on empty files and wrong counts, lose doubles in OBJ and text
// files, and load a file without coordinates as if it had some. All of these throw FileError on
// anything that is not whole, and never allocate more than the file's size can account for. Fields
// are named by pclName().

/// PCD: ascii, binary, binary_compressed.
CloudTable readPcd(InputFile& file);
/// PLY: ascii, binary of both byte orders; elements other than vertex and face are skipped. red,
/// green, blue become rgb.
CloudTable readPly(InputFile& file);
/// OBJ: the vertices.
CloudTable readObj(InputFile& file);
/// Text: a point a line, x y z first; a line of column names and comments (#, //) may come before.
CloudTable readText(InputFile& file);

/// PTX: one or more scans, each with its grid and pose; the points in the coordinates that the
/// poses lead to, with intensity, colours where there are some, `vp_x vp_y vp_z` (the scanner's
/// place) and, where there are several scans, `scan` (0, 1, ...). What a scanner did not see is 0 0
/// 0 in the file: NaN in a single scan, which stays a grid (width: along a column of the scan, as
/// the file has it); left out where there are several, as no cloud holds two grids.
CloudTable readPtx(InputFile& file);
/// PTS: number of points, then x y z, intensity and colours; several scans one after another get a
/// field `scan`. Without that number, it is text as readText() takes it.
CloudTable readPts(InputFile& file);
/// LAS 1.0 to 1.4, point formats 0 to 10: coordinates in double, and all that a point has but for
/// its waveform. LAZ: throws, and names programs that unpack it.
CloudTable readLas(InputFile& file);
/// A trajectory: text, time x y z a line (what follows is not used), comments (#, //, %); a line of
/// column names may come before.
Trajectory readTrajectory(const std::string& path);

/// A cloud by the file's ending (.pcd, .ply, .las, .obj, .ptx, .pts, .xyz, .txt, .asc, .csv),
/// checked to have coordinates; whole numbers among them become floating point ones. Says on
/// standard error what of the file is left out.
CloudTable readCloud(const std::string& path);

/// The same, and at least one point has finite coordinates.
CloudTable readUsableCloud(const std::string& path);

/// Bounds the memory that `size` rows of the table may take by what the file holds: throws if its
/// remaining bytes cannot hold that many rows of at least `least_bytes`. Then allocates the rows.
void allocateRows(const InputFile& file, CloudTable& table, std::uint64_t size,
                  std::uint64_t least_bytes);

}  // namespace segorient::program
