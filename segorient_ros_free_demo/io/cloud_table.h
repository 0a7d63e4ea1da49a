// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/point_view.h>
#include <segorient/orientation/orientation_hints.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace segorient::program {

struct LasOrigin;

/// One named column of a cloud, as in a PCD header.
struct Field {
  std::string name;
  char type = 'F';          ///< F floating point, I signed, U unsigned
  std::uint32_t size = 4;   ///< bytes of one element: 1, 2, 4 or 8
  std::uint32_t count = 1;  ///< elements
  std::size_t offset = 0;   ///< bytes from the beginning of a row

  std::size_t bytes() const { return std::size_t{size} * count; }
};

/// Three vertices of a mesh's triangle.
using Triangle = std::array<std::uint32_t, 3>;

/// A cloud as it is in a file: all its fields, each in its own type, row by row without padding.
///
/// pcl::PCLPointCloud2 would do as well but for its 32-bit sizes, which end at 4 GB.
struct CloudTable {
  std::vector<Field> fields;
  std::size_t size = 0;       ///< number of points
  std::size_t row_bytes = 0;  ///< bytes of a row
  std::size_t width = 0;
  std::size_t height = 1;                                ///< above 1 in an organised cloud
  std::array<double, 7> viewpoint{0, 0, 0, 1, 0, 0, 0};  ///< origin and quaternion, as in a PCD
  std::vector<std::uint8_t> rows;
  std::vector<Triangle> triangles;   ///< faces of a PLY, where it has any
  std::vector<std::string> dropped;  ///< properties of the file that a table has no place for
  std::vector<std::string> notes;    ///< what else of the file a user should know, a line each
  /// Where several clouds were joined: the range images among them.
  std::vector<OrganizedGrid> grids;
  std::shared_ptr<const LasOrigin> las;  ///< of a LAS file: what it says beyond its points

  /// Appends a field behind the others; only before rows are stored.
  void addField(std::string name, char type, std::uint32_t field_size, std::uint32_t count = 1);
  /// Appends fields to a table that has rows already; those of the new fields are zero. A field
  /// whose name is there already takes its place.
  void appendFields(const std::vector<Field>& added);
  /// The field of this name, or null.
  const Field* find(const std::string& name) const;
  const std::uint8_t* at(const Field& field, std::size_t row) const {
    return rows.data() + row * row_bytes + field.offset;
  }
  std::uint8_t* at(const Field& field, std::size_t row) {
    return rows.data() + row * row_bytes + field.offset;
  }
  /// One element as a double.
  double value(const Field& field, std::size_t row, std::uint32_t element = 0) const;
  /// Three fields of one point as doubles.
  std::array<double, 3> triple(const std::array<const Field*, 3>& columns, std::size_t row) const;
  /// Where a point is.
  std::array<double, 3> position(std::size_t row) const { return triple(xyz(), row); }
  std::array<const Field*, 3> xyz() const { return {find("x"), find("y"), find("z")}; }
  /// The fields normal_x, normal_y, normal_z; null where the cloud has none.
  std::array<const Field*, 3> normals() const {
    return {find("normal_x"), find("normal_y"), find("normal_z")};
  }
  bool hasNormals() const;
  /// The fields vp_x, vp_y, vp_z: where each point was seen from; null where the cloud has none.
  std::array<const Field*, 3> viewpoints() const {
    return {find("vp_x"), find("vp_y"), find("vp_z")};
  }
  bool hasViewpoints() const;
  /// Stores a number in a field of floating point, in its own precision.
  void setReal(const Field& field, std::size_t row, double value);

  /// Makes fields of whole numbers floating point ones: of 4 bytes where that loses nothing, else
  /// of 8.
  void makeReal(const std::vector<std::string>& names);
};

/// nx, ny, nz as PCL names them, normal_x, normal_y, normal_z; other names as they are.
std::string pclName(std::string name);

/// A number in memory as a double.
double loadNumber(const std::uint8_t* data, char type, std::uint32_t size);

/// Points of a table as floats near the origin.
///
/// Floats hold seven digits. Where a cloud lies further from the origin than twice its extent (map
/// coordinates, say) it is moved, in double, so that they resolve 1e-7 of its extent; otherwise
/// `origin` is zero and float fields are viewed in place, without a copy. Strays, such as points at
/// 0,0,0 among map coordinates, have no say in that (see bulkBounds()); those at more than 2^24
/// times the extent, where floats end, become NaN.
class LocalPoints {
 public:
  explicit LocalPoints(const CloudTable& table);  ///< `table` must outlive this object

  const PointView& view() const { return view_; }
  const std::array<double, 3>& origin() const { return origin_; }
  double extent() const { return extent_; }       ///< longest side of the bulk's bounding box
  double reach() const { return reach_; }         ///< largest absolute coordinate of the bulk
  std::size_t finite() const { return finite_; }  ///< points of the view that are not NaN

 private:
  std::vector<float> copy_;
  PointView view_;
  std::array<double, 3> origin_{0, 0, 0};
  double extent_ = 0.0;
  double reach_ = 0.0;
  std::size_t finite_ = 0;
};

}  // namespace segorient::program
