// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <segorient/search/median_hash_index.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "brute_force.h"
#include "structured_cloud.h"
#include "targets.h"

namespace segorient::test {
namespace {

using search::MedianHashIndex;

constexpr std::size_t kMostPoints = 64;

struct Found {
  std::vector<pcl::index_t> indices;
  std::vector<float> distances;

  void resize(std::size_t size) {
    indices.resize(size);
    distances.resize(size);
  }
  bool same(const std::vector<Neighbor>& truth, std::size_t count) const {
    if (indices.size() != count) return false;
    for (std::size_t i = 0; i < count; ++i) {
      if (indices[i] != truth[i].index || distances[i] != truth[i].distance) return false;
    }
    return true;
  }
};

class SearchFuzzer {
 public:
  explicit SearchFuzzer(ByteReader& reader) {
    constexpr std::array<std::size_t, 8> kRegionSizes{0, 1, 2, 3, 7, 16, 64, 2048};
    options_.region_size = kRegionSizes[reader.below(kRegionSizes.size())];
    options_.threads = reader.byte() == 0 ? 2 : 1;
    with_indices_ = reader.below(4) == 0;
    max_nn_ = static_cast<unsigned int>(reader.below(8));
    for (float& v : free_query_) v = reader.whole();
    if (with_indices_) {
      indices_.resize(reader.below(24));
      for (pcl::index_t& i : indices_) i = static_cast<pcl::index_t>(reader.byte()) - 4;
    }
    k_ = static_cast<int>(reader.below(kMostPoints + 4)) - 2;
    cloud_ = readCloud(reader, kMostPoints);
    index_.build(cloud_.view(), indices(), options_);
  }

  void run() {
    ask(free_query_.data());
    const std::size_t size = cloud_.size();
    if (size == 0) return;
    for (const std::size_t row : {std::size_t{0}, size / 2, size - 1}) {
      ask(cloud_.view()[row]);
    }
    askAll();
    askAllWithin();
  }

 private:
  const std::vector<pcl::index_t>* indices() const { return with_indices_ ? &indices_ : nullptr; }

  void ask(const float* query) {
    std::vector<Neighbor> truth;
    if (isFinite(query)) truth = bruteForce(cloud_.view(), query, indices());
    const std::size_t wanted = std::min(static_cast<std::size_t>(std::max(k_, 0)), truth.size());
    Found found;
    found.resize(std::min(static_cast<std::size_t>(std::max(k_, 0)), index_.size()));
    const int count = index_.nearestK(query, k_, found.indices.data(), found.distances.data(), 0.F);
    found.resize(static_cast<std::size_t>(count));
    expectProperty(found.same(truth, wanted), "k nearest are those of brute force");
    askRadius(query, truth);
    askApproximate(query, truth, wanted);
  }

  // Around a distance that occurs, where < and <= differ.
  void askRadius(const float* query, const std::vector<Neighbor>& truth) {
    const double squared =
        truth.empty() ? 1.0 : static_cast<double>(truth[truth.size() / 2].distance);
    const double radius = std::sqrt(squared);
    Found found;
    index_.radius(query, radius, found.indices, found.distances, 0, true);
    // The comparison is made in float, as FLANN does.
    const auto limit = static_cast<float>(radius * radius);
    const auto within = static_cast<std::size_t>(std::count_if(
        truth.begin(), truth.end(), [&](const Neighbor& n) { return n.distance < limit; }));
    if (radius > 0.0 && std::isfinite(limit)) {
      expectProperty(found.same(truth, within), "all within a radius are those of brute force");
    }
    Found closest;
    index_.radius(query, radius, closest.indices, closest.distances, max_nn_, true);
    const std::size_t most =
        max_nn_ == 0 ? found.indices.size() : std::min<std::size_t>(max_nn_, found.indices.size());
    expectProperty(closest.indices.size() == most, "max_nn bounds what is found");
    expectProperty(
        std::equal(closest.indices.begin(), closest.indices.end(), found.indices.begin()),
        "max_nn keeps the closest");
    Found unsorted;
    index_.radius(query, radius, unsorted.indices, unsorted.distances, 0, false);
    std::sort(unsorted.indices.begin(), unsorted.indices.end());
    std::sort(found.indices.begin(), found.indices.end());
    expectProperty(unsorted.indices == found.indices, "unsorted finds the same");
  }

