// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// The part of the Python package that is compiled: takes float arrays that segorient/__init__.py
// has checked, runs the library without the interpreter's lock, and hands its results over without
// copies.
#include <pybind11/functional.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <segorient/orientation/check_normals.h>
#include <segorient/orientation/first_stages.h>
#include <segorient/orientation/pipeline.h>
#include <segorient/orientation/sensors.h>
#include <segorient/orientation/trajectory.h>
#include <segorient/search/median_hash_index.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <utility>

#include "common/bulk_bounds.h"
#include "orientation/report_fields.h"

namespace py = pybind11;

namespace segorient {
namespace {

using FloatArray = py::array_t<float>;

constexpr float kDegree = 0.017453292519943295F;

// Rows of three floats where they are; __init__.py has seen to it that they can be viewed.
PointView viewOf(const FloatArray& array) {
  PointView view;
  if (array.ndim() == 2 && array.shape(0) == 0) return view;  // strides then mean nothing
  constexpr py::ssize_t kFloat = sizeof(float);
  if (array.ndim() != 2 || array.shape(1) != 3 || array.strides(1) != kFloat ||
      array.strides(0) < 0 || array.strides(0) % kFloat != 0) {
    throw std::invalid_argument("points must be rows of three consecutive floats");
  }
  view.data = array.data();
  view.stride = static_cast<std::size_t>(array.strides(0) / kFloat);
  view.size = static_cast<std::size_t>(array.shape(0));
  return view;
}

// An array that views memory of `owner`, which it keeps alive.
template <typename T, typename Owner>
py::array_t<T> view(std::vector<py::ssize_t> shape, std::vector<py::ssize_t> strides, const T* data,
                    const std::shared_ptr<Owner>& owner) {
  auto* kept = new std::shared_ptr<Owner>(owner);
  const py::capsule base(kept, [](void* p) { delete static_cast<std::shared_ptr<Owner>*>(p); });
  return py::array_t<T>(std::move(shape), std::move(strides), data, base);
}

template <typename T>
py::array_t<T> column(std::vector<T> values) {
  auto owner = std::make_shared<std::vector<T>>(std::move(values));
  const auto size = static_cast<py::ssize_t>(owner->size());
  return view({size}, {sizeof(T)}, owner->data(), owner);
}

// (normals, curvatures) from 4 floats a row.
py::tuple normalArrays(std::vector<float> normals) {
  auto owner = std::make_shared<std::vector<float>>(std::move(normals));
  const auto rows = static_cast<py::ssize_t>(owner->size() / 4);
  constexpr py::ssize_t kFloat = sizeof(float);
  return py::make_tuple(view({rows, 3}, {4 * kFloat, kFloat}, owner->data(), owner),
                        view({rows}, {4 * kFloat}, owner->data() + 3, owner));
}

constexpr std::array<std::pair<const char*, NormalEstimator>, 6> kEstimators{
    {{"auto", NormalEstimator::AUTO},
     {"plane", NormalEstimator::PLANE},
     {"lct", NormalEstimator::LCT},
     {"ldt", NormalEstimator::LDT},
     {"awas", NormalEstimator::AWAS_QUADRATIC},
     {"awas3", NormalEstimator::AWAS_CUBIC}}};

NormalEstimator estimatorNamed(const std::string& name) {
  for (const auto& [known, estimator] : kEstimators) {
    if (name == known) return estimator;
  }
  throw std::invalid_argument(
      "normals must be 'auto', 'plane', 'lct', 'ldt', 'awas' or 'awas3', not '" + name + "'");
}

void setAngle(const py::dict& given, const char* name, float& out) {
  if (given.contains(name)) out = kDegree * given[name].cast<float>();
}

// Settings by their names on the command line, angles in degrees; those not given stay.
PipelineOptions optionsFrom(const py::dict& given) {
  PipelineOptions options;
  if (given.contains("k")) options.k = given["k"].cast<int>();
  if (given.contains("threads")) options.threads = given["threads"].cast<int>();
  if (given.contains("recompute")) options.recomputations = given["recompute"].cast<int>();
  if (given.contains("normals")) {
    options.normals.estimator = estimatorNamed(given["normals"].cast<std::string>());
  }
  if (given.contains("method") &&
      !fromString(given["method"].cast<std::string>(), options.orientation.method)) {
    throw std::invalid_argument(
        "method must be 'auto', 'propagation', 'boundary', 'combined', 'extremal' or 'hoppe', not "
        "'" +
        given["method"].cast<std::string>() + "'");
  }
  setAngle(given, "alpha", options.segmentation.alpha);
  setAngle(given, "alpha", options.orientation.automatic.alpha);
  setAngle(given, "beta", options.segmentation.beta);
  setAngle(given, "beta", options.orientation.automatic.beta);
  setAngle(given, "epsilon", options.segmentation.epsilon);
  setAngle(given, "epsilon", options.orientation.automatic.epsilon);
  setAngle(given, "gamma", options.orientation.gamma);
  setAngle(given, "delta", options.recomputation.delta);
  if (given.contains("delta")) {
    options.recomputation.rule = RecomputationRule::MODIFIED_NEIGHBORHOODS;
  }
  return options;
}

std::vector<float> rowsOf(const py::handle& array) {
  const auto rows = array.cast<py::array_t<float, py::array::c_style | py::array::forcecast>>();
  return {rows.data(), rows.data() + rows.size()};
}

std::shared_ptr<const OrientationHints> hintsFrom(const py::dict& given) {
  auto hints = std::make_shared<OrientationHints>();
  if (given.contains("suggested")) {
    const std::vector<float> v = rowsOf(given["suggested"]);
    hints->suggested = {{v[0], v[1], v[2]}};
  }
  if (given.contains("closed")) {
    hints->surface = given["closed"].cast<bool>() ? SurfaceKind::CLOSED : SurfaceKind::OPEN;
  }
  if (given.contains("viewpoint")) {
    hints->has_viewpoint = true;
    const std::vector<float> v = rowsOf(given["viewpoint"]);
    std::copy_n(v.begin(), 3, hints->viewpoint.begin());
  }
  if (given.contains("viewpoints")) hints->viewpoints = rowsOf(given["viewpoints"]);
  if (given.contains("direction")) {
    hints->has_direction = true;
    const std::vector<float> v = rowsOf(given["direction"]);
    std::copy_n(v.begin(), 3, hints->direction.begin());
  }
  if (given.contains("scans")) {
    const auto scans = given["scans"].cast<py::array_t<std::int32_t, py::array::c_style>>();
    hints->scans.assign(scans.data(), scans.data() + scans.size());
  }
  if (given.contains("grid")) {
    const auto shape = given["grid"].cast<std::array<std::size_t, 2>>();
    hints->grids.push_back({0, shape[1], shape[0]});
  }
  if (given.contains("keep")) hints->normals = rowsOf(given["keep"]);
  if (given.contains("seeds")) {
    const std::vector<float> v = rowsOf(given["seeds"]);
    for (std::size_t i = 0; i + 6 <= v.size(); i += 6) {
      hints->seeds.push_back({{v[i], v[i + 1], v[i + 2]}, {v[i + 3], v[i + 4], v[i + 5]}});
    }
  }
  return hints;
}

// Between stages the interpreter may end the work (Ctrl-C), and the caller hears how far it is.
PipelineProgress progressTo(const py::object& callback) {
  return [callback](const char* stage, double fraction) {
    const py::gil_scoped_acquire lock;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    if (!callback.is_none()) callback(stage, fraction);
  };
}

const char* nameOf(NormalEstimator estimator) {
  for (const auto& [name, known] : kEstimators) {
    if (estimator == known) return name;
  }
  return "auto";
}

// A list of what a report lists, one dictionary an item.
template <typename Items>
py::list listOf(const Items& items) {
  py::list out;
  for (const auto& item : items) {
    py::dict fields;
    detail::fieldsOf(item, {}, [&](const char* name, auto value) { fields[name] = value; });
    out.append(fields);
  }
  return out;
}

void addSegments(const OrientedCloud& cloud, py::dict& out) {
  std::vector<detail::ReportedSegment> segments;
  py::list hard;
  for (std::size_t i = 0; i < cloud.segments.size(); ++i) {
    segments.push_back({i, cloud.segmentation.segments[i], cloud.segments[i]});
    if (cloud.segments[i].hard) hard.append(i);
  }
  out["segments"] = listOf(segments);
  out["hard_segments"] = hard;
}

// The same names and values as --report.
py::dict reportOf(const OrientedCloud& cloud) {
  const PipelineReport& report = cloud.report;
  py::dict out;
  out["points"] = report.points;
  out["non_finite"] = report.non_finite;
  out["duplicates"] = report.duplicates;
  out["without_normal"] = report.without_normal;
  out["k"] = report.k;
  out["normals"] = report.method == OrientationMethod::AUTO ? "own" : nameOf(report.estimator);
  out["normals_chosen"] = report.normals_chosen;
  out["method"] = toString(report.method);
  out["spacing"] = report.spacing;
  out["noise_in_spacings"] = report.noise;
  out["denoised"] = report.denoised;
  py::dict kinds;
  kinds["regular"] = report.regular_segments;
  kinds["connected"] = report.connected_segments;
  kinds["isolated"] = report.isolated_segments;
  kinds["hard"] = report.hard_segments;
  out["segments_by_kind"] = kinds;
  py::dict seconds;
  for (const StageTime& s : report.stages) seconds[s.stage.c_str()] = s.seconds;
  seconds["total"] = report.seconds;
  out["seconds"] = seconds;
  out["peak_memory_bytes"] = report.peak_memory;
  out["components"] = listOf(report.components);
  out["clusters"] = listOf(report.clusters);
  out["scales"] = listOf(report.scales);
  out["scale_components"] = listOf(detail::componentsOf(report.scales));
  out["contradictions"] = listOf(report.contradictions);
  out["known_sensors"] = listOf(report.known_sensors);
  out["seeds_left_out"] = report.seeds_left_out;
  out["sensors"] = listOf(report.sensors.sensors);
  addSegments(cloud, out);
  return out;
}

py::tuple sensors(const FloatArray& points, const py::object& suggestions, std::size_t image_width,
                  int threads) {
  const PointView rows = viewOf(points);
  SensorOptions options;
  options.threads = threads;
  options.image_width = image_width;
  options.suggestions.clear();
  const std::vector<float> places = rowsOf(suggestions);
  for (std::size_t i = 0; i + 3 <= places.size(); i += 3) {
    options.suggestions.push_back({places[i], places[i + 1], places[i + 2]});
  }
  SensorReport report;
  {
    const py::gil_scoped_release unlocked;
    report = findSensors(rows, options);
  }
  const py::list found = listOf(report.sensors);
  return py::make_tuple(found, column(std::move(report.sensor_of)), report.deviation, report.chance,
                        report.why, column(std::move(report.directions)), report.faces_up);
}

py::tuple orient(const FloatArray& points, const py::dict& given, const py::object& progress) {
  const PointView rows = viewOf(points);
  PipelineOptions options = optionsFrom(given);
  options.orientation.hints = hintsFrom(given);
  if (given.contains("find_sensors"))
    options.orientation.automatic.find_sensors = given["find_sensors"].cast<bool>();
  const PipelineProgress callback = progressTo(progress);
  OrientedCloud cloud;
  {
    const py::gil_scoped_release unlocked;
    cloud = orientCloud(rows, nullptr, options, callback);
  }
  const py::dict report = reportOf(cloud);
  const py::tuple normals = normalArrays(std::move(cloud.normals));
  return py::make_tuple(normals[0], normals[1], column(std::move(cloud.segmentation.labels)),
                        column(std::move(cloud.confidences)), column(std::move(cloud.components)),
                        report);
}

py::tuple normals(const FloatArray& points, const py::dict& given, const py::object& progress) {
  const PointView rows = viewOf(points);
  const PipelineOptions options = optionsFrom(given);
  const PipelineProgress callback = progressTo(progress);
  std::vector<float> result;
  {
    const py::gil_scoped_release unlocked;
    FirstStages stages(rows, options, callback);
    stages.findNormals();
    result = stages.normals();
  }
  return normalArrays(std::move(result));
}

py::tuple segment(const FloatArray& points, const py::dict& given, const py::object& progress) {
  const PointView rows = viewOf(points);
  PipelineOptions options = optionsFrom(given);
  options.segmentation.unite_smooth = given.contains("faces") && given["faces"].cast<bool>();
  const PipelineProgress callback = progressTo(progress);
  OrientedCloud cloud;
  {
    const py::gil_scoped_release unlocked;
    cloud = segmentCloud(rows, options, callback);
  }
  std::vector<std::uint8_t> kinds;
  for (const Segment& s : cloud.segmentation.segments) {
    kinds.push_back(static_cast<std::uint8_t>(s.kind));
  }
  const py::tuple normals = normalArrays(std::move(cloud.normals));
  return py::make_tuple(column(std::move(cloud.segmentation.labels)), column(std::move(kinds)),
                        normals[0], normals[1]);
}

// (faults, places, report) of normals that a cloud has.
py::tuple check(const FloatArray& points, const FloatArray& normals, const py::dict& given,
                const py::object& progress) {
  const PointView rows = viewOf(points);
  PipelineOptions options = optionsFrom(given);
  const std::shared_ptr<const OrientationHints> hints = hintsFrom(given);
  options.orientation.hints = hints;
  const std::vector<float> own = rowsOf(normals);
  const PipelineProgress callback = progressTo(progress);
  NormalCheck found;
  {
    const py::gil_scoped_release unlocked;
    const OrientedCloud ours = orientCloud(rows, nullptr, options, callback);
    found = checkNormals(rows, own, ours, *hints, options.threads);
  }
  py::dict report;
  report["points"] = found.faults.size();
  report["judged"] = found.judged;
  report["contradicting"] = found.at_fault;
  report["share"] = found.judged == 0
                        ? 0.0
                        : static_cast<double>(found.at_fault) / static_cast<double>(found.judged);
  report["without_normal"] = found.without_normal;
  report["unlike"] = found.unlike;
  report["places"] = listOf(found.places);
  report["scans"] = listOf(found.scans);
  std::vector<std::uint8_t> faults;
  for (const NormalFault f : found.faults) faults.push_back(static_cast<std::uint8_t>(f));
  return py::make_tuple(column(std::move(faults)), column(std::move(found.place_of)), report);
}

// (viewpoints: (n, 3) in double, points joined, points outside, why there are none)
py::tuple trajectoryViewpoints(
    const py::array_t<double, py::array::c_style | py::array::forcecast>& rows,
    const py::array_t<double, py::array::c_style | py::array::forcecast>& at) {
  std::vector<Trajectory::Pose> poses;
  for (py::ssize_t i = 0; i < rows.shape(0); ++i) {
    poses.push_back({rows.at(i, 0), {rows.at(i, 1), rows.at(i, 2), rows.at(i, 3)}});
  }
  const Trajectory trajectory(std::move(poses));
  TrajectoryJoin join =
      joinTrajectory(trajectory, std::vector<double>(at.data(), at.data() + at.size()));
  const std::string reason = join.joined == 0 ? explainNoOverlap(trajectory, join) : std::string();
  auto owner = std::make_shared<std::vector<double>>(std::move(join.viewpoints));
  constexpr py::ssize_t kDouble = sizeof(double);
  return py::make_tuple(view({at.size(), 3}, {3 * kDouble, kDouble}, owner->data(), owner),
                        join.joined, join.outside, reason);
}

// Distances in place of squared ones; what a row lacks is -1 and infinitely far.
void finishTable(Neighborhoods& table) {
  for (std::size_t row = 0; row < table.size(); ++row) {
    pcl::index_t* indices = table.mutableIndices(row);
    float* distances = table.mutableSqrDistances(row);
    for (int j = 0; j < table.k(); ++j) {
      const bool there = j < table.count(row);
      if (!there) indices[j] = -1;
      distances[j] = there ? std::sqrt(distances[j]) : INFINITY;
    }
  }
}

void searchQueries(const search::MedianHashIndex& index, const PointView& queries, int k,
                   Neighborhoods& table) {
  std::vector<std::vector<pcl::index_t>> indices;
  std::vector<std::vector<float>> distances;
  index.nearestKBatch(queries, k, indices, distances, index.epsilon());
  table.reset(queries.size, k);
  for (std::size_t i = 0; i < queries.size; ++i) {
    std::copy(indices[i].begin(), indices[i].end(), table.mutableIndices(i));
    std::copy(distances[i].begin(), distances[i].end(), table.mutableSqrDistances(i));
    table.setCount(i, static_cast<int>(indices[i].size()));
  }
}

template <typename T>
py::tuple frameOf(const py::array_t<T, py::array::forcecast>& points) {
  const auto at = points.template unchecked<2>();
  const auto position = [&](std::size_t i) {
    std::array<double, 3> p{};
    for (py::ssize_t a = 0; a < 3; ++a)
      p[static_cast<std::size_t>(a)] = static_cast<double>(at(static_cast<py::ssize_t>(i), a));
    return p;
  };
  const auto size = static_cast<std::size_t>(points.shape(0));
  std::vector<double> origin(3, 0.0);
  std::vector<std::int64_t> strays;
  {
    const py::gil_scoped_release unlocked;
    const Bounds bulk = bulkBounds(size, position);
    for (std::size_t a = 0; a < 3 && bulk.isFar(); ++a) origin[a] = bulk.middle()[a];
    for (std::size_t i = 0; i < size; ++i) {
      const std::array<double, 3> p = position(i);
      const bool finite = std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
      if (finite && bulk.isBeyondFloats(p)) strays.push_back(static_cast<std::int64_t>(i));
    }
  }
  return py::make_tuple(column(std::move(origin)), column(std::move(strays)));
}

// What points are moved by so that floats do, and the rows that are beyond all floats.
py::tuple frame(const py::array& points) {
  if (py::isinstance<py::array_t<float>>(points)) return frameOf<float>(points);
  return frameOf<double>(points);
}

py::tuple knn(const FloatArray& points, int k, const py::object& queries, int threads) {
  const PointView rows = viewOf(points);
  const FloatArray query_array = queries.is_none() ? FloatArray() : queries.cast<FloatArray>();
  const PointView query_rows = queries.is_none() ? PointView{} : viewOf(query_array);
  auto table = std::make_shared<Neighborhoods>();
  {
    const py::gil_scoped_release unlocked;
    search::MedianHashIndex index;
    search::MedianHashIndex::Options options;
    options.threads = threads;
    index.build(rows, nullptr, options);
    if (queries.is_none()) {
      index.nearestKAll(k, *table);
    } else {
      searchQueries(index, query_rows, k, *table);
    }
    finishTable(*table);
  }
  const auto size = static_cast<py::ssize_t>(table->size());
  const auto width = static_cast<py::ssize_t>(table->k());
  constexpr auto kIndex = static_cast<py::ssize_t>(sizeof(pcl::index_t));
  constexpr auto kFloat = static_cast<py::ssize_t>(sizeof(float));
  return py::make_tuple(
      view({size, width}, {width * kIndex, kIndex}, table->indices(0), table),
      view({size, width}, {width * kFloat, kFloat}, table->sqrDistances(0), table));
}

}  // namespace
}  // namespace segorient

namespace segorient {
void definePage(py::module_& module);  // page.cpp
}

PYBIND11_MODULE(_core, module) {
  module.doc() = "What segorient/__init__.py calls; not meant to be used directly.";
  module.def("orient", &segorient::orient);
  module.def("normals", &segorient::normals);
  module.def("segment", &segorient::segment);
  module.def("check", &segorient::check);
  module.def("join_trajectory", &segorient::trajectoryViewpoints);
  module.def("sensors", &segorient::sensors);
  module.def("knn", &segorient::knn);
  module.def("frame", &segorient::frame);
  segorient::definePage(module);
}
