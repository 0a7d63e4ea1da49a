// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
//
// Sorting some tens of candidates without a branch. A candidate is one 64-bit key, the bits of its
// distance above its id: ascending keys are ascending distances, ties by id. Keys lie in rows of
// four lanes; the order of a sorted block runs down the first lane, then down the second and so on,
// so that most comparisons are between whole rows.

SEGORIENT_INLINE void exchange(Keys& a, Keys& b) {
  const Keys least = minOf(a, b);
  b = maxOf(a, b);
  a = least;
}

// Sorting networks with the least number of comparisons known, by number of rows.
SEGORIENT_INLINE void sortLanes(Keys (&/*k*/)[1]) {}
SEGORIENT_INLINE void sortLanes(Keys (&k)[2]) {
  exchange(k[0], k[1]);
}
SEGORIENT_INLINE void sortLanes(Keys (&k)[3]) {
  exchange(k[0], k[2]), exchange(k[0], k[1]), exchange(k[1], k[2]);
}
SEGORIENT_INLINE void sortLanes(Keys (&k)[4]) {
  exchange(k[0], k[1]), exchange(k[2], k[3]);
  exchange(k[0], k[2]), exchange(k[1], k[3]);
  exchange(k[1], k[2]);
}
SEGORIENT_INLINE void sortLanes(Keys (&k)[5]) {
  exchange(k[0], k[3]), exchange(k[1], k[4]);
  exchange(k[0], k[2]), exchange(k[1], k[3]);
  exchange(k[0], k[1]), exchange(k[2], k[4]);
  exchange(k[1], k[2]), exchange(k[3], k[4]);
  exchange(k[2], k[3]);
}
SEGORIENT_INLINE void sortLanes(Keys (&k)[6]) {
  exchange(k[0], k[5]), exchange(k[1], k[3]), exchange(k[2], k[4]);
  exchange(k[1], k[2]), exchange(k[3], k[4]);
  exchange(k[0], k[3]), exchange(k[2], k[5]);
  exchange(k[0], k[1]), exchange(k[2], k[3]), exchange(k[4], k[5]);
  exchange(k[1], k[2]), exchange(k[3], k[4]);
}
SEGORIENT_INLINE void sortLanes(Keys (&k)[7]) {
  exchange(k[0], k[6]), exchange(k[2], k[3]), exchange(k[4], k[5]);
  exchange(k[0], k[2]), exchange(k[1], k[4]), exchange(k[3], k[6]);
  exchange(k[0], k[1]), exchange(k[2], k[5]), exchange(k[3], k[4]);
  exchange(k[1], k[2]), exchange(k[4], k[6]);
  exchange(k[2], k[3]), exchange(k[4], k[5]);
  exchange(k[1], k[2]), exchange(k[3], k[4]), exchange(k[5], k[6]);
}
SEGORIENT_INLINE void sortLanes(Keys (&k)[8]) {
  exchange(k[0], k[2]), exchange(k[1], k[3]), exchange(k[4], k[6]), exchange(k[5], k[7]);
  exchange(k[0], k[4]), exchange(k[1], k[5]), exchange(k[2], k[6]), exchange(k[3], k[7]);
  exchange(k[0], k[1]), exchange(k[2], k[3]), exchange(k[4], k[5]), exchange(k[6], k[7]);
  exchange(k[2], k[4]), exchange(k[3], k[5]);
  exchange(k[1], k[4]), exchange(k[3], k[6]);
  exchange(k[1], k[2]), exchange(k[3], k[4]), exchange(k[5], k[6]);
}

