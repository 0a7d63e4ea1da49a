// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <array>
#include <cmath>

#include "common/compiler.h"
#include "common/instruction_set.h"
#include "orientation/winding/winding_number.h"

namespace segorient {
namespace {

constexpr std::size_t kLanes = 8;

struct Dipoles {
  const float* x;
  const float* y;
  const float* z;
  const float* mx;
  const float* my;
  const float* mz;
  std::size_t count;
};

// Sums by lane, so that compilers can use vectors without changing the order of any sum.
struct Sums {
  alignas(32) std::array<float, kLanes> x;
  alignas(32) std::array<float, kLanes> y;
  alignas(32) std::array<float, kLanes> z;
};

SEGORIENT_INLINE void addDipole(const Dipoles& from, std::size_t i, const float* at, float r2,
                                std::size_t lane, Sums& sums) {
  const float dx = from.x[i] - at[0];
  const float dy = from.y[i] - at[1];
  const float dz = from.z[i] - at[2];
  const float s = dx * dx + dy * dy + dz * dz + r2;
  const float weight = 1.F / (s * std::sqrt(s));
  const float along = 3.F * (from.mx[i] * dx + from.my[i] * dy + from.mz[i] * dz) / s;
  sums.x[lane] += weight * (from.mx[i] - along * dx);
  sums.y[lane] += weight * (from.my[i] - along * dy);
  sums.z[lane] += weight * (from.mz[i] - along * dz);
}

SEGORIENT_INLINE void addToNumber(const Dipoles& from, std::size_t i, const float* at, float r2,
                                  std::size_t lane, Sums& sums) {
  const float dx = from.x[i] - at[0];
  const float dy = from.y[i] - at[1];
  const float dz = from.z[i] - at[2];
  const float inverse = 1.F / (dx * dx + dy * dy + dz * dz + r2);
  const float weight = inverse * std::sqrt(inverse);
  sums.x[lane] += weight * (from.mx[i] * dx + from.my[i] * dy + from.mz[i] * dz);
}

SEGORIENT_INLINE void addToPull(const Dipoles& from, std::size_t i, const float* at, float r2,
                                std::size_t lane, Sums& sums) {
  const float dx = at[0] - from.x[i];
  const float dy = at[1] - from.y[i];
  const float dz = at[2] - from.z[i];
  const float inverse = 1.F / (dx * dx + dy * dy + dz * dz + r2);
  const float weight = from.mx[i] * inverse * std::sqrt(inverse);
  sums.x[lane] += weight * dx;
  sums.y[lane] += weight * dy;
  sums.z[lane] += weight * dz;
}

enum class Field { Number, Descent, Pull };

template <Field field>
SEGORIENT_INLINE void addOne(const Dipoles& from, std::size_t i, const float* at, float r2,
                             std::size_t lane, Sums& sums) {
  if constexpr (field == Field::Number) {
    addToNumber(from, i, at, r2, lane, sums);
  } else if constexpr (field == Field::Descent) {
    addDipole(from, i, at, r2, lane, sums);
  } else {
    addToPull(from, i, at, r2, lane, sums);
  }
}

template <Field field>
SEGORIENT_INLINE void addLanes(const Dipoles& from, const float* at, float r2, Sums& sums) {
  std::size_t i = 0;
  for (; i + kLanes <= from.count; i += kLanes) {
    for (std::size_t l = 0; l < kLanes; ++l) addOne<field>(from, i + l, at, r2, l, sums);
  }
  for (std::size_t l = 0; i < from.count; ++i, ++l) addOne<field>(from, i, at, r2, l, sums);
}

using AddDipoles = void (*)(const Dipoles&, const float*, float, Sums&);

template <Field field>
void addPortably(const Dipoles& from, const float* at, float r2, Sums& sums) {
  addLanes<field>(from, at, r2, sums);
}
#if SEGORIENT_X86
SEGORIENT_TARGET_BEGIN("avx2")
template <Field field>
void addByAvx2(const Dipoles& from, const float* at, float r2, Sums& sums) {
  addLanes<field>(from, at, r2, sums);
}
SEGORIENT_TARGET_END
#endif

template <Field field>
AddDipoles chooseAddDipoles() {
#if SEGORIENT_X86
  if (instructionSet() >= InstructionSet::Avx2) return &addByAvx2<field>;
#endif
  return &addPortably<field>;
}

template <Field field>
Sums sumOf(const DipoleList& dipoles, const float* x, float radius) {
  const Dipoles from{dipoles.x.data(),  dipoles.y.data(),  dipoles.z.data(), dipoles.mx.data(),
                     dipoles.my.data(), dipoles.mz.data(), dipoles.size()};
  static const AddDipoles addDipoles = chooseAddDipoles<field>();
  Sums sums{};
  addDipoles(from, x, radius * radius, sums);
  return sums;
}

float total(const std::array<float, kLanes>& lanes) {
  float sum = 0.F;
  for (const float v : lanes) sum += v;
  return kOneOver4Pi * sum;
}

}  // namespace

void DipoleList::grow() {
  for (std::vector<float>* v : {&x, &y, &z, &mx, &my, &mz}) v->resize(2 * size_ + 4 * kBlock);
}

void steepestDescent(const DipoleList& dipoles, const float* x, float radius, float* descent) {
  const Sums sums = sumOf<Field::Descent>(dipoles, x, radius);
  descent[0] = total(sums.x);
  descent[1] = total(sums.y);
  descent[2] = total(sums.z);
}

float windingNumberOf(const DipoleList& dipoles, const float* x, float radius) {
  return total(sumOf<Field::Number>(dipoles, x, radius).x);
}

void windingPull(const DipoleList& dipoles, const float* x, float radius, float* pull) {
  const Sums sums = sumOf<Field::Pull>(dipoles, x, radius);
  pull[0] = total(sums.x);
  pull[1] = total(sums.y);
  pull[2] = total(sums.z);
}

}  // namespace segorient
