// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
//
// Whether pictures tell the truth, as a Markdown table: pixels that are red although all signs are
// right, and the share of red where one segment was turned over.
//   picture_benchmark [--open] [--size PIXELS] DIRECTORY [CLOUD.ply ...]
// DIRECTORY holds clouds with true normals (see true_clouds.h); without names, all closed ones are
// drawn (with --open, all others), from twelve directions. Each cloud is drawn with its true
// normals and, where the default method gets all signs right, with those that it finds. Turned are
// segments of at least 1 % of the points, one at a time: the largest, the smallest and those evenly
// between. Of the pixels that show the segment's front in the right picture, so many are to be red
// in the other.
#include <segorient/orientation/pipeline.h>

#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "io/readers.h"
#include "render/scene.h"
#include "render/splats.h"
#include "true_clouds.h"

namespace {

using namespace segorient;           // NOLINT(google-build-using-namespace)
using namespace segorient::program;  // NOLINT(google-build-using-namespace)

constexpr std::size_t kTurned = 5;  // segments of a cloud
constexpr std::uint32_t kGreen = 0x00ff00U;
constexpr std::uint32_t kGrey = 0x808080U;
// A face seen nearly from its edge, or nearly all of which is hidden, is a line of pixels that
// share their colour with what is beside it.
constexpr std::size_t kLeastPixels = 400;

bool isRed(const std::uint8_t* p) {
  return p[0] > p[1] + 25 && p[0] > p[2] + 25;
}

bool isGreen(const std::uint8_t* p) {
  return p[1] > 2 * p[0] && p[1] > 2 * p[2];
}

std::vector<View> directions(std::size_t size) {
  std::vector<View> views;
  for (const double elevation : {-60.0, -20.0, 20.0, 60.0}) {
    for (const double azimuth : {20.0, 140.0, 260.0}) {
      View view;
      view.width = view.height = size;
      view.azimuth = azimuth;
      view.elevation = elevation;
      views.push_back(view);
    }
  }
  return views;
}

// Segments to turn, by label.
std::vector<std::uint32_t> chosenSegments(const std::vector<std::int32_t>& labels) {
  std::map<std::int32_t, std::size_t> sizes;
  for (const std::int32_t label : labels) {
    if (label >= 0) ++sizes[label];
  }
  std::vector<std::pair<std::size_t, std::uint32_t>> large;
  for (const auto& [label, size] : sizes) {
    if (100 * size >= labels.size()) large.emplace_back(size, static_cast<std::uint32_t>(label));
  }
  std::sort(large.rbegin(), large.rend());
  std::vector<std::uint32_t> chosen;
  const std::size_t count = std::min(kTurned, large.size());
  for (std::size_t i = 0; i < count; ++i) {
    chosen.push_back(large[count == 1 ? 0 : i * (large.size() - 1) / (count - 1)].second);
  }
  return chosen;
}

struct Shares {
  double least = 1.0;
  std::size_t red = 0;
  std::size_t all = 0;
};

struct Task {
  CloudTable table;
  LocalPoints points;
  std::vector<float> normals;  // 4 floats a point
  std::vector<std::int32_t> labels;

