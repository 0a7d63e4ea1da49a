// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <dlfcn.h>

#include "render/vtk/parts.h"

namespace segorient::program::vtk {

// VTK brings Xlib along, whose headers need not be installed to build this. Where VTK draws
// otherwise, there is no Xlib and no screen of its kind to ask for.
bool hasScreen() {
  using Open = void* (*)(const char*);
  using Close = int (*)(void*);
  const auto open = reinterpret_cast<Open>(dlsym(RTLD_DEFAULT, "XOpenDisplay"));
  const auto close = reinterpret_cast<Close>(dlsym(RTLD_DEFAULT, "XCloseDisplay"));
  if (open == nullptr || close == nullptr) return true;
  void* const screen = open(nullptr);
  if (screen != nullptr) close(screen);
  return screen != nullptr;
}

}  // namespace segorient::program::vtk
