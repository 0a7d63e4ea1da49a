// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
//
// Sorting of several values a lane; needs lanes.inl.

inline void exchange(Lanes& less, Lanes& more) {
  const Lanes a = less;
  less = smaller(a, more);
  more = larger(a, more);
}

/// Whatever is compared is known when this is compiled, so that values stay in registers.
template <std::size_t kCount, std::size_t... kPair>
SEGORIENT_INLINED inline void sortByPairs(Lanes* values, std::index_sequence<kPair...> /*pairs*/) {
  (exchange(values[kSortingPairs<kCount>[kPair].first],
            values[kSortingPairs<kCount>[kPair].second]),
   ...);
}

/// Ascending, lane by lane.
template <std::size_t kCount>
SEGORIENT_INLINED inline void sortLanes(Lanes* values) {
  sortByPairs<kCount>(values, std::make_index_sequence<countSortingPairs(kCount)>());
}
