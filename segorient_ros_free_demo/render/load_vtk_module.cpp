// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#define BOOST_DLL_USE_STD_FS
#include <boost/dll/runtime_symbol_info.hpp>
#include <boost/dll/shared_library.hpp>
#include <exception>

#include "io/errors.h"
#include "render/vtk/vtk_module.h"

namespace segorient::program {
namespace {

namespace dll = boost::dll;

const VtkModule& load() {
  const dll::fs::path file = dll::shared_library::decorate(dll::program_location().parent_path() /
                                                           SEGORIENT_MODULES / "segorient_vtk");
  try {
    static const dll::shared_library library(file);
    return library.get<const VtkModule&()>(kVtkModuleEntry)();
  } catch (const std::exception& e) {  // from the loader's words, or that the function is not there
    const std::string reason = dll::fs::exists(file) ? e.what() : "there is no such file";
    throw FileError(file.lexically_normal().string(), "needed for pictures: " + reason);
  }
}

}  // namespace

const VtkModule& vtkModule() {
  static const VtkModule& module = load();
  return module;
}

}  // namespace segorient::program