  explicit Task(CloudTable t) : table(std::move(t)), points(table) {}
  Scene scene(const std::vector<float>& n) const {
    return makeScene(table, points, n.data(), Coloring::Normal, 0);
  }
};

std::size_t redPixels(const Task& task, const std::vector<View>& views) {
  const Scene scene = task.scene(task.normals);
  std::size_t red = 0;
  for (const View& view : views) {
    const Picture picture = drawScene(scene, view);
    for (std::size_t i = 0; i < picture.rgb.size(); i += 3) red += isRed(&picture.rgb[i]) ? 1U : 0U;
  }
  return red;
}

void addTurned(const Task& task, std::uint32_t segment, const std::vector<View>& views,
               Shares& shares) {
  Scene right = task.scene(task.normals);
  std::vector<float> turned = task.normals;
  for (std::size_t i = 0; i < task.labels.size(); ++i) {
    const bool member = task.labels[i] == static_cast<std::int32_t>(segment);
    for (std::size_t a = 0; a < 3 && member; ++a) turned[4 * i + a] *= -1.F;
  }
  for (std::size_t i = 0; i < right.splats.size(); ++i) {
    const bool member = task.labels[right.rows[i]] == static_cast<std::int32_t>(segment);
    right.splats[i].front = member ? kGreen : kGrey;
    right.splats[i].back = kGrey;
  }
  const Scene wrong = task.scene(turned);
  for (const View& view : views) {
    const Picture seen = drawScene(right, view);
    const Picture picture = drawScene(wrong, view);
    std::size_t all = 0;
    std::size_t red = 0;
    for (std::size_t i = 0; i < seen.rgb.size(); i += 3) {
      if (!isGreen(&seen.rgb[i])) continue;
      ++all;
      red += isRed(&picture.rgb[i]) ? 1U : 0U;
    }
    if (all < kLeastPixels) continue;
    shares.red += red;
    shares.all += all;
    shares.least = std::min(shares.least, static_cast<double>(red) / static_cast<double>(all));
  }
}

bool show(const std::string& name, const char* what, const Task& task,
          const std::vector<View>& views) {
  const std::size_t red = redPixels(task, views);
  Shares shares;
  for (const std::uint32_t segment : chosenSegments(task.labels)) {
    addTurned(task, segment, views, shares);
  }
  std::printf("| %s | %s | %zu | ", name.c_str(), what, red);
  if (shares.all == 0) {
    std::printf("| |\n");
  } else {
    std::printf("%.3f | %.3f |\n",
                static_cast<double>(shares.red) / static_cast<double>(shares.all), shares.least);
  }
  std::fflush(stdout);
  return red == 0 && shares.least >= 0.95;
}

bool showCloud(const std::string& directory, const std::string& name,
               const std::vector<View>& views) {
  Task task(readCloud(directory + "/" + name));
  const NormalSource truth(task.table, nullptr);
  OrientedCloud found = orientCloud(task.points.view(), nullptr, {});
  task.labels.assign(found.segmentation.labels.begin(), found.segmentation.labels.end());
  bool right = true;
  for (std::size_t i = 0; i < task.table.size; ++i) {
    const auto n = truth.at(i);
    task.normals.insert(task.normals.end(), {n[0], n[1], n[2], 0.F});
    const float* f = &found.normals[4 * i];
    right = right && n[0] * f[0] + n[1] * f[1] + n[2] * f[2] > 0.F;
  }
  bool good = show(name, "true", task, views);
  if (right) {
    task.normals = std::move(found.normals);
    good = show(name, "found", task, views) && good;
  }
  return good;
}

}  // namespace

int main(int argc, char** argv) {
  bool open = false;
  std::size_t size = 600;
  std::vector<std::string> words(argv + 1, argv + argc);
  while (!words.empty() && words[0].rfind("--", 0) == 0) {
    const bool sized = words[0] == "--size" && words.size() > 1;
    if (sized) size = std::stoul(words[1]);
    open = open || words[0] == "--open";
    words.erase(words.begin(), words.begin() + (sized ? 2 : 1));
  }
  if (words.empty()) {
    std::fprintf(stderr,
                 "usage: picture_benchmark [--open] [--size PIXELS] DIRECTORY [CLOUD.ply ...]\n");
    return 2;
  }
  std::vector<std::string> names(words.begin() + 1, words.end());
  if (names.empty()) {
    for (const auto& [name, closed] : benchmark::listClouds(words[0])) {
      if (closed != open) names.push_back(name);
    }
  }
  std::printf(
      "| cloud | normals | red pixels, all right | red share, one segment turned | least |\n");
  std::printf("|---|---|---|---|---|\n");
  bool good = true;
  for (const std::string& name : names) good = showCloud(words[0], name, directions(size)) && good;
  return good ? 0 : 1;
}
