// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "tiles/cloud_field.h"

#include <utility>

#include "orientation/automatic/noise_field.h"
#include "orientation/automatic/patch_signs.h"

namespace segorient::detail {
namespace {

constexpr int kRing = 8;  // as many as the pairs that face each other are sought among

void addCells(const std::vector<float>& places, float unit, const std::vector<float>& vectors,
              float vector_unit, CloudField& out) {
  for (std::size_t c = 0; c < places.size(); c += 4) {
    FieldCell cell;
    for (std::size_t a = 0; a < 3; ++a) {
      cell.position[a] = unit * places[c + a];
      cell.vector[a] = vector_unit * vectors[c + a];
    }
    out.cells.push_back(cell);
  }
}

// 4 floats a cell.
std::vector<float> placesOf(const CloudField& field, float unit) {
  std::vector<float> out;
  for (const FieldCell& cell : field.cells) {
    for (const float x : cell.position) out.push_back(x / unit);
    out.push_back(0.F);
  }
  return out;
}

void takeNoise(const PointView& points, const Neighborhoods& neighborhoods, float unit,
               const CloudField& field, int threads, AutoNormals& found) {
  NoiseField noise;
  noise.places = placesOf(field, unit);
  for (const FieldCell& cell : field.cells) {
    for (const float x : cell.vector) noise.dipoles.push_back(x / (unit * unit));
    noise.dipoles.push_back(cell.value / (unit * unit));
    noise.keeps.push_back(cell.keeps != 0 ? 1 : 0);
  }
  noise.radius = field.radius / unit;
  noise.averaged_below = field.averaged_below;
  noise.consistent = field.noise == CloudField::kConsistentNoise;
  takeNoiseField(points, neighborhoods, noise, threads, found);
}

// Of rows that repeat a point, what the one says that stands for it.
struct FieldCloud {
  PreparedCloud cloud;
  std::vector<float> normals;
  std::vector<float> confidences;

  FieldCloud(const PointView& places, const std::vector<float>& of_rows,
             const std::vector<float>& sure, int threads)
      : cloud(places, nullptr, threads) {
    cloud.findNeighbors(kRing, false);
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      const float* n = &of_rows[4 * cloud.rowOf(i)];
      normals.insert(normals.end(), n, n + 4);
      confidences.push_back(sure[cloud.rowOf(i)]);
    }
  }
};

CloudField cellsOf(const NoiseField& noise, float unit) {
  CloudField out;
  if (noise.empty()) return out;
  out.noise = noise.consistent ? CloudField::kConsistentNoise : CloudField::kNoise;
  out.radius = unit * noise.radius;
  addCells(noise.places, unit, noise.dipoles, unit * unit, out);
  for (std::size_t c = 0; c < out.cells.size(); ++c) {
    out.cells[c].value = unit * unit * noise.dipoles[4 * c + 3];
    if (!noise.keeps.empty()) out.cells[c].keeps = noise.keeps[c];
  }
  return out;
}

void takeSigns(const PointView& points, float unit, const CloudField& field, int threads,
               AutoNormals& found) {
  CellSigns signs;
  signs.cells.places = placesOf(field, unit);
  for (const FieldCell& cell : field.cells) {
    signs.cells.normals.insert(signs.cells.normals.end(), cell.vector, cell.vector + 3);
    signs.cells.normals.push_back(0.F);
    signs.signs.push_back(cell.value);
  }
  assignCells(points, threads, signs.cells);
  takeCellSigns(points, signs, found);
}

}  // namespace

CloudField findNoise(const PointView& places, const std::vector<float>& normals,
                     const std::vector<float>& confidences, const KnownField& known, int threads) {
  FieldCloud of(places, normals, confidences, threads);
  const Neighborhoods& near = of.cloud.neighborhoods();
  if (known.consistent) of.confidences.clear();
  NoiseField noise =
      findNoiseField(of.cloud.points(), near, of.normals, threads, of.confidences, known);
  findWhatSheetsKeep(of.cloud.points(), near, of.normals, threads, noise);
  return cellsOf(noise, of.cloud.unit());
}

CloudField findFine(const PointView& places, const std::vector<float>& normals,
                    const std::vector<float>& confidences, int threads) {
  FieldCloud of(places, normals, confidences, threads);
  AutoNormals found;
  found.normals = std::move(of.normals);
  found.confidences = std::move(of.confidences);
  const NoiseField fine =
      takeFineField(of.cloud.points(), of.cloud.neighborhoods(), threads, found);
  CloudField out = cellsOf(fine, of.cloud.unit());
  out.averaged_below = fine.averaged_below;
  return out;
}

CloudField findSigns(const PreparedCloud& cloud, const std::vector<float>& normals, float spacing,
                     const AutoOrientation& orientation, const PointHints& hints, bool noisy,
                     int threads) {
  CloudField out;
  const CellSigns signs =
      findCellSigns(cloud.points(), normals, spacing, orientation, noisy, threads);
  if (signs.empty() ||
      contradictHints(cloud.points(), signs, normals, orientation.result.point_components,
                      orientation.inside_out, hints)) {
    return out;
  }
  out.radius = cloud.unit() * spacing;
  addCells(signs.cells.places, cloud.unit(), signs.cells.normals, 1.F, out);
  for (std::size_t c = 0; c < out.cells.size(); ++c) out.cells[c].value = signs.signs[c];
  return out;
}

void takeField(const PointView& points, const Neighborhoods& neighborhoods, float unit,
               const CloudField& field, int threads, AutoNormals& found) {
  if (field.cells.empty()) return;
  if (field.noise != 0) {
    takeNoise(points, neighborhoods, unit, field, threads, found);
  } else {
    takeSigns(points, unit, field, threads, found);
  }
}

}  // namespace segorient::detail
