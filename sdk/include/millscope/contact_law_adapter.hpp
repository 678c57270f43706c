// Turns a plain C++ class into a contact_law plugin.
//
//   struct MyLaw {
//     static constexpr int kHistory = 3, kChannels = 2;
//     static constexpr PairTermInfo kInfo = pair_term({histories}, {channels});
//     explicit MyLaw(const Parameters&, const PairContext&);          // throws Refusal with the remedy
//     double reach(double radius) const;                              // 0 for laws that act on touch
//     double contact_time(double radius, double mass, double speed) const;  // s, estimate; 0: none
//     double restitution() const; double friction() const;            // the pair's own e and μ
//     template <class R> void force(const Contact<R>&, R (&history)[kHistory], Response<R, kChannels>&) const;
//   };
//   constexpr Descriptor kDescriptor = describe<MyLaw>({.name = "my_law", .doc = "…", .parameters = kParameters});
#pragma once

#include <string>

#include "millscope/contact_law.hpp"
#include "millscope/describe.hpp"
#include "millscope/pack.hpp"
#include "millscope/parameters.hpp"

namespace millscope {

/// One contact (R = double) or a pack of them.
template <class R>
struct Contact {
  R overlap;        ///< δ_n
  Vec<R> normal;    ///< n, from j to i
  Vec<R> velocity;  ///< of i relative to j at the contact point
  R radius;         ///< R*
  R mass;           ///< m*
  R restitution;    ///< e; the pair's own value unless a pair_parameter gives it
  R friction;       ///< μ
  R added_cap;      ///< added to F_n in Coulomb's cap
  R time_step;      ///< s
  R per_time_step;  ///< 1/s; 0 when the step is 0
  bool own_e;       ///< true: `restitution` is the pair's own in every lane, so that what follows from it was computed once
};

template <class R, int Channels>
struct Response {
  Vec<R> force;                          ///< on i, N
  R normal_force;                        ///< F_n along n
  R normal_stiffness;                    ///< elastic dF_n/dδ
  R elastic_energy;                      ///< J
  R power[Channels > 0 ? Channels : 1];  ///< W lost to each channel
};

template <class Law, class R>
void evaluate_contacts(const void* self, ContactBatch* b) {
  const Law& law = *static_cast<const Law*>(self);
  constexpr int width = kWidthOf<R>;
  R elastic_sum(0.0);
  R power_sum[Law::kChannels > 0 ? Law::kChannels : 1];
  for (R& p : power_sum) p = R(0.0);
  const std::int64_t count = b->count;
  const R time_step(b->time_step), per_time_step(b->time_step > 0.0 ? 1.0 / b->time_step : 0.0);  // read once: the stores may alias
  for (std::int64_t s = 0; s < count; s += width) {
    Contact<R> c;
    c.overlap = load<R>(b->overlap + s);
    c.normal = load_vector<R>(b->normal, s);
    c.velocity = load_vector<R>(b->velocity, s);
    c.radius = load<R>(b->radius + s);
    c.mass = load<R>(b->mass + s);
    c.restitution = b->restitution ? load<R>(b->restitution + s) : R(law.restitution());
    c.friction = b->friction ? load<R>(b->friction + s) : R(law.friction());
    c.added_cap = b->added_cap ? load<R>(b->added_cap + s) : R(0.0);
    c.time_step = time_step;
    c.per_time_step = per_time_step;
    c.own_e = b->restitution == nullptr;
    R history[Law::kHistory > 0 ? Law::kHistory : 1];
    for (int h = 0; h < Law::kHistory; ++h) history[h] = load<R>(b->history[h] + s);
    Response<R, Law::kChannels> out;
    law.force(c, history, out);
    for (int h = 0; h < Law::kHistory; ++h) store(b->history[h] + s, history[h]);
    store(b->force[0] + s, out.force.x);
    store(b->force[1] + s, out.force.y);
    store(b->force[2] + s, out.force.z);
    if (b->normal_force) store(b->normal_force + s, out.normal_force);
    if (b->normal_stiffness) store(b->normal_stiffness + s, out.normal_stiffness);
    if (b->elastic_energy) store(b->elastic_energy + s, out.elastic_energy);
    elastic_sum += out.elastic_energy;
    for (int k = 0; k < Law::kChannels; ++k) {
      if (b->power[k]) store(b->power[k] + s, out.power[k]);
      power_sum[k] += out.power[k];
    }
  }
  b->elastic_sum = lane_sum(elastic_sum);
  for (int k = 0; k < Law::kChannels; ++k) b->power_sum[k] = lane_sum(power_sum[k]);
}

template <class Law>
constexpr ContactLawTable make_contact_law_table() {
  static_assert(kTermIsSane<Law>,
                "kInfo must name kHistory histories (sign +1 or -1) and kChannels channels, within the limits of the SDK");
  ContactLawTable t{};
  t.info = Law::kInfo;
  t.create = [](const Values* values, const PairContext* pair, void** self, Failure* failure) -> Status {
    return guarded(failure, [&] { *self = new Law(Parameters(*values), *pair); });
  };
  t.destroy = [](void* self) { delete static_cast<Law*>(self); };
  t.reach = [](const void* self, double radius) { return static_cast<const Law*>(self)->reach(radius); };
  t.contact_time = [](const void* self, double radius, double mass, double speed) {
    return static_cast<const Law*>(self)->contact_time(radius, mass, speed);
  };
  t.evaluate = &evaluate_contacts<Law, Pack>;
  t.evaluate_scalar = &evaluate_contacts<Law, double>;
  return t;
}

/// What tells a contact law from the other kinds.
template <class C>
concept ContactLawClass = requires(const C& law) {
  law.contact_time(0.0, 0.0, 0.0);
};

template <ContactLawClass C>
struct [[gnu::visibility("hidden")]] Adapter<C> {
  static constexpr Kind kind = Kind::contact_law;
  static constexpr std::uint64_t layout = kContactLawLayout;
  static constexpr std::uint64_t features = 0;
  static constexpr ContactLawTable table = make_contact_law_table<C>();
};

}  // namespace millscope
