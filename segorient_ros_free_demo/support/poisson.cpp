// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "support/poisson.h"

#include <segorient/search/median_hash_index.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>

#include "io/cloud_writer.h"
#include "io/output_file.h"
#include "render/scene.h"
#include "render/vtk/vtk_module.h"
#include "support/silence.h"

namespace segorient::program {
namespace {

// The surface over the points that have a normal, as a table with triangles.
CloudTable poissonSurface(const LocalPoints& points, const std::vector<float>& normals, int depth) {
  std::vector<std::array<float, 3>> places;
  std::vector<std::array<float, 3>> directions;
  for (std::size_t i = 0; i < points.view().size; ++i) {
    const float* p = points.view()[i];
    const float* n = &normals[4 * i];
    if (!std::isfinite(n[0]) || !isFinite(p)) continue;
    places.push_back({p[0], p[1], p[2]});
    directions.push_back({n[0], n[1], n[2]});
  }
  CloudTable table;
  for (const char* name : {"x", "y", "z"}) table.addField(name, 'F', 8);
  if (places.empty()) return table;
  const auto surface = [&] {
    // PCL's own remarks are no part of what this program says.
    const Silence silence;
    return vtkModule().poisson(places, directions, depth);
  }();
  table.size = table.width = surface.vertices.size();
  table.rows.resize(table.size * table.row_bytes);
  for (std::size_t i = 0; i < table.size; ++i) {
    for (std::size_t a = 0; a < 3; ++a) {
      const double v = static_cast<double>(surface.vertices[i][a]) + points.origin()[a];
      std::memcpy(table.at(table.fields[a], i), &v, sizeof(v));
    }
  }
  table.triangles = surface.triangles;
  return table;
}

// Distances from each row of `from` to the nearest row of `to`.
std::vector<double> distances(const PointView& from, const PointView& to) {
  search::MedianHashIndex index;
  index.build(to, nullptr, {});
  std::vector<double> out;
  for (std::size_t i = 0; i < from.size; ++i) {
    pcl::index_t nearest = 0;
    float squared = 0.F;
    if (index.nearestK(from[i], 1, &nearest, &squared) == 1) {
      out.push_back(std::sqrt(static_cast<double>(squared)));
    }
  }
  return out;
}

std::vector<double> distances(const PointView& from, const TrueSurface& truth) {
  std::vector<double> out;
  for (std::size_t i = 0; i < from.size && !truth.empty(); ++i) {
    out.push_back(truth.distance(from[i]));
  }
  return out;
}

std::string distancesText(const char* name, std::vector<double> d, double extent) {
  if (d.empty()) return {};
  std::sort(d.begin(), d.end());
  char text[160];
  std::snprintf(text, sizeof(text),
                "  %-26s median %.4f  p95 %.4f  largest %.4f %% of the extent\n", name,
                100.0 * d[d.size() / 2] / extent, 100.0 * d[d.size() * 95 / 100] / extent,
                100.0 * d.back() / extent);
  return text;
}

}  // namespace

std::string comparePoisson(const LocalPoints& points,
                           const std::array<std::vector<float>, 2>& normals, int depth,
                           const std::string& prefix, const TrueSurface& truth, ProgressBar& bar) {
  std::string text;
  const std::array<std::string, 2> names{"pcl", "ours"};
  OutputFile picture_file(prefix + ".png");
  std::vector<Picture> pictures;
  for (std::size_t i = 0; i < 2; ++i) {
    OutputFile file(prefix + "_" + names[i] + ".ply");
    bar.update("poisson", 0.6 + 0.2 * static_cast<double>(i));
    const CloudTable surface = poissonSurface(points, normals[i], depth);
    OutputCloud out(surface);
    out.triangles = &surface.triangles;
    writePly(out, file);
    file.commit();
    const LocalPoints vertices(surface);
    std::vector<float> near(3 * surface.size);  // the vertices in the points' frame
    for (std::size_t v = 0; v < surface.size; ++v) {
      const auto p = surface.position(v);
      for (std::size_t a = 0; a < 3; ++a) {
        near[3 * v + a] = static_cast<float>(p[a] - points.origin()[a]);
      }
    }
    const PointView view{near.data(), 3, surface.size};
    text += std::string("Poisson surface from ") + (i == 0 ? "PCL's" : "our") +
            " normals: " + std::to_string(surface.triangles.size()) + " triangles, " + file.path() +
            "\n";
    const double extent = points.extent();
    text += distancesText("surface to nearest point", distances(view, points.view()), extent);
    text += distancesText("point to nearest vertex", distances(points.view(), view), extent);
    text += distancesText("surface to the truth", distances(view, truth), extent);
    if (!surface.triangles.empty()) {
      pictures.push_back(drawScene(makeScene(surface, vertices, nullptr, Coloring::Normal, 0), {}));
    }
  }
  if (pictures.empty()) return text;
  writePng(beside(pictures), picture_file);
  picture_file.commit();
  return text + "written     " + picture_file.path() + "\n";
}

}  // namespace segorient::program
