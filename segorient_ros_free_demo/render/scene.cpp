// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "render/scene.h"

#include <algorithm>
#include <cmath>

#include "common/threads.h"
#include "render/splats.h"

namespace segorient::program {
namespace {

void addMesh(const CloudTable& table, const PointView& points, const Palette& palette,
             Scene& scene) {
  for (std::size_t i = 0; i < points.size; ++i) {
    scene.vertices.push_back({points[i][0], points[i][1], points[i][2]});
  }
  for (const Triangle& t : table.triangles) {
    const bool whole =
        std::all_of(t.begin(), t.end(), [&](std::uint32_t v) { return isFinite(points[v]); });
    if (!whole) continue;
    scene.triangles.push_back(t);
    const auto& a = scene.vertices[t[0]];
    const auto& b = scene.vertices[t[1]];
    const auto& c = scene.vertices[t[2]];
    std::array<float, 3> normal{};
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t u = (k + 1) % 3;
      const std::size_t v = (k + 2) % 3;
      normal[k] = (b[u] - a[u]) * (c[v] - a[v]) - (b[v] - a[v]) * (c[u] - a[u]);
    }
    const float length = std::hypot(normal[0], normal[1], normal[2]);
    const bool flat = length > 0.F && std::isfinite(length);
    for (float& v : normal) v = flat ? v / length : 0.F;
    palette.setTriangle(t[0], normal, scene.front.emplace_back(), scene.back.emplace_back());
  }
  // Vertices of no triangle are not seen and shall not stretch the picture.
  std::vector<char> used(scene.vertices.size(), 0);
  for (const Triangle& t : scene.triangles) {
    for (const std::uint32_t v : t) used[v] = 1;
  }
  for (std::size_t i = 0; i < used.size() && !scene.triangles.empty(); ++i) {
    if (used[i] == 0) scene.vertices[i] = scene.vertices[scene.triangles[0][0]];
  }
}

void addMarkers(const std::vector<std::array<double, 3>>& places, Marker::Kind kind,
                const LocalPoints& points, Scene& scene) {
  for (const auto& place : places) {
    Marker marker;
    marker.kind = kind;
    for (std::size_t a = 0; a < 3; ++a) {
      marker.position[a] = static_cast<float>(place[a] - points.origin()[a]);
    }
    scene.markers.push_back(marker);
  }
}

}  // namespace

Scene makeScene(const CloudTable& table, const LocalPoints& points, const float* normals,
                Coloring coloring, int threads, const Facts& facts) {
  Scene scene;
  const Palette palette(table, coloring, facts);
  if (!table.triangles.empty()) {
    addMesh(table, points.view(), palette, scene);
  } else {
    scene.splats = makeSplats(points.view(), NormalSource(table, normals), threads, scene.rows);
    const auto count = static_cast<std::ptrdiff_t>(scene.rows.size());
#pragma omp parallel for num_threads(resolveThreads(threads))
    for (std::ptrdiff_t i = 0; i < count; ++i) {
      Splat& s = scene.splats[static_cast<std::size_t>(i)];
      s.side =
          palette.set(scene.rows[static_cast<std::size_t>(i)], s.normal, s.side, s.front, s.back);
    }
  }
  addMarkers(facts.sensors, Marker::Kind::Sensor, points, scene);
  addMarkers(facts.contradictions, Marker::Kind::Wrong, points, scene);
  return scene;
}

ShownSides shownSides(const Scene& scene) {
  ShownSides shown;
  for (const Splat& s : scene.splats) {
    const bool none = !std::isfinite(s.normal[0]);
    shown.none = shown.none || none;
    shown.wrong = shown.wrong || isWrong(s.side);
    shown.backs = shown.backs || (!none && !isClosed(s.side));
  }
  return shown;
}

Picture drawViews(const Scene& scene, const View& view, bool both) {
  if (!both) return drawScene(scene, view);
  View left = view;
  left.width /= 2;
  View right = left;
  right.azimuth += 180.0;
  right.elevation = -right.elevation;
  return beside({drawScene(scene, left), drawScene(scene, right)});
}

}  // namespace segorient::program
