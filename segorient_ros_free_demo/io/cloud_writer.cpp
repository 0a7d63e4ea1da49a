// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "io/cloud_writer.h"

#include <algorithm>
#include <cstring>
#include <sstream>

#include "io/file_endings.h"
#include "io/las_writer.h"
#include "io/ply_writer.h"
#include "io/row_blocks.h"

namespace segorient::program {
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

void writePcdRows(const OutputCloud& cloud, OutputFile& file, int threads = 1) {
  std::size_t row_bytes = 0;
  for (const Column& c : cloud.columns) row_bytes += c.field.bytes();
  const auto make_row = [&](std::size_t row, std::uint8_t* to) {
    for (const Column& c : cloud.columns) {
      std::memcpy(to, c.data + row * c.stride, c.field.bytes());
      to += c.field.bytes();
    }
  };
  writeRows(cloud.size, row_bytes, file, make_row, threads);
}

}  // namespace

void writePcd(const OutputCloud& cloud, OutputFile& file) {
  writePcdHeader(cloud, file);
  writePcdRows(cloud, file);
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

CloudWriter::CloudWriter(OutputFile& file, const Bounds& bulk, int threads)
    : file_(file), threads_(threads), kind_(Kind::PCD), summary_(bulk) {
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
  if (width_ > 0) {
    all.width = width_;
    all.height = all.size / width_;
  }
  if (kind_ == Kind::PLY) writePlyHeader(all, file_);
  if (kind_ == Kind::PCD) writePcdHeader(all, file_);
  if (kind_ == Kind::LAS) las_ = std::make_unique<LasWriter>(block, summary_, file_);
}

void CloudWriter::add(const OutputCloud& block, std::uint64_t size) {
  const ConstantViewpoint viewpoint(block);
  const OutputCloud cloud = kind_ == Kind::PCD ? block : viewpoint.addedTo(block);
  if (!begun_) begin(cloud, size);
  if (kind_ == Kind::PLY) writePlyRows(cloud, file_, threads_);
  if (kind_ == Kind::PCD) writePcdRows(cloud, file_, threads_);
  if (kind_ == Kind::LAS) las_->add(cloud);
}

void CloudWriter::end() {
  if (las_) las_->end();
}

}  // namespace segorient::program
