// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <set>

#include "partition_quality.h"
#include "segmentation/region_growing.h"
#include "segmentation/segment_graph.h"
#include "segmentation_support.h"

namespace segorient::test {
namespace {

constexpr float kDegree = 3.14159265F / 180.F;

SegmentationOptions growingOnly() {
  SegmentationOptions options;
  options.absorb_small = false;
  options.extract_edges = false;
  options.connect_small = false;
  options.settle_edges = false;
  options.neighbors = 0;
  return options;
}

// Growing as section 2.3 puts it, word by word.
std::vector<std::int32_t> growPlainly(const Prepared& in, const SegmentationOptions& options) {
  const std::size_t n = in.cloud.size();
  const auto normal = [&](std::size_t i) {
    return Eigen::Vector3f(in.normals[4 * i], in.normals[4 * i + 1], in.normals[4 * i + 2]);
  };
  std::vector<std::size_t> seeds(n);
  std::iota(seeds.begin(), seeds.end(), std::size_t{0});
  std::stable_sort(seeds.begin(), seeds.end(), [&](std::size_t a, std::size_t b) {
    return in.normals[4 * a + 3] < in.normals[4 * b + 3];
  });
  std::vector<std::int32_t> labels(n, -1);
  std::vector<Eigen::Vector3f> signed_normal(n);
  std::int32_t label = 0;
  for (const std::size_t seed : seeds) {
    if (labels[seed] >= 0) continue;
    Eigen::Vector3d sum(0, 0, 0);
    std::vector<std::size_t> queue;
    const auto accept = [&](std::size_t q, float sign) {
      labels[q] = label;
      signed_normal[q] = sign * normal(q);
      sum += signed_normal[q].cast<double>();
      if (q == seed || in.normals[4 * q + 3] <= options.max_curvature) queue.push_back(q);
    };
    accept(seed, 1.F);
    for (std::size_t head = 0; head < queue.size(); ++head) {
      const std::size_t p = queue[head];
      for (int j = 1; j < in.table.count(p); ++j) {
        const auto q = static_cast<std::size_t>(in.table.indices(p)[j]);
        if (labels[q] >= 0) continue;
        const float cosine = signed_normal[p].dot(normal(q));
        const float sign = cosine < 0 ? -1.F : 1.F;
        if (std::abs(cosine) < std::cos(options.alpha)) continue;
        const double to_reference = sign * normal(q).cast<double>().dot(sum.normalized());
        if (to_reference < std::cos(static_cast<double>(options.beta))) continue;
        accept(q, sign);
      }
    }
    ++label;
  }
  return labels;
}

std::size_t inRegular(const Segmentation& s) {
  std::size_t points = 0;
  for (const Segment& segment : s.segments) {
    if (segment.kind == SegmentKind::REGULAR) points += segment.size;
  }
  return points;
}

// What holds for every segmentation.
void expectConsistent(const Segmentation& s, const std::vector<float>& normals) {
  ASSERT_EQ(s.labels.size(), normals.size() / 4);
  ASSERT_EQ(s.signs.size(), s.labels.size());
  std::vector<std::size_t> counted(s.segments.size(), 0);
  for (const std::int32_t label : s.labels) {
    ASSERT_LT(label, static_cast<std::int32_t>(s.segments.size()));
    if (label >= 0) ++counted[static_cast<std::size_t>(label)];
  }
  for (std::size_t i = 0; i < s.segments.size(); ++i) {
    EXPECT_EQ(counted[i], s.segments[i].size);
    ASSERT_TRUE(std::is_sorted(s.begin(i), s.end(i)));
    if (i > 0) {
      EXPECT_GE(s.segments[i - 1].size, s.segments[i].size);
      if (s.segments[i - 1].size == s.segments[i].size) {
        EXPECT_LT(*s.begin(i - 1), *s.begin(i));
      }
    }
    Eigen::Vector3d sum(0, 0, 0);
    for (const auto* it = s.begin(i); it != s.end(i); ++it) {
      const auto p = static_cast<std::size_t>(*it);
      ASSERT_EQ(s.labels[p], static_cast<std::int32_t>(i));
      sum += static_cast<double>(s.signs[p]) *
             Eigen::Vector3d(normals[4 * p], normals[4 * p + 1], normals[4 * p + 2]);
    }
    const Eigen::Vector3d reference =
        Eigen::Vector3f(s.segments[i].reference_normal.data()).cast<double>();
    EXPECT_LT((sum.normalized() - reference).norm(), 1e-4) << "segment " << i;
    if (s.segments[i].kind != SegmentKind::REGULAR) continue;
    for (const auto* it = s.begin(i); it != s.end(i); ++it) {
      const auto p = static_cast<std::size_t>(*it);
      const Eigen::Vector3d n(normals[4 * p], normals[4 * p + 1], normals[4 * p + 2]);
      EXPECT_GT(s.signs[p] * n.dot(reference), 0.0);
    }
  }
}

TEST(RegionGrowing, EqualsPlainGrowing) {
  for (const double sigma : {0.0, 0.2}) {
    for (const auto& faces : {bracket(), cylinder()}) {
      const Prepared in(sample("solid", faces, 6000, 5, sigma));
      SegmentationOptions options = growingOnly();
      options.max_gap = 0;
      options.max_offset = 0;
      SegmentationReport report;
      const Segmentation s = in.segment(options, &report);
      const std::vector<std::int32_t> plain = growPlainly(in, options);
      EXPECT_EQ(report.grown, std::set<std::int32_t>(plain.begin(), plain.end()).size());
      EXPECT_DOUBLE_EQ(adjustedRandIndex(s.labels, plain), 1.0);
      expectConsistent(s, in.normals);
    }
  }
}

// A twentieth to most of the points are seeds here, and come in one order only.
TEST(RegionGrowing, ManySeedsComeFlattestFirst) {
  Prepared in(sample("bracket", bracket(), 6000, 5, 0.3));
  for (std::size_t i = 0; i < 500; ++i) in.normals[4 * i + 3] = 0.01F;  // then the index decides
  for (const float alpha : {0.5F * kDegree, 3.F * kDegree, 15.F * kDegree}) {
    SegmentationOptions options = growingOnly();
    options.alpha = alpha;
    options.max_gap = 0;
    options.max_offset = 0;
    options.max_curvature = std::numeric_limits<float>::lowest();  // nothing is passed on
    SegmentationReport report;
    const Segmentation s = in.segment(options, &report);
    const std::vector<std::int32_t> plain = growPlainly(in, options);
    EXPECT_GT(report.grown, in.cloud.size() / 20);
    EXPECT_EQ(report.grown, std::set<std::int32_t>(plain.begin(), plain.end()).size());
    EXPECT_DOUBLE_EQ(adjustedRandIndex(s.labels, plain), 1.0);
  }
}

TEST(RegionGrowing, TrueNormalsGiveTheFaces) {
  for (const auto& faces : {cube(), octagonalPrism(), steppedSolid(), bracket()}) {
    Prepared in(sample("solid", faces, 12000, 3));
    in.normals = in.cloud.normals;
    // Signs must not matter.
    for (std::size_t i = 0; i < in.cloud.size(); i += 3) {
      for (std::size_t c = 0; c < 3; ++c) in.normals[4 * i + c] = -in.normals[4 * i + c];
    }
    const Segmentation s = in.segment();
    // A point in a corner may have all of its neighbours on the other faces.
    const auto regular = std::count_if(s.segments.begin(), s.segments.end(), [](const Segment& x) {
      return x.kind == SegmentKind::REGULAR;
    });
    EXPECT_EQ(static_cast<std::size_t>(regular), faces.size());
    EXPECT_GE(adjustedRandIndex(s.labels, in.cloud.face), 0.999);
    expectConsistent(s, in.normals);
  }
}

TEST(RegionGrowing, FindsTheFacesOfSolids) {
  struct Case {
    const char* name;
    std::vector<Face> faces;
  };
  for (const Case& c : {Case{"cube", cube()}, Case{"prism", octagonalPrism()},
                        Case{"steps", steppedSolid()}, Case{"bracket", bracket()}}) {
    for (const double sigma : {0.0, 0.1}) {
      const Prepared in(sample(c.name, c.faces, 20000, 7, sigma));
      const Segmentation s = in.segment();
      expectConsistent(s, in.normals);
      const auto large = std::count_if(s.segments.begin(), s.segments.end(), [](const Segment& x) {
        return x.kind == SegmentKind::REGULAR && x.size >= 200;
      });
      EXPECT_EQ(static_cast<std::size_t>(large), c.faces.size()) << c.name << ", sigma " << sigma;
      EXPECT_GE(purity(s.labels, in.cloud.face), 0.98) << c.name << ", sigma " << sigma;
      EXPECT_GE(inRegular(s), in.cloud.size() * 99 / 100) << c.name << ", sigma " << sigma;
    }
  }
}

TEST(RegionGrowing, CylinderSidesAreStripsOfTwiceBeta) {
  const Prepared in(sample("cylinder", cylinder(), 20000, 2));
  SegmentationOptions options;
  EXPECT_GE(purity(in.segment(options).labels, in.cloud.face), 0.99);
  // The angles are those of growing and of the passes; settling looks at distances.
  options.settle_edges = false;
  const Segmentation s = in.segment(options);
  expectConsistent(s, in.normals);
  std::size_t caps = 0;
  for (const Segment& segment : s.segments) {
    if (segment.kind != SegmentKind::REGULAR) continue;
    if (std::abs(segment.reference_normal[2]) > 0.99F && segment.size > 1000) ++caps;
  }
  EXPECT_EQ(caps, 2U);
  for (std::size_t p = 0; p < in.cloud.size(); ++p) {
    const Segment& segment = s.segments[static_cast<std::size_t>(s.labels[p])];
    if (segment.kind != SegmentKind::REGULAR) continue;
    const float along = std::abs(in.normals[4 * p] * segment.reference_normal[0] +
                                 in.normals[4 * p + 1] * segment.reference_normal[1] +
                                 in.normals[4 * p + 2] * segment.reference_normal[2]);
    // The reference goes on moving after a point was accepted, but not by much: about 20 degrees,
    // as the sample falls, which differs between compilers.
    EXPECT_GT(along, std::cos(options.beta + options.epsilon + 25 * kDegree));
  }
}

TEST(RegionGrowing, PassesCanBeSwitched) {
  const Prepared in(sample("bracket", bracket(), 15000, 11));
  SegmentationOptions options = growingOnly();
  SegmentationReport grown;
  const Segmentation none = in.segment(options, &grown);
  EXPECT_EQ(grown.absorbed + grown.extracted + grown.connected, 0U);
  EXPECT_EQ(grown.isolated, grown.small);
  EXPECT_EQ(grown.regular + grown.isolated, grown.grown);

  options.absorb_small = true;
  SegmentationReport one;
  const Segmentation first = in.segment(options, &one);
  EXPECT_EQ(one.grown, grown.grown);
  EXPECT_GT(one.absorbed, 0U);
  EXPECT_EQ(one.extracted, 0U);
  EXPECT_EQ(one.regular + one.isolated, one.grown - one.absorbed);
  EXPECT_GT(inRegular(first), inRegular(none));

  options.extract_edges = true;
  SegmentationReport two;
  const Segmentation second = in.segment(options, &two);
  EXPECT_EQ(two.absorbed, one.absorbed);
  EXPECT_GT(two.extracted, 0U);
  EXPECT_EQ(inRegular(second), inRegular(first) + two.extracted);

  options.settle_edges = true;
  SegmentationReport settled;
  const Segmentation with_edges = in.segment(options, &settled);
  EXPECT_EQ(two.settled, 0U);
  EXPECT_GT(settled.settled, 0U);
  EXPECT_GT(purity(with_edges.labels, in.cloud.face), purity(second.labels, in.cloud.face));
  EXPECT_GT(inRegular(with_edges), inRegular(second));
  options.settle_edges = false;

  options.connect_small = true;
  SegmentationReport three;
  const Segmentation third = in.segment(options, &three);
  EXPECT_EQ(inRegular(third), inRegular(second));
  EXPECT_GT(three.connected, 0U);
  EXPECT_LT(three.connected + three.isolated, two.isolated);
  for (const Segmentation* s : {&none, &first, &second, &third, &with_edges}) {
    expectConsistent(*s, in.normals);
    for (const Segment& segment : s->segments) {
      if (segment.kind == SegmentKind::REGULAR) {
        EXPECT_GE(segment.size, options.small_size);
      } else if (segment.kind == SegmentKind::ISOLATED) {
        EXPECT_LT(segment.size, options.small_size);
      }
    }
  }
}

TEST(RegionGrowing, SmallSegmentsThatTouchAreConnected) {
  const Prepared in(sample("cube", cube(), 15000, 4));
  SegmentationOptions options;
  options.max_gap = 0;
  options.neighbors = 0;
  options.settle_edges = false;
  const Segmentation s = in.segment(options);
  const SegmentGraph graph = buildSegmentGraph(s, in.table);
  std::size_t borders = 0;
  for (const SegmentBorder& border : graph.borders) {
    const bool small_a =
        s.segments[static_cast<std::size_t>(border.a)].kind != SegmentKind::REGULAR;
    const bool small_b =
        s.segments[static_cast<std::size_t>(border.b)].kind != SegmentKind::REGULAR;
    EXPECT_FALSE(small_a && small_b) << border.a << " " << border.b;
    if (small_a != small_b) ++borders;
  }
  EXPECT_GT(borders, 0U);
}

TEST(RegionGrowing, DoesNotJumpGaps) {
  // Two coplanar squares; with 40 neighbours each reaches the other one.
  LabelledCloud cloud = sample("square", {parallelogram({0, 0, 0}, {1, 0, 0}, {0, 1, 0})}, 2500, 9);
  const LabelledCloud other =
      sample("square", {parallelogram({1.08, 0, 0}, {1, 0, 0}, {0, 1, 0})}, 2500, 10);
  cloud.xyz.insert(cloud.xyz.end(), other.xyz.begin(), other.xyz.end());
  cloud.normals.insert(cloud.normals.end(), other.normals.begin(), other.normals.end());
  cloud.face.insert(cloud.face.end(), 2500, 1);
  const Prepared in(std::move(cloud), 40);
  SegmentationOptions options;
  options.neighbors = 0;
  const Segmentation apart = in.segment(options);
  EXPECT_DOUBLE_EQ(purity(apart.labels, in.cloud.face), 1.0);
  EXPECT_GE(apart.segments[1].size, 2450U);
  options.max_gap = 0;
  const Segmentation joined = in.segment(options);
  EXPECT_GE(joined.segments[0].size, 4950U);
}

TEST(RegionGrowing, SidesOfAThinPlateStayApart) {
  for (const unsigned seed : {1U, 2U, 3U}) {
    const Prepared in(sample("plate", plate(2, 12000), 12000, seed), 10);
    const Segmentation s = in.segment();
    std::vector<std::int32_t> labels = s.labels;
    // The rim does not count: its normals are anything.
    for (std::size_t p = 0; p < labels.size(); ++p) {
      if (in.cloud.face[p] > 1) labels[p] = -1;
    }
    EXPECT_GE(purity(labels, in.cloud.face), 0.995) << "seed " << seed;
    EXPECT_GE(inRegular(s), in.cloud.size() * 7 / 10);
  }
}

TEST(RegionGrowing, ThreadsDoNotMatter) {
  const Prepared in(sample("holed", holedSolid(), 15000, 6, 0.1));
  SegmentationOptions options;
  options.threads = 1;
  const Segmentation one = in.segment(options);
  for (const int threads : {2, 4, 0}) {
    options.threads = threads;
    const Segmentation more = in.segment(options);
    EXPECT_EQ(one.labels, more.labels);
    EXPECT_EQ(one.signs, more.signs);
  }
}

TEST(RegionGrowing, ScaleDoesNotMatter) {
  const Prepared in(sample("bracket", bracket(), 8000, 6));
  // Distances would have to be scaled as well.
  Neighborhoods table;
  table.reset(in.cloud.size(), in.table.k(), false);
  for (std::size_t row = 0; row < in.cloud.size(); ++row) {
    table.setCount(row, in.table.count(row));
    std::copy_n(in.table.indices(row), in.table.count(row), table.mutableIndices(row));
  }
  const Segmentation s = segmentByNormals(viewOf(in.cloud.xyz), normalsOf(in.normals), table, {});
  // Powers of two change no mantissa; the last two would over- and underflow when squared.
  for (const float scale : {0x1p-30F, 0x1p20F, 0x1p-100F, 0x1p100F}) {
    std::vector<float> scaled = in.cloud.xyz;
    for (float& v : scaled) v *= scale;
    const Segmentation t = segmentByNormals(viewOf(scaled), normalsOf(in.normals), table, {});
    EXPECT_EQ(s.labels, t.labels) << scale;
  }
}

TEST(RegionGrowing, NormalsAndCurvaturesMayLieApart) {
  const Prepared in(sample("bracket", bracket(), 8000, 6));
  constexpr std::size_t kStride = 7;
  constexpr std::size_t kCurvature = 5;
  // Numbers that no stage may read.
  std::vector<float> apart(kStride * in.cloud.size(), std::numeric_limits<float>::quiet_NaN());
  for (std::size_t i = 0; i < in.cloud.size(); ++i) {
    std::copy_n(&in.normals[4 * i], 3, &apart[kStride * i]);
    apart[kStride * i + kCurvature] = in.normals[4 * i + 3];
  }
  const NormalView view(PointView{apart.data(), kStride, in.cloud.size()}, kCurvature);
  const Segmentation s =
      segmentByNormals(viewOf(in.cloud.xyz), normalsOf(in.normals), in.table, {});
  const Segmentation t = segmentByNormals(viewOf(in.cloud.xyz), view, in.table, {});
  EXPECT_EQ(s.labels, t.labels);
  EXPECT_EQ(s.signs, t.signs);
}

// Where neighbours are far from each other in memory, growing asks for it ahead in another way. Not
// exactly equal: sums that are made in another order round in another way.
TEST(RegionGrowing, OrderInMemoryDoesNotMatter) {
  const LabelledCloud cloud = sample("bracket", bracket(), 30000, 9, 0.1);
  const auto segmentIn = [&](const std::vector<std::size_t>& order) {
    LabelledCloud moved = cloud;
    for (std::size_t i = 0; i < order.size(); ++i)
      std::copy_n(&cloud.xyz[4 * order[i]], 4, &moved.xyz[4 * i]);
    const Segmentation s = Prepared(moved).segment();
    std::vector<int> labels(order.size());
    for (std::size_t i = 0; i < order.size(); ++i) labels[order[i]] = s.labels[i];
    return labels;
  };
  std::vector<std::size_t> order(cloud.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::shuffle(order.begin(), order.end(), std::mt19937(1));
  const std::vector<int> scattered = segmentIn(order);
  const auto cell = [&](std::size_t i) {
    const float* p = &cloud.xyz[4 * i];
    return std::array<float, 3>{std::floor(20.F * p[0]), std::floor(20.F * p[1]),
                                std::floor(20.F * p[2])};
  };
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return cell(a) < cell(b); });
  const std::vector<int> coherent = segmentIn(order);
  EXPECT_GE(adjustedRandIndex(scattered, coherent), 0.98);
  EXPECT_GE(adjustedRandIndex(scattered, cloud.face), 0.9);
}

TEST(RegionGrowing, MeasuresSegments) {
  Prepared in(sample("cube", cube(), 20000, 8));
  in.normals = in.cloud.normals;
  for (std::size_t i = 0; i < in.cloud.size(); ++i) in.cloud.xyz[4 * i] += 1000.F;
  const Segmentation s = in.segment();
  ASSERT_GE(s.segments.size(), 6U);
  for (std::size_t i = 0; i < 6; ++i) {
    const Segment& segment = s.segments[i];
    EXPECT_NEAR(segment.area, 1.F, 0.1F);
    EXPECT_NEAR(segment.rms, 0.F, 1e-3F);
    Eigen::Vector3d mean(0, 0, 0);
    for (const auto* it = s.begin(i); it != s.end(i); ++it) {
      const float* p = &in.cloud.xyz[4 * static_cast<std::size_t>(*it)];
      mean += Eigen::Vector3d(p[0], p[1], p[2]);
    }
    mean /= segment.size;
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(segment.centroid[static_cast<std::size_t>(c)], mean[c], 1e-3);
    }
  }
}

TEST(RegionGrowing, CurvatureLimitStopsSpreading) {
  const Prepared in(sample("cylinder", cylinder(), 8000, 3));
  SegmentationOptions options = growingOnly();
  options.max_curvature = 0.F;
  SegmentationReport limited;
  in.segment(options, &limited);
  options.max_curvature = std::numeric_limits<float>::max();
  SegmentationReport free;
  in.segment(options, &free);
  EXPECT_GT(limited.grown, 2 * free.grown);
}

}  // namespace
}  // namespace segorient::test
