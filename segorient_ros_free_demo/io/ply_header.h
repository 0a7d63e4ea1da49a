// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "io/input_file.h"

namespace segorient::program {

/// As fields have it: F, I or U, and bytes.
struct PlyType {
  char type = 'F';
  std::uint32_t size = 4;
};

struct PlyProperty {
  std::string name;
  PlyType value;
  bool is_list = false;
  PlyType length;  ///< of a list's number of entries
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;

  bool hasLists() const {
    return std::any_of(properties.begin(), properties.end(),
                       [](const PlyProperty& p) { return p.is_list; });
  }
  /// Bytes that a row takes at least.
  std::uint64_t leastBytes(bool ascii) const {
    std::uint64_t bytes = 0;
    for (const PlyProperty& p : properties)
      bytes += ascii ? 2 : (p.is_list ? p.length : p.value).size;
    return bytes;
  }
};

struct PlyHeader {
  bool ascii = false;
  bool swap = false;
  std::vector<PlyElement> elements;
};

/// Everything up to end_header.
PlyHeader readPlyHeader(InputFile& file);

}  // namespace segorient::program
