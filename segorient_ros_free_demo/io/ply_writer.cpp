// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "io/ply_writer.h"

#include <cstring>

#include "io/row_blocks.h"

namespace segorient::program {
namespace {

// How one property of a PLY row is made.
struct PlyProperty {
  std::string name;
  std::string type;
  const Column* column = nullptr;
  std::size_t offset = 0;  // bytes into the column's value
  std::size_t bytes = 0;
  enum class Kind { Copy, ToDouble, LabelToFloat } kind = Kind::Copy;
};

const char* plyTypeName(const Field& f) {
  if (f.type == 'F') return f.size == 8 ? "double" : "float";
  const bool is_signed = f.type == 'I';
  if (f.size == 1) return is_signed ? "char" : "uchar";
  if (f.size == 2) return is_signed ? "short" : "ushort";
  return is_signed ? "int" : "uint";
}

std::string plyName(const std::string& name) {
  if (name == "normal_x") return "nx";
  if (name == "normal_y") return "ny";
  if (name == "normal_z") return "nz";
  return name;
}

std::vector<PlyProperty> plyProperties(const OutputCloud& cloud) {
  using Kind = PlyProperty::Kind;
  std::vector<PlyProperty> out;
  for (const Column& c : cloud.columns) {
    const Field& f = c.field;
    if (f.name == "rgb" && f.size == 4 && f.count == 1) {
      out.push_back({"red", "uchar", &c, 2, 1, Kind::Copy});
      out.push_back({"green", "uchar", &c, 1, 1, Kind::Copy});
      out.push_back({"blue", "uchar", &c, 0, 1, Kind::Copy});
      continue;
    }
    for (std::uint32_t e = 0; e < f.count; ++e) {
      const std::string suffix = f.count > 1 ? "_" + std::to_string(e) : "";
      const bool wide = f.type != 'F' && f.size == 8;  // PLY has no integers of 64 bits
      out.push_back({plyName(f.name) + suffix, wide ? "double" : plyTypeName(f), &c,
                     std::size_t{e} * f.size, f.size, wide ? Kind::ToDouble : Kind::Copy});
    }
    if (f.name == "label" && f.type == 'U' && f.size == 4 && !cloud.has("scalar_label")) {
      out.push_back({"scalar_label", "float", &c, 0, 4, Kind::LabelToFloat});
    }
  }
  return out;
}

void makeValue(const PlyProperty& p, const std::uint8_t* from, std::uint8_t* to) {
  switch (p.kind) {
    case PlyProperty::Kind::Copy:
      std::memcpy(to, from, p.bytes);
      break;
    case PlyProperty::Kind::ToDouble: {
      const double v = loadNumber(from, p.column->field.type, p.column->field.size);
      std::memcpy(to, &v, sizeof(v));
      break;
    }
    case PlyProperty::Kind::LabelToFloat: {
      std::int32_t label = 0;
      std::memcpy(&label, from, sizeof(label));
      const auto v = static_cast<float>(label);
      std::memcpy(to, &v, sizeof(v));
      break;
    }
  }
}

std::size_t bytesOf(const PlyProperty& p) {
  return p.kind == PlyProperty::Kind::ToDouble ? sizeof(double) : p.bytes;
}

}  // namespace

void writePlyHeader(const OutputCloud& cloud, OutputFile& file) {
  std::string header =
      "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(cloud.size) + "\n";
  for (const PlyProperty& p : plyProperties(cloud)) {
    header += "property " + p.type + " " + p.name + "\n";
  }
  if (cloud.triangles != nullptr) {
    header += "element face " + std::to_string(cloud.triangles->size()) +
              "\nproperty list uchar int vertex_indices\n";
  }
  file.write(header + "end_header\n");
}

void writePlyRows(const OutputCloud& cloud, OutputFile& file, int threads) {
  const std::vector<PlyProperty> properties = plyProperties(cloud);
  std::size_t row_bytes = 0;
  for (const PlyProperty& p : properties) row_bytes += bytesOf(p);
  const auto make_row = [&](std::size_t row, std::uint8_t* to) {
    for (const PlyProperty& p : properties) {
      makeValue(p, p.column->data + row * p.column->stride + p.offset, to);
      to += bytesOf(p);
    }
  };
  writeRows(cloud.size, row_bytes, file, make_row, threads);
}

void writePly(const OutputCloud& cloud, OutputFile& file) {
  writePlyHeader(cloud, file);
  writePlyRows(cloud, file);
  if (cloud.triangles == nullptr) return;
  writeRows(cloud.triangles->size(), 13, file, [&](std::size_t i, std::uint8_t* to) {
    to[0] = 3;
    std::memcpy(to + 1, (*cloud.triangles)[i].data(), 12);
  });
}

}  // namespace segorient::program
