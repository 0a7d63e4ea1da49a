// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <limits>

#include "common/bulk_bounds.h"
#include "common/parts.h"
#include "io/cloud_stream.h"
#include "support/command_line.h"
#include "support/hint_options.h"
#include "tiles/input_state.h"
#include "tiles/plan_inputs.h"
#include "tiles/plan_probe.h"
#include "tiles/plan_sensors.h"
#include "tiles/planned_input.h"
#include "tiles/point_files.h"
#include "tiles/point_sample.h"
#include "tiles/steps.h"
#include "tiles/tile_tree.h"

namespace segorient::program {
namespace {

using Place = TileTree::Place;

bool isFinite(const Place& p) {
  return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
}

// NaN where a file names none.
Place headerPlace(const CloudTable& block) {
  const Place here{block.viewpoint[0], block.viewpoint[1], block.viewpoint[2]};
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  return here != Place{0, 0, 0} ? here : Place{kUnknown, kUnknown, kUnknown};
}

// Draws a sample of all inputs: of those that are small enough all points are looked at, of others
// some of each of many pages from all over them, by no pattern that a file could have, too. Those
// of a page may lie side by side: few of them, so that what is measured between points of the
// sample is not only between those. \param begin called with each input's layout
template <typename Begin>
void drawSample(const Plan& plan, const StepProgress& progress, const Begin& begin,
                PointSample& sample, PlacesSaid& said) {
  constexpr std::uint64_t kAll = std::uint64_t{1} << 22;   // points
  constexpr std::uint64_t kRead = std::uint64_t{1} << 21;  // of more
  constexpr std::uint64_t kPage = 32;
  constexpr std::uint64_t kOfPage = 16;  // one of so many is taken
  constexpr std::size_t kSmallBuffer = 4096;
  const bool all = plan.rows <= kAll;
  const double share = static_cast<double>(kRead) / static_cast<double>(plan.rows);
  const auto limit = static_cast<std::uint64_t>(std::ldexp(all ? 0.5 : share, 64));
  for (const PlanInput& in : plan.inputs) {
    CloudStream stream(in.streamed, kSmallBuffer);
    begin(stream.layout());
    CloudTable block;
    const std::uint64_t page = all ? std::uint64_t{1} << 14 : kPage;
    for (std::uint64_t row = 0; row < in.rows; row += page) {
      if (!all && PointSample::scatter((in.first_row + row) / kPage) > limit) continue;
      stream.skipTo(row);
      if (!stream.next(block, static_cast<std::size_t>(page))) break;
      const auto xyz = block.xyz();
      const bool columns = block.hasViewpoints();
      const Place header = headerPlace(block);
      for (std::size_t i = 0; i < block.size; ++i) {
        if (!all && PointSample::scatter(in.first_row + row + i) % kOfPage != 0) continue;
        const Place place = block.triple(xyz, i);
        if (!isFinite(place)) continue;
        sample.add(in.first_row + row + i, place);
        if (plan.has_viewpoints) {
          said.add(columns ? block.triple(block.viewpoints(), i) : header, place);
        }
      }
      if (progress) {
        progress(0.35 * static_cast<double>(in.first_row + row) / static_cast<double>(plan.rows));
      }
    }
  }
}

// Where floats are exact enough: near the tile. Coordinates that were floats lose nothing, as the
// origin is a multiple of a power of two, and no farther from 0 than they are.
Place tileOrigin(const Bounds& bounds) {
  Place origin{0, 0, 0};
  if (bounds.points == 0 || !bounds.isFar()) return origin;
  const double step = std::exp2(std::ceil(std::log2(std::max(8.0 * bounds.extent(), 1e-30))));
  const Place middle = bounds.middle();
  for (std::size_t a = 0; a < 3; ++a) origin[a] = step * std::trunc(middle[a] / step);
  return origin;
}

// Space is not to be cut for the sake of a few points that are far from all others, at 0,0,0 say.
// \param most of the sample that any tile has room for beside its own
std::vector<Place> withoutStrays(const std::vector<Place>& sample, const Bounds& bulk,
                                 double most) {
  std::vector<Place> out;
  std::copy_if(sample.begin(), sample.end(), std::back_inserter(out),
               [&](const Place& p) { return bulk.contains(p); });
  const std::size_t strays = sample.size() - out.size();
  const bool few = 1000 * strays <= sample.size() && static_cast<double>(strays) <= most;
  return few ? out : sample;
}

// Of all tiles: such points do not count.
std::vector<Place> tileOrigins(const TileTree& tree, const std::vector<Place>& sample) {
  std::vector<std::vector<Place>> of_tiles(tree.tiles());
  double reach = 0.0;
  for (const Place& p : sample) of_tiles[tree.owner(p, reach)].push_back(p);
  std::vector<Place> origins;
  for (const std::vector<Place>& places : of_tiles) {
    origins.push_back(
        tileOrigin(bulkBounds(places.size(), [&](std::size_t i) { return places[i]; })));
  }
  return origins;
}

// Where points are said to have been seen from, or where that was found.
class Viewpoints {
 public:
  explicit Viewpoints(const PlanSensors& sensors) : sensors_(sensors) {}
  void begin(const CloudTable& layout) {
    columns_ = layout.hasViewpoints();
    header_ = headerPlace(layout);
  }
  std::array<float, 3> of(const CloudTable& block, std::size_t row, std::uint64_t number,
                          const Place& place, const Place& origin) const {
    Place said = columns_ ? block.triple(block.viewpoints(), row) : header_;
    const bool known = detail::saysPlace(said.data(), place.data());
    const bool keeps = sensors_.found() == 0 || (sensors_.completesGiven() && known);
    if (!keeps) return sensors_.of(number, near(place, origin));
    if (!known) said.fill(std::numeric_limits<double>::quiet_NaN());
    return near(said, origin);
  }

