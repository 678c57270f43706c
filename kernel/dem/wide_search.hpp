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

/// Keeps those of a list's slots that are within reach, eight by eight and without a branch, whose outcome no processor could guess.
struct Sieve {
  const std::uint32_t* __restrict all_owners;  // of the list
  const std::uint32_t* __restrict all_partners;
  std::uint32_t* __restrict owner;  // of those that are kept
  std::uint32_t* __restrict partner;
  std::uint32_t* __restrict source;
  std::uint32_t read;
  std::int64_t count = 0;

  /// The slots from s on; bit k of `hits`: slot s + k is within reach; bit k of `touched`: it was in the last step.
  void four_slots(std::int64_t s, int hits, int touched) {
    const FourIndices places = kKept.places[hits], ranks = kKept.ranks[touched];
    const FourIndices sources = (indices(read) + ranks) | kKept.fresh[touched];
    store_indices(owner + count, __builtin_shuffle(load_indices<FourIndices>(all_owners + s), places));
    store_indices(partner + count, __builtin_shuffle(load_indices<FourIndices>(all_partners + s), places));
    store_indices(source + count, __builtin_shuffle(sources, places));
    read += static_cast<std::uint32_t>(kKept.count[touched]);
    count += kKept.count[hits];
  }

  void eight_slots(std::int64_t s, unsigned hits, unsigned touched) {
#if defined(__AVX512VL__)
    const EightIndices order{0, 1, 2, 3, 4, 5, 6, 7};
    const EightIndices sources = expanded((EightIndices{} + read) + order, EightIndices{} + kNoSource, touched);
    store_indices(owner + count, compressed(load_indices<EightIndices>(all_owners + s), hits));
    store_indices(partner + count, compressed(load_indices<EightIndices>(all_partners + s), hits));
    store_indices(source + count, compressed(sources, hits));
    read += static_cast<std::uint32_t>(__builtin_popcount(touched));
    count += __builtin_popcount(hits);
#else
    four_slots(s, static_cast<int>(hits & 0xfU), static_cast<int>(touched & 0xfU));
    four_slots(s + 4, static_cast<int>(hits >> 4), static_cast<int>(touched >> 4));
#endif
  }

  /// The same of the last slots of a list.
  void one_slot(std::int64_t s, bool hit, bool touched) {
    owner[count] = all_owners[s];
    partner[count] = all_partners[s];
    source[count] = touched ? read : kNoSource;
    read += touched ? 1 : 0;
    count += hit ? 1 : 0;
  }
};

/// Eight bytes that are 0 or 1 as eight bits, and back.
inline unsigned bits_of(const std::uint8_t* flags) {
  std::uint64_t word;
  __builtin_memcpy(&word, flags, sizeof word);
  return static_cast<unsigned>(word * 0x0102040810204080U >> 56);
}
inline void store_bits(std::uint8_t* flags, unsigned bits) {
  __builtin_memcpy(flags, &kKept.flags[bits & 0xfU], 4);
  __builtin_memcpy(flags + 4, &kKept.flags[bits >> 4], 4);
}

/// Asks early for the lines of beads, two at a time.
struct Lookahead {
  const GatherContext& g;
  std::int64_t bead = g.ahead;

  void two() {
    if (bead >= g.ahead_end) return;
    __builtin_prefetch(g.position + bead, 0, 2);
    __builtin_prefetch(g.motion + bead, 0, 2);
    __builtin_prefetch(g.motion + bead + 1, 0, 2);
    if (g.ahead_force) {
      __builtin_prefetch(g.ahead_force + (bead - g.ahead), 1, 2);
      __builtin_prefetch(g.ahead_force + (bead - g.ahead) + 1, 1, 2);
    }
    bead += 2;
  }
};

template <Repeats kRepeats>
std::int64_t search_slots(const GatherContext& context, const Box4& box4, PairListView& list, std::int64_t first, std::int64_t last,
                          const PairBatch& b) {
  const GatherContext g = context;
  const Box4 box = box4;
  const double* __restrict x = reinterpret_cast<const double*>(g.position);
  const std::uint32_t* __restrict owner = list.owner;
  const std::uint32_t* __restrict partner = list.partner;
  std::uint8_t* __restrict touching = list.touching;
  Sieve sieve{list.owner, list.partner, b.owner, b.partner, b.source, static_cast<std::uint32_t>(list.read)};
  const auto difference = [&](std::int64_t s) {
    return load4(x + 4 * static_cast<std::int64_t>(owner[s])) + negate3(load4(x + 4 * static_cast<std::int64_t>(partner[s])));
  };
  const auto four_hits = [&](Four d0, Four d1, Four d2, Four d3) {
    Four d[4] = {d0, d1, d2, d3};
    transpose(d[0], d[1], d[2], d[3]);
    each_minimum_image<kRepeats>(d, box);
    const Four limit = d[3] + four(g.reach);
    return static_cast<unsigned>(bits_of((d[0] * d[0] + d[1] * d[1] + d[2] * d[2]) < (limit * limit)));
  };
  Lookahead ahead{g};
  std::int64_t s = first;
  for (; s + 8 <= last; s += 8) {
    ahead.two();
    ahead.two();
    const unsigned low = four_hits(difference(s), difference(s + 1), difference(s + 2), difference(s + 3));
    const unsigned high = four_hits(difference(s + 4), difference(s + 5), difference(s + 6), difference(s + 7));
    const unsigned hits = low | high << 4;
    sieve.eight_slots(s, hits, bits_of(touching + s));
    store_bits(touching + s, hits);
  }
  for (; s < last; ++s) {
    const Four d = difference(s);
    const bool hit = (four_hits(d, d, d, d) & 1U) != 0;
    sieve.one_slot(s, hit, touching[s] != 0);
    touching[s] = hit ? 1 : 0;
  }
  list.read = sieve.read;
  std::uint8_t* __restrict fresh = b.fresh;
  for (std::int64_t k = 0; k < sieve.count; ++k) fresh[k] = sieve.source[k] == kNoSource ? 1 : 0;
  return sieve.count;
}

std::int64_t search(const GatherContext& g, PairListView& list, std::int64_t first, std::int64_t last, PairBatch& b) {
  const Box4 box = box4(g.box);
  return with_repeats(box.repeats, [&]<Repeats kRepeats>() { return search_slots<kRepeats>(g, box, list, first, last, b); });
}

}  // namespace
}  // namespace millscope::dem
