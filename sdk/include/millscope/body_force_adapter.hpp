// Turns a plain C++ class into a body_force plugin.
//
//   struct MyDrag {
//     explicit MyDrag(const Parameters&);                              // throws Refusal with the remedy
//     bool uniform(double time, double (&acceleration)[3]) const;      // may be absent: not the same for every bead
//     void act(const Bead&, BeadForce&) const;                         // may be absent when `uniform` always gives true
//   };
//   constexpr Descriptor kDescriptor = describe<MyDrag>({.name = "my_drag", .doc = "…", .parameters = kParameters});
#pragma once

#include "millscope/body_force.hpp"
#include "millscope/describe.hpp"
#include "millscope/pack.hpp"
#include "millscope/parameters.hpp"

namespace millscope {

/// One bead.
struct Bead {
  double time;
  double time_step;
  Vec<double> position, velocity, spin;
  double radius, mass;
};

/// What acts on it; zero on entry.
struct BeadForce {
  Vec<double> force;   ///< N
  Vec<double> moment;  ///< N m
  double added_mass;   ///< kg of fluid that moves with the bead
  double power;        ///< W taken from the bead (drag: > 0)
};

namespace detail {

template <class F>
concept HasUniform = requires(const F& f, double (&a)[3]) {
  f.uniform(0.0, a);
};
template <class F>
concept HasAct = requires(const F& f, const Bead& bead, BeadForce& out) {
  f.act(bead, out);
};

inline Vec<double> vector_at(const double* const (&p)[3], std::int64_t i) { return {p[0][i], p[1][i], p[2][i]}; }
inline void add_at(double* const (&p)[3], std::int64_t i, const Vec<double>& value) {
  p[0][i] += value.x;
  p[1][i] += value.y;
  p[2][i] += value.z;
}

template <class F>
void act_on_beads(const void* self, BodyForceBatch* b) {
  b->power_sum = 0.0;
  if constexpr (HasAct<F>) {
    for (std::int64_t i = 0; i < b->count; ++i) {
      const Bead bead{b->time,      b->time_step, vector_at(b->position, i), vector_at(b->velocity, i), vector_at(b->spin, i),
                      b->radius[i], b->mass[i]};
      BeadForce out{};
      static_cast<const F*>(self)->act(bead, out);
      add_at(b->force, i, out.force);
      add_at(b->moment, i, out.moment);
      b->added_mass[i] += out.added_mass;
      b->power_sum += out.power;
    }
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
