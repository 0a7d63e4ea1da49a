// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "io/cloud_table.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "common/bulk_bounds.h"

namespace segorient::program {
namespace {

template <typename T>
double load(const std::uint8_t* data) {
  T v;
  std::memcpy(&v, data, sizeof(T));
  return static_cast<double>(v);
}

// Whether rows can be read as three consecutive floats where they are.
bool viewable(const CloudTable& table, const std::array<const Field*, 3>& xyz) {
  const bool floats = std::all_of(xyz.begin(), xyz.end(),
                                  [](const Field* f) { return f->type == 'F' && f->size == 4; });
  return floats && xyz[1]->offset == xyz[0]->offset + 4 && xyz[2]->offset == xyz[0]->offset + 8 &&
         table.row_bytes % sizeof(float) == 0 && xyz[0]->offset % sizeof(float) == 0;
}

/// What there is to know before points are made floats near the origin.
struct Survey {
  Bounds bulk;
  std::size_t near = 0;  ///< finite points that are no strays
  bool has_strays = false;
};

/// \param position of each of `size` points, an array of three
template <typename Position>
Survey surveyOf(std::size_t size, const Position& position) {
  Survey survey;
  survey.bulk = bulkBounds(size, position);
  for (std::size_t i = 0; i < size; ++i) {
    const std::array<double, 3> p = position(i);
    const bool finite = std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
    const bool near = finite && !survey.bulk.isBeyondFloats(p);
    survey.near += near ? 1 : 0;
    survey.has_strays = survey.has_strays || (finite && !near);
  }
  return survey;
}

}  // namespace

std::string pclName(std::string name) {
  if (name == "nx" || name == "ny" || name == "nz") name.insert(1, "ormal_");
  return name;
}

double loadNumber(const std::uint8_t* data, char type, std::uint32_t size) {
  if (type == 'F') return size == 8 ? load<double>(data) : load<float>(data);
  const bool is_signed = type == 'I';
  switch (size) {
    case 1:
      return is_signed ? load<std::int8_t>(data) : load<std::uint8_t>(data);
    case 2:
      return is_signed ? load<std::int16_t>(data) : load<std::uint16_t>(data);
    case 4:
      return is_signed ? load<std::int32_t>(data) : load<std::uint32_t>(data);
    default:
      return is_signed ? load<std::int64_t>(data) : load<std::uint64_t>(data);
  }
}

void CloudTable::addField(std::string name, char type, std::uint32_t field_size,
                          std::uint32_t count) {
  fields.push_back({std::move(name), type, field_size, count, row_bytes});
  row_bytes += fields.back().bytes();
}

const Field* CloudTable::find(const std::string& name) const {
  const auto it =
      std::find_if(fields.begin(), fields.end(), [&](const Field& f) { return f.name == name; });
  return it == fields.end() ? nullptr : &*it;
}

double CloudTable::value(const Field& field, std::size_t row, std::uint32_t element) const {
  return loadNumber(at(field, row) + std::size_t{element} * field.size, field.type, field.size);
}

std::array<double, 3> CloudTable::triple(const std::array<const Field*, 3>& columns,
                                         std::size_t row) const {
  return {value(*columns[0], row), value(*columns[1], row), value(*columns[2], row)};
}

bool CloudTable::hasNormals() const {
  const auto n = normals();
  return std::all_of(n.begin(), n.end(), [](const Field* f) { return f != nullptr; });
}

bool CloudTable::hasViewpoints() const {
  const auto v = viewpoints();
  return std::all_of(v.begin(), v.end(), [](const Field* f) { return f != nullptr; });
}

void CloudTable::setReal(const Field& field, std::size_t row, double value) {
  const auto single = static_cast<float>(value);
  std::memcpy(at(field, row), field.size == 8 ? static_cast<const void*>(&value) : &single,
              field.size);
}

void CloudTable::appendFields(const std::vector<Field>& added) {
  CloudTable wider;
  for (const Field& f : fields) {
    const bool replaced = std::any_of(added.begin(), added.end(),
                                      [&](const Field& other) { return other.name == f.name; });
    if (!replaced) wider.addField(f.name, f.type, f.size, f.count);
  }
  const std::size_t kept = wider.fields.size();
  for (const Field& f : added) wider.addField(f.name, f.type, f.size, f.count);
  wider.rows.resize(size * wider.row_bytes);
  for (std::size_t c = 0; c < kept; ++c) {
    const Field& to = wider.fields[c];
    const Field& from = *find(to.name);
    for (std::size_t i = 0; i < size; ++i) {
      std::memcpy(wider.rows.data() + i * wider.row_bytes + to.offset, at(from, i), to.bytes());
    }
  }
  fields = std::move(wider.fields);
  row_bytes = wider.row_bytes;
  rows = std::move(wider.rows);
}

void CloudTable::makeReal(const std::vector<std::string>& names) {
  constexpr double kExactInFloat = 16777216.0;  // 2^24
  CloudTable real;
  for (const Field& f : fields) {
    const bool chosen =
        f.type != 'F' && std::find(names.begin(), names.end(), f.name) != names.end();
    bool wide = false;
    for (std::size_t i = 0; i < (chosen ? size * f.count : 0) && !wide; ++i) {
      wide =
          std::abs(value(f, i / f.count, static_cast<std::uint32_t>(i % f.count))) > kExactInFloat;
    }
    real.addField(f.name, chosen ? 'F' : f.type, chosen ? (wide ? 8 : 4) : f.size, f.count);
  }
  real.rows.resize(size * real.row_bytes);
  for (std::size_t i = 0; i < size; ++i) {
    for (std::size_t c = 0; c < fields.size(); ++c) {
      const Field& from = fields[c];
      const Field& to = real.fields[c];
      if (from.type == to.type) {
        std::memcpy(real.at(to, i), at(from, i), from.bytes());
        continue;
      }
      for (std::uint32_t e = 0; e < from.count; ++e) {
        Field element = to;
        element.offset += std::size_t{e} * to.size;
        real.setReal(element, i, value(from, i, e));
      }
    }
  }
  fields = std::move(real.fields);
  row_bytes = real.row_bytes;
  rows = std::move(real.rows);
}

LocalPoints::LocalPoints(const CloudTable& table) {
  const auto xyz = table.xyz();
  const bool in_place = table.size > 0 && viewable(table, xyz);
  if (in_place) {
    view_.data = reinterpret_cast<const float*>(table.at(*xyz[0], 0));
    view_.stride = table.row_bytes / sizeof(float);
    view_.size = table.size;
  }
  // Reading floats where they are takes a fraction of the time.
  const Survey survey =
      in_place ? surveyOf(table.size, [this](std::size_t i) { return inDouble(view_[i]); })
               : surveyOf(table.size, [&](std::size_t i) { return table.triple(xyz, i); });
  const Bounds& bulk = survey.bulk;
  extent_ = bulk.extent();
  reach_ = bulk.reach();
  finite_ = survey.near;
  const bool move = bulk.isFar();
  if (move) origin_ = bulk.middle();
  if (in_place && !move && !survey.has_strays) return;

  view_.size = table.size;
  if (table.size == 0) return;
  copy_.resize(3 * table.size);
  for (std::size_t i = 0; i < table.size; ++i) {
    const auto p = table.triple(xyz, i);
    const bool near = !bulk.isBeyondFloats(p);
    for (std::size_t a = 0; a < 3; ++a) {
      copy_[3 * i + a] =
          near ? static_cast<float>(p[a] - origin_[a]) : std::numeric_limits<float>::quiet_NaN();
    }
  }
  view_.data = copy_.data();
  view_.stride = 3;
}

}  // namespace segorient::program
