// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "support/component_report.h"

namespace segorient::program {

void addTo(JsonWriter& json, const std::vector<ComponentOrientationResult>& components) {
  json.beginArray("components");
  for (const ComponentOrientationResult& c : components) {
    json.beginItem();
    json.field("points", c.points);
    json.field("oriented_by", toString(c.by));
    json.field("sign", static_cast<int>(c.sign));
    json.field("evidence", c.evidence);
    json.field("votes", c.votes);
    json.field("confidence", c.confidence);
    json.field("contradiction", c.contradiction);
    json.endObject();
  }
  json.endArray();
}

}  // namespace segorient::program
