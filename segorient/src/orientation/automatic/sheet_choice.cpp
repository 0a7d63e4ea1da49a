// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/automatic/sheet_choice.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

#include "common/dot.h"
#include "common/parallel_for.h"

namespace segorient::detail {
namespace {

// The oriented planes of one sheet near a point: mean normal, and how far off them the point is.
struct Sheet {
  std::array<float, 3> normal{0.F, 0.F, 0.F};
  float offset = 0.F;
  float total = 0.F;
  int witnesses = 0;

  float along(const float* n) const { return dot(normal.data(), n); }
  float length() const { return std::sqrt(along(normal.data())); }
  float meanOffset() const { return offset / total; }
};

constexpr float kDecided = 0.9F;  ///< confidence from which on the surroundings agree

class SheetChoice {
 public:
  SheetChoice(const PointView& points, const Neighborhoods& nb, const FilteredNormals& filtered,
              const std::vector<std::uint8_t>& decided, float residual)
      : points_(points), nb_(nb), filtered_(filtered), decided_(decided), residual_(residual) {}

  /// Writes the normal of the sheet that p is on to `normal`, if that can be told.
  bool choose(std::size_t p, float h, float* normal) const {
    std::array<Sheet, kSheets> sheets;
    const std::size_t count = listSheets(p, h, sheets);
    const Sheet* best = nullptr;
    const Sheet* second = nullptr;
    for (std::size_t s = 0; s < count; ++s) {
      const Sheet* sheet = &sheets[s];
      if (sheet->witnesses < kLeastWitnesses) continue;
      if (best == nullptr || sheet->meanOffset() < best->meanOffset()) std::swap(best, sheet);
      if (sheet != nullptr && (second == nullptr || sheet->meanOffset() < second->meanOffset())) {
        second = sheet;
      }
    }
    if (second == nullptr || best->meanOffset() > kOnSheet + residual_ ||
        best->meanOffset() + residual_ >= second->meanOffset()) {
      return false;
    }
    const float cosine = best->along(second->normal.data()) / (best->length() * second->length());
    if (cosine > kOpposite) return false;
    const float length = best->length();
    for (std::size_t a = 0; a < 3; ++a) normal[a] = best->normal[a] / length;
    return true;
  }

 private:
  static constexpr std::size_t kSheets = 4;   // three meet at a corner
  static constexpr int kLeastWitnesses = 3;   // as many as a plane takes
  static constexpr float kSameSheet = 0.94F;  // 20 degrees: curvature over a neighbourhood
  static constexpr float kOpposite = -0.7F;   // a wedge; at other edges a mean is not wrong
  static constexpr float kOnSheet = 0.1F;     // what curvature explains, as in the mean
  static constexpr float kFar2 = 1e6F;        // a thousand spacings away, where weights vanish

  std::size_t listSheets(std::size_t p, float h, std::array<Sheet, kSheets>& sheets) const {
    const pcl::index_t* row = nb_.indices(p);
    std::size_t count = 0;
    for (int j = 1; j < nb_.count(p); ++j) {
      const auto q = static_cast<std::size_t>(row[j]);
      if (decided_[q] == 0) continue;
      const float* n = filtered_.normals.data() + 4 * q;
      float off = 0.F;
      float far2 = 0.F;
      for (std::size_t a = 0; a < 3; ++a) {
        const float d = (points_[q][a] - points_[p][a]) / h;
        off += d * n[a];
        far2 += d * d;
      }
      if (!(far2 < kFar2)) continue;
      std::size_t s = 0;
      while (s < count && sheets[s].along(n) < kSameSheet * sheets[s].length()) ++s;
      if (s == kSheets) continue;
      count = std::max(count, s + 1);
      const float weight = 1.F / (1.F + 0.25F * far2);
      for (std::size_t a = 0; a < 3; ++a) sheets[s].normal[a] += weight * n[a];
      sheets[s].offset += weight * std::fabs(off);
      sheets[s].total += weight;
      ++sheets[s].witnesses;
    }
    return count;
  }

  const PointView& points_;
  const Neighborhoods& nb_;
  const FilteredNormals& filtered_;
  const std::vector<std::uint8_t>& decided_;
  float residual_;
};

}  // namespace

void chooseSheets(const PointView& points, const Neighborhoods& nb,
                  const std::vector<float>& spacing, float residual, int threads,
                  FilteredNormals& filtered) {
  std::vector<std::uint8_t> decided(points.size);
  std::vector<std::size_t> undecided;
  for (std::size_t p = 0; p < points.size; ++p) {
    decided[p] = filtered.confidences[p] >= kDecided ? 1 : 0;
    if (decided[p] == 0 && spacing[p] > 0.F) undecided.push_back(p);
  }
  std::vector<std::array<float, 4>> chosen(undecided.size());
  const SheetChoice choice(points, nb, filtered, decided, residual);
  // What has been told is a witness in the next pass: so they work their way into the wedge.
  constexpr int kPasses = 4;
  for (int pass = 0; pass < kPasses && !undecided.empty(); ++pass) {
    parallelFor(undecided.size(), threads, 3000.0, [&](std::size_t i) {
      const bool found = choice.choose(undecided[i], spacing[undecided[i]], chosen[i].data());
      chosen[i][3] = found ? 1.F : 0.F;
    });
    std::size_t left = 0;
    for (std::size_t i = 0; i < undecided.size(); ++i) {
      const std::size_t p = undecided[i];
      if (chosen[i][3] > 0.F) {
        std::copy(chosen[i].begin(), chosen[i].begin() + 3,
                  filtered.normals.begin() + static_cast<std::ptrdiff_t>(4 * p));
        decided[p] = 1;
      } else {
        undecided[left++] = p;
      }
    }
    if (left == undecided.size()) break;
    undecided.resize(left);
  }
}

}  // namespace segorient::detail
