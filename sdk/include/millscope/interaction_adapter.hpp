// Turns a plain C++ class into an interaction plugin: what acts on a pair besides its contact law.
//
//   struct MyInteraction {
//     static constexpr int kHistory = 0, kChannels = 1;               // both may be 0
//     static constexpr PairTermInfo kInfo = pair_term({histories}, {channels});
//     MyInteraction(const Parameters&, const PairContext&);           // throws Refusal with the remedy
//     double reach(double radius) const;                              // largest gap at which it acts, m; 0: on touch only
//     template <class R> void pre(const PairState<R>&, R* history, PreResponse<R, kChannels>&) const;    // either this
//     template <class R> void post(const PairState<R>&, R* history, PostResponse<R, kChannels>&) const;  // or this
//   };
//   constexpr Descriptor kDescriptor = describe<MyInteraction>({.name = "my_interaction", .doc = "…", .parameters = kParameters});
//
// `pre` acts before the contact law (an added normal force, an added Coulomb cap); `post` acts after it and turns the bodies.
// The responses are zero on entry; R is double (the oracle) or Pack. Padding has overlap −1: give zero there, as without contact.
#pragma once

#include "millscope/describe.hpp"
#include "millscope/interaction.hpp"
#include "millscope/pack.hpp"
#include "millscope/parameters.hpp"

