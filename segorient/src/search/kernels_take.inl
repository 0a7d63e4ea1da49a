// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
//
// What is near, out of a block of candidates, where lanes can be moved together.

// Copies what is nearer to a point than the square root of `limit` out of the block.
// \return how many
inline std::size_t takeNear(const Block& from, const float* q, float limit, float* out_distance,
                            std::uint32_t* out_id) {
  const Vector qx = broadcast(q[0]);
  const Vector qy = broadcast(q[1]);
  const Vector qz = broadcast(q[2]);
  const Vector bound = broadcast(limit);
  const float* const x = from.xyz[0];
  const float* const y = from.xyz[1];
  const float* const z = from.xyz[2];
  const std::uint32_t* const id = from.id;
  const std::size_t block = from.count;
  std::size_t count = 0;
  for (std::size_t i = 0; i < block; i += 2 * std::size_t{kWidth}) {
    const std::size_t j = i + kWidth;
    const Vector d = squaredNorm(qx - load(x + i), qy - load(y + i), qz - load(z + i));
    const Vector e = squaredNorm(qx - load(x + j), qy - load(y + j), qz - load(z + j));
    const unsigned int mask = lessMask(d, bound);
    const unsigned int next_mask = lessMask(e, bound);
    compress(d, mask, out_distance + count);
    count += compressIds(id + i, mask, out_id + count);
    compress(e, next_mask, out_distance + count);
    count += compressIds(id + j, next_mask, out_id + count);
  }
  return count;
}

// The same for two points at once: what each of them waits for leaves time for the other.
inline void takeNearTwo(const Block& from, const float* p, const float* q, float limit,
                        Candidates& of_p, Candidates& of_q) {
  const Vector px = broadcast(p[0]);
  const Vector py = broadcast(p[1]);
  const Vector pz = broadcast(p[2]);
  const Vector qx = broadcast(q[0]);
  const Vector qy = broadcast(q[1]);
  const Vector qz = broadcast(q[2]);
  const Vector bound = broadcast(limit);
  const float* const x = from.xyz[0];
  const float* const y = from.xyz[1];
  const float* const z = from.xyz[2];
  const std::uint32_t* const id = from.id;
  float* const p_distance = of_p.distance;
  float* const q_distance = of_q.distance;
  std::uint32_t* const p_id = of_p.id;
  std::uint32_t* const q_id = of_q.id;
  const std::size_t block = from.count;
  std::size_t p_count = 0;
  std::size_t q_count = 0;
  for (std::size_t i = 0; i < block; i += kWidth) {
    const Vector bx = load(x + i);
    const Vector by = load(y + i);
    const Vector bz = load(z + i);
    const Vector d = squaredNorm(px - bx, py - by, pz - bz);
    const Vector e = squaredNorm(qx - bx, qy - by, qz - bz);
    const unsigned int p_mask = lessMask(d, bound);
    const unsigned int q_mask = lessMask(e, bound);
    compress(d, p_mask, p_distance + p_count);
    p_count += compressIds(id + i, p_mask, p_id + p_count);
    compress(e, q_mask, q_distance + q_count);
    q_count += compressIds(id + i, q_mask, q_id + q_count);
  }
  of_p.count = p_count;
  of_q.count = q_count;
}
