// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
//
// What is near, out of a block of candidates, where lanes cannot be moved together: first all
// distances and a list of the places of those that count, then these one by one.

// Copies what is nearer to a point than the square root of `limit` out of the block.
// \return how many
inline std::size_t takeNear(const Block& from, const float* q, float limit, float* out_distance,
                            std::uint32_t* out_id) {
  constexpr std::size_t kAtOnce = 128;
  float distance[kAtOnce];
  std::uint32_t place[kAtOnce + kWidth];
  const Vector qx = broadcast(q[0]);
  const Vector qy = broadcast(q[1]);
  const Vector qz = broadcast(q[2]);
  const Vector bound = broadcast(limit);
  std::size_t count = 0;
  for (std::size_t begin = 0; begin < from.count; begin += kAtOnce) {
    const float* const x = from.xyz[0] + begin;
    const float* const y = from.xyz[1] + begin;
    const float* const z = from.xyz[2] + begin;
    const std::uint32_t* const id = from.id + begin;
    const std::size_t size = from.count - begin < kAtOnce ? from.count - begin : kAtOnce;
    std::size_t near = 0;
    for (std::size_t i = 0; i < size; i += kWidth) {
      const Vector d = squaredNorm(qx - load(x + i), qy - load(y + i), qz - load(z + i));
      store(d, distance + i);
      near += listLanes(static_cast<std::uint32_t>(i), lessMask(d, bound), place + near);
    }
    for (std::size_t k = 0; k < near; ++k) {
      out_distance[count + k] = distance[place[k]];
      out_id[count + k] = id[place[k]];
    }
    count += near;
  }
  return count;
}

inline void takeNearTwo(const Block& from, const float* p, const float* q, float limit,
                        Candidates& of_p, Candidates& of_q) {
  of_p.count = takeNear(from, p, limit, of_p.distance, of_p.id);
  of_q.count = takeNear(from, q, limit, of_q.distance, of_q.id);
}
