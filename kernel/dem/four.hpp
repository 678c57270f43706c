// Four doubles side by side, for the files that are built once per instruction set: g++'s vector types. Internal linkage
// on purpose: each build has its own.
#pragma once

#include <cstdint>

#include "kernel/dem/lines.hpp"

namespace millscope::dem {
namespace {

typedef double Four __attribute__((vector_size(32)));
typedef double FourAlias __attribute__((vector_size(32), may_alias));
typedef std::int64_t FourBits __attribute__((vector_size(32)));
typedef double Two __attribute__((vector_size(16)));

typedef std::uint32_t FourIndices __attribute__((vector_size(16)));

inline FourIndices indices(std::uint32_t a) { return FourIndices{a, a, a, a}; }
template <class Indices>
inline Indices load_indices(const std::uint32_t* p) {
  Indices v;
  __builtin_memcpy(&v, p, sizeof v);
  return v;
}
inline void store_indices(std::uint32_t* p, FourIndices v) { __builtin_memcpy(p, &v, sizeof v); }

#if defined(__AVX512VL__)
typedef std::uint32_t EightIndices __attribute__((vector_size(32)));
typedef int EightInts __attribute__((vector_size(32)));

inline void store_indices(std::uint32_t* p, EightIndices v) { __builtin_memcpy(p, &v, sizeof v); }
/// Those whose bit is set, first.
inline EightIndices compressed(EightIndices v, unsigned bits) {
  return (EightIndices)__builtin_ia32_compresssi256_mask((EightInts)v, EightInts{}, static_cast<unsigned char>(bits));
}
/// The first of v where a bit is set, in order; `others` where it is not.
inline EightIndices expanded(EightIndices v, EightIndices others, unsigned bits) {
  return (EightIndices)__builtin_ia32_expandsi256_mask((EightInts)v, (EightInts)others, static_cast<unsigned char>(bits));
}
#endif

/// Truth values as the bits of a number.
inline int bits_of(FourBits truth) {
#if defined(__AVX__)
  return __builtin_ia32_movmskpd256((Four)truth);
#else
  Two halves[2];
  __builtin_memcpy(halves, &truth, sizeof halves);
  return __builtin_ia32_movmskpd(halves[0]) | __builtin_ia32_movmskpd(halves[1]) << 2;
#endif
}

inline Four four(double a) { return Four{a, a, a, a}; }
inline Four root(Four a) {
#if defined(__AVX__)
  return __builtin_ia32_sqrtpd256(a);
#else
  Two halves[2];
  __builtin_memcpy(halves, &a, sizeof halves);
  for (Two& half : halves) half = __builtin_ia32_sqrtpd(half);
  __builtin_memcpy(&a, halves, sizeof halves);
  return a;
#endif
}
inline Four load4(const void* p) { return *static_cast<const FourAlias*>(p); }
inline void store4(void* p, Four v) { *static_cast<FourAlias*>(p) = v; }
inline void store4_unaligned(double* p, Four v) { __builtin_memcpy(p, &v, sizeof v); }

typedef float FourSingleAlias __attribute__((vector_size(16), may_alias));
inline Four load4_single(const float* p) {
#if defined(__AVX__)  // which __builtin_convertvector takes in two halves, through memory
  return __builtin_ia32_cvtps2pd256(*reinterpret_cast<const FourSingleAlias*>(p));
#else
  return __builtin_convertvector(*reinterpret_cast<const FourSingleAlias*>(p), Four);
#endif
}
inline void store4_single(float* p, Four v) { *reinterpret_cast<FourSingleAlias*>(p) = __builtin_convertvector(v, FourSingleAlias); }

/// Rounds to the nearest integer (|a| < 2^51) with additions alone: exact and the same everywhere.
inline Four nearest(Four a) {
  const Four magic = four(6755399441055744.0);  // 1.5 · 2^52
  return (a + magic) - magic;
}

/// Which axes repeat, as a constant of a loop: none, z (as in nearly every case that repeats), or whichever.
enum class Repeats { none, z, any };

struct Box4 {
  Four length, inverse;
  Repeats repeats;
};

Box4 box4(const PeriodicBox& b) {
  Box4 r{};
  for (int a = 0; a < 3; ++a) {
    r.length[a] = b.length[a];
    r.inverse[a] = b.length[a] > 0 ? 1.0 / b.length[a] : 0.0;
  }
  r.repeats = b.length[0] > 0 || b.length[1] > 0 ? Repeats::any : b.length[2] > 0 ? Repeats::z : Repeats::none;
  return r;
}

/// Four differences, x, y and z one after the other, between the nearest images.
template <Repeats kRepeats>
inline void each_minimum_image(Four (&d)[4], const Box4& b) {
  for (int a = kRepeats == Repeats::z ? 2 : 0; a < 3 && kRepeats != Repeats::none; ++a) {
    d[a] -= four(b.length[a]) * nearest(d[a] * four(b.inverse[a]));
  }
}

/// Calls `work` with what repeats as a constant.
template <class Work>
inline auto with_repeats(Repeats repeats, const Work& work) {
  if (repeats == Repeats::none) return work.template operator()<Repeats::none>();
  return repeats == Repeats::z ? work.template operator()<Repeats::z>() : work.template operator()<Repeats::any>();
}

/// 4 × 4 transpose.
inline void transpose(Four& a, Four& b, Four& c, Four& d) {
  const Four ab_lo = __builtin_shuffle(a, b, FourBits{0, 4, 2, 6});
  const Four ab_hi = __builtin_shuffle(a, b, FourBits{1, 5, 3, 7});
  const Four cd_lo = __builtin_shuffle(c, d, FourBits{0, 4, 2, 6});
  const Four cd_hi = __builtin_shuffle(c, d, FourBits{1, 5, 3, 7});
  a = __builtin_shuffle(ab_lo, cd_lo, FourBits{0, 1, 4, 5});
  b = __builtin_shuffle(ab_hi, cd_hi, FourBits{0, 1, 4, 5});
  c = __builtin_shuffle(ab_lo, cd_lo, FourBits{2, 3, 6, 7});
  d = __builtin_shuffle(ab_hi, cd_hi, FourBits{2, 3, 6, 7});
}

/// The components of four vectors, from place k on, as four lines.
inline void lines_of(double* const (&components)[3], std::int64_t k, Four (&lines)[4]) {
  for (int a = 0; a < 3; ++a) lines[a] = load4(components[a] + k);
  lines[3] = four(0.0);
  transpose(lines[0], lines[1], lines[2], lines[3]);
}
/// And back: three components of four lines that were transposed.
template <int kCount>
inline void store_each(double* const* to, std::int64_t k, const Four (&v)[kCount]) {
  for (int a = 0; a < 3; ++a) store4_unaligned(to[a] + k, v[a]);
}

/// Four beads, component by component: centre and radius, velocity and 1/m, spin and 1/I.
struct FourBeads {
  Four x[4], v[4], w[4];
};
/// `bead`: the number of the bead at each of the four places.
template <class NumberAt>
inline FourBeads four_beads(const PositionLine* position, const MotionLine* motion, const NumberAt& bead) {
  FourBeads b;
  for (int c = 0; c < 4; ++c) {
    const std::int64_t i = bead(c);
    b.x[c] = load4(position + i);
    b.v[c] = load4(motion[i].v);
    b.w[c] = load4(motion[i].w);
  }
  transpose(b.x[0], b.x[1], b.x[2], b.x[3]);
  transpose(b.v[0], b.v[1], b.v[2], b.v[3]);
  transpose(b.w[0], b.w[1], b.w[2], b.w[3]);
  return b;
}

/// Turns (x, y, z, r) of j into (−x, −y, −z, r), so that one addition gives the difference of the first three and the sum of the last.
inline Four negate3(Four a) {
  const FourBits sign = {INT64_MIN, INT64_MIN, INT64_MIN, 0};
  return (Four)((FourBits)a ^ sign);
}

}  // namespace
}  // namespace millscope::dem
