// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <string>

#include "orientation/report_fields.h"
#include "support/json.h"

namespace segorient::program {

/// An array of what a report lists, one object an item.
/// \param items of a type that report_fields.h knows \param origin added to places
template <typename Items>
void addList(JsonWriter& json, const std::string& name, const Items& items,
             const detail::Origin& origin = {}) {
  json.beginArray(name);
  for (const auto& item : items) {
    json.beginItem();
    detail::fieldsOf(item, origin, [&](const char* key, auto value) { json.field(key, value); });
    json.endObject();
  }
  json.endArray();
}

}  // namespace segorient::program