// The same for lanes that first rise and then fall, or the other way round.
template <std::size_t kRows>
SEGORIENT_INLINE void sortBitonicLanes(Keys (&k)[kRows]) {
  sortLanes(k);
}
SEGORIENT_INLINE void sortBitonicLanes(Keys (&k)[4]) {
  exchange(k[0], k[2]), exchange(k[1], k[3]);
  exchange(k[0], k[1]), exchange(k[2], k[3]);
}
SEGORIENT_INLINE void sortBitonicLanes(Keys (&k)[8]) {
  exchange(k[0], k[4]), exchange(k[1], k[5]), exchange(k[2], k[6]), exchange(k[3], k[7]);
  exchange(k[0], k[2]), exchange(k[1], k[3]), exchange(k[4], k[6]), exchange(k[5], k[7]);
  exchange(k[0], k[1]), exchange(k[2], k[3]), exchange(k[4], k[5]), exchange(k[6], k[7]);
}

// The last steps to a sorted block, where lanes 0 and 1 hold the lesser half and each half rises
// and then falls or the other way round.
template <std::size_t kRows>
SEGORIENT_INLINE void sortBitonicHalves(Keys (&k)[kRows]) {
  SEGORIENT_UNROLL
  for (std::size_t r = 0; r < kRows; ++r) {
    const Keys other = swapPairs(k[r]);
    k[r] = evenOdd(minOf(k[r], other), maxOf(k[r], other));
  }
  sortBitonicLanes(k);
}

template <std::size_t kRows>
SEGORIENT_INLINE void sortBlock(Keys (&k)[kRows]) {
  sortLanes(k);
  // Lanes 0 and 1, as well as 2 and 3, are merged: the least of one meet the largest of the other.
  Keys merged[kRows];
  SEGORIENT_UNROLL
  for (std::size_t r = 0; r < kRows; ++r) {
    const Keys other = swapPairs(k[kRows - 1 - r]);
    merged[r] = evenOdd(minOf(k[r], other), maxOf(k[r], other));
  }
  sortBitonicLanes(merged);
  SEGORIENT_UNROLL
  for (std::size_t r = 0; r < kRows; ++r) {
    const Keys other = reverse(merged[kRows - 1 - r]);
    k[r] = lowHigh(minOf(merged[r], other), maxOf(merged[r], other));
  }
  sortBitonicHalves(k);
}

template <std::size_t kRows>
SEGORIENT_INLINE void sortBitonicBlock(Keys (&k)[kRows]) {
  SEGORIENT_UNROLL
  for (std::size_t r = 0; r < kRows; ++r) {
    const Keys other = swapHalves(k[r]);
    k[r] = lowHigh(minOf(k[r], other), maxOf(k[r], other));
  }
  sortBitonicHalves(k);
}

template <std::size_t kRows>
SEGORIENT_INLINE void loadBlock(const float* distance, const std::uint32_t* id, Keys (&k)[kRows]) {
  SEGORIENT_UNROLL
  for (std::size_t r = 0; r < kRows; ++r) k[r] = packKeys(distance + 4 * r, id + 4 * r);
}

// Writes up to three entries more than the block has.
template <std::size_t kRows>
SEGORIENT_INLINE void storeBlock(const Keys (&k)[kRows], float* distance, std::uint32_t* id) {
  constexpr std::size_t kSquares = (kRows + 3) / 4;
  Keys square[kSquares][4];
  SEGORIENT_UNROLL
  for (std::size_t s = 0; s < kSquares; ++s) {
    SEGORIENT_UNROLL
    for (std::size_t r = 0; r < 4; ++r) square[s][r] = k[4 * s + r < kRows ? 4 * s + r : 0];
    transpose(square[s]);
  }
  // What is written beyond the end of a lane is overwritten by the next lane.
  SEGORIENT_UNROLL
  for (std::size_t lane = 0; lane < 4; ++lane) {
    SEGORIENT_UNROLL
    for (std::size_t s = 0; s < kSquares; ++s) {
      const std::size_t at = lane * kRows + 4 * s;
      unpackKeys(square[s][lane], distance + at, id + at);
    }
  }
}

template <std::size_t kRows>
void sortOneBlock(const float* distance, const std::uint32_t* id, float* out_distance,
                  std::uint32_t* out_id) {
  Keys k[kRows];
  loadBlock(distance, id, k);
  sortBlock(k);
  storeBlock(k, out_distance, out_id);
}

