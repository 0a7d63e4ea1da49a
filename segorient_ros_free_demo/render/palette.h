// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <string>
#include <vector>

#include "io/cloud_table.h"
#include "render/legend.h"
#include "render/page/sides.h"
#include "support/report_facts.h"

namespace segorient::program {

constexpr std::uint32_t kWrongSide = 0xd03020U;  ///< red: a normal that points the wrong way

/// What the colours of a picture mean.
enum class Coloring {
  Normal,   ///< light grey where the normal points to the viewer, red where it points away
  Segment,  ///< by the field `label`
  /// As Normal, with a tint of each segment's own, hard segments in a colour of their own
  Orientation,
  Rgb,         ///< by the field `rgb`
  Confidence,  ///< of the orientation: by the field `confidence` or a report
  Height,      ///< by z
  Scan         ///< by the number of the scan
};

/// Reads a name of --color; "auto" takes Normal if the cloud has normals, else Segment or Rgb.
/// Throws UsageError for another name, FileError if the cloud lacks what it needs.
Coloring parseColoring(const std::string& name, const CloudTable& table, const std::string& path,
                       const Facts& facts = {});

/// The field that numbers the scans of a cloud, or null.
const Field* scanField(const CloudTable& table);

/// Packed colours, stored as the integer or the float whose bytes they are.
std::uint32_t packedColor(const CloudTable& table, const Field& field, std::size_t row);

/// The segment of a point; kNoSegment without one.
std::uint32_t labelOf(const CloudTable& table, const Field* field, std::size_t row);

/// Where each point was seen from, as far as fields vp_x, vp_y, vp_z tell it, or Facts do. A sensor
/// of the whole cloud that the file names is no such thing: it need not have seen every point.
class PointSensors {
 public:
  explicit PointSensors(const CloudTable& table, const Facts& facts = {});
  bool any() const { return fields_[2] != nullptr || !told_.empty(); }
  /// What the fields say. False where it is not known.
  bool at(std::size_t row, std::array<double, 3>& place) const;
  /// The side of a point whose sensor is known: its true one faces it. Of several that may have
  /// seen it (a sample of them where they are many), its true side faces the nearest; the wrong
  /// one, none. `side` where that is not known.
  Side side(std::size_t row, const std::array<float, 3>& normal, Side side) const;

 private:
  const CloudTable& table_;
  std::array<const Field*, 3> fields_{};
  std::vector<std::array<double, 3>> told_;
};

/// The different places that the points were seen from, a sample of them where they are many.
std::vector<std::array<double, 3>> sensorsOfPoints(const CloudTable& table);

/// What a picture shows that a legend is to tell.
struct ShownSides {
  bool backs = false;  ///< sides from behind may be seen
  bool wrong = false;  ///< there are wrong ones
  bool none = false;   ///< points without a normal
};

/// Colours of both sides of a point's splat: light where it is seen from its true side, brown from
/// behind, and red from both sides where its normal points the wrong way.
class Palette {
 public:
  /// \param facts must outlive this object, and so must the table
  Palette(const CloudTable& table, Coloring coloring, const Facts& facts);
  /// \param normal unit, NaN without one
  /// \return side, or what the sensor of the point says of it
  Side set(std::size_t row, const std::array<float, 3>& normal, Side side, std::uint32_t& front,
           std::uint32_t& back) const;
  /// Colours of a triangle: its back is red.
  void setTriangle(std::size_t row, const std::array<float, 3>& normal, std::uint32_t& front,
                   std::uint32_t& back) const;
  /// What the colours mean; empty where they mean nothing to be told.
  Legend legend(const ShownSides& shown = {}) const;

 private:
  void setSides(std::size_t row, Side side, std::uint32_t& front, std::uint32_t& back) const;
  std::uint32_t plain(std::size_t row) const;
  double height(std::size_t row) const;
  double confidence(std::size_t row) const;

  const CloudTable& table_;
  Coloring coloring_;
  const Facts& facts_;
  PointSensors sensors_;
  const Field* field_ = nullptr;
  const Field* label_ = nullptr;
  double low_ = 0.0;  // of heights
  double high_ = 0.0;
};

}  // namespace segorient::program
