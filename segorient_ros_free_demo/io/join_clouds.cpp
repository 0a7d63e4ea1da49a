// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "io/join_clouds.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "io/las_format.h"

namespace segorient::program {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

bool isSensorField(const std::string& name) {
  return name == "scan" || name == "vp_x" || name == "vp_y" || name == "vp_z";
}

// A type that holds the numbers of both.
Field widened(Field a, const Field& b) {
  if (a.type == b.type) {
    a.size = std::max(a.size, b.size);
    return a;
  }
  // A float holds 16 bits, a double 32; what is longer has no common type and is rounded.
  const auto wide = [](const Field& f) { return f.type == 'F' ? f.size == 8 : f.size >= 4; };
  a.size = wide(a) || wide(b) ? 8 : 4;
  a.type = 'F';
  return a;
}

bool knowsViewpoint(const CloudTable& cloud) {
  return cloud.viewpoint[0] != 0.0 || cloud.viewpoint[1] != 0.0 || cloud.viewpoint[2] != 0.0;
}

// All fields but those of the sensor, in the order in which they first come.
std::vector<Field> commonFields(const std::vector<CloudTable>& clouds,
                                const std::vector<std::string>& names,
                                std::vector<std::string>& notes) {
  std::vector<Field> fields;
  std::vector<std::string> dropped;
  for (std::size_t c = 0; c < clouds.size(); ++c) {
    for (const Field& f : clouds[c].fields) {
      if (isSensorField(f.name)) continue;
      const auto same = std::find_if(fields.begin(), fields.end(),
                                     [&](const Field& other) { return other.name == f.name; });
      if (same == fields.end()) {
        fields.push_back(f);
      } else if (same->count == f.count) {
        *same = widened(*same, f);
      } else if (std::find(dropped.begin(), dropped.end(), f.name) == dropped.end()) {
        dropped.push_back(f.name);
        notes.push_back("field " + f.name + " is left out: it has " + std::to_string(f.count) +
                        " numbers a point in " + names[c] + ", " + std::to_string(same->count) +
                        " before");
      }
    }
  }
  fields.erase(std::remove_if(fields.begin(), fields.end(),
                              [&](const Field& f) {
                                return std::find(dropped.begin(), dropped.end(), f.name) !=
                                       dropped.end();
                              }),
               fields.end());
  return fields;
}

template <typename T>
void store(T value, std::uint8_t* to) {
  std::memcpy(to, &value, sizeof(T));
}

// A number in the type of a field that has room for it.
void storeElement(double v, const Field& field, std::uint8_t* to) {
  if (field.type == 'F') {
    if (field.size == 8) return store(v, to);
    return store(static_cast<float>(v), to);
  }
  const auto whole = static_cast<std::int64_t>(v);
  if (field.size == 8) return store(whole, to);
  if (field.size == 4) return store(static_cast<std::uint32_t>(whole), to);
  if (field.size == 2) return store(static_cast<std::uint16_t>(whole), to);
  store(static_cast<std::uint8_t>(whole), to);
}

// One field of one cloud to its place in the joint one, from row `first` on.
void copyField(const CloudTable& cloud, const Field* from, const Field& to, std::size_t first,
               CloudTable& out) {
  if (from == nullptr) {
    if (to.type != 'F' || to.name == "rgb") return;  // rows are zero
    for (std::size_t i = 0; i < cloud.size; ++i) {
      for (std::uint32_t e = 0; e < to.count; ++e) {
        storeElement(kNaN, to, out.at(to, first + i) + std::size_t{e} * to.size);
      }
    }
    return;
  }
  const bool verbatim = from->type == to.type && from->size == to.size;
  for (std::size_t i = 0; i < cloud.size; ++i) {
    std::uint8_t* at = out.at(to, first + i);
    if (verbatim) {
      std::memcpy(at, cloud.at(*from, i), to.bytes());
      continue;
    }
    for (std::uint32_t e = 0; e < to.count; ++e) {
      storeElement(cloud.value(*from, i, e), to, at + std::size_t{e} * to.size);
    }
  }
}

void copyViewpoints(const CloudTable& cloud, bool headers, std::size_t first, CloudTable& out) {
  const auto to = out.viewpoints();
  const bool own = cloud.hasViewpoints();
  const bool known = headers && knowsViewpoint(cloud);
  for (std::size_t i = 0; i < cloud.size; ++i) {
    std::array<double, 3> v{kNaN, kNaN, kNaN};
    if (own) {
      v = cloud.triple(cloud.viewpoints(), i);
    } else if (known) {
      std::copy_n(cloud.viewpoint.begin(), 3, v.begin());
    }
    for (std::size_t a = 0; a < 3; ++a) out.setReal(*to[a], first + i, v[a]);
  }
}

// Numbers the scans of a cloud from `base` on; how many there are.
std::uint32_t copyScans(const CloudTable& cloud, std::uint32_t base, std::size_t first,
                        CloudTable& out) {
  constexpr double kMost = 2147483647.0;
  const Field* own = cloud.find("scan");
  const Field& to = *out.find("scan");
  std::uint32_t count = 1;
  for (std::size_t i = 0; i < cloud.size; ++i) {
    const double v = own == nullptr ? 0.0 : cloud.value(*own, i);
    const auto number =
        v >= 0.0 && v + base < kMost ? static_cast<std::uint32_t>(v) : std::uint32_t{0};
    count = std::max(count, number + 1);
    const std::uint32_t scan = base + number;
    std::memcpy(out.at(to, first + i), &scan, sizeof(scan));
  }
  return count;
}

}  // namespace

