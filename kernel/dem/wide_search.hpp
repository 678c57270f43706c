// The part of wide.cpp that finds the listed pairs within reach; each of its builds has its own.
#pragma once

#include "kernel/dem/four.hpp"
#include "kernel/dem/wide.hpp"

namespace millscope::dem {
namespace {

constexpr std::uint32_t kNoSource = 0xffffffffU;  // of a contact that is fresh

/// What follows from four flags, for each of their 16 patterns.
struct KeptOfFour {
  FourIndices places[16];     ///< those that are set, first
  FourIndices ranks[16];      ///< how many are set before each
  FourIndices fresh[16];      ///< kNoSource where not set, else 0
  std::uint8_t count[16];     ///< how many are set
  std::uint8_t flags[16][4];  ///< the pattern as bytes, 0 or 1
};
constexpr KeptOfFour kept_of_four() {
  KeptOfFour k{};
  for (unsigned m = 0; m < 16; ++m) {
    std::uint32_t places[4] = {}, ranks[4] = {}, fresh[4] = {};
    unsigned n = 0;
    for (unsigned i = 0; i < 4; ++i) {
      const bool set = (m >> i & 1U) != 0;
      ranks[i] = n;
      fresh[i] = set ? 0 : kNoSource;
      k.flags[m][i] = set ? 1 : 0;
      if (set) places[n++] = i;
    }
    k.places[m] = FourIndices{places[0], places[1], places[2], places[3]};
    k.ranks[m] = FourIndices{ranks[0], ranks[1], ranks[2], ranks[3]};
    k.fresh[m] = FourIndices{fresh[0], fresh[1], fresh[2], fresh[3]};
    k.count[m] = static_cast<std::uint8_t>(n);
  }
  return k;
}
constexpr KeptOfFour kKept = kept_of_four();

/// Keeps those of a list's slots that are within reach, four by four and without a branch, whose outcome no processor could guess.
struct Sieve {
  PairListView& list;
  PairBatch& batch;
  std::uint32_t read;
  std::int64_t count = 0;

  /// The slots from s on; bit k of `hits`: slot s + k is within reach; bit k of `touched`: it was in the last step.
  void four_slots(std::int64_t s, int hits, int touched) {
    const FourIndices places = kKept.places[hits], ranks = kKept.ranks[touched];
    const FourIndices slots = indices(static_cast<std::uint32_t>(s)) + FourIndices{0, 1, 2, 3};
    const FourIndices sources = (indices(read) + ranks) | kKept.fresh[touched];
    store_indices(batch.slot + count, __builtin_shuffle(slots, places));
    store_indices(batch.source + count, __builtin_shuffle(sources, places));
    read += static_cast<std::uint32_t>(kKept.count[touched]);
    count += kKept.count[hits];
  }

  /// The same of the last slots of a list.
  void one_slot(std::int64_t s, bool hit) {
    const std::uint8_t touched = list.touching[s];
    batch.slot[count] = static_cast<std::uint32_t>(s);
    batch.source[count] = touched != 0 ? read : kNoSource;
    list.touching[s] = hit ? 1 : 0;
    read += touched;
    count += hit ? 1 : 0;
  }
};

/// Four bytes that are 0 or 1 as four bits.
inline int bits_of(const std::uint8_t* flags) {
  std::uint32_t word;
  __builtin_memcpy(&word, flags, sizeof word);
  return static_cast<int>((word | word >> 7 | word >> 14 | word >> 21) & 0xfU);
}

template <bool kPeriodic>
std::int64_t search_slots(const GatherContext& g, PairListView& list, std::int64_t first, std::int64_t last, PairBatch& b) {
  const Box4 box = box4(g.box);
  const double* __restrict x = reinterpret_cast<const double*>(g.position);
  const std::uint32_t* __restrict owner = list.owner;
  const std::uint32_t* __restrict partner = list.partner;
  const double reach = g.reach;
  Sieve sieve{list, b, static_cast<std::uint32_t>(list.read)};
  const auto difference = [&](std::int64_t s) {
    return load4(x + 4 * static_cast<std::int64_t>(owner[s])) + negate3(load4(x + 4 * static_cast<std::int64_t>(partner[s])));
  };
  std::int64_t s = first;
  std::int64_t ahead = g.ahead;
  for (; s + 4 <= last; s += 4) {
    if (ahead < g.ahead_end) {
      __builtin_prefetch(g.position + ahead, 0, 2);
      __builtin_prefetch(g.motion + ahead, 0, 2);
      __builtin_prefetch(g.motion + ahead + 1, 0, 2);
      if (g.ahead_force) {
        __builtin_prefetch(g.ahead_force + (ahead - g.ahead), 1, 2);
        __builtin_prefetch(g.ahead_force + (ahead - g.ahead) + 1, 1, 2);
      }
      ahead += 2;
    }
    Four d[4] = {difference(s), difference(s + 1), difference(s + 2), difference(s + 3)};
    transpose(d[0], d[1], d[2], d[3]);
    if constexpr (kPeriodic) each_minimum_image(d, box);
    const Four limit = d[3] + four(reach);
    const int hits = bits_of((d[0] * d[0] + d[1] * d[1] + d[2] * d[2]) < (limit * limit));
    sieve.four_slots(s, hits, bits_of(list.touching + s));
    __builtin_memcpy(list.touching + s, &kKept.flags[hits], 4);
  }
  for (; s < last; ++s) {
    const Four d = kPeriodic ? minimum_image(difference(s), box) : difference(s);
    const double limit = d[3] + reach;
    sieve.one_slot(s, d[0] * d[0] + d[1] * d[1] + d[2] * d[2] < limit * limit);
  }
  list.read = sieve.read;
  for (std::int64_t k = 0; k < sieve.count; ++k) b.fresh[k] = b.source[k] == kNoSource;
  return sieve.count;
}

std::int64_t search(const GatherContext& g, PairListView& list, std::int64_t first, std::int64_t last, PairBatch& b) {
  return box4(g.box).any ? search_slots<true>(g, list, first, last, b) : search_slots<false>(g, list, first, last, b);
}

}  // namespace
}  // namespace millscope::dem