  void askApproximate(const float* query, const std::vector<Neighbor>& truth, std::size_t wanted) {
    constexpr float kEpsilon = 0.5F;
    Found found;
    found.resize(wanted);
    const int count =
        index_.nearestK(query, k_, found.indices.data(), found.distances.data(), kEpsilon);
    expectProperty(static_cast<std::size_t>(count) == wanted, "approximate finds as many");
    for (std::size_t i = 0; i < wanted; ++i) {
      const double allowed =
          1.0001 * std::sqrt(static_cast<double>(truth[i].distance)) * (1.0 + kEpsilon);
      expectProperty(std::sqrt(static_cast<double>(found.distances[i])) <= allowed,
                     "approximate distances are within 1 + epsilon");
    }
  }

  void askAll() {
    Neighborhoods table;
    index_.nearestKAll(k_, table, true, 0.F);
    const std::size_t rows = with_indices_ ? indices_.size() : cloud_.size();
    expectProperty(table.size() == rows, "a row for each point");
    for (std::size_t row = 0; row < rows; row += 1 + rows / 4) {
      const pcl::index_t self = with_indices_ ? indices_[row] : static_cast<pcl::index_t>(row);
      if (!isValid(self) || k_ <= 0) {
        expectProperty(table.count(row) == 0, "an invalid row is empty");
        continue;
      }
      const auto truth =
          bruteForceRow(cloud_.view(), self, static_cast<std::size_t>(k_), indices());
      Found found;
      found.indices.assign(table.indices(row), table.indices(row) + table.count(row));
      found.distances.assign(table.sqrDistances(row), table.sqrDistances(row) + table.count(row));
      expectProperty(found.same(truth, truth.size()), "a row is that of brute force");
    }
  }

  // With the radius of a distance that occurs.
  void askAllWithin() {
    const std::size_t rows = with_indices_ ? indices_.size() : cloud_.size();
    double radius = 1.0;
    RadiusNeighborhoods table;
    for (std::size_t row = 0; row < rows; row += 1 + rows / 4) {
      const pcl::index_t self = with_indices_ ? indices_[row] : static_cast<pcl::index_t>(row);
      std::vector<Neighbor> truth;
      if (isValid(self)) truth = bruteForceRow(cloud_.view(), self, rows, indices());
      if (!truth.empty()) radius = std::sqrt(static_cast<double>(truth[truth.size() / 2].distance));
      const auto limit = static_cast<float>(radius * radius);
      if (!(radius > 0.0) || !(limit > 0.0F) || !std::isfinite(limit)) continue;
      index_.radiusAll(radius, table, max_nn_);
      expectProperty(table.size() == rows, "a row within a radius for each point");
      auto within = static_cast<std::size_t>(std::count_if(
          truth.begin(), truth.end(), [&](const Neighbor& n) { return n.distance < limit; }));
      if (max_nn_ > 0) within = std::min<std::size_t>(within, max_nn_);
      expectProperty(table.count(row) == within, "a row has all within the radius");
      Found found;
      found.indices.assign(table.indices(row), table.indices(row) + within);
      found.distances.assign(table.sqrDistances(row), table.sqrDistances(row) + within);
      expectProperty(found.same(truth, within), "a row within a radius is that of brute force");
    }
  }

  bool isValid(pcl::index_t i) const {
    return i >= 0 && static_cast<std::size_t>(i) < cloud_.size() &&
           isFinite(cloud_.view()[static_cast<std::size_t>(i)]);
  }

  MedianHashIndex::Options options_;
  bool with_indices_ = false;
  unsigned int max_nn_ = 0;
  std::array<float, 3> free_query_{};
  std::vector<pcl::index_t> indices_;
  int k_ = 0;
  StructuredCloud cloud_;
  MedianHashIndex index_;
};

}  // namespace

void fuzzSearch(const std::uint8_t* data, std::size_t size) {
  ByteReader reader(data, size);
  SearchFuzzer(reader).run();
}

}  // namespace segorient::test
