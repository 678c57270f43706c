// The part of wide.cpp that finds which beads are near one, for the lists; each of its builds has its own.
#pragma once

#include "kernel/dem/wide_search.hpp"

namespace millscope::dem {
namespace {

typedef float Eight __attribute__((vector_size(32)));
typedef float EightHalf __attribute__((vector_size(16)));
typedef std::int32_t EightBits __attribute__((vector_size(32)));

inline Eight eight(float a) { return Eight{a, a, a, a, a, a, a, a}; }
inline Eight load8(const float* p) {
  Eight v;
  __builtin_memcpy(&v, p, sizeof v);
  return v;
}
inline int bits_of(EightBits truth) {
#if defined(__AVX__)
  return __builtin_ia32_movmskps256((Eight)truth);
#else
  EightHalf halves[2];
  __builtin_memcpy(halves, &truth, sizeof halves);
  return __builtin_ia32_movmskps(halves[0]) | __builtin_ia32_movmskps(halves[1]) << 4;
#endif
}
/// Rounds to the nearest integer (|a| < 2^22).
inline Eight nearest(Eight a) {
  const Eight magic = eight(12582912.0F);  // 1.5 · 2^23
  return (a + magic) - magic;
}

/// Few beads stand side by side in three cells: eight at once are mostly all of them, and the last are no special case.
template <Repeats kRepeats>
std::int64_t near_repeating(const NearPlaces& places, const Box4& box, BeadRange owners, const BeadRange* ranges, int count,
                            const NearSlots& found) {
  const NearPlaces p = places;
  const NearSlots f = found;
  Eight length[3], inverse[3];
  for (int a = 0; a < 3; ++a) {
    length[a] = eight(static_cast<float>(box.length[a]));
    inverse[a] = eight(static_cast<float>(box.inverse[a]));
  }
  std::int64_t n = 0;
  for (std::int64_t i = owners.begin; i < owners.end; ++i) {
    const Eight own[3] = {eight(p.centre[0][i]), eight(p.centre[1][i]), eight(p.centre[2][i])}, own_reach = eight(p.reach[i]);
    const FourIndices owner = indices(static_cast<std::uint32_t>(i));
    f.first[i - owners.begin] = static_cast<std::uint32_t>(n);
    for (int r = 0; r < count; ++r) {
      const std::int64_t end = ranges[r].end < i ? ranges[r].end : i;
      for (std::int64_t j = ranges[r].begin; j < end; j += kNearLanes) {
        Eight d[3] = {own[0] - load8(p.centre[0] + j), own[1] - load8(p.centre[1] + j), own[2] - load8(p.centre[2] + j)};
        for (int a = kRepeats == Repeats::z ? 2 : 0; a < 3 && kRepeats != Repeats::none; ++a)
          d[a] -= length[a] * nearest(d[a] * inverse[a]);
        const Eight limit = own_reach + load8(p.reach + j);
        const int there = end - j < kNearLanes ? (1 << (end - j)) - 1 : 0xff;
        const int hits = bits_of((d[0] * d[0] + d[1] * d[1] + d[2] * d[2]) < limit * limit) & there;
        for (int half = 0; half < 2; ++half) {
          const int four_hits = hits >> 4 * half & 0xf;
          store_indices(f.owner + n, owner);
          store_indices(f.partner + n, indices(static_cast<std::uint32_t>(j + 4 * half)) + kKept.places[four_hits]);
          n += kKept.count[four_hits];
        }
      }
    }
  }
  return n;
}

std::int64_t near(const NearPlaces& places, const PeriodicBox& periodic, BeadRange owners, const BeadRange* ranges, int count,
                  const NearSlots& found) {
  const Box4 box = box4(periodic);
  return with_repeats(box.repeats, [&]<Repeats kRepeats>() { return near_repeating<kRepeats>(places, box, owners, ranges, count, found); });
}

}  // namespace
}  // namespace millscope::dem
