// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include "io/cloud_table.h"
#include "io/las_summary.h"
#include "io/output_file.h"

#include <array>
#include <memory>
#include <string>
#include <vector>

namespace segorient::program {

/// One column of a cloud to be written: a field, and where its values are. The memory is somebody
/// else's.
struct Column {
  Field field;                         ///< name and type; its offset is not used
  const std::uint8_t* data = nullptr;  ///< first row's value
  std::size_t stride = 0;              ///< bytes from one row to the next
};

/// A number of a column.
inline double numberOf(const Column& c, std::size_t row, std::uint32_t element = 0) {
  return loadNumber(c.data + row * c.stride + std::size_t{element} * c.field.size, c.field.type,
                    c.field.size);
}

/// A cloud to be written: columns, in the order they shall have in the file.
struct OutputCloud {
  std::size_t size = 0;
  std::size_t width = 0;
  std::size_t height = 1;
  std::array<double, 7> viewpoint{0, 0, 0, 1, 0, 0, 0};
  std::vector<Column> columns;
  const std::vector<Triangle>* triangles = nullptr;  ///< of a mesh; not kept in a PCD
  std::shared_ptr<const LasOrigin> las;              ///< of the table, for LAS

  /// As many points as `table`, and its fields x, y, z.
  explicit OutputCloud(const CloudTable& table);
  /// Appends the fields of `table` that are not there yet and not among `dropped`.
  void addRest(const CloudTable& table, const std::vector<std::string>& dropped = {});
  /// Appends a field of `table`.
  void add(const CloudTable& table, const Field& field);
  /// Appends a column of one float, unsigned int or byte a point; `stride` in values.
  void add(const std::string& name, const float* values, std::size_t stride);
  void add(const std::string& name, const std::uint32_t* values);
  void add(const std::string& name, const std::uint8_t* values);
  bool has(const std::string& name) const { return find(name) != nullptr; }
  const Column* find(const std::string& name) const;
};

/// Binary PCD, fields as they are.
void writePcd(const OutputCloud& cloud, OutputFile& file);
/// Binary PLY, with faces if there are triangles: normals as nx ny nz, colours as red green blue.
/// `label` is written a second time as `scalar_label`, the only kind of name that CloudCompare
/// takes; no label is 4294967295 and -1.
void writePly(const OutputCloud& cloud, OutputFile& file);

/// Binary legacy VTK poly data: points, triangles (points as vertices where there are none),
/// colours.
void writeVtk(const OutputCloud& cloud, OutputFile& file);

/// LAS: as the input's if that was one (version, records about the coordinate system, scale and
/// offset), else 1.2 with the finest steps that hold the cloud, or 1.4 where what it has asks for
/// it. Fields that LAS knows are those; all others, the normals first, become extra bytes, with the
/// record that describes them. Points without finite coordinates are left out, with a
/// warning, and strays so far away that integers could not tell the others apart.
void writeLas(const OutputCloud& cloud, OutputFile& file);

/// By the file's ending, .pcd, .ply, .las or .vtk; does not commit. What a PCD says by its
/// VIEWPOINT becomes fields vp_x, vp_y, vp_z in PLY and LAS.
void writeCloud(const OutputCloud& cloud, OutputFile& file);

class LasWriter;

/// A PCD, PLY or LAS that is written block by block; does not commit. All blocks have the same
/// columns.
class CloudWriter {
 public:
  /// \param bulk where the points are but for strays; only LAS asks for it
  CloudWriter(OutputFile& file, const Bounds& bulk, int threads = 1);
  ~CloudWriter();
  CloudWriter(const CloudWriter&) = delete;
  CloudWriter& operator=(const CloudWriter&) = delete;

  /// Columns of a cloud that is organised, else 0: a PCD keeps them. Before the first block.
  void setWidth(std::size_t width) { width_ = width; }
  /// Whether all blocks have to be summed up before the first is added.
  bool needsSummary() const { return kind_ == Kind::LAS; }
  void sumUp(const OutputCloud& block);
  /// The next points. \param size of the whole cloud
  void add(const OutputCloud& block, std::uint64_t size);
  /// After the last one.
  void end();

 private:
  enum class Kind { PCD, PLY, LAS };
  void begin(const OutputCloud& block, std::uint64_t size);

  OutputFile& file_;
  int threads_;
  Kind kind_;
  bool begun_ = false;
  std::size_t width_ = 0;  // 0 = in no order
  LasSummary summary_;
  std::unique_ptr<LasWriter> las_;
};

}  // namespace segorient::program
