// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <segorient/common/impl/fast_vector.hpp>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <iterator>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "common/parallel_for.h"
#include "features/growing_scales.h"
#include "features/grown_planes.h"
#include "features/local_fit_job.h"
#include "features/scan_scale.h"

namespace segorient::detail {
namespace {

// Half as many again each time, up to where planes are nearly free of noise.
constexpr Scales<6> kMany{{8, 12, 18, 27, 40, 60}};

void copyRow(const GrownPlanes& from, std::size_t i, GrownPlanes& to, std::size_t j) {
  for (std::size_t a = 0; a < 3; ++a) {
    to.normal[a][j] = from.normal[a][i];
    to.lambda[a][j] = from.lambda[a][i];
    to.mean[a][j] = from.mean[a][i];
  }
  to.n[j] = from.n[i];
  to.unit[j] = from.unit[i];
}

// Some points, and what their choice of a scale needs but for the variances of those around them.
class FittedPoints {
 public:
  // \param first of the scales that may be taken
  explicit FittedPoints(std::size_t first) : first_(first), planes_(kMany.sizes.size() - first) {
    clear();
  }

  void clear() {
    size_ = 0;
    ready_ = 0;
    around_.clear();
  }
  std::size_t size() const { return size_; }
  bool full() const { return size_ == GrownPlanes::kRows; }

  // Points [begin, end) of a region in place of those that there were.
  // \param table of the region \param planes of these points \param noise2 gets their variances
  void assign(const std::vector<pcl::index_t>& points, const Neighborhoods& table,
              std::size_t begin, std::size_t end, const Scales<6>::Planes& planes,
              FastVector<Scales<6>::Values>& noise2) {
    clear();
    std::copy(planes.begin() + static_cast<std::ptrdiff_t>(first_), planes.end(), planes_.begin());
    for (std::size_t at = begin; at < end; ++at, ++size_) {
      const Around around(table, at);
      around_.set(size_, points[at], around.used, around);
      const Scales<6>::Fits fits = Scales<6>::fitsAt(planes, size_);
      width2_[size_] = fits.width2;
      noise2[static_cast<std::size_t>(points[at])] = fits.noise2;
    }
  }
  // Takes point i of some others out of these.
  void take(FittedPoints& others, std::size_t i) {
    around_.set(size_, others.around_[i], kAround,
                [&](std::size_t j) { return others.around_[(1 + j) * GrownPlanes::kRows + i]; });
    others.around_.set(i, PointsAround::kNobody, kAround,
                       [](std::size_t) { return PointsAround::kNobody; });
    width2_[size_] = others.width2_[i];
    for (std::size_t s = 0; s < planes_.size(); ++s) {
      copyRow(others.planes_[s], i, planes_[s], size_);
    }
    ++size_;
  }

  // Whether a condition holds for all points around point i, itself included.
  template <typename Condition>
  bool allAround(std::size_t i, const Condition& condition) const {
    for (std::size_t v = i; v < around_.size(); v += GrownPlanes::kRows) {
      if (around_[v] != PointsAround::kNobody && !condition(around_[v])) return false;
    }
    return true;
  }
  // The same for all of them; those that it held for are not asked for again.
  template <typename Condition>
  bool allAround(const Condition& condition) {
    for (; ready_ < around_.size(); ++ready_) {
      const pcl::index_t point = around_[ready_];
      if (point != PointsAround::kNobody && !condition(point)) return false;
    }
    return true;
  }

  void choose(MediansAround<6>& medians, const ScanPlaneTaker& take) const {
    medians.restart(around_);
    for (std::size_t i = 0; i < size_; ++i) {
      if (around_[i] == PointsAround::kNobody) continue;
      const std::size_t scale =
          kMany.choose(width2_[i], [&](std::size_t size) { return medians(i, size); });
      if (scale < first_) continue;
      const GrownPlanes& planes = planes_[scale - first_];
      if (planes.at(i).valid) take(static_cast<std::size_t>(around_[i]), planes, i);
    }
  }

 private:
  std::size_t first_;
  std::size_t size_ = 0;
  std::size_t ready_ = 0;
  PointsAround around_;
  std::array<Scales<6>::Values, GrownPlanes::kRows> width2_;
  std::vector<GrownPlanes> planes_;
};

// Fits planes region by region, and chooses the scale of a point as soon as all around it are
// fitted: only those on the rims of regions wait, so that nobody's neighbours are searched for
// twice.
class ScanPlanes {
 public:
  ScanPlanes(const PointView& points, int smallest, const ScanPlaneTaker& take)
      : points_(points),
        xyz_(points_),
        take_(take),
        noise2_(points_.size),
        fitted_(new std::atomic<bool>[points_.size] {}) {
    while (first_ < kMany.sizes.size() &&
           static_cast<float>(kMany.sizes[first_]) <= kClearly * static_cast<float>(smallest)) {
      ++first_;
    }
  }

