// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "segmentation/sheet_segmentation.h"

namespace segorient::detail {

/// Signed sum of a segment's normals, and its points in a list through SheetGrower::next.
struct SheetSegment {
  float x = 0.F, y = 0.F, z = 0.F;
  std::uint32_t size = 0;
  pcl::index_t head = -1;
  pcl::index_t tail = -1;
  float squaredLength() const { return x * x + y * y + z * z; }
  float length() const { return std::sqrt(squaredLength()); }
};

/// State of one segmentSheets() run: labels are provisional, and segments that were merged away
/// empty.
class SheetGrower {
 public:
  SheetGrower(const PointView& points, const Neighborhoods& neighborhoods, const SheetField& field,
              const std::vector<std::uint32_t>& admissible,
              const SheetSegmentationOptions& options);

  /// Grows segments from the flattest points on: reliable ones first, then what is left around
  /// them, then what is left at all.
  void growAll();
  /// Pass 1: whole small segments join a neighbour.
  void mergeSmall();
  /// Pass 2: points of small segments go over one by one, until nothing moves.
  void extractFromSmall();

  Segmentation finish() const;

 private:
  struct Contact;

  static std::size_t at(pcl::index_t i) { return static_cast<std::size_t>(i); }
  const float* normal(std::size_t i) const { return field_.normals + 4 * i; }
  int degree(std::size_t i) const { return std::min(nb_.count(i) - 1, kSheetDegree); }
  const pcl::index_t* neighbors(std::size_t i) const { return nb_.indices(i) + 1; }
  bool admits(std::size_t i, int j) const { return (admissible_[i] >> j & 1U) != 0; }
  bool isSmall(std::int32_t label) const {
    return segments_[static_cast<std::size_t>(label)].size < options_.small;
  }

  std::vector<pcl::index_t> seedOrder() const;
  int accepts(std::size_t p, std::size_t q, const SheetSegment& segment, float cos_beta) const;
  bool supported(std::size_t q, std::int32_t label, std::uint32_t size) const;
  void add(std::size_t q, std::int32_t label, int sign);
  void visit(std::size_t p, bool reliable_only);
  void grow(pcl::index_t seed, bool reliable_only);
  void listMembers();
  void findContacts(std::int32_t label, std::vector<Contact>& contacts, int& foreign) const;
  void absorb(std::int32_t gone, std::int32_t into, float sign);
  bool moveOut(std::size_t p);

  const PointView& points_;
  const Neighborhoods& nb_;
  const SheetField& field_;
  const std::vector<std::uint32_t>& admissible_;
  const SheetSegmentationOptions& options_;
  float cos_alpha_;
  float cos_beta_;
  float cos_relaxed_;
  std::vector<std::int32_t> labels_;
  std::vector<std::int8_t> signs_;
  std::vector<SheetSegment> segments_;
  std::vector<pcl::index_t> next_;
  std::vector<pcl::index_t> queue_;
};

}  // namespace segorient::detail
