// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

// What a shared library of ours shows to others; all else in it is hidden. One macro a library,
// since on Windows a name is exported by the library that has it and imported by all others. CMake
// defines segorient_NAME_EXPORTS where library NAME itself is compiled, and SEGORIENT_STATIC where
// libraries are static.
//
// Headers below src/ use the macros for what other libraries of ours, the program or the Python
// package call: that is shown as well, but nothing that users may build on.

#if defined(SEGORIENT_STATIC)
#define SEGORIENT_SHOWN
#define SEGORIENT_TAKEN
#elif defined(_WIN32)
#define SEGORIENT_SHOWN __declspec(dllexport)
#define SEGORIENT_TAKEN __declspec(dllimport)
#else
#define SEGORIENT_SHOWN __attribute__((visibility("default")))
#define SEGORIENT_TAKEN SEGORIENT_SHOWN
#endif

#if defined(segorient_search_EXPORTS)
#define SEGORIENT_SEARCH_EXPORT SEGORIENT_SHOWN
#else
#define SEGORIENT_SEARCH_EXPORT SEGORIENT_TAKEN
#endif

#if defined(segorient_features_EXPORTS)
#define SEGORIENT_FEATURES_EXPORT SEGORIENT_SHOWN
#else
#define SEGORIENT_FEATURES_EXPORT SEGORIENT_TAKEN
#endif

#if defined(segorient_segmentation_EXPORTS)
#define SEGORIENT_SEGMENTATION_EXPORT SEGORIENT_SHOWN
#else
#define SEGORIENT_SEGMENTATION_EXPORT SEGORIENT_TAKEN
#endif

#if defined(segorient_surface_EXPORTS)
#define SEGORIENT_SURFACE_EXPORT SEGORIENT_SHOWN
#else
#define SEGORIENT_SURFACE_EXPORT SEGORIENT_TAKEN
#endif

#if defined(segorient_orientation_EXPORTS)
#define SEGORIENT_ORIENTATION_EXPORT SEGORIENT_SHOWN
#else
#define SEGORIENT_ORIENTATION_EXPORT SEGORIENT_TAKEN
#endif

#if defined(segorient_tiles_EXPORTS)
#define SEGORIENT_TILES_EXPORT SEGORIENT_SHOWN
#else
#define SEGORIENT_TILES_EXPORT SEGORIENT_TAKEN
#endif

// Around code that may use names that are deprecated: copies of what still has them.
#if defined(__GNUC__) || defined(__clang__)
#define SEGORIENT_DEPRECATED_BEGIN \
  _Pragma("GCC diagnostic push") _Pragma("GCC diagnostic ignored \"-Wdeprecated-declarations\"")
#define SEGORIENT_DEPRECATED_END _Pragma("GCC diagnostic pop")
#elif defined(_MSC_VER)
#define SEGORIENT_DEPRECATED_BEGIN __pragma(warning(push)) __pragma(warning(disable : 4996))
#define SEGORIENT_DEPRECATED_END __pragma(warning(pop))
#else
#define SEGORIENT_DEPRECATED_BEGIN
#define SEGORIENT_DEPRECATED_END
#endif
