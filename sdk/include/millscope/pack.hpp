// Packs of doubles: a law written once as a template runs on `double` (the oracle) and on `Pack` (as wide as the machine).
// Only IEEE-exact operations (+ − × ÷ √ min max compare select), so that every width gives the same bits; anything else goes lane by
// lane through the standard library.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>

namespace millscope {

/// Batches are padded to this many slots, whatever the width.
inline constexpr int kLanes = 8;

#if defined(__AVX512F__)
inline constexpr int kPackWidth = 8;
#elif defined(__AVX__)
inline constexpr int kPackWidth = 4;
#else
inline constexpr int kPackWidth = 2;
#endif

namespace wide {
typedef double Native __attribute__((vector_size(kPackWidth * sizeof(double))));
typedef std::int64_t NativeMask __attribute__((vector_size(kPackWidth * sizeof(double))));
}  // namespace wide

/// One truth value per lane (all bits or none).
struct Mask {
  wide::NativeMask v;
  friend Mask operator&&(Mask a, Mask b) { return {a.v & b.v}; }
  friend Mask operator||(Mask a, Mask b) { return {a.v | b.v}; }
  friend Mask operator!(Mask a) { return {~a.v}; }
};

struct Pack {
  wide::Native v;
  Pack() = default;
  Pack(wide::Native value) : v(value) {}
  Pack(double value) : v(value - wide::Native{}) {}  // a broadcast: x − 0 is x for every x, −0 included

  friend Pack operator+(Pack a, Pack b) { return {a.v + b.v}; }
  friend Pack operator-(Pack a, Pack b) { return {a.v - b.v}; }
  friend Pack operator*(Pack a, Pack b) { return {a.v * b.v}; }
  friend Pack operator/(Pack a, Pack b) { return {a.v / b.v}; }
  friend Pack operator-(Pack a) { return {-a.v}; }
  Pack& operator+=(Pack b) { return *this = *this + b; }
  Pack& operator-=(Pack b) { return *this = *this - b; }
  Pack& operator*=(Pack b) { return *this = *this * b; }
  friend Mask operator<(Pack a, Pack b) { return {a.v < b.v}; }
  friend Mask operator>(Pack a, Pack b) { return {a.v > b.v}; }
  friend Mask operator<=(Pack a, Pack b) { return {a.v <= b.v}; }
  friend Mask operator>=(Pack a, Pack b) { return {a.v >= b.v}; }
};

template <class R>
struct MaskOf {
  using type = Mask;
};
template <>
struct MaskOf<double> {
  using type = bool;
};

inline Pack select(Mask m, Pack a, Pack b) { return {m.v ? a.v : b.v}; }
inline double select(bool m, double a, double b) { return m ? a : b; }
inline Pack maximum(Pack a, Pack b) { return {a.v > b.v ? a.v : b.v}; }
inline double maximum(double a, double b) { return a > b ? a : b; }
inline Pack minimum(Pack a, Pack b) { return {a.v < b.v ? a.v : b.v}; }
inline double minimum(double a, double b) { return a < b ? a : b; }
inline bool any(bool m) { return m; }
inline bool any(Mask m) {
  std::int64_t bits = 0;
  for (int lane = 0; lane < kPackWidth; ++lane) bits |= m.v[lane];
  return bits != 0;
}

/// Applies a scalar function lane by lane (exp, cbrt, …: slow, exact across widths).
template <class F>
Pack lanewise(F f, Pack a) {
  Pack r;
  for (int lane = 0; lane < kPackWidth; ++lane) r.v[lane] = f(static_cast<double>(a.v[lane]));
  return r;
}
template <class F>
double lanewise(F f, double a) {
  return f(a);
}

inline double square_root(double a) { return std::sqrt(a); }
inline Pack square_root(Pack a) {
#if defined(__AVX512F__) && defined(__clang__)
  return {__builtin_ia32_sqrtpd512(a.v, 4)};
#elif defined(__AVX512F__)
  return {reinterpret_cast<wide::Native>(__builtin_ia32_sqrtpd512_mask(a.v, a.v, static_cast<unsigned char>(-1), 4))};
#elif defined(__AVX__)
  return {__builtin_ia32_sqrtpd256(a.v)};
#else
  return {__builtin_ia32_sqrtpd(a.v)};
#endif
}
inline Pack absolute(Pack a) {
  return {reinterpret_cast<wide::Native>(reinterpret_cast<wide::NativeMask>(a.v) & 0x7fffffffffffffffLL)};  // −0 becomes 0, as in fabs
}
inline double absolute(double a) { return std::fabs(a); }

template <class R>
R load(const double* p) {
  if constexpr (sizeof(R) == sizeof(double)) {
    return *p;
  } else {
    wide::Native v;
    __builtin_memcpy(&v, p, sizeof v);
    return R(v);
  }
}
inline void store(double* p, double v) { *p = v; }
inline void store(double* p, Pack v) { __builtin_memcpy(p, &v.v, sizeof v.v); }

inline double lane_sum(double a) { return a; }
inline double lane_sum(Pack a) {
  double sum = 0;
  for (int lane = 0; lane < kPackWidth; ++lane) sum += a.v[lane];
  return sum;
}

template <class R>
inline constexpr int kWidthOf = static_cast<int>(sizeof(R) / sizeof(double));

/// Three components.
template <class R>
struct Vec {
  R x, y, z;
  friend Vec operator+(const Vec& a, const Vec& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend Vec operator-(const Vec& a, const Vec& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend Vec operator*(const R& s, const Vec& a) { return {s * a.x, s * a.y, s * a.z}; }
};
template <class R>
R dot(const Vec<R>& a, const Vec<R>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class R>
Vec<R> cross(const Vec<R>& a, const Vec<R>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class R>
R length(const Vec<R>& a) {
  return square_root(dot(a, a));
}
/// Slot s of three arrays, or the pack that begins there.
template <class R>
Vec<R> load_vector(const double* const (&p)[3], std::int64_t s) {
  return {load<R>(p[0] + s), load<R>(p[1] + s), load<R>(p[2] + s)};
}
template <class R>
void add_to(double* p, const R& value) {
  store(p, load<R>(p) + value);
}
template <class R>
void add_vector(double* const (&p)[3], std::int64_t s, const Vec<R>& value) {
  add_to(p[0] + s, value.x);
  add_to(p[1] + s, value.y);
  add_to(p[2] + s, value.z);
}
template <class R>
Vec<R> select(const typename MaskOf<R>::type& m, const Vec<R>& a, const Vec<R>& b) {
  return {select(m, a.x, b.x), select(m, a.y, b.y), select(m, a.z, b.z)};
}

}  // namespace millscope
