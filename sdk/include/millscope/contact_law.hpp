// The table of a contact_law: normal and tangential force of a contact.
#pragma once

#include "millscope/pair_term.hpp"

namespace millscope {

struct ContactBatch {
  std::int64_t count;              ///< slots, a multiple of kLanes
  double time_step;                ///< s
  const double* overlap;           ///< δ, m; negative: a gap
  const double* normal[3];         ///< n, unit
  const double* velocity[3];       ///< relative velocity of the surfaces, m/s
  const double* radius;            ///< R*, m
  const double* mass;              ///< m*, kg
  const double* restitution;       ///< e per contact, or nullptr: the pair's
  const double* friction;          ///< μ per contact, or nullptr: the pair's
  const double* added_cap;         ///< N added to the normal force in Coulomb's cap, or nullptr
  double* history[kMaxHistory];    ///< in/out; zero at first touch
  double* force[3];                ///< out: contact force on i, N
  double* normal_force;            ///< out: F_n along n, N, positive pushes apart
  double* normal_stiffness;        ///< out: dF_n/dδ of the elastic part, N/m
  double* elastic_energy;          ///< out per contact, J, or nullptr
  double* power[kMaxChannels];     ///< out per contact: W lost to each channel, or nullptr
  double elastic_sum;              ///< out: Σ elastic_energy
  double power_sum[kMaxChannels];  ///< out: Σ power
};
template <>
struct Layout<ContactBatch> {
  using S = ContactBatch;
  static constexpr std::size_t offsets[] = {
      offsetof(S, count),   offsetof(S, time_step),   offsetof(S, overlap),      offsetof(S, normal),           offsetof(S, velocity),
      offsetof(S, radius),  offsetof(S, mass),        offsetof(S, restitution),  offsetof(S, friction),         offsetof(S, added_cap),
      offsetof(S, history), offsetof(S, force),       offsetof(S, normal_force), offsetof(S, normal_stiffness), offsetof(S, elastic_energy),
      offsetof(S, power),   offsetof(S, elastic_sum), offsetof(S, power_sum)};
};

struct ContactLawTable {
  PairTermInfo info;
  Status (*create)(const Values*, const PairContext*, void** self, Failure*);
  void (*destroy)(void* self);
  double (*reach)(const void* self, double radius);  ///< largest gap at which the law acts, m, ≥ 0
  void (*evaluate)(const void* self, ContactBatch*);
  void (*evaluate_scalar)(const void* self, ContactBatch*);                            ///< the oracle of the tests
  double (*contact_time)(const void* self, double radius, double mass, double speed);  ///< s, estimate; 0: none
};
template <>
struct Layout<ContactLawTable> {
  using S = ContactLawTable;
  static constexpr std::size_t offsets[] = {offsetof(S, info),        offsetof(S, create),   offsetof(S, destroy),
                                            offsetof(S, reach),       offsetof(S, evaluate), offsetof(S, evaluate_scalar),
                                            offsetof(S, contact_time)};
};

inline constexpr std::uint64_t kContactLawLayout =
    layout_hash(Kind::contact_law, {kMaxHistory, kMaxChannels}, PairStructs<PairTermInfo, Channel, ContactBatch, ContactLawTable>{});

}  // namespace millscope