 private:
  const PlanSensors& sensors_;
  bool columns_ = false;
  Place header_{0, 0, 0};
};

// What coordinates are rounded to, so that they take fewer bits: the last digit of a float that is
// the smallest spacing. Floats lose nothing but nearer to 0 than that. 0 = not at all.
double roundingStep(const TileTree& tree) {
  constexpr double kSpacingsInReach = 20.0;
  constexpr int kBits = std::numeric_limits<float>::digits - 1;
  double least = std::numeric_limits<double>::infinity();
  for (const TileTree::Node& node : tree.nodes()) {
    if (node.axis < 0 && node.reach > 0.0) least = std::min(least, node.reach);
  }
  return std::isfinite(least) ? std::ldexp(1.0, std::ilogb(least / kSpacingsInReach) - kBits) : 0.0;
}

// \param out by point: whether it is one of the probe's
void findWanted(const Probe& probe, const StoredPoint* points, std::size_t size, int threads,
                std::vector<std::uint8_t>& out) {
  constexpr double kPointTime = 60.0;  // nanoseconds
  out.resize(size);
  const Parts parts(size, threads, kPointTime);
  parts.forEach([&](std::size_t part) {
    for (std::size_t i = parts.begin(part); i < parts.end(part); ++i) {
      out[i] = points[i].cell != kNoCell && probe.wants(points[i].place) ? 1 : 0;
    }
  });
}

// The second pass: each point to its tile.
void distribute(const std::string& folder, const StepProgress& progress, const PlanSensors& sensors,
                int threads, Probe& probe, Plan& plan) {
  PointFiles files(folder, plan.run, plan.tree, {plan.has_viewpoints, plan.hasNormals()}, threads);
  Viewpoints viewpoints(sensors);
  plan.step = roundingStep(plan.tree);
  const Trajectory trajectory = trajectoryOf(plan);
  std::vector<std::uint8_t> wanted;  // by row of a block
  std::uint64_t row = 0;
  TrajectoryJoin joined;
  for (std::uint32_t o = 0; o < plan.outputs.size(); ++o) {
    const auto visit = [&](CloudTable& block) {
      viewpoints.begin(block);
      StoredPoint* points = files.add(block.size);
      storePoints(plan, block, threads, points);
      findWanted(probe, points, block.size, threads, wanted);
      for (std::size_t i = 0; i < block.size; ++i, ++row) {
        StoredPoint& point = points[i];
        if (point.cell == kNoCell) continue;
        const Place place = block.triple(block.xyz(), i);
        if (plan.has_viewpoints) {
          point.seen_from = viewpoints.of(block, i, row, place, plan.origin);
        }
        if (plan.keep_orientation) {
          point.normal = near(block.triple(block.normals(), i), {0.0, 0.0, 0.0});
        } else if (plan.place.seen_within) {
          point.normal = sensors.directionOf(row, near(place, plan.origin));
        }
        if (wanted[i] != 0) {
          probe.add(point.place, plan.has_viewpoints ? point.seen_from.data() : nullptr,
                    plan.hasNormals() ? point.normal.data() : nullptr);
        }
        ++plan.finite;
      }
      if (progress) {
        progress(0.4 + 0.55 * static_cast<double>(row) / static_cast<double>(plan.rows));
      }
    };
    forEachBlock(
        plan, plan.outputs[o], trajectory, visit, [&] { files.endChunk(o); }, &joined);
  }
  if (trajectory.size() > 0) requireJoined(trajectory, joined, plan.trajectory);
  if (plan.finite == 0) {
    throw FileError(plan.inputs[0].path, "has no point with finite coordinates");
  }
  plan.tile_points = files.commit();
}

// What takes a quarter of the memory: a point as it is stored and its place in the order, and in
// writing the row with what is added to it.
std::uint64_t chunkRows(const TileRequest& request, std::size_t row_bytes) {
  constexpr std::size_t kAdded = 24;
  const std::size_t each = sizeof(StoredPoint) + sizeof(std::uint32_t) + kAdded + row_bytes;
  return std::max<std::uint64_t>(1, request.memory / (4 * each));
}

double mostPoints(const TileRequest& request, double points_each) {
  double most = static_cast<double>(request.tile_points);
  if (request.tile_points == 0) {
    const std::uint64_t room =
        request.memory > 2 * kBytesAnyway ? request.memory - kBytesAnyway : request.memory / 2;
    // The halo of a tile of a surface is as wide as 20 spacings: a tenth of a large tile.
    most = static_cast<double>(room) / (1.15 * static_cast<double>(kBytesPerPoint));
  }
  // A sample tells a tile's points to a few hundredths.
  constexpr double kSafe = 0.9;
  return std::max(1.0, points_each > 1.0 ? kSafe * most : most);
}

void followSensors(const PlanSensors& sensors, Plan& plan) {
  if (!sensors.followsGiven()) {
    plan.place_refused = plan.has_viewpoint || plan.has_viewpoints;
    plan.has_viewpoint = plan.has_viewpoints = false;
  }
  if (sensors.refusesUp()) {
    plan.place_refused = true;
    plan.up = false;
  }
  plan.place = sensors.place();
  plan.found_sensors = sensors.completesGiven() ? 0 : static_cast<std::uint32_t>(sensors.found());
  plan.has_viewpoints = plan.has_viewpoints || sensors.found() > 0;
}

}  // namespace

Plan planStep(const TileRequest& request, const std::string& folder, const StepProgress& progress) {
  Plan plan;
  planFiles(request, plan);
  if (std::filesystem::exists(planPath(folder))) {
    Plan known = loadPlan(folder);
    if (known.run == plan.run) return known;
    throw FileError(folder,
                    "has files of other inputs, outputs or options, or of an input that was "
                    "changed: remove it, or name another folder");
  }
  warnOfTextLeftOut(request.inputs);
  plan.k = request.k;
  plan.has_viewpoint = request.has_viewpoint;
  plan.viewpoint = request.viewpoint;
  plan.up = request.up;
  plan.closed = request.closed;
  plan.open = request.open;
  plan.find_sensors = request.find_sensors;
  plan.keep_orientation = request.keep_orientation;
  if (!request.trajectory.empty()) {
    plan.trajectory = std::filesystem::absolute(request.trajectory).lexically_normal().string();
  }
  plan.alpha = request.alpha;
  plan.beta = request.beta;
  plan.epsilon = request.epsilon;
  plan.memory = request.memory;
  openInputs(folder, plan);
  addSeeds(request.seeds, plan);
  PointSample sample;
  PlacesSaid said;
  std::size_t image_width = 0;
  std::size_t row_bytes = 0;
  drawSample(
      plan, progress,
      [&](const CloudTable& layout) {
        row_bytes = std::max(row_bytes, layout.row_bytes);
        image_width = imageWidth(layout, plan.rows);
      },
      sample, said);
  const std::vector<Place>& places = sample.places();
  const double points_each =
      static_cast<double>(plan.rows) / std::max(1.0, static_cast<double>(sample.places().size()));
  plan.bulk = bulkBounds(places.size(), [&](std::size_t i) { return places[i]; });
  if (plan.bulk.isFar()) plan.origin = plan.bulk.middle();
  constexpr double kRoom = 0.05;
  const double most_points = mostPoints(request, points_each);
  plan.tree = TileTree(withoutStrays(places, plan.bulk, kRoom * most_points / points_each),
                       points_each, most_points);
  plan.tile_origins = tileOrigins(plan.tree, places);
  plan.chunk_rows = chunkRows(request, row_bytes);
  plan.patch_points = static_cast<std::uint32_t>((plan.rows + kSamplePoints - 1) / kSamplePoints);
  Probe probe(places, points_each, plan.origin);
  // Columns of unknown places say no more than none, as in memory.
  if (plan.trajectory.empty() && said.none()) plan.has_viewpoints = false;
  const PlanSensors sensors(plan, sample, said, image_width, request.threads);
  followSensors(sensors, plan);
  distribute(folder, progress, sensors, request.threads, probe, plan);
  OrientationHints hints = hintsOf(plan, plan.origin);
  hints.viewpoints = probe.viewpoints();
  hints.normals = probe.normals();
  plan.traits = measureTileTraits(probe.points(), plan.k, hints, request.threads);
  // Its points are so much farther apart, and see as many of them.
  if (plan.traits.level > 1.F) plan.tree.widen(static_cast<double>(plan.traits.level));
  requireUnchanged(plan);
  savePlan(plan, folder);
  return plan;
}

}  // namespace segorient::program
