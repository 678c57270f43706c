// Turns a plain C++ class into a pair_parameter plugin: e or μ as a function of the pair's state.
//
//   struct MyRestitution {
//     static constexpr int kHistory = 1;
//     static constexpr PairParameterInfo kInfo = pair_parameter_info({histories});
//     static constexpr std::uint64_t kGives = kGivesRestitution;      // or kGivesFriction, or both
//     MyRestitution(const Parameters&, const PairContext&);           // throws Refusal with the remedy
//     template <class R> void values(const ParameterState<R>&, R* history, PairValues<R>&) const;
//   };
//   constexpr Descriptor kDescriptor = describe<MyRestitution>({.name = "my_restitution", .doc = "…", .parameters = kParameters});
#pragma once

#include "millscope/describe.hpp"
#include "millscope/pack.hpp"
#include "millscope/pair_parameter.hpp"
#include "millscope/parameters.hpp"

namespace millscope {

/// One pair within reach (R = double) or a pack of them.
template <class R>
struct ParameterState {
  R overlap;        ///< δ_n, m
  Vec<R> normal;    ///< n, from j to i
  Vec<R> velocity;  ///< of i relative to j at the contact point, m/s
  R radius;         ///< R*, m
  R mass;           ///< m*, kg
  R time_step;      ///< s
};

/// What the plugin gives; a value that is not among kGives is ignored.
template <class R>
struct PairValues {
  R restitution;  ///< e, 0…1
  R friction;     ///< μ, ≥ 0
};

template <class P, class R>
void evaluate_pair_parameter(const void* self, PairParameterBatch* b) {
  const P& parameter = *static_cast<const P*>(self);
  for (std::int64_t s = 0; s < b->count; s += kWidthOf<R>) {
    ParameterState<R> state;
    state.overlap = load<R>(b->overlap + s);
    state.normal = load_vector<R>(b->normal, s);
    state.velocity = load_vector<R>(b->velocity, s);
    state.radius = load<R>(b->radius + s);
    state.mass = load<R>(b->mass + s);
    state.time_step = R(b->time_step);
    R history[P::kHistory > 0 ? P::kHistory : 1];
    for (int h = 0; h < P::kHistory; ++h) history[h] = load<R>(b->history[h] + s);
    PairValues<R> out{R(0.0), R(0.0)};
    parameter.values(state, history, out);
    for (int h = 0; h < P::kHistory; ++h) store(b->history[h] + s, history[h]);
    if constexpr ((P::kGives & kGivesRestitution) != 0) store(b->restitution + s, out.restitution);
    if constexpr ((P::kGives & kGivesFriction) != 0) store(b->friction + s, out.friction);
  }
}

template <class P>
constexpr PairParameterTable make_pair_parameter_table() {
  static_assert((P::kGives & (kGivesRestitution | kGivesFriction)) != 0, "kGives says kGivesRestitution, kGivesFriction or both");
  static_assert(is_sane(P::kInfo) && P::kInfo.history_count == P::kHistory, "kInfo must name kHistory histories (sign +1 or -1)");
  PairParameterTable t{};
  t.info = P::kInfo;
  t.create = [](const Values* values, const PairContext* pair, void** self, Failure* failure) -> Status {
    return guarded(failure, [&] { *self = new P(Parameters(*values), *pair); });
  };
  t.destroy = [](void* self) { delete static_cast<P*>(self); };
  t.evaluate = &evaluate_pair_parameter<P, Pack>;
  return t;
}

/// What tells a pair parameter from the other kinds.
template <class C>
concept PairParameterClass = requires {
  C::kGives;
};

template <PairParameterClass C>
struct [[gnu::visibility("hidden")]] Adapter<C> {
  static constexpr Kind kind = Kind::pair_parameter;
  static constexpr std::uint64_t layout = kPairParameterLayout;
  static constexpr std::uint64_t features = C::kGives;
  static constexpr PairParameterTable table = make_pair_parameter_table<C>();
};

}  // namespace millscope
