// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "tiles/planned_input.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "common/parts.h"
#include "io/cloud_stream.h"
#include "io/readers.h"
#include "support/hint_options.h"

namespace segorient::program {
namespace {

constexpr double kMostScan = 2147483647.0;

// The points of one input.
class InputBlocks {
 public:
  // \param first_scan its number among those of all inputs of one output
  InputBlocks(const Plan& plan, const PlanInput& input, const Trajectory& trajectory,
              std::uint64_t first_scan)
      : plan_(plan),
        input_(input),
        trajectory_(trajectory),
        first_scan_(first_scan),
        stream_(input.streamed) {}

  bool next(CloudTable& block, std::uint64_t most) {
    constexpr std::uint64_t kBlock = std::uint64_t{1} << 16;
    if (!stream_.next(read_, static_cast<std::size_t>(std::min(kBlock, most)))) return false;
    block = read_;
    if (plan_.adds_scans) addScan(block);
    if (trajectory_.size() > 0) addViewpoints(trajectory_, input_.path, block);
    return true;
  }
  // How many scans the blocks so far are of.
  std::uint64_t scans() const { return scans_; }

 private:
  void addScan(CloudTable& block);

  const Plan& plan_;
  const PlanInput& input_;
  const Trajectory& trajectory_;
  std::uint64_t first_scan_;
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

}  // namespace

void forEachBlock(const Plan& plan, const PlanOutput& output, const Trajectory& trajectory,
                  const std::function<void(CloudTable&)>& visit, const std::function<void()>& end) {
  std::uint64_t in_chunk = 0;
  std::uint64_t scans = 0;
  for (std::size_t i = output.first_input; i < output.first_input + output.inputs; ++i) {
    InputBlocks blocks(plan, plan.inputs[i], trajectory, scans);
    CloudTable block;
    while (blocks.next(block, plan.chunk_rows - in_chunk)) {
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
        out[first + j].cell = finite ? cells[j] : kNoCell;
      }
    }
  });
}

Trajectory trajectoryOf(const Plan& plan) {
  return plan.trajectory.empty() ? Trajectory() : readTrajectory(plan.trajectory);
}

}  // namespace segorient::program