std::shared_ptr<const LasOrigin> commonOrigin(
    const std::vector<std::shared_ptr<const LasOrigin>>& origins) {
  std::shared_ptr<const LasOrigin> first;
  bool same = true;
  for (const std::shared_ptr<const LasOrigin>& las : origins) {
    if (las && !first) first = las;
    same = same && las && las->scale == first->scale && las->offset == first->offset;
  }
  if (!first || same) return first;
  auto changed = std::make_shared<LasOrigin>(*first);
  changed->scale = {0.0, 0.0, 0.0};
  return changed;
}

CloudTable joinClouds(std::vector<CloudTable> clouds, const std::vector<std::string>& names,
                      bool headers) {
  CloudTable out;
  for (const Field& f : commonFields(clouds, names, out.notes)) {
    out.addField(f.name, f.type, f.size, f.count);
  }
  out.addField("scan", 'U', 4);
  const bool viewpoints = std::any_of(clouds.begin(), clouds.end(), [&](const CloudTable& c) {
    return c.hasViewpoints() || (headers && knowsViewpoint(c));
  });
  const bool wide = std::any_of(clouds.begin(), clouds.end(),
                                [](const CloudTable& c) { return c.find("x")->size == 8; });
  for (const char* name : {"vp_x", "vp_y", "vp_z"}) {
    if (viewpoints) out.addField(name, 'F', wide ? 8 : 4);
  }
  for (const CloudTable& c : clouds) out.size += c.size;
  out.width = out.size;
  out.rows.resize(out.size * out.row_bytes);
  std::vector<std::shared_ptr<const LasOrigin>> origins;
  for (const CloudTable& c : clouds) origins.push_back(c.las);
  out.las = commonOrigin(origins);
  std::size_t first = 0;
  std::uint32_t scan = 0;
  for (CloudTable& cloud : clouds) {
    for (const Field& to : out.fields) {
      if (!isSensorField(to.name)) copyField(cloud, cloud.find(to.name), to, first, out);
    }
    if (viewpoints) copyViewpoints(cloud, headers, first, out);
    scan += copyScans(cloud, scan, first, out);
    if (cloud.height > 1) out.grids.push_back({first, cloud.width, cloud.height});
    for (OrganizedGrid grid : cloud.grids) {
      grid.first += first;
      out.grids.push_back(grid);
    }
    first += cloud.size;
    cloud = CloudTable{};  // its memory is not needed any more
  }
  return out;
}

}  // namespace segorient::program
