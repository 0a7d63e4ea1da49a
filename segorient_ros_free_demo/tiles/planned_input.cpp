// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "tiles/planned_input.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "common/parts.h"
#include "io/cloud_stream.h"
#include "io/join_clouds.h"
#include "io/readers.h"
#include "support/hint_options.h"

namespace segorient::program {
namespace {

constexpr double kMostScan = 2147483647.0;

// The points of one input.
class InputBlocks {
 public:
  // \param first_scan its number among those of all inputs of one output
  // \param las of the output, null where it is what the input says
  InputBlocks(const Plan& plan, const PlanInput& input, const Trajectory& trajectory,
              std::uint64_t first_scan, std::shared_ptr<const LasOrigin> las)
      : plan_(plan),
        input_(input),
        trajectory_(trajectory),
        first_scan_(first_scan),
        las_(std::move(las)),
        stream_(input.streamed) {}

  bool next(CloudTable& block, std::uint64_t most, TrajectoryJoin* joined) {
    constexpr std::uint64_t kBlock = std::uint64_t{1} << 16;
    if (!stream_.next(read_, static_cast<std::size_t>(std::min(kBlock, most)))) return false;
    block = read_;
    if (plan_.adds_scans) addScan(block);
    if (las_) block.las = las_;
    if (trajectory_.size() > 0) {
      const TrajectoryJoin join = addViewpoints(trajectory_, input_.path, block);
      if (joined != nullptr) addUp(join, *joined);
    }
    return true;
  }
  // How many scans the blocks so far are of.
  std::uint64_t scans() const { return scans_; }

 private:
  void addScan(CloudTable& block);
  static void addUp(const TrajectoryJoin& join, TrajectoryJoin& sum) {
    const bool first = sum.joined + sum.outside == 0;
    if (join.joined + join.outside > 0) {
      sum.first_time = first ? join.first_time : std::min(sum.first_time, join.first_time);
      sum.last_time = first ? join.last_time : std::max(sum.last_time, join.last_time);
    }
    sum.joined += join.joined;
    sum.outside += join.outside;
    sum.without_time += join.without_time;
  }

  const Plan& plan_;
  const PlanInput& input_;
  const Trajectory& trajectory_;
  std::uint64_t first_scan_;
  std::shared_ptr<const LasOrigin> las_;
  CloudStream stream_;
  CloudTable read_;
  std::uint64_t scans_ = 1;
};

// As joinClouds() does: fields of the input's own sensors stay what they are.
void InputBlocks::addScan(CloudTable& block) {
  std::vector<Field> added{{"scan", 'U', 4, 1, 0}};
  const std::uint32_t size = block.find("x")->size;
  if (plan_.adds_viewpoints) {
    for (const char* name : {"vp_x", "vp_y", "vp_z"}) added.push_back({name, 'F', size, 1, 0});
  }
  block.appendFields(added);
  const Field* own = read_.find("scan");
  const bool has_viewpoints = read_.hasViewpoints();
  const bool known =
      read_.viewpoint[0] != 0.0 || read_.viewpoint[1] != 0.0 || read_.viewpoint[2] != 0.0;
  for (std::size_t i = 0; i < block.size; ++i) {
    const double v = own == nullptr ? 0.0 : read_.value(*own, i);
    const std::uint64_t number = v >= 0.0 && v < kMostScan ? static_cast<std::uint64_t>(v) : 0;
    scans_ = std::max(scans_, number + 1);
    const auto scan = static_cast<std::uint32_t>(first_scan_ + number);
    std::memcpy(block.at(*block.find("scan"), i), &scan, sizeof(scan));
    if (!plan_.adds_viewpoints) continue;
    constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
    std::array<double, 3> seen_from{kNaN, kNaN, kNaN};
    if (known) std::copy_n(read_.viewpoint.begin(), 3, seen_from.begin());
    if (has_viewpoints) seen_from = read_.triple(read_.viewpoints(), i);
    for (std::size_t a = 0; a < 3; ++a) {
      block.setReal(*block.viewpoints()[a], i, seen_from[a]);
    }
  }
}

// What the LAS file of several inputs says, as that of joinClouds(); null if there is only one.
std::shared_ptr<const LasOrigin> lasOf(const Plan& plan, const PlanOutput& output) {
  if (output.inputs < 2) return nullptr;
  std::vector<std::shared_ptr<const LasOrigin>> origins;
  for (std::size_t i = output.first_input; i < output.first_input + output.inputs; ++i) {
    origins.push_back(CloudStream(plan.inputs[i].streamed).layout().las);
  }
  return commonOrigin(origins);
}

}  // namespace

void forEachBlock(const Plan& plan, const PlanOutput& output, const Trajectory& trajectory,
                  const std::function<void(CloudTable&)>& visit, const std::function<void()>& end,
                  TrajectoryJoin* joined) {
  const std::shared_ptr<const LasOrigin> las = lasOf(plan, output);
  std::uint64_t in_chunk = 0;
  std::uint64_t scans = 0;
  for (std::size_t i = output.first_input; i < output.first_input + output.inputs; ++i) {
    InputBlocks blocks(plan, plan.inputs[i], trajectory, scans, las);
    CloudTable block;
    while (blocks.next(block, plan.chunk_rows - in_chunk, joined)) {
      in_chunk += block.size;
      visit(block);
      if (in_chunk < plan.chunk_rows) continue;
      end();
      in_chunk = 0;
    }
    scans += blocks.scans();
  }
  end();
}

void storePoints(const Plan& plan, const CloudTable& block, int threads, StoredPoint* out) {
  constexpr double kPointTime = 150.0;  // nanoseconds
  const auto xyz = block.xyz();
  const Parts parts(block.size, threads, kPointTime);
  parts.forEach([&](std::size_t part) {
    constexpr std::size_t kGroup = 16;
    std::array<TileTree::Place, kGroup> places;
    std::array<std::uint32_t, kGroup> cells;
    for (std::size_t first = parts.begin(part); first < parts.end(part); first += kGroup) {
      const std::size_t count = std::min(kGroup, parts.end(part) - first);
      for (std::size_t j = 0; j < count; ++j) {
        places[j] = storedPlace(plan, block.triple(xyz, first + j));
      }
      plan.tree.findCells(places.data(), count, cells.data());
      for (std::size_t j = 0; j < count; ++j) {
        const TileTree::Place& p = places[j];
        const bool finite = std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
        out[first + j].place = p;
        // A stray where floats end is nobody's neighbour, as in memory.
        out[first + j].cell = finite && !plan.bulk.isBeyondFloats(p) ? cells[j] : kNoCell;
      }
    }
  });
}

Trajectory trajectoryOf(const Plan& plan) {
  return plan.trajectory.empty() ? Trajectory() : readTrajectory(plan.trajectory);
}

}  // namespace segorient::program
