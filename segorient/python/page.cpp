// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// The page that shows a cloud, from arrays that segorient/__init__.py has made.
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "render/page/page.h"

namespace py = pybind11;

namespace segorient {
namespace {

template <typename T>
using Rows = py::array_t<T, py::array::c_style | py::array::forcecast>;

template <typename T>
std::vector<T> valuesOf(const py::dict& given, const char* name) {
  if (!given.contains(name)) return {};
  const auto rows = given[name].cast<Rows<T>>();
  return {rows.data(), rows.data() + rows.size()};
}

std::vector<std::array<double, 3>> placesOf(const py::dict& given, const char* name) {
  const std::vector<double> values = valuesOf<double>(given, name);
  std::vector<std::array<double, 3>> places;
  for (std::size_t i = 0; i + 3 <= values.size(); i += 3) {
    places.push_back({values[i], values[i + 1], values[i + 2]});
  }
  return places;
}

// The page as one string of bytes.
py::bytes page(const Rows<float>& points, const py::dict& given, std::size_t most, int threads) {
  program::PageCloud cloud;
  cloud.points.data = points.data();
  cloud.points.stride = 3;
  cloud.points.size = static_cast<std::size_t>(points.size() / 3);
  cloud.title = given["title"].cast<std::string>();
  const auto origin = valuesOf<double>(given, "origin");
  std::copy_n(origin.begin(), 3, cloud.origin.begin());
  cloud.normals = valuesOf<float>(given, "normals");
  cloud.labels = valuesOf<std::uint32_t>(given, "labels");
  cloud.confidences = valuesOf<float>(given, "confidences");
  cloud.colors = valuesOf<std::uint32_t>(given, "colors");
  cloud.sensors = placesOf(given, "sensors");
  cloud.contradictions = placesOf(given, "contradictions");
  if (given.contains("segments")) {
    for (const auto& text : given["segments"].cast<std::vector<std::string>>()) {
      program::PageSegment segment;
      segment.text = text;
      cloud.segments.push_back(segment);
    }
  }
  std::string text;
  {
    const py::gil_scoped_release unlocked;
    writePage(cloud, {most, threads}, [&](std::string_view piece) { text += piece; });
  }
  return py::bytes(text);
}

}  // namespace

void definePage(py::module_& module) {
  module.def("page", &page);
}

}  // namespace segorient
