// Turns a plain C++ class into a wear_law plugin: how much of a wall a bead takes away.
//
//   struct MyWear {
//     MyWear(const Parameters&, const PairContext&);         // throws Refusal with the remedy
//     double worn_volume(const Rubbing&) const;              // m³ in this step
//   };
//   constexpr Descriptor kDescriptor = describe<MyWear>({.name = "my_wear", .doc = "…", .parameters = kParameters});
#pragma once

#include <algorithm>
#include <cmath>

#include "millscope/describe.hpp"
#include "millscope/parameters.hpp"
#include "millscope/wear_law.hpp"

namespace millscope {

/// A bead at a wall in one step.
struct Rubbing {
  bool first;           ///< they did not touch in the step before
  double time_step;     ///< s
  double closing;       ///< speed towards the wall, m/s; negative: away from it
  double along;         ///< speed along the wall, m/s
  double radius, mass;  ///< of the bead, m, kg
  double pressing;      ///< N, ≥ 0
  double sliding;       ///< m/s, ≥ 0; 0 while they stick
};

template <class W>
void evaluate_wear(const void* self, WearBatch* b) {
  const W& law = *static_cast<const W*>(self);
  for (std::int64_t s = 0; s < b->count; ++s) {
    double closing = 0, squared = 0;
    for (int a = 0; a < 3; ++a) {
      closing -= b->velocity[a][s] * b->normal[a][s];
      squared += b->velocity[a][s] * b->velocity[a][s];
    }
    const double along = std::sqrt(std::max(squared - closing * closing, 0.0));
    b->volume[s] =
        law.worn_volume(Rubbing{b->first[s] != 0, b->time_step, closing, along, b->radius[s], b->mass[s], b->pressing[s], b->sliding[s]});
  }
}

template <class W>
constexpr WearLawTable make_wear_law_table() {
  WearLawTable t{};
  t.create = [](const Values* values, const PairContext* pair, void** self, Failure* failure) -> Status {
    return guarded(failure, [&] { *self = new W(Parameters(*values), *pair); });
  };
  t.destroy = [](void* self) { delete static_cast<W*>(self); };
  t.evaluate = &evaluate_wear<W>;
  return t;
}

/// What tells a wear law from the other kinds.
template <class C>
concept WearLawClass = requires(const C& law, const Rubbing& rubbing) {
  law.worn_volume(rubbing);
};

template <WearLawClass C>
struct [[gnu::visibility("hidden")]] Adapter<C> {
  static constexpr Kind kind = Kind::wear_law;
  static constexpr std::uint64_t layout = kWearLawLayout;
  static constexpr std::uint64_t features = 0;
  static constexpr WearLawTable table = make_wear_law_table<C>();
};

}  // namespace millscope
