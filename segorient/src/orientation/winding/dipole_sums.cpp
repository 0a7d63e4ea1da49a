// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/winding/dipole_sums.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include "common/compiler.h"
#include "common/vectors.h"
#include "common/widest.h"

namespace segorient {
namespace {

// As many as the widest registers hold, whatever the machine's are: the same sums everywhere.
constexpr std::size_t kSums = DipoleList::kBlock;

struct Dipoles {
  const float* x;
  const float* y;
  const float* z;
  const float* mx;
  const float* my;
  const float* mz;
  std::size_t count;
};

struct Sums {
  std::array<float, kSums> x;
  std::array<float, kSums> y;
  std::array<float, kSums> z;
};

}  // namespace

#define SEGORIENT_KERNELS "orientation/winding/dipole_lanes.inl"
#include "common/each_width.inl"
#undef SEGORIENT_KERNELS

namespace {

struct Kernels {
  using Add = void (*)(const Dipoles&, const float*, float, Sums&);
  Add numbers = SEGORIENT_WIDEST(addNumbers);
  Add descents = SEGORIENT_WIDEST(addDescents);
  Add pulls = SEGORIENT_WIDEST(addPulls);
};

const Kernels& kernels() {
  static const Kernels chosen;
  return chosen;
}

// The last block is filled up with dipoles that are 0, so that no sum has a remainder.
Dipoles blocksOf(const DipoleList& list) {
  return {list.x.data(),  list.y.data(),  list.z.data(), list.mx.data(),
          list.my.data(), list.mz.data(), list.size()};
}

float total(const std::array<float, kSums>& parts) {
  float sum = 0.F;
  for (const float v : parts) sum += v;
  return kOneOver4Pi * sum;
}

// \param out 3 floats
void addUp(Kernels::Add add, const DipoleList& dipoles, const float* x, float radius, float* out) {
  Sums sums;
  add(blocksOf(dipoles), x, radius * radius, sums);
  out[0] = total(sums.x);
  out[1] = total(sums.y);
  out[2] = total(sums.z);
}

}  // namespace

void DipoleList::grow() {
  for (std::vector<float>* v : {&x, &y, &z, &mx, &my, &mz}) v->resize(2 * size_ + 4 * kBlock);
}

void DipoleList::fillBlock() {
  if (size_ + kBlock > x.size()) grow();
  for (std::vector<float>* v : {&x, &y, &z, &mx, &my, &mz}) {
    std::fill_n(v->begin() + static_cast<std::ptrdiff_t>(size_), kBlock, 0.F);
  }
}

void steepestDescent(const DipoleList& dipoles, const float* x, float radius, float* descent) {
  addUp(kernels().descents, dipoles, x, radius, descent);
}

float windingNumberOf(const DipoleList& dipoles, const float* x, float radius) {
  Sums sums;
  kernels().numbers(blocksOf(dipoles), x, radius * radius, sums);
  return total(sums.x);
}

void windingPull(const DipoleList& dipoles, const float* x, float radius, float* pull) {
  addUp(kernels().pulls, dipoles, x, radius, pull);
}

}  // namespace segorient
