// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include "common/parts.h"
#include "io/cloud_stream.h"
#include "io/cloud_writer.h"
#include "io/file_endings.h"
#include "support/colors.h"
#include "support/hint_options.h"
#include "tiles/chunk_order.h"
#include "tiles/planned_input.h"
#include "tiles/row_file.h"
#include "tiles/steps.h"
#include "tiles/tile_records.h"

namespace segorient::program {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

// The results of all tiles for the points of one output, in the order of its rows.
class Results {
 public:
  Results(const Plan& plan, const std::string& folder, std::uint32_t output, int threads)
      : plan_(plan),
        threads_(threads),
        order_(plan.tree),
        labels_(loadLabels(labelsPath(folder), plan.run, plan.tiles())) {
    for (std::size_t t = 0; t < plan.tiles(); ++t) {
      const auto tile = static_cast<std::uint32_t>(t);
      SignsFile file = loadSigns(tilePath(folder, t, "signs"), plan.run, tile);
      signs_.push_back(std::move(file.signs.pieces));
      rows_.push_back(std::make_unique<RowReader>(
          tilePath(folder, t, file.again ? "rows2" : "rows"), plan.run, tile, output));
    }
  }

  // Of the rows of a chunk; NaN and no label for those that no tile knows.
  void take(const std::vector<CloudTable>& blocks, std::size_t size) {
    normals.assign(4 * size, kNaN);
    labels.assign(size, kNoSegment);
    points_.resize(size);
    std::size_t first = 0;
    for (const CloudTable& block : blocks) {
      storePoints(plan_, block, threads_, &points_[first]);
      first += block.size;
    }
    order_.cut(points_);
    const std::vector<PacketRange>& packets = order_.packets();
    // How many rows of its tile are before each packet in this chunk.
    std::vector<std::uint64_t> before;
    std::uint64_t rows = 0;
    for (std::size_t p = 0; p < packets.size(); ++p) {
      if (p == 0 || packets[p].tile != packets[p - 1].tile) rows = 0;
      before.push_back(rows);
      rows += packets[p].size();
    }
    const Parts parts(packets.size(), threads_, kPacketTime);
    parts.forEach(
        [&](std::size_t part) { takePackets(before, parts.begin(part), parts.end(part)); });
    for (std::size_t p = 0; p < packets.size(); ++p) {
      const bool last = p + 1 == packets.size() || packets[p + 1].tile != packets[p].tile;
      if (last) rows_[packets[p].tile]->skip(before[p] + packets[p].size());
    }
  }

  std::vector<float> normals;  // 4 a row, with the curvature
  std::vector<std::uint32_t> labels;

 private:
  // Those from `first` to `last`, with readers of their own.
  void takePackets(const std::vector<std::uint64_t>& before, std::size_t first, std::size_t last) {
    PlaceOrder order;
    std::optional<RowReader> rows;
    for (std::size_t p = first; p < last; ++p) {
      const PacketRange& range = order_.packets()[p];
      if (p == first || range.tile != order_.packets()[p - 1].tile) {
        rows.emplace(*rows_[range.tile]);
        rows->skip(before[p]);
      }
      order.clear();
      order_.addPlaces(points_, range, order);
      order.order(nullptr);
      for (std::size_t i = 0; i < range.size() && !rows->done(); ++i, rows->next()) {
        copy(range.tile, rows->row(), order_.pointOf(range, order.at(i)));
      }
    }
  }

  void copy(std::size_t tile, const RowRecord& r, std::size_t i) {
    std::copy_n(r.normal, 4, &normals[4 * i]);
    const auto label = static_cast<std::size_t>(r.label);
    if (r.label >= 0 && label < labels_[tile].size()) labels[i] = labels_[tile][label];
    const auto piece = static_cast<std::size_t>(r.followed);
    if (r.followed < 0 || piece >= signs_[tile].size()) return;
    for (std::size_t a = 0; a < 3; ++a) normals[4 * i + a] *= signs_[tile][piece];
  }