namespace millscope {

/// One pair within reach (R = double) or a pack of them.
template <class R>
struct PairState {
  R overlap;           ///< δ_n, m; negative: a gap
  Vec<R> normal;       ///< n, from j to i
  Vec<R> velocity;     ///< of i relative to j at the contact point, m/s
  Vec<R> spin_i;       ///< ω_i, rad/s
  Vec<R> spin_j;       ///< ω_j, rad/s; a wall's is its own
  R radius_i;          ///< m
  R radius_j;          ///< m; 0 for a wall, which is flat (R_j = ∞)
  R radius;            ///< R*, m
  R mass;              ///< m*, kg
  R normal_force;      ///< post: F_n of the law and all pre interactions, N; pre: 0
  R normal_stiffness;  ///< post: elastic dF_n/dδ, N/m; pre: 0
  R time_step;         ///< s
};

/// What a pre interaction adds.
template <class R, int Channels>
struct PreResponse {
  R added_force;                         ///< along n, N, positive pushes apart
  R added_cap;                           ///< added to F_n in Coulomb's cap, N
  R elastic_energy;                      ///< J
  R power[Channels > 0 ? Channels : 1];  ///< W lost to each channel
};

/// What a post interaction adds.
template <class R, int Channels>
struct PostResponse {
  Vec<R> moment_i;                       ///< on i, N m
  Vec<R> moment_j;                       ///< on j, N m
  R elastic_energy;                      ///< J
  R power[Channels > 0 ? Channels : 1];  ///< W lost to each channel
};

namespace detail {

template <class I>
concept HasPre = requires(const I& i, const PairState<double>& s, double (&h)[I::kHistory > 0 ? I::kHistory : 1],
                          PreResponse<double, I::kChannels>& out) {
  i.pre(s, h, out);
};
template <class I>
concept HasPost = requires(const I& i, const PairState<double>& s, double (&h)[I::kHistory > 0 ? I::kHistory : 1],
                           PostResponse<double, I::kChannels>& out) {
  i.post(s, h, out);
};

template <class R>
PairState<R> load_pair(const InteractionBatch& b, std::int64_t s) {
  PairState<R> p;
  p.overlap = load<R>(b.overlap + s);
  p.normal = load_vector<R>(b.normal, s);
  p.velocity = load_vector<R>(b.velocity, s);
  p.spin_i = load_vector<R>(b.spin_i, s);
  p.spin_j = load_vector<R>(b.spin_j, s);
  p.radius_i = load<R>(b.radius_i + s);
  p.radius_j = load<R>(b.radius_j + s);
  p.radius = load<R>(b.radius + s);
  p.mass = load<R>(b.mass + s);
  p.normal_force = b.normal_force ? load<R>(b.normal_force + s) : R(0.0);
  p.normal_stiffness = b.normal_stiffness ? load<R>(b.normal_stiffness + s) : R(0.0);
  p.time_step = R(b.time_step);
  return p;
}

/// Calls pre or post on one pack and adds what it gives to the batch; returns the response for the sums.
template <class I, class R>
auto respond(const I& interaction, const PairState<R>& pair, R (&history)[I::kHistory > 0 ? I::kHistory : 1], InteractionBatch& b,
             std::int64_t s) {
  const R zero(0.0);
  if constexpr (HasPre<I>) {
    PreResponse<R, I::kChannels> out;
    out.added_force = out.added_cap = out.elastic_energy = zero;
    for (R& p : out.power) p = zero;
    interaction.pre(pair, history, out);
    add_to(b.added_force + s, out.added_force);
    add_to(b.added_cap + s, out.added_cap);
    return out;
  } else {
    PostResponse<R, I::kChannels> out;
    out.moment_i = out.moment_j = {zero, zero, zero};
    out.elastic_energy = zero;
    for (R& p : out.power) p = zero;
    interaction.post(pair, history, out);
    add_vector(b.moment_i, s, out.moment_i);
    add_vector(b.moment_j, s, out.moment_j);
    return out;
  }
}

}  // namespace detail

template <class I, class R>
void evaluate_interaction(const void* self, InteractionBatch* b) {
  const I& interaction = *static_cast<const I*>(self);
  R elastic_sum(0.0);
  R power_sum[I::kChannels > 0 ? I::kChannels : 1];
  for (R& p : power_sum) p = R(0.0);
  for (std::int64_t s = 0; s < b->count; s += kWidthOf<R>) {
    const PairState<R> pair = detail::load_pair<R>(*b, s);
    R history[I::kHistory > 0 ? I::kHistory : 1];
    for (int h = 0; h < I::kHistory; ++h) history[h] = load<R>(b->history[h] + s);
    const auto out = detail::respond(interaction, pair, history, *b, s);
    for (int h = 0; h < I::kHistory; ++h) store(b->history[h] + s, history[h]);
    elastic_sum += out.elastic_energy;
    for (int k = 0; k < I::kChannels; ++k) power_sum[k] += out.power[k];
  }
  b->elastic_sum = lane_sum(elastic_sum);
  for (int k = 0; k < I::kChannels; ++k) b->power_sum[k] = lane_sum(power_sum[k]);
}

template <class I>
constexpr InteractionTable make_interaction_table() {
  static_assert(detail::HasPre<I> != detail::HasPost<I>, "an interaction has either pre(…) or post(…), a template over R = double, Pack");
  static_assert(kTermIsSane<I>, "kInfo must name kHistory histories (sign +1 or -1) and kChannels channels, within the limits of the SDK");
  InteractionTable t{};
  t.info = I::kInfo;
  t.create = [](const Values* values, const PairContext* pair, void** self, Failure* failure) -> Status {
    return guarded(failure, [&] { *self = new I(Parameters(*values), *pair); });
  };
  t.destroy = [](void* self) { delete static_cast<I*>(self); };
  t.reach = [](const void* self, double radius) { return static_cast<const I*>(self)->reach(radius); };
  t.evaluate = &evaluate_interaction<I, Pack>;
  t.evaluate_scalar = &evaluate_interaction<I, double>;
  return t;
}

/// What tells an interaction from the other kinds.
template <class C>
concept InteractionClass = requires(const C& interaction) {
  interaction.reach(0.0);
  C::kHistory;
}
&&!requires(const C& law) { law.contact_time(0.0, 0.0, 0.0); };

template <InteractionClass C>
struct [[gnu::visibility("hidden")]] Adapter<C> {
  static constexpr Kind kind = Kind::interaction;
  static constexpr std::uint64_t layout = kInteractionLayout;
  static constexpr std::uint64_t features = detail::HasPre<C> ? kPreInteraction : kPostInteraction;
  static constexpr InteractionTable table = make_interaction_table<C>();
};

}  // namespace millscope
