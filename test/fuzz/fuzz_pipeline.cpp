// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <segorient/orientation/pipeline.h>
#include <segorient/surface/segment_mesh.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "structured_cloud.h"
#include "targets.h"

namespace segorient::test {
namespace {

constexpr std::size_t kMostPoints = 56;

PipelineOptions readOptions(ByteReader& reader) {
  PipelineOptions options;
  options.threads = 1;
  // The default most of all: it is what most people run.
  options.orientation.method = static_cast<OrientationMethod>(reader.below(8) % 6);
  options.k = static_cast<int>(reader.below(24));
  options.normals.estimator = static_cast<NormalEstimator>(reader.below(5));
  options.recomputations = static_cast<int>(reader.below(3));
  const std::uint8_t flags = reader.byte();
  if ((flags & 1U) != 0) options.orientation.boundary = BoundaryTest::TRIANGULATED;
  if ((flags & 2U) != 0) options.orientation.angle = SegmentAngle::REFERENCE_NORMALS;
  if ((flags & 4U) != 0) options.orientation.check_borders = false;
  if ((flags & 8U) != 0) options.recomputation.rule = RecomputationRule::MODIFIED_NEIGHBORHOODS;
  if ((flags & 16U) != 0) options.segmentation.small_size = 4;
  if ((flags & 32U) != 0) options.segmentation.connect_small = false;
  return options;
}

// 0 and -0 are the same, and so are NaNs.
bool sameNumbers(const float* a, const float* b) {
  for (int i = 0; i < 4; ++i) {
    if (a[i] != b[i] && !(std::isnan(a[i]) && std::isnan(b[i]))) return false;
  }
  return true;
}

void checkRows(const StructuredCloud& cloud, const OrientedCloud& out) {
  const std::size_t size = cloud.size();
  expectProperty(out.normals.size() == 4 * size && out.confidences.size() == size &&
                     out.components.size() == size && out.segmentation.labels.size() == size &&
                     out.segmentation.signs.size() == size,
                 "a result for each row");
  std::size_t without = 0;
  for (std::size_t i = 0; i < size; ++i) {
    const float* n = &out.normals[4 * i];
    const bool has_normal = isFinite(n);
    expectProperty(out.confidences[i] >= 0.F && out.confidences[i] <= 1.F, "confidence is 0 to 1");
    if (!has_normal) {
      ++without;
      expectProperty(std::isnan(n[0]) && std::isnan(n[1]) && std::isnan(n[2]),
                     "no normal is all NaN");
      expectProperty(out.segmentation.labels[i] == -1, "no label without a normal");
      continue;
    }
    expectProperty(isFinite(cloud.view()[i]), "an invalid point has no normal");
    const float length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    expectProperty(std::abs(length - 1.F) < 1e-4F, "normals are unit vectors");
    expectProperty(out.segmentation.labels[i] < static_cast<int>(out.segmentation.segments.size()),
                   "labels are those of segments");
  }
  expectProperty(out.report.without_normal == without, "the report counts missing normals");
}

void checkSegments(const OrientedCloud& out) {
  const Segmentation& s = out.segmentation;
  expectProperty(out.segments.size() == s.segments.size(), "each segment has an orientation");
  std::size_t members = 0;
  for (std::size_t label = 0; label < s.segments.size(); ++label) {
    members += s.segments[label].size;
    for (const pcl::index_t* p = s.begin(label); p != s.end(label); ++p) {
      expectProperty(s.labels[static_cast<std::size_t>(*p)] == static_cast<int>(label),
                     "members have their segment's label");
    }
  }
  expectProperty(members == s.members.size(), "segments hold all members");
}

void checkMeshes(const StructuredCloud& cloud, const OrientedCloud& out) {
  TriangulationOptions options;
  options.threads = 1;
  const std::vector<SegmentMesh> meshes =
      triangulateSegments(cloud.view(), out.segmentation, options, true);
  expectProperty(meshes.size() == out.segmentation.segments.size(), "a mesh for each segment");
  for (std::size_t label = 0; label < meshes.size(); ++label) {
    std::map<std::pair<pcl::index_t, pcl::index_t>, int> edges;
    std::vector<pcl::index_t> seen = meshes[label].duplicates;
    seen.insert(seen.end(), meshes[label].loose.begin(), meshes[label].loose.end());
    for (const auto& t : meshes[label].triangles) {
      for (std::size_t c = 0; c < 3; ++c) {
        seen.push_back(t[c]);
        ++edges[std::minmax(t[c], t[(c + 1) % 3])];
        expectProperty(t[c] != t[(c + 1) % 3], "corners differ");
      }
    }
    for (const auto& edge : edges) expectProperty(edge.second <= 2, "an edge has two sides");
    std::sort(seen.begin(), seen.end());
    seen.erase(std::unique(seen.begin(), seen.end()), seen.end());
    expectProperty(std::equal(seen.begin(), seen.end(), out.segmentation.begin(label),
                              out.segmentation.end(label)),
                   "every point is in a triangle or said not to be");
  }
}

void checkShuffled(const StructuredCloud& cloud, const PipelineOptions& options,
                   const OrientedCloud& out, std::uint32_t seed) {
  const std::vector<std::size_t> rows = shuffledRows(cloud.size(), seed);
  StructuredCloud other;
  for (const std::size_t row : rows) {
    const float* p = cloud.view()[row];
    other.add(p[0], p[1], p[2]);
  }
  const OrientedCloud again = orientCloud(other.view(), nullptr, options);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    expectProperty(sameNumbers(&again.normals[4 * i], &out.normals[4 * rows[i]]),
                   "normals do not depend on the order of the rows");
    expectProperty(again.segmentation.labels[i] == out.segmentation.labels[rows[i]],
                   "labels do not depend on the order of the rows");
  }
}

void checkThreads(const StructuredCloud& cloud, PipelineOptions options, const OrientedCloud& out) {
  options.threads = 2;
  const OrientedCloud again = orientCloud(cloud.view(), nullptr, options);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    expectProperty(sameNumbers(&again.normals[4 * i], &out.normals[4 * i]),
                   "normals do not depend on the threads");
  }
  expectProperty(again.segmentation.labels == out.segmentation.labels &&
                     again.confidences == out.confidences && again.components == out.components,
                 "nothing depends on the threads");
}

}  // namespace

void fuzzPipeline(const std::uint8_t* data, std::size_t size) {
  ByteReader reader(data, size);
  const PipelineOptions options = readOptions(reader);
  const std::uint8_t seed = reader.byte();
  const StructuredCloud cloud = readCloud(reader, kMostPoints);
  const OrientedCloud out = orientCloud(cloud.view(), nullptr, options);
  checkRows(cloud, out);
  checkSegments(out);
  checkMeshes(cloud, out);
  // Threads cost much more to start than all the rest.
  if (seed == 0) checkThreads(cloud, options, out);
  if (seed % 4 == 1) checkShuffled(cloud, options, out, seed);
}

}  // namespace segorient::test