  void takeRegion(const std::vector<pcl::index_t>& rows, const Neighborhoods& table) {
    std::vector<Block> blocks = fit(rows, table);
    const Medians medians = this->medians();
    const auto fitted = [this](pcl::index_t point) { return isFitted(point); };
    std::vector<Block> rim;
    for (const Block& block : blocks) {
      for (std::size_t i = 0; i < block->size(); ++i) {
        if (block->allAround(i, fitted)) continue;
        if (rim.empty() || rim.back()->full()) rim.push_back(emptyBlock());
        rim.back()->take(*block, i);
      }
      block->choose(*medians, take_);
    }
    giveBack(blocks);
    blocks = exchange(rim);
    for (const Block& block : blocks) block->choose(*medians, take_);
    giveBack(blocks);
  }

  // What still waits, once all regions were taken.
  void takeRest(int threads) {
    parallelFor(
        waiting_.size(), threads, kFitTime * GrownPlanes::kRows, [this] { return medians(); },
        [this](std::size_t b, Medians& medians) { waiting_[b]->choose(*medians, take_); });
  }

 private:
  using Block = std::unique_ptr<FittedPoints>;
  using Medians = std::unique_ptr<MediansAround<6>>;

  Medians medians() const { return std::make_unique<MediansAround<6>>(noise2_.data()); }
  bool isFitted(pcl::index_t point) const {
    return fitted_[static_cast<std::size_t>(point)].load(std::memory_order_acquire);
  }

  std::vector<Block> fit(const std::vector<pcl::index_t>& rows, const Neighborhoods& table) {
    const std::vector<float> at = positionsOf(points_, rows);
    const LocalFitJob job = jobOf({at.data(), 4, rows.size()}, xyz_, table, kMany.sizes.back());
    const auto planes = std::make_unique<Scales<6>::Planes>();
    std::vector<Block> blocks;
    for (std::size_t begin = 0; begin < rows.size(); begin += GrownPlanes::kRows) {
      const std::size_t end = std::min(rows.size(), begin + GrownPlanes::kRows);
      fitGrownPlanes(job, kMany.sizes.data(), kMany.sizes.size(), begin, end, planes->data());
      Block block = emptyBlock();
      block->assign(rows, table, begin, end, *planes, noise2_);
      for (std::size_t i = begin; i < end; ++i) {
        fitted_[static_cast<std::size_t>(rows[i])].store(true, std::memory_order_release);
      }
      blocks.push_back(std::move(block));
    }
    return blocks;
  }

  Block emptyBlock() {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (unused_.empty()) return std::make_unique<FittedPoints>(first_);
    Block block = std::move(unused_.back());
    unused_.pop_back();
    block->clear();
    return block;
  }
  void giveBack(std::vector<Block>& blocks) {
    const std::lock_guard<std::mutex> lock(mutex_);
    std::move(blocks.begin(), blocks.end(), std::back_inserter(unused_));
  }

  // \param blocks begin to wait
  // \return those that have waited long enough
  std::vector<Block> exchange(std::vector<Block>& blocks) {
    const std::lock_guard<std::mutex> lock(mutex_);
    std::move(blocks.begin(), blocks.end(), std::back_inserter(waiting_));
    const auto ready = std::partition(waiting_.begin(), waiting_.end(), [this](Block& block) {
      return !block->allAround([this](pcl::index_t point) { return isFitted(point); });
    });
    std::vector<Block> out(std::make_move_iterator(ready), std::make_move_iterator(waiting_.end()));
    waiting_.erase(ready, waiting_.end());
    return out;
  }

  const PointView points_;
  const FourFloats xyz_;
  const ScanPlaneTaker& take_;
  std::size_t first_ = 0;  // of the scales that may be taken
  FastVector<Scales<6>::Values> noise2_;
  std::unique_ptr<std::atomic<bool>[]> fitted_;
  std::mutex mutex_;
  std::vector<Block> waiting_;
  std::vector<Block> unused_;
};

}  // namespace

void fitScanPlanes(MoreNeighbors& more, int smallest, int threads, const ScanPlaneTaker& take) {
  ScanPlanes planes(more.points(), smallest, take);
  more.index().nearestKByRegion(
      kVoters + 1, [&](const std::vector<pcl::index_t>& rows, const Neighborhoods& table) {
        planes.takeRegion(rows, table);
      });
  planes.takeRest(threads);
}

}  // namespace segorient::detail
