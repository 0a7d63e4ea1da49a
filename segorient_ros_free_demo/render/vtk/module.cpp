// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <boost/config.hpp>

#include "render/vtk/parts.h"

// Found by its name, see kVtkModuleEntry.
extern "C" BOOST_SYMBOL_EXPORT const segorient::program::VtkModule& segorientVtkModule();

const segorient::program::VtkModule& segorientVtkModule() {
  namespace vtk = segorient::program::vtk;
  static const segorient::program::VtkModule module{vtk::textLine, vtk::png, vtk::hasScreen,
                                                    vtk::show, vtk::poisson};
  return module;
}
