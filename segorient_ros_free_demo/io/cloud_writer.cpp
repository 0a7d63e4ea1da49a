// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "io/cloud_writer.h"

#include <algorithm>
#include <cstring>
#include <sstream>

#include "io/file_endings.h"
#include "io/las_writer.h"

namespace segorient::program {
namespace {

constexpr std::size_t kRowsAtOnce = 4096;

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

// Writes rows in blocks; `makeRow (row, to)` fills row_bytes bytes.
template <typename MakeRow>
void writeRows(std::size_t size, std::size_t row_bytes, OutputFile& file, const MakeRow& make_row) {
  std::vector<std::uint8_t> block(kRowsAtOnce * row_bytes);
  for (std::size_t first = 0; first < size; first += kRowsAtOnce) {
    const std::size_t count = std::min(kRowsAtOnce, size - first);
    for (std::size_t i = 0; i < count; ++i) make_row(first + i, block.data() + i * row_bytes);
    file.write(block.data(), count * row_bytes);
  }
}

// Legacy VTK files hold their numbers the big end first.
template <typename T>
std::uint8_t* putBigEndian(T value, std::uint8_t* to) {
  std::memcpy(to, &value, sizeof(T));
  std::reverse(to, to + sizeof(T));
  return to + sizeof(T);
}

}  // namespace

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

namespace {

void writePcdHeader(const OutputCloud& cloud, OutputFile& file) {
  std::ostringstream header;
  header.precision(17);
  header << "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS";
  for (const Column& c : cloud.columns) header << ' ' << c.field.name;
  header << "\nSIZE";
  for (const Column& c : cloud.columns) header << ' ' << c.field.size;
  header << "\nTYPE";
  for (const Column& c : cloud.columns) header << ' ' << c.field.type;
  header << "\nCOUNT";
  for (const Column& c : cloud.columns) header << ' ' << c.field.count;
  header << "\nWIDTH " << cloud.width << "\nHEIGHT " << cloud.height << "\nVIEWPOINT";
  for (const double v : cloud.viewpoint) header << ' ' << v;
  header << "\nPOINTS " << cloud.size << "\nDATA binary\n";
  file.write(header.str());
}

void writePcdRows(const OutputCloud& cloud, OutputFile& file) {
  std::size_t row_bytes = 0;
  for (const Column& c : cloud.columns) row_bytes += c.field.bytes();
  writeRows(cloud.size, row_bytes, file, [&](std::size_t row, std::uint8_t* to) {
    for (const Column& c : cloud.columns) {
      std::memcpy(to, c.data + row * c.stride, c.field.bytes());
      to += c.field.bytes();
    }
  });
}

std::size_t bytesOf(const PlyProperty& p) {
  return p.kind == PlyProperty::Kind::ToDouble ? sizeof(double) : p.bytes;
}

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

void writePlyRows(const OutputCloud& cloud, OutputFile& file) {
  const std::vector<PlyProperty> properties = plyProperties(cloud);
  std::size_t row_bytes = 0;
  for (const PlyProperty& p : properties) row_bytes += bytesOf(p);
  writeRows(cloud.size, row_bytes, file, [&](std::size_t row, std::uint8_t* to) {
    for (const PlyProperty& p : properties) {
      makeValue(p, p.column->data + row * p.column->stride + p.offset, to);
      to += bytesOf(p);
    }
  });
}

}  // namespace

void writePcd(const OutputCloud& cloud, OutputFile& file) {
  writePcdHeader(cloud, file);
  writePcdRows(cloud, file);
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

namespace {

// Where the sensor was as columns of one value for all points, in the type of the coordinates.
class ConstantViewpoint {
 public:
  explicit ConstantViewpoint(const OutputCloud& cloud) : wide_(cloud.viewpoint) {
    for (std::size_t a = 0; a < 3; ++a) single_[a] = static_cast<float>(wide_[a]);
  }
  OutputCloud addedTo(OutputCloud cloud) const {
    const bool known = wide_[0] != 0.0 || wide_[1] != 0.0 || wide_[2] != 0.0;
    if (!known || cloud.has("vp_x") || cloud.has("vp_y") || cloud.has("vp_z")) return cloud;
    const std::uint32_t size = cloud.find("x")->field.size;
    const char* const names[] = {"vp_x", "vp_y", "vp_z"};
    for (std::size_t a = 0; a < 3; ++a) {
      const void* value = size == 8 ? static_cast<const void*>(&wide_[a]) : &single_[a];
      cloud.columns.push_back(
          {{names[a], 'F', size, 1, 0}, static_cast<const std::uint8_t*>(value), 0});
    }
    return cloud;
  }

 private:
  std::array<double, 7> wide_;
  std::array<float, 3> single_{};
};

}  // namespace

void writeCloud(const OutputCloud& cloud, OutputFile& file) {
  const std::string ending = fileEnding(file.path());
  if (ending == ".ply") return writePly(ConstantViewpoint(cloud).addedTo(cloud), file);
  if (ending == ".las") return writeLas(ConstantViewpoint(cloud).addedTo(cloud), file);
  if (ending == ".vtk") return writeVtk(cloud, file);
  writePcd(cloud, file);
}

CloudWriter::CloudWriter(OutputFile& file, const Bounds& bulk)
    : file_(file), kind_(Kind::PCD), summary_(bulk) {
  const std::string ending = fileEnding(file.path());
  if (ending == ".ply") kind_ = Kind::PLY;
  if (ending == ".las") kind_ = Kind::LAS;
}

CloudWriter::~CloudWriter() = default;

void CloudWriter::sumUp(const OutputCloud& block) {
  summary_.add(block);
}

void CloudWriter::begin(const OutputCloud& block, std::uint64_t size) {
  begun_ = true;
  OutputCloud all = block;
  all.size = all.width = static_cast<std::size_t>(size);
  if (kind_ == Kind::PLY) writePlyHeader(all, file_);
  if (kind_ == Kind::PCD) writePcdHeader(all, file_);
  if (kind_ == Kind::LAS) las_ = std::make_unique<LasWriter>(block, summary_, file_);
}

void CloudWriter::add(const OutputCloud& block, std::uint64_t size) {
  const ConstantViewpoint viewpoint(block);
  const OutputCloud cloud = kind_ == Kind::PCD ? block : viewpoint.addedTo(block);
  if (!begun_) begin(cloud, size);
  if (kind_ == Kind::PLY) writePlyRows(cloud, file_);
  if (kind_ == Kind::PCD) writePcdRows(cloud, file_);
  if (kind_ == Kind::LAS) las_->add(cloud);
}

void CloudWriter::end() {
  if (las_) las_->end();
}

}  // namespace segorient::program
