// Turns a plain C++ class into a body_force plugin.
//
//   struct MyDrag {
//     explicit MyDrag(const Parameters&);                              // throws Refusal with the remedy
//     bool uniform(double time, double (&acceleration)[3]) const;      // may be absent: not the same for every bead
//     void act(const Bead&, BeadForce&) const;                         // may be absent when `uniform` always gives true
//   };
//   constexpr Descriptor kDescriptor = describe<MyDrag>({.name = "my_drag", .doc = "…", .parameters = kParameters});
//
// Faster: `template <class R> void act(const BeadState<R>&, BeadResponse<R>&) const`, for R = double or Pack, which is several beads at
// once.
#pragma once

#include "millscope/body_force.hpp"
#include "millscope/describe.hpp"
#include "millscope/pack.hpp"
#include "millscope/parameters.hpp"

namespace millscope {

/// One bead (R = double) or a pack of them.
template <class R>
struct BeadState {
  double time;       ///< s
  double time_step;  ///< s
  Vec<R> position;   ///< m
  Vec<R> velocity;   ///< m/s
  Vec<R> spin;       ///< rad/s
  R radius;          ///< m
  R mass;            ///< kg
};
using Bead = BeadState<double>;

/// What acts on it; zero on entry.
template <class R>
struct BeadResponse {
  Vec<R> force;   ///< N
  Vec<R> moment;  ///< N m
  R added_mass;   ///< kg of fluid that moves with the bead
  R power;        ///< W taken from the bead (drag: > 0)
};
using BeadForce = BeadResponse<double>;

namespace detail {

template <class F>
concept HasUniform = requires(const F& f, double (&a)[3]) {
  f.uniform(0.0, a);
};
template <class F>
concept HasAct = requires(const F& f, const Bead& bead, BeadForce& out) {
  f.act(bead, out);
};
template <class F>
concept HasWideAct = requires(const F& f, const BeadState<Pack>& beads, BeadResponse<Pack>& out) {
  f.act(beads, out);
};

/// Bead i, or the pack that begins there; what it takes from them, W.
template <class R, class F>
R act_at(const F& force, BodyForceBatch& b, std::int64_t i) {
  const R zero(0.0);
  const BeadState<R> bead{b.time,
                          b.time_step,
                          load_vector<R>(b.position, i),
                          load_vector<R>(b.velocity, i),
                          load_vector<R>(b.spin, i),
                          load<R>(b.radius + i),
                          load<R>(b.mass + i)};
  BeadResponse<R> out{{zero, zero, zero}, {zero, zero, zero}, zero, zero};
  force.act(bead, out);
  add_vector(b.force, i, out.force);
  add_vector(b.moment, i, out.moment);
  add_to(b.added_mass + i, out.added_mass);
  return out.power;
}

template <class F>
void act_on_beads(const void* self, BodyForceBatch* b) {
  b->power_sum = 0.0;
  std::int64_t i = 0;
  if constexpr (HasWideAct<F>) {
    for (; i + kPackWidth <= b->count; i += kPackWidth) {
      const Pack power = act_at<Pack>(*static_cast<const F*>(self), *b, i);
      for (int lane = 0; lane < kPackWidth; ++lane) b->power_sum += power.v[lane];  // bead by bead: the same bits at every width
    }
  }
  if constexpr (HasAct<F>) {
    for (; i < b->count; ++i) b->power_sum += act_at<double>(*static_cast<const F*>(self), *b, i);
  }
}

}  // namespace detail

template <class F>
constexpr BodyForceTable make_body_force_table() {
  static_assert(detail::HasUniform<F> || detail::HasAct<F>, "a body force has uniform(time, acceleration), act(bead, force), or both");
  BodyForceTable t{};
  t.create = [](const Values* values, void** self, Failure* failure) -> Status {
    return guarded(failure, [&] { *self = new F(Parameters(*values)); });
  };
  t.destroy = [](void* self) { delete static_cast<F*>(self); };
  t.uniform = [](const void* self, double time, double acceleration[3]) -> std::int32_t {
    if constexpr (detail::HasUniform<F>) {
      double found[3] = {};
      const bool is_uniform = static_cast<const F*>(self)->uniform(time, found);
      for (int axis = 0; axis < 3; ++axis) acceleration[axis] = found[axis];
      return is_uniform ? 1 : 0;
    } else {
      return static_cast<void>(self), static_cast<void>(time), static_cast<void>(acceleration), 0;
    }
  };
  t.evaluate = &detail::act_on_beads<F>;
  return t;
}

/// What tells a body force from the other kinds.
template <class C>
concept BodyForceClass = detail::HasUniform<C> || detail::HasAct<C>;

template <BodyForceClass C>
struct [[gnu::visibility("hidden")]] Adapter<C> {
  static constexpr Kind kind = Kind::body_force;
  static constexpr std::uint64_t layout = kBodyForceLayout;
  static constexpr std::uint64_t features = 0;
  static constexpr BodyForceTable table = make_body_force_table<C>();
};

}  // namespace millscope
