// Built three times (MILLSCOPE_WIDE = wide_v2, wide_v3, wide_v4). Everything here has internal linkage and no library template is
// used, so that no wide instruction can leak into code that runs on a smaller machine.
#include "kernel/dem/wide.hpp"

#include "kernel/dem/four.hpp"
#include "kernel/dem/wide_search.hpp"
#include "kernel/dem/wide_walls.hpp"

namespace millscope::dem {
namespace {

inline double root(double a) { return __builtin_sqrt(a); }

/// Loads the raw differences of four contacts starting at k.
template <bool kEqual, bool kPeriodic>
inline void gather_four(const GatherContext& g, const Box4& box, std::int64_t k, const PairBatch& b) {
  const double* __restrict x = reinterpret_cast<const double*>(g.position);
  const double* __restrict m = reinterpret_cast<const double*>(g.motion);
  Four d[4], v[4], w[4];
  Four ri, rj;
  for (int c = 0; c < 4; ++c) {
    const std::int64_t i = b.owner[k + c], j = b.partner[k + c];
    d[c] = load4(x + 4 * i) + negate3(load4(x + 4 * j));
    v[c] = load4(m + 8 * i) + negate3(load4(m + 8 * j));
    if constexpr (kEqual) {
      w[c] = load4(m + 8 * i + 4) + load4(m + 8 * j + 4);
    } else {
      ri[c] = x[4 * i + 3];
      rj[c] = x[4 * j + 3];
    }
  }
  transpose(d[0], d[1], d[2], d[3]);
  if constexpr (kPeriodic) each_minimum_image(d, box);
  transpose(v[0], v[1], v[2], v[3]);
  for (int a = 0; a < 3; ++a) {
    store4_unaligned(b.difference[a] + k, d[a]);
    store4_unaligned(b.velocity[a] + k, v[a]);
  }
  if constexpr (kEqual) {
    transpose(w[0], w[1], w[2], w[3]);
    for (int a = 0; a < 3; ++a) store4_unaligned(b.spin_sum[a] + k, w[a]);
  } else {
    store4_unaligned(b.radius_i + k, ri);
    store4_unaligned(b.radius_j + k, rj);
    store4_unaligned(b.mass + k, four(1.0) / v[3]);
  }
}

void gather_spins(const GatherContext& g, std::int64_t padded, PairBatch& b) {
  const double* m = reinterpret_cast<const double*>(g.motion);
  for (std::int64_t k = 0; k < padded; k += 4) {
    Four p[4], q[4];
    for (int c = 0; c < 4; ++c) {
      p[c] = load4(m + 8 * static_cast<std::int64_t>(b.owner[k + c]) + 4);
      q[c] = load4(m + 8 * static_cast<std::int64_t>(b.partner[k + c]) + 4);
    }
    transpose(p[0], p[1], p[2], p[3]);
    transpose(q[0], q[1], q[2], q[3]);
    for (int a = 0; a < 3; ++a) {
      store4_unaligned(b.spin_i[a] + k, p[a]);
      store4_unaligned(b.spin_j[a] + k, q[a]);
    }
  }
}

/// Overlap, normal and the surfaces' relative velocity v_i − v_j − (a_i ω_i + a_j ω_j) × n, a = r − δ/2.
template <bool kEqual>
void kinematics(std::int64_t n, double radius, PairBatch& arrays) {
  const PairBatch b = arrays;
  const double* __restrict dx = b.difference[0];
  const double* __restrict dy = b.difference[1];
  const double* __restrict dz = b.difference[2];
  double* __restrict nx = b.normal[0];
  double* __restrict ny = b.normal[1];
  double* __restrict nz = b.normal[2];
  double* __restrict vx = b.velocity[0];
  double* __restrict vy = b.velocity[1];
  double* __restrict vz = b.velocity[2];
  double* __restrict overlap = b.overlap;
  double* __restrict arm_i = b.arm_i;
  double* __restrict arm_j = b.arm_j;
  const double* __restrict ri = b.radius_i;
  const double* __restrict rj = b.radius_j;
  double* __restrict reduced = b.radius;
  const double* __restrict sx = b.spin_sum[0];
  const double* __restrict sy = b.spin_sum[1];
  const double* __restrict sz = b.spin_sum[2];
  const double* __restrict pix = b.spin_i[0];
  const double* __restrict piy = b.spin_i[1];
  const double* __restrict piz = b.spin_i[2];
  const double* __restrict pjx = b.spin_j[0];
  const double* __restrict pjy = b.spin_j[1];
  const double* __restrict pjz = b.spin_j[2];
#pragma GCC ivdep
  for (std::int64_t k = 0; k < n; ++k) {
    const double d = root(dx[k] * dx[k] + dy[k] * dy[k] + dz[k] * dz[k]);
    const double inverse = 1.0 / d;
    nx[k] = dx[k] * inverse;
    ny[k] = dy[k] * inverse;
    nz[k] = dz[k] * inverse;
    double wx, wy, wz;
    if constexpr (kEqual) {
      overlap[k] = 2 * radius - d;
      const double arm = 0.5 * d;
      arm_i[k] = arm;
      wx = arm * sx[k];
      wy = arm * sy[k];
      wz = arm * sz[k];
    } else {
      const double sum = ri[k] + rj[k];
      const double half = 0.5 * (sum - d);
      overlap[k] = sum - d;
      reduced[k] = ri[k] * rj[k] / sum;
      arm_i[k] = ri[k] - half;
      arm_j[k] = rj[k] - half;
      wx = arm_i[k] * pix[k] + arm_j[k] * pjx[k];
      wy = arm_i[k] * piy[k] + arm_j[k] * pjy[k];
      wz = arm_i[k] * piz[k] + arm_j[k] * pjz[k];
    }
    vx[k] -= wy * nz[k] - wz * ny[k];
    vy[k] -= wz * nx[k] - wx * nz[k];
    vz[k] -= wx * ny[k] - wy * nx[k];
  }
}

void gather_history(const PairListView& list, std::int64_t count, std::int64_t padded, PairBatch& b) {
  for (std::int32_t h = 0; h < list.history_count; ++h) {
    const double* __restrict from = list.history[h];
    double* __restrict to = b.history[h];
    const std::uint8_t* __restrict fresh = b.fresh;
    const std::uint32_t* __restrict source = b.source;
    for (std::int64_t k = 0; k < count; ++k) to[k] = fresh[k] ? 0.0 : from[source[k]];
    for (std::int64_t k = count; k < padded; ++k) to[k] = 0.0;
  }
}

/// Padding: a gap of 1 m, at rest; R* and m* are those of the last contact.
void pad(std::int64_t count, std::int64_t padded, PairBatch& b) {
  for (std::int64_t k = count; k < padded; ++k) {
    b.overlap[k] = -1.0;
    for (int a = 0; a < 3; ++a) {
      b.normal[a][k] = a == 0 ? 1.0 : 0.0;
      b.velocity[a][k] = b.spin_i[a][k] = b.spin_j[a][k] = 0.0;
    }
  }
}

void gather(const GatherContext& g, const PairListView& list, std::int64_t count, PairBatch& b) {
  const Box4 box = box4(g.box);
  const std::int64_t padded = padded_count(count);
  std::uint32_t* __restrict owner = b.owner;
  std::uint32_t* __restrict partner = b.partner;
  const std::uint32_t* __restrict slot = b.slot;
  for (std::int64_t k = 0; k < count; ++k) {
    owner[k] = list.owner[slot[k]];
    partner[k] = list.partner[slot[k]];
  }
  for (std::int64_t k = count; k < padded; ++k) {
    owner[k] = owner[count - 1];
    partner[k] = partner[count - 1];
  }
  if (g.spins || !g.equal) gather_spins(g, padded, b);
  const PairBatch local = b;
  if (g.equal) {
    if (box.any) {
      for (std::int64_t k = 0; k < padded; k += 4) gather_four<true, true>(g, box, k, local);
    } else {
      for (std::int64_t k = 0; k < padded; k += 4) gather_four<true, false>(g, box, k, local);
    }
    kinematics<true>(padded, g.radius, b);
  } else {
    if (box.any) {
      for (std::int64_t k = 0; k < padded; k += 4) gather_four<false, true>(g, box, k, local);
    } else {
      for (std::int64_t k = 0; k < padded; k += 4) gather_four<false, false>(g, box, k, local);
    }
    kinematics<false>(padded, 0.0, b);
  }
  gather_history(list, count, padded, b);
  for (std::int32_t h = 0; h < list.history_count; ++h) {  // those of the next batch, about as many
    for (std::int64_t k = 0; k < count; k += 8) __builtin_prefetch(list.history[h] + list.read + k, 0, 2);
  }
  pad(count, padded, b);
}

/// Torque on either bead: a (F × n); unequal beads have their own arms.
void torques(std::int64_t n, bool equal, bool with_moments, PairBatch& arrays) {
  const PairBatch b = arrays;
  for (int a = 0; a < 3; ++a) {
    const int p = (a + 1) % 3, q = (a + 2) % 3;
    const double* __restrict fp = b.force[p];
    const double* __restrict fq = b.force[q];
    const double* __restrict np = b.normal[p];
    const double* __restrict nq = b.normal[q];
    const double* __restrict arm_i = b.arm_i;
    const double* __restrict arm_j = b.arm_j;
    const double* __restrict mi = b.moment_i[a];
    const double* __restrict mj = b.moment_j[a];
    double* __restrict ti = b.torque_i[a];
    double* __restrict tj = b.torque_j[a];
    if (equal && !with_moments) {
      for (std::int64_t k = 0; k < n; ++k) ti[k] = arm_i[k] * (fp[k] * nq[k] - fq[k] * np[k]);
    } else {
      const double* __restrict other = equal ? arm_i : arm_j;
      for (std::int64_t k = 0; k < n; ++k) {
        const double c = fp[k] * nq[k] - fq[k] * np[k];
        ti[k] = arm_i[k] * c;
        tj[k] = other[k] * c;
      }
      if (with_moments) {
        for (std::int64_t k = 0; k < n; ++k) {
          ti[k] += mi[k];
          tj[k] += mj[k];
        }
      }
    }
  }
}

template <bool kSame>
void scatter_lines(const ScatterContext& s, std::int64_t count, const PairBatch& arrays) {
  const PairBatch b = arrays;
  for (std::int64_t k = 0; k < count; k += 4) {
    Four f[4] = {load4(b.force[0] + k), load4(b.force[1] + k), load4(b.force[2] + k), four(0.0)};
    Four ti[4] = {load4(b.torque_i[0] + k), load4(b.torque_i[1] + k), load4(b.torque_i[2] + k), four(0.0)};
    Four tj[4] = {};
    transpose(f[0], f[1], f[2], f[3]);
    transpose(ti[0], ti[1], ti[2], ti[3]);
    if constexpr (!kSame) {
      tj[0] = load4(b.torque_j[0] + k);
      tj[1] = load4(b.torque_j[1] + k);
      tj[2] = load4(b.torque_j[2] + k);
      transpose(tj[0], tj[1], tj[2], tj[3]);
    }
    const int lanes = count - k < 4 ? static_cast<int>(count - k) : 4;
    for (int c = 0; c < lanes; ++c) {
      const std::int64_t i = b.owner[k + c], j = b.partner[k + c];
      ForceLine* to_i = &s.force[i];
      ForceLine* to_j = j < s.slab_end ? &s.force[j] : s.halo + (j - s.slab_end);
      store4(to_i->f, load4(to_i->f) + f[c]);
      store4(to_i->t, load4(to_i->t) + ti[c]);
      store4(to_j->f, load4(to_j->f) - f[c]);
      store4(to_j->t, load4(to_j->t) + (kSame ? ti[c] : tj[c]));
    }
  }
}

void scatter(const ScatterContext& s, PairListView& list, std::int64_t count, bool with_moments, PairBatch& b) {
  const std::int64_t padded = padded_count(count);
  torques(padded, s.equal, with_moments, b);
  if (s.equal && !with_moments) {
    scatter_lines<true>(s, count, b);
  } else {
    scatter_lines<false>(s, count, b);
  }
  for (std::int32_t h = 0; h < list.history_count; ++h) {
    const double* __restrict from = b.history[h];
    double* __restrict to = list.next[h] + list.written;
    for (std::int64_t k = 0; k < count; ++k) to[k] = from[k];
  }
  list.written += count;
}

IntegrateResult integrate(const IntegrateContext& c) {
  constexpr std::int64_t kFetchAhead = 24;  // beads: longer than a line takes to come from memory
  IntegrateResult result{false, -1};
  const Four dt = four(c.time_step), half_dt = four(0.5 * c.time_step);
  const Four g = {c.acceleration[0], c.acceleration[1], c.acceleration[2], 0.0};
  const Four keep = {1.0, 1.0, 1.0, 0.0};
  for (std::int64_t i = c.begin; i < c.end; ++i) {
    __builtin_prefetch(c.half + i + kFetchAhead, 1, 2);
    __builtin_prefetch(c.last + i + kFetchAhead, 1, 2);
    __builtin_prefetch(c.reference + i + kFetchAhead, 0, 2);
    MotionLine& motion = c.motion[i];
    MotionLine& half = c.half[i];
    ForceLine& force = c.force[i];
    const Four a = (load4(force.f) * four(motion.inverse_mass) + g) * keep;
    const Four alpha = load4(force.t) * four(motion.inverse_inertia) * keep;
    AccelerationLine& last = c.last[i];
    const Four next_a = a + (a - load4_single(last.linear)), next_alpha = alpha + (alpha - load4_single(last.angular));
    store4_single(last.linear, a);
    store4_single(last.angular, alpha);
    const Four v = load4(half.v) + dt * a;
    const Four w = load4(half.w) + dt * alpha;
    const Four step = dt * v * keep;
    const Four x = load4(&c.position[i]) + step;
    const Four moved = (x - load4_single(c.reference[i].centre)) * keep;
    const Four step2 = step * step, moved2 = moved * moved;
    store4(half.v, v);
    store4(half.w, w);
    store4(motion.v, v + half_dt * next_a);
    store4(motion.w, w + half_dt * next_alpha);
    store4(&c.position[i], x);
    store4(force.f, four(0.0));
    store4(force.t, four(0.0));
    if (!(moved2[0] + moved2[1] + moved2[2] <= static_cast<double>(c.reference[i].allowed2))) result.rebuild = true;
    if (!(step2[0] + step2[1] + step2[2] <= c.largest_step2)) result.runaway = i;
  }
  return result;
}

std::int64_t near(const PositionLine* reaches, const PeriodicBox& periodic, std::int64_t i, std::int64_t first, std::int64_t last,
                  std::uint32_t* found) {
  const Box4 box = box4(periodic);
  const Four own = load4(reaches + i);
  std::int64_t n = 0, j = first;
  for (; j + 4 <= last; j += 4) {
    Four d[4];
    for (int k = 0; k < 4; ++k) {
      d[k] = own + negate3(load4(reaches + j + k));
    }
    transpose(d[0], d[1], d[2], d[3]);
    if (box.any) each_minimum_image(d, box);
    const FourBits hit = (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]) < (d[3] * d[3]);
    for (int k = 0; k < 4; ++k) {
      found[n] = static_cast<std::uint32_t>(j + k);
      n += hit[k] & 1;
    }
  }
  for (; j < last; ++j) {
    Four d = own + negate3(load4(reaches + j));
    if (box.any) d = minimum_image(d, box);
    found[n] = static_cast<std::uint32_t>(j);
    n += d[0] * d[0] + d[1] * d[1] + d[2] * d[2] < d[3] * d[3];
  }
  return n;
}

}  // namespace

extern const WideTable MILLSCOPE_WIDE;
const WideTable MILLSCOPE_WIDE = {MILLSCOPE_WIDE_NAME, search, gather, scatter, to_frame, gather_walls, scatter_walls, integrate, near};

}  // namespace millscope::dem
