// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "segmentation/sheet_grower.h"

namespace segorient::detail {

// One neighbouring segment of a small one.
struct SheetGrower::Contact {
  std::int32_t label;
  int good;     // admissible edges to it
  int bad;      // other ones
  float agree;  // sum over the admissible ones of the signed products of normals
};

void SheetGrower::listMembers() {
  next_.assign(points_.size, -1);
  for (std::size_t i = 0; i < points_.size; ++i) {
    if (labels_[i] < 0) continue;
    SheetSegment& s = segments_[static_cast<std::size_t>(labels_[i])];
    const auto index = static_cast<pcl::index_t>(i);
    if (s.head < 0) {
      s.head = index;
    } else {
      next_[at(s.tail)] = index;
    }
    s.tail = index;
  }
}

void SheetGrower::findContacts(std::int32_t label, std::vector<Contact>& contacts,
                               int& foreign) const {
  contacts.clear();
  foreign = 0;
  for (pcl::index_t p = segments_[static_cast<std::size_t>(label)].head; p >= 0; p = next_[at(p)]) {
    const pcl::index_t* row = neighbors(at(p));
    const float* n = normal(at(p));
    for (int j = 0; j < degree(at(p)); ++j) {
      const std::size_t q = at(row[j]);
      const std::int32_t l = labels_[q];
      if (l < 0 || l == label) continue;
      ++foreign;
      auto it = std::find_if(contacts.begin(), contacts.end(),
                             [l](const Contact& c) { return c.label == l; });
      if (it == contacts.end()) it = contacts.insert(it, Contact{l, 0, 0, 0.F});
      if (!admits(at(p), j)) {
        ++it->bad;
        continue;
      }
      ++it->good;
      const float* m = normal(q);
      it->agree +=
          (n[0] * m[0] + n[1] * m[1] + n[2] * m[2]) * static_cast<float>(signs_[at(p)] * signs_[q]);
    }
  }
}

void SheetGrower::absorb(std::int32_t gone, std::int32_t into, float sign) {
  SheetSegment& from = segments_[static_cast<std::size_t>(gone)];
  SheetSegment& to = segments_[static_cast<std::size_t>(into)];
  for (pcl::index_t p = from.head; p >= 0; p = next_[at(p)]) {
    labels_[at(p)] = into;
    if (sign < 0.F) signs_[at(p)] = static_cast<std::int8_t>(-signs_[at(p)]);
  }
  to.x += sign * from.x;
  to.y += sign * from.y;
  to.z += sign * from.z;
  to.size += from.size;
  next_[at(to.tail)] = from.head;
  to.tail = from.tail;
  from = SheetSegment{};
}

void SheetGrower::mergeSmall() {
  constexpr float kShare = 0.4F;  // of the foreign neighbours, as in the paper
  listMembers();
  std::vector<std::int32_t> order;
  for (std::size_t s = 0; s < segments_.size(); ++s) {
    const auto label = static_cast<std::int32_t>(s);
    if (segments_[s].size > 0 && isSmall(label)) order.push_back(label);
  }
  std::stable_sort(order.begin(), order.end(), [&](std::int32_t a, std::int32_t b) {
    return segments_[static_cast<std::size_t>(a)].size <
           segments_[static_cast<std::size_t>(b)].size;
  });
  std::vector<Contact> contacts;
  for (const std::int32_t label : order) {
    if (!isSmall(label)) continue;  // it has grown by others that joined it
    const SheetSegment& own = segments_[static_cast<std::size_t>(label)];
    int foreign = 0;
    findContacts(label, contacts, foreign);
    std::int32_t best = -1;
    float best_cos = cos_relaxed_;
    float best_sign = 1.F;
    for (const Contact& c : contacts) {
      if (c.bad > c.good || static_cast<float>(c.good) < kShare * static_cast<float>(foreign))
        continue;
      const SheetSegment& other = segments_[static_cast<std::size_t>(c.label)];
      const float cosine =
          (own.x * other.x + own.y * other.y + own.z * other.z) / (own.length() * other.length());
      // The border and the reference normals have to agree about the sign.
      if (cosine * c.agree <= 0.F || std::fabs(cosine) <= best_cos) continue;
      best_cos = std::fabs(cosine);
      best_sign = cosine >= 0.F ? 1.F : -1.F;
      best = c.label;
    }
    if (best >= 0) absorb(label, best, best_sign);
  }
}

// Moves one point of a small segment to the regular neighbour with the nearest reference normal.
bool SheetGrower::moveOut(std::size_t p) {
  const pcl::index_t* row = neighbors(p);
  std::int32_t best = -1;
  float best_cos = cos_relaxed_;
  int best_sign = 1;
  for (int j = 0; j < degree(p); ++j) {
    const std::size_t q = at(row[j]);
    const std::int32_t l = labels_[q];
    if (l < 0 || l == labels_[p] || !admits(p, j) || isSmall(l)) continue;
    const SheetSegment& s = segments_[static_cast<std::size_t>(l)];
    const int sign = accepts(q, p, s, best_cos);
    if (sign == 0 || !supported(p, l, s.size)) continue;
    const float* n = normal(p);
    best_cos = std::fabs(n[0] * s.x + n[1] * s.y + n[2] * s.z) / s.length();
    best = l;
    best_sign = sign;
  }
  if (best < 0) return false;
  SheetSegment& old = segments_[static_cast<std::size_t>(labels_[p])];
  const float* n = normal(p);
  const auto s = static_cast<float>(signs_[p]);
  old.x -= s * n[0];
  old.y -= s * n[1];
  old.z -= s * n[2];
  --old.size;
  add(p, best, best_sign);
  return true;
}

void SheetGrower::extractFromSmall() {
  std::vector<pcl::index_t> work;
  for (std::size_t i = 0; i < points_.size; ++i) {
    if (labels_[i] >= 0 && isSmall(labels_[i])) work.push_back(static_cast<pcl::index_t>(i));
  }
  // Each round moves at least one point out for good, and small segments are a few points deep.
  std::vector<pcl::index_t> rest;
  while (!work.empty()) {
    rest.clear();
    for (const pcl::index_t i : work) {
      if (!moveOut(at(i))) rest.push_back(i);
    }
    if (rest.size() == work.size()) break;
    work.swap(rest);
  }
}

}  // namespace segorient::detail
