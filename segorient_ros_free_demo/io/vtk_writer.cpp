// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <algorithm>
#include <cstring>

#include "io/cloud_writer.h"
#include "io/row_blocks.h"

namespace segorient::program {
namespace {

// Legacy VTK files hold their numbers the big end first.
template <typename T>
std::uint8_t* putBigEndian(T value, std::uint8_t* to) {
  std::memcpy(to, &value, sizeof(T));
  std::reverse(to, to + sizeof(T));
  return to + sizeof(T);
}

}  // namespace

void writeVtk(const OutputCloud& cloud, OutputFile& file) {
  const std::array<const Column*, 3> xyz{cloud.find("x"), cloud.find("y"), cloud.find("z")};
  const bool wide = xyz[0]->field.size == 8;
  file.write("# vtk DataFile Version 3.0\nsegorient\nBINARY\nDATASET POLYDATA\nPOINTS " +
             std::to_string(cloud.size) + (wide ? " double\n" : " float\n"));
  writeRows(cloud.size, wide ? 24 : 12, file, [&](std::size_t row, std::uint8_t* to) {
    for (const Column* c : xyz) {
      const double v = loadNumber(c->data + row * c->stride, c->field.type, c->field.size);
      to = wide ? putBigEndian(v, to) : putBigEndian(static_cast<float>(v), to);
    }
  });
  const bool mesh = cloud.triangles != nullptr;
  const std::size_t cells = mesh ? cloud.triangles->size() : cloud.size;
  const std::uint32_t corners = mesh ? 3 : 1;
  file.write((mesh ? "\nPOLYGONS " : "\nVERTICES ") + std::to_string(cells) + " " +
             std::to_string(cells * (corners + 1)) + "\n");
  writeRows(cells, std::size_t{4} * (corners + 1), file, [&](std::size_t i, std::uint8_t* to) {
    to = putBigEndian(corners, to);
    for (std::uint32_t c = 0; c < corners; ++c) {
      to = putBigEndian(mesh ? (*cloud.triangles)[i][c] : static_cast<std::uint32_t>(i), to);
    }
  });
  const Column* rgb = cloud.find("rgb");
  if (rgb == nullptr) return;
  file.write("\nPOINT_DATA " + std::to_string(cloud.size) + "\nCOLOR_SCALARS Colors 3\n");
  writeRows(cloud.size, 3, file, [&](std::size_t row, std::uint8_t* to) {
    const std::uint8_t* from = rgb->data + row * rgb->stride;
    for (std::size_t c = 0; c < 3; ++c) to[c] = from[2 - c];
  });
}

}  // namespace segorient::program
