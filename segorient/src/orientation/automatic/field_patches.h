// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/export.h>

#include <cstdint>
#include <vector>

#include "orientation/automatic/even_cells.h"
#include "orientation/winding/field_solver.h"

namespace segorient::detail {

/// Whether a patch of cells may be the wrong way: the means of the winding number are below 0 or
/// above 1 at as many cells as such a mean is of. Turning over one side of a thin part does that to
/// the other side; noise takes them to neither.
/// \param lack see FieldSolver::lackOf()
SEGORIENT_ORIENTATION_EXPORT bool contradictsField(const std::vector<float>& lack);

/// Gives those patches of cells the normals of another solution that have the opposite sign there,
/// if that makes the field clearly better: each patch as a whole, the largest first, if the sum of
/// squares of what the field lacks is less by a fourth of the patch's area and more. That is what
/// as many places cost which w says to be inside or outside, and not on the surface.
///
/// One solution that has all signs by the field alone is a worse one, as it loses fine parts, and
/// the least sum is not the truth; so much less of it is.
///
/// \param factor of FieldSolver::fit() \param lack of FieldSolver::lackOf(), both of `normals`
/// \param normals 4 floats a cell, evidence that may change
/// \param other of another solution
/// \return one a cell: whether it has another normal now; empty where none has
SEGORIENT_ORIENTATION_EXPORT std::vector<std::uint8_t> takeBetterPatches(
    const FieldSolver& solver, const EvenCells& cells, float factor, std::vector<float> lack,
    const std::vector<float>& other, std::vector<float>& normals);

}  // namespace segorient::detail
