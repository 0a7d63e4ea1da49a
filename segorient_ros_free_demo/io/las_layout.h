// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "io/cloud_writer.h"
#include "io/las_format.h"
#include "io/las_summary.h"

namespace segorient::program {

/// How a cloud becomes a LAS file: format, grid of coordinates, and which column goes where.
class LasLayout {
 public:
  /// A number of a column that is stored as a dimension of its own.
  struct Extra {
    std::size_t column = 0;
    std::uint32_t element = 0;
    std::string name;
  };

  /// \param block any part of the cloud
  LasLayout(const OutputCloud& block, const LasSummary& summary);

  bool extended() const { return lasIsExtended(format_); }
  std::size_t recordBytes() const { return record_bytes_; }
  /// All up to the first point.
  std::vector<std::uint8_t> head() const;
  /// All behind the last one.
  std::vector<std::uint8_t> tail() const;
  /// \return false where the point has no place
  bool makeRecord(const OutputCloud& block, std::size_t row, std::uint8_t* to) const;

 private:
  struct Standard {
    LasItem item;
    std::size_t column = 0;
  };

  double ticks(std::size_t a, double v) const;
  double stored(std::size_t a, double v) const { return scale_[a] * ticks(a, v) + offset_[a]; }
  void chooseFormat(const OutputCloud& block);
  void chooseScale();
  void assignColumns(const OutputCloud& block);
  void listExtras(const OutputCloud& block, const std::vector<std::size_t>& used);
  std::vector<std::uint8_t> header(std::uint32_t records, std::uint64_t points_begin) const;
  std::vector<std::uint8_t> describeExtras() const;

  LasSummary summary_;
  LasOrigin origin_;
  std::array<std::size_t, 3> xyz_{};
  int format_ = 0;
  int minor_version_ = 2;
  std::array<double, 3> scale_{};
  std::array<double, 3> offset_{};
  std::vector<Standard> standard_;
  bool has_returns_ = false;
  std::size_t packed_colors_ = 0;  ///< column; none where `has_packed_colors_` is false
  bool has_packed_colors_ = false;
  double intensity_factor_ = 1.0;
  std::vector<Extra> extras_;
  std::vector<Field> extra_fields_;  ///< of the columns of `extras_`
  std::size_t record_bytes_ = 0;
};

}  // namespace segorient::program
