// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <algorithm>

#include "io/cloud_writer.h"

namespace segorient::program {

OutputCloud::OutputCloud(const CloudTable& table)
    : size(table.size),
      width(table.width),
      height(table.height),
      viewpoint(table.viewpoint),
      las(table.las) {
  for (const Field* f : table.xyz()) add(table, *f);
}

void OutputCloud::add(const CloudTable& table, const Field& field) {
  columns.push_back({field, table.rows.data() + field.offset, table.row_bytes});
}

void OutputCloud::add(const std::string& name, const float* values, std::size_t stride) {
  columns.push_back(
      {{name, 'F', 4, 1, 0}, reinterpret_cast<const std::uint8_t*>(values), 4 * stride});
}

void OutputCloud::add(const std::string& name, const std::uint32_t* values) {
  columns.push_back({{name, 'U', 4, 1, 0}, reinterpret_cast<const std::uint8_t*>(values), 4});
}

void OutputCloud::add(const std::string& name, const std::uint8_t* values) {
  columns.push_back({{name, 'U', 1, 1, 0}, values, 1});
}

const Column* OutputCloud::find(const std::string& name) const {
  const auto it = std::find_if(columns.begin(), columns.end(),
                               [&](const Column& c) { return c.field.name == name; });
  return it == columns.end() ? nullptr : &*it;
}

void OutputCloud::addRest(const CloudTable& table, const std::vector<std::string>& dropped) {
  for (const Field& f : table.fields) {
    const bool drop = std::find(dropped.begin(), dropped.end(), f.name) != dropped.end();
    if (!drop && !has(f.name)) add(table, f);
  }
}

}  // namespace segorient::program
