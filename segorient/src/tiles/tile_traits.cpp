// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/automatic/noise_field.h"
#include "orientation/automatic/stages.h"
#include "search/prepared_cloud.h"
#include "tiles/tile_share.h"

namespace segorient {

TileTraits measureTileTraits(const PointView& points, int k, const OrientationHints& hints,
                             int threads) {
  PreparedCloud cloud(points, nullptr, threads);
  TileTraits out;
  if (cloud.size() == 0) return out;
  PipelineOptions pipeline;
  pipeline.k = k;
  pipeline.threads = threads;
  pipeline.orientation.automatic.find_sensors = false;
  const detail::AutoStages found = detail::runAutoStages(
      cloud, pipeline, resolveHints(hints, cloud), [](const char*, double) {});
  out.noise = found.sheets.noise.fine;
  out.wide_noise = found.sheets.noise.coarse;
  out.thin = found.sheets.noise.thin ? 1 : 0;
  out.residual = found.sheets.residual;
  out.scan = found.sheets.scan_scales ? 1 : 0;
  out.noisy = found.noise >= detail::kFewTellNothing ? 1 : 0;
  out.consistent = found.consistent ? 1 : 0;
  out.fine_field = found.fine_field ? 1 : 0;
  out.judged = found.scales.empty() ? 0 : 1;
  out.denoise = found.denoised ? 1 : 0;
  const AutomaticNormalTraits& surfaces = found.final_traits.surfaces;
  out.edges = found.final_traits.edges ? 1 : 0;
  out.edges_sampled = found.final_traits.edges_sampled ? 1 : 0;
  out.typical_offset = found.typical_offset;
  out.analytic = surfaces.analytic ? 1 : 0;
  out.cubic_edges = surfaces.cubic_edges ? 1 : 0;
  out.lines = found.sheets.lines ? 1U : 0U;
  out.surface_noise = static_cast<float>(surfaces.noise.length) * cloud.unit();
  out.surface_ratio = static_cast<float>(surfaces.noise.in_spacings);
  out.level = found.level;
  if (found.level > 0.F) {
    out.level_radius = found.level * found.spacing * cloud.unit();
    out.level_noise = found.level_sheets.noise.fine;
    out.level_wide_noise = found.level_sheets.noise.coarse;
    out.level_thin = found.level_sheets.noise.thin ? 1 : 0;
    out.level_residual = found.level_sheets.residual;
  }
  return out;
}

bool needsFinishing(const TileTraits& traits, const TileShare& share, const TileSigns& signs) {
  // Of sensors, the whole knows which are to be believed.
  if (!signs.toward.empty() || traits.level > 0.F) return true;
  // A point of a border has about eight neighbours across it: four of 100,000 points, less than
  // half of the one in 10,000 by which tiles may differ from the whole.
  constexpr double kMost = 3e-4;
  std::uint64_t points = 0;
  std::uint64_t wrong = 0;
  for (const std::uint32_t size : share.piece_sizes) points += size;
  const auto right = [&](std::int32_t piece) {
    const std::size_t p = static_cast<std::size_t>(piece);
    return p >= signs.pieces.size() || p >= share.piece_signs.size() ||
           signs.pieces[p] == share.piece_signs[p];
  };
  for (const TileVote& v : share.votes) {
    if (right(v.a) != right(v.b)) wrong += v.count;
  }
  return static_cast<double>(wrong) > kMost * static_cast<double>(points);
}

}  // namespace segorient