  const Plan& plan_;
  int threads_;
  ChunkOrder order_;
  std::vector<StoredPoint> points_;
  LabelFile labels_;
  std::vector<std::vector<std::int8_t>> signs_;  // of each tile's pieces
  std::vector<std::unique_ptr<RowReader>> rows_;
};

// \param first row of the block among those of the results
void addBlock(const CloudTable& block, const Results& results, std::size_t first, bool colors,
              std::uint64_t size, int threads, CloudWriter& writer) {
  OutputCloud out(block);
  const float* n = results.normals.data() + 4 * first;
  const std::uint32_t* labels = results.labels.data() + first;
  out.add("normal_x", n, 4);
  out.add("normal_y", n + 1, 4);
  out.add("normal_z", n + 2, 4);
  out.add("curvature", n + 3, 4);
  std::vector<std::uint32_t> rgb;
  if (colors && block.find("rgb") == nullptr) {
    constexpr double kPointTime = 20.0;  // nanoseconds
    rgb.resize(block.size);
    const Parts parts(block.size, threads, kPointTime);
    parts.forEach([&](std::size_t part) {
      for (std::size_t i = parts.begin(part); i < parts.end(part); ++i) {
        rgb[i] = segmentColor(labels[i]);
      }
    });
    out.columns.push_back(
        {{"rgb", 'F', 4, 1, 0}, reinterpret_cast<const std::uint8_t*>(rgb.data()), 4});
  }
  out.add("label", labels);
  out.addRest(block);
  writer.add(out, size);
}

}  // namespace

void writeStep(const Plan& plan, const std::string& folder, std::size_t output, int threads,
               const StepProgress& progress) {
  requireUnchanged(plan);
  if (!std::filesystem::exists(joinPath(folder))) {
    throw FileError(folder, "cannot be written from before it is joined");
  }
  for (std::size_t t = 0; t < plan.tiles(); ++t) finishStep(plan, folder, t, threads);
  labelStep(plan, folder);
  const PlanOutput& to = plan.outputs[output];
  OutputFile file(to.path);
  CloudWriter writer(file, plan.bulk, threads);
  const Trajectory trajectory = trajectoryOf(plan);
  std::uint64_t size = 0;
  for (std::size_t i = to.first_input; i < to.first_input + to.inputs; ++i) {
    size += plan.inputs[i].rows;
  }
  if (to.inputs == 1 && size > 0) {
    const CloudStream stream(plan.inputs[to.first_input].streamed);
    writer.setWidth(imageWidth(stream.layout(), size));
  }
  if (writer.needsSummary()) {
    forEachBlock(
        plan, to, trajectory,
        [&](CloudTable& block) {
          OutputCloud columns(block);
          columns.addRest(block);
          writer.sumUp(columns);
        },
        [] {});
  }
  // As of a cloud in memory: LAS has room for a camera's colours only in some of its formats.
  const bool colors = fileEnding(to.path) != ".las";
  Results results(plan, folder, static_cast<std::uint32_t>(output), threads);
  std::vector<CloudTable> chunk;
  std::size_t rows = 0;
  std::uint64_t written = 0;
  forEachBlock(
      plan, to, trajectory,
      [&](CloudTable& block) {
        rows += block.size;
        chunk.push_back(std::move(block));
      },
      [&] {
        results.take(chunk, rows);
        std::size_t first = 0;
        for (const CloudTable& block : chunk) {
          addBlock(block, results, first, colors, size, threads, writer);
          first += block.size;
        }
        written += rows;
        if (progress && size > 0)
          progress(static_cast<double>(written) / static_cast<double>(size));
        chunk.clear();
        rows = 0;
      });
  if (size == 0) {  // a cloud without points has its fields all the same
    CloudTable none = CloudStream(plan.inputs[to.first_input].streamed).layout();
    none.size = none.width = 0;
    if (trajectory.size() > 0) addViewpoints(trajectory, to.path, none);
    // Columns begin somewhere, though nobody reads there.
    none.rows.resize(none.row_bytes);
    results.normals.assign(4, kNaN);
    results.labels.assign(1, kNoSegment);
    addBlock(none, results, 0, colors, 0, threads, writer);
  }
  writer.end();
  file.commit();
}

}  // namespace segorient::program