template <std::size_t kRows>
void sortTwoBlocks(const float* distance, const std::uint32_t* id, float* out_distance,
                   std::uint32_t* out_id) {
  Keys a[kRows];
  Keys b[kRows];
  loadBlock(distance, id, a);
  loadBlock(distance + 4 * kRows, id + 4 * kRows, b);
  sortBlock(a);
  sortBlock(b);
  Keys high[kRows];
  SEGORIENT_UNROLL
  for (std::size_t r = 0; r < kRows; ++r) {
    const Keys other = reverse(b[kRows - 1 - r]);
    high[r] = maxOf(a[r], other);
    a[r] = minOf(a[r], other);
  }
  sortBitonicBlock(a);
  storeBlock(a, out_distance, out_id);
  sortBitonicBlock(high);
  storeBlock(high, out_distance + 4 * kRows, out_id + 4 * kRows);
}

// Most candidates that are sorted at once.
constexpr std::size_t kMostAtOnce = 64;

// Entries that sortAtOnce() may write beyond the last candidate.
constexpr std::size_t kSortRoom = 12;

// Sorts padded candidates; in place, too.
inline void sortAtOnce(const float* distance, const std::uint32_t* id, std::size_t count,
                       float* out_distance, std::uint32_t* out_id) {
  using Sort = void (*)(const float*, const std::uint32_t*, float*, std::uint32_t*);
  static constexpr Sort kSorts[] = {
      sortOneBlock<1>,  sortOneBlock<1>,  sortOneBlock<2>,  sortOneBlock<3>,  sortOneBlock<4>,
      sortOneBlock<5>,  sortOneBlock<6>,  sortOneBlock<7>,  sortOneBlock<8>,  sortTwoBlocks<5>,
      sortTwoBlocks<5>, sortTwoBlocks<6>, sortTwoBlocks<6>, sortTwoBlocks<7>, sortTwoBlocks<7>,
      sortTwoBlocks<8>, sortTwoBlocks<8>};
  kSorts[(count + 3) / 4](distance, id, out_distance, out_id);
}

// Copies the candidates of distances in [from, to).
inline std::size_t select(const float* distance, const std::uint32_t* id, std::size_t count,
                          float from, float to, float* out_distance, std::uint32_t* out_id) {
  const Vector low = broadcast(from);
  const Vector high = broadcast(to);
  std::size_t selected = 0;
  for (std::size_t i = 0; i < count; i += kWidth) {
    const Vector d = load(distance + i);
    unsigned int mask = lessMask(d, high) & ~lessMask(d, low);
    if (count - i < kWidth) mask &= (1U << (count - i)) - 1U;
    compress(d, mask, out_distance + selected);
    selected += compressIds(id + i, mask, out_id + selected);
  }
  return selected;
}

void sortNearest(const float* distance, const std::uint32_t* id, std::size_t count, std::size_t k,
                 float limit, const SortScratch& scratch) {
  if (count <= kMostAtOnce) {
    sortAtOnce(distance, id, count, scratch.distance, scratch.id);
    return;
  }
  // Divided by distance into parts of about 40, since uneven ones shall not exceed 64 either.
  const std::size_t parts = count / 40 + 1;
  const float step = limit / static_cast<float>(parts);
  std::size_t done = 0;
  float from = 0.0F;
  for (std::size_t part = 1; part <= parts && done < k; ++part) {
    const float to = part == parts ? limit : step * static_cast<float>(part);
    const std::size_t selected =
        select(distance, id, count, from, to, scratch.part_distance, scratch.part_id);
    float* const out_distance = scratch.distance + done;
    std::uint32_t* const out_id = scratch.id + done;
    if (selected <= kMostAtOnce) {
      padCandidates(scratch.part_distance, scratch.part_id, selected);
      sortAtOnce(scratch.part_distance, scratch.part_id, selected, out_distance, out_id);
    } else {
      sortMany(scratch.part_distance, scratch.part_id, selected, out_distance, out_id);
    }
    done += selected;
    from = to;
  }
}
