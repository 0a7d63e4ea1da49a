// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <gtest/gtest.h>
#include <segorient/search/median_hash_index.h>

#include <vector>

#include "orientation/paper/outward_components.h"
#include "oriented_shapes.h"

namespace segorient {
namespace {

using test::LabelledCloud;

// Components = faces, each oriented in itself; every second one starts turned over.
OrientationResult orient(const LabelledCloud& cloud, std::size_t faces) {
  search::MedianHashIndex index;
  index.build(test::pointsOf(cloud), nullptr, {});
  Neighborhoods neighbors;
  index.nearestKAll(13, neighbors);
  OrientationResult result;
  result.components.resize(faces);
  for (const int face : cloud.face) {
    result.point_signs.push_back(face % 2 == 0 ? std::int8_t{1} : std::int8_t{-1});
    result.point_confidences.push_back(1.F);
    result.point_components.push_back(face);
  }
  orientComponents(test::pointsOf(cloud), test::normalsOf(cloud), neighbors, {}, result);
  return result;
}

// All points outward, and the component of each face.
void expectOutward(const LabelledCloud& cloud, const OrientationResult& result) {
  std::size_t wrong = 0;
  for (const std::int8_t sign : result.point_signs) wrong += sign == 1 ? 0 : 1;
  EXPECT_EQ(wrong, 0U) << cloud.name;
}

TEST(ComponentSign, TurnsEachBodyOutward) {
  const LabelledCloud cloud = test::sample(
      "three", {test::sphere({0, 0, 0}, 1), test::sphere({3, 0, 0}, 0.7), test::torus(5, 0.3)},
      9000, 31);
  const OrientationResult result = orient(cloud, 3);
  expectOutward(cloud, result);
  ASSERT_EQ(result.components.size(), 3U);
  EXPECT_GE(result.components[0].points, result.components[1].points);
  EXPECT_GE(result.components[1].points, result.components[2].points);
  for (const ComponentOrientationResult& component : result.components) {
    EXPECT_GT(component.confidence, 0.8F);
  }
}

// A hollow ball with a ball in its cavity, and one more in that: walls face away from the material.
TEST(ComponentSign, TurnsCavitiesInward) {
  const LabelledCloud cloud =
      test::sample("nested",
                   {test::sphere({0, 0, 0}, 2), test::sphere({0.2, 0, 0}, 1.5, -1),
                    test::sphere({0.3, 0.1, 0}, 1), test::sphere({0.3, 0, 0}, 0.6, -1)},
                   20000, 32);
  const OrientationResult result = orient(cloud, 4);
  expectOutward(cloud, result);
  std::size_t enclosed = 0;
  for (const ComponentOrientationResult& component : result.components) {
    enclosed += component.by == DecidedBy::ENCLOSURE ? 1 : 0;
    EXPECT_GT(component.confidence, 0.5F);
  }
  EXPECT_EQ(enclosed, 3U);
}

// Within another's bounding box, yet outside of its material: the hole of a ring.
TEST(ComponentSign, IsNotFooledByBoundingBoxes) {
  const LabelledCloud cloud =
      test::sample("ring", {test::torus(2, 0.5), test::sphere({0, 0, 0}, 0.4)}, 9000, 33);
  expectOutward(cloud, orient(cloud, 2));
}

TEST(ComponentSign, IsUnsureAboutOpenSurfaces) {
  const LabelledCloud cloud = test::sample("bowl", {test::bowl({0, 0, 0}, 1)}, 6000, 34);
  const OrientationResult result = orient(cloud, 1);
  ASSERT_EQ(result.components.size(), 1U);
  EXPECT_LT(result.components[0].confidence, 0.6F);
}

}  // namespace
}  // namespace segorient
