// Built three times (MILLSCOPE_WIDE = wide_v2, wide_v3, wide_v4). Everything here has internal linkage and no library template is
// used, so that no wide instruction can leak into code that runs on a smaller machine.
#include "kernel/dem/wide.hpp"

#include "kernel/dem/four.hpp"
#include "kernel/dem/wide_bodies.hpp"
#include "kernel/dem/wide_near.hpp"
#include "kernel/dem/wide_search.hpp"
#include "kernel/dem/wide_walls.hpp"

namespace millscope::dem {
namespace {

/// Four contacts from place k on: overlap, normal and the surfaces' relative velocity
/// v_i − v_j − (a_i ω_i + a_j ω_j) × n, a = r − δ/2; where interactions need them, the spins. Always inline, for g++ would
/// call it for every four pairs.
template <bool kEqual, bool kSpins, Repeats kRepeats>
[[gnu::always_inline]] inline void gather_four(const GatherContext& g, const Box4& box, std::int64_t k, const PairBatch& b) {
  const double* __restrict x = reinterpret_cast<const double*>(g.position);
  const double* __restrict m = reinterpret_cast<const double*>(g.motion);
  Four d[4], v[4], wi[4], wj[4], ri, rj;
  for (int c = 0; c < 4; ++c) {
    const std::int64_t i = b.owner[k + c], j = b.partner[k + c];
    d[c] = load4(x + 4 * i) + negate3(load4(x + 4 * j));
    v[c] = load4(m + 8 * i) + negate3(load4(m + 8 * j));
    wi[c] = load4(m + 8 * i + 4);
    wj[c] = load4(m + 8 * j + 4);
    if constexpr (kEqual && !kSpins) wi[c] += wj[c];
    if constexpr (!kEqual) {
      ri[c] = x[4 * i + 3];
      rj[c] = x[4 * j + 3];
    }
  }
  transpose(d[0], d[1], d[2], d[3]);
  each_minimum_image<kRepeats>(d, box);
  transpose(v[0], v[1], v[2], v[3]);
  transpose(wi[0], wi[1], wi[2], wi[3]);
  if constexpr (!kEqual || kSpins) transpose(wj[0], wj[1], wj[2], wj[3]);
  if constexpr (kSpins) {
    store_each(b.spin_i, k, wi);
    store_each(b.spin_j, k, wj);
  }
  const Four distance = root(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]), inverse = four(1.0) / distance;
  const Four n[3] = {d[0] * inverse, d[1] * inverse, d[2] * inverse};
  Four w[3];
  if constexpr (kEqual) {
    const Four arm = four(0.5) * distance;
    store4_unaligned(b.overlap + k, four(2 * g.radius) - distance);
    store4_unaligned(b.arm_i + k, arm);
    for (int a = 0; a < 3; ++a) w[a] = arm * (kSpins ? wi[a] + wj[a] : wi[a]);
  } else {
    const Four sum = ri + rj, half = four(0.5) * (sum - distance), arm_i = ri - half, arm_j = rj - half;
    store4_unaligned(b.overlap + k, sum - distance);
    store4_unaligned(b.radius_i + k, ri);
    store4_unaligned(b.radius_j + k, rj);
    store4_unaligned(b.radius + k, ri * rj / sum);
    store4_unaligned(b.mass + k, four(1.0) / v[3]);
    store4_unaligned(b.arm_i + k, arm_i);
    store4_unaligned(b.arm_j + k, arm_j);
    for (int a = 0; a < 3; ++a) w[a] = arm_i * wi[a] + arm_j * wj[a];
  }
  const Four surfaces[3] = {v[0] - (w[1] * n[2] - w[2] * n[1]), v[1] - (w[2] * n[0] - w[0] * n[2]), v[2] - (w[0] * n[1] - w[1] * n[0])};
  store_each(b.normal, k, n);
  store_each(b.velocity, k, surfaces);
}

template <bool kEqual, bool kSpins>
void gather_all(const GatherContext& context, const Box4& box, std::int64_t padded, const PairBatch& arrays) {
  const GatherContext g = context;
  const PairBatch b = arrays;
  with_repeats(box.repeats, [&]<Repeats kRepeats>() {
    for (std::int64_t k = 0; k < padded; k += 4) gather_four<kEqual, kSpins, kRepeats>(g, box, k, b);
  });
}

/// Histories come in the order of the contacts, so eight of them stand side by side unless one of them is fresh or another one has parted.
void gather_history(const PairListView& list, std::int64_t count, std::int64_t padded, PairBatch& b) {
  const std::uint8_t* __restrict fresh = b.fresh;
  const std::uint32_t* __restrict source = b.source;
  const auto one = [&](std::int64_t k) {
    for (std::int32_t h = 0; h < list.history_count; ++h) b.history[h][k] = fresh[k] ? 0.0 : list.history[h][source[k]];
  };
  std::int64_t k = 0;
  for (; k + 8 <= count; k += 8) {
    std::uint64_t any_fresh;
    __builtin_memcpy(&any_fresh, fresh + k, sizeof any_fresh);
    if (any_fresh == 0 && source[k + 7] - source[k] == 7) {
      for (std::int32_t h = 0; h < list.history_count; ++h)
        __builtin_memcpy(b.history[h] + k, list.history[h] + source[k], 8 * sizeof(double));
    } else {
      for (std::int64_t c = k; c < k + 8; ++c) one(c);
    }
  }
  for (; k < count; ++k) one(k);
  for (std::int32_t h = 0; h < list.history_count; ++h) {
    for (k = count; k < padded; ++k) b.history[h][k] = 0.0;
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
  for (std::int64_t k = count; k < padded; ++k) {
    owner[k] = owner[count - 1];
    partner[k] = partner[count - 1];
  }
  const auto all = g.equal ? (g.spins ? gather_all<true, true> : gather_all<true, false>)
                           : (g.spins ? gather_all<false, true> : gather_all<false, false>);
  all(g, box, padded, b);
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

template <bool kSame, bool kNotes>
std::int64_t scatter_lines(const ScatterContext& s, std::int64_t count, const PairBatch& arrays) {
  const PairBatch b = arrays;
  std::int64_t noted = 0;
  for (std::int64_t k = 0; k < count; k += 4) {
    Four f[4], ti[4], tj[4];
    lines_of(b.force, k, f);
    lines_of(b.torque_i, k, ti);
    if constexpr (!kSame) lines_of(b.torque_j, k, tj);
    const int lanes = count - k < 4 ? static_cast<int>(count - k) : 4;
    for (int c = 0; c < lanes; ++c) {
      const std::int64_t i = b.owner[k + c], j = b.partner[k + c];
      ForceLine* to_i = &s.force[i];
      store4(to_i->f, load4(to_i->f) + f[c]);
      store4(to_i->t, load4(to_i->t) + ti[c]);
      if (kNotes && j < s.own_begin) {
        s.noted_bead[noted] = b.partner[k + c];
        store4(s.noted_push[noted].f, four(0.0) - f[c]);
        store4(s.noted_push[noted++].t, kSame ? ti[c] : tj[c]);
        continue;
      }
      ForceLine* to_j = &s.force[j];
      store4(to_j->f, load4(to_j->f) - f[c]);
      store4(to_j->t, load4(to_j->t) + (kSame ? ti[c] : tj[c]));
    }
  }
  return noted;
}

std::int64_t scatter(const ScatterContext& s, PairListView& list, std::int64_t count, bool with_moments, PairBatch& b) {
  const std::int64_t padded = padded_count(count);
  torques(padded, s.equal, with_moments, b);
  const bool same = s.equal && !with_moments;
  std::int64_t noted = 0;
  if (s.noted_bead) {
    noted = same ? scatter_lines<true, true>(s, count, b) : scatter_lines<false, true>(s, count, b);
  } else {
    same ? scatter_lines<true, false>(s, count, b) : scatter_lines<false, false>(s, count, b);
  }
  for (std::int32_t h = 0; h < list.history_count; ++h) {
    const double* __restrict from = b.history[h];
    double* __restrict to = list.next[h] + list.written;
    for (std::int64_t k = 0; k < count; ++k) to[k] = from[k];
  }
  list.written += count;
  return noted;
}

/// What a step makes of one bead.
struct Moved {
  Four step, since_rebuild;  ///< x, y, z (m); the fourth lanes are of no use
  Four along;                ///< lanes whose sum over x, y, z is a·a₋ + R² α·α₋; the fourth: that sum of the step before
};

/// Kick, drift and predict of one bead.
inline Moved move_bead(const IntegrateContext& c, std::int64_t i) {
  const Four dt = four(c.time_step), half_dt = four(0.5 * c.time_step);
  const Four g = {c.acceleration[0], c.acceleration[1], c.acceleration[2], 0.0};
  const Four keep = {1.0, 1.0, 1.0, 0.0}, fourth = {0.0, 0.0, 0.0, 1.0};
  MotionLine& motion = c.motion[i];
  MotionLine& half = c.half[i];
  ForceLine& force = c.force[i];
  AccelerationLine& last = c.last[i];
  const Four a = (load4(force.f) * four(motion.inverse_mass) + g) * keep, last_a = load4_single(last.linear);
  const Four alpha = load4(force.t) * four(motion.inverse_inertia) * keep, last_alpha = load4_single(last.angular);
  const Four v = load4(half.v) + dt * a;
  const Four w = load4(half.w) + dt * alpha;
  const Four position = load4(&c.position[i]), step = dt * v * keep, x = position + step;
  store4_single(last.linear, a);
  store4_single(last.angular, alpha);
  store4(half.v, v);
  store4(half.w, w);
  store4(motion.v, v + half_dt * (a + (a - last_a)) * keep);
  store4(motion.w, w + half_dt * (alpha + (alpha - last_alpha)));
  store4(&c.position[i], x);
  store4(force.f, four(0.0));
  store4(force.t, four(0.0));
  const double square = x[3] * x[3];  // of the radius
  return {step, x - load4_single(c.reference[i].centre), (a + fourth) * last_a + four(square) * (alpha * last_alpha)};
}

/// Takes back what a bead was predicted to gain on its half step, the more the more it has turned round in both of the last two steps.
/// Steadily: a switch would make chaos of rounding.
void hold_back(const IntegrateContext& c, std::int64_t i, double along, double along_before) {
  constexpr double kSoon = 32;  // all is taken back even where accelerations grow threefold from step to step
  const MotionLine& half = c.half[i];
  MotionLine& motion = c.motion[i];
  const Four ahead = load4(motion.v) - load4(half.v), ahead_w = load4(motion.w) - load4(half.w);  // ½ Δt (2a − a₋)
  const Four a = load4_single(c.last[i].linear), alpha = load4_single(c.last[i].angular), per_time = four(2 / c.time_step);
  const Four last_a = a + a - per_time * ahead, last_alpha = alpha + alpha - per_time * ahead_w;
  const double square = c.position[i].radius * c.position[i].radius;
  const Four squares = a * a + last_a * last_a + four(square) * (alpha * alpha + last_alpha * last_alpha);
  const double largest = (squares[0] + squares[1] + squares[2]) / -kSoon;
  const auto turned = [&](double sum) { return sum > largest ? sum / largest : 1.0; };
  const Four used = four(1.0 - turned(along) * turned(along_before));
  store4(motion.v, load4(half.v) + used * ahead);
  store4(motion.w, load4(half.w) + used * ahead_w);
}

/// Notes for the next step how far four beads, or the first `count` of them, have gone on or turned round, and holds back those that
/// turned twice.
inline void judge_prediction(const IntegrateContext& c, std::int64_t i, Four (&along)[4], int count) {
  transpose(along[0], along[1], along[2], along[3]);
  const Four sum = along[0] + along[1] + along[2];
  const FourSingleAlias noted = __builtin_convertvector(sum, FourSingleAlias);
  for (int k = 0; k < count; ++k) c.last[i + k].linear[3] = noted[k];
  const int twice = bits_of((sum < four(0.0)) & (along[3] < four(0.0)));
  if (twice == 0) return;
  for (int k = 0; k < count; ++k) {
    if (twice >> k & 1) hold_back(c, i + k, sum[k], along[3][k]);
  }
}

IntegrateResult integrate(const IntegrateContext& context) {
  constexpr std::int64_t kFetchAhead = 24;  // beads: longer than a line takes to come from memory
  const IntegrateContext c = context;       // nobody else has its address, so that no store can change it
  IntegrateResult result{false, -1};
  const auto judge = [&](std::int64_t i, double step2, double moved2, double allowed2) {
    if (!(moved2 <= allowed2)) result.rebuild = true;
    if (result.runaway < 0 && !(step2 <= c.largest_step2)) result.runaway = i;
  };
  std::int64_t i = c.begin;
  for (; i + 4 <= c.end; i += 4) {
    Four step[4], moved[4], along[4];
    for (int k = 0; k < 4; ++k) {
      __builtin_prefetch(c.half + i + k + kFetchAhead, 1, 2);
      __builtin_prefetch(c.last + i + k + kFetchAhead, 1, 2);
      __builtin_prefetch(c.reference + i + k + kFetchAhead, 0, 2);
      const Moved bead = move_bead(c, i + k);
      step[k] = bead.step, moved[k] = bead.since_rebuild, along[k] = bead.along;
    }
    judge_prediction(c, i, along, 4);
    transpose(step[0], step[1], step[2], step[3]);
    transpose(moved[0], moved[1], moved[2], moved[3]);
    const Four step2 = step[0] * step[0] + step[1] * step[1] + step[2] * step[2];
    const Four moved2 = moved[0] * moved[0] + moved[1] * moved[1] + moved[2] * moved[2];
    const Four allowed2 = {c.reference[i].allowed2, c.reference[i + 1].allowed2, c.reference[i + 2].allowed2, c.reference[i + 3].allowed2};
    const FourBits sound = (moved2 <= allowed2) & (step2 <= four(c.largest_step2));
    if (bits_of(sound) == 0xf) continue;
    for (int k = 0; k < 4; ++k) judge(i + k, step2[k], moved2[k], allowed2[k]);
  }
  for (; i < c.end; ++i) {
    const Moved bead = move_bead(c, i);
    const Four step2 = bead.step * bead.step, moved2 = bead.since_rebuild * bead.since_rebuild;
    Four along[4] = {bead.along};
    judge_prediction(c, i, along, 1);
    judge(i, step2[0] + step2[1] + step2[2], moved2[0] + moved2[1] + moved2[2], static_cast<double>(c.reference[i].allowed2));
  }
  return result;
}

}  // namespace

extern const WideTable MILLSCOPE_WIDE;
const WideTable MILLSCOPE_WIDE = {MILLSCOPE_WIDE_NAME, search,        gather,         scatter,   to_frame, gather_walls,
                                  scatter_walls,       gather_bodies, scatter_bodies, integrate, near};

}  // namespace millscope::dem
