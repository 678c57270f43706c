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
  static constexpr Member members[] = {
      MILLSCOPE_MEMBER(S, count),        MILLSCOPE_MEMBER(S, time_step),        MILLSCOPE_MEMBER(S, overlap),
      MILLSCOPE_MEMBER(S, normal),       MILLSCOPE_MEMBER(S, velocity),         MILLSCOPE_MEMBER(S, radius),
      MILLSCOPE_MEMBER(S, mass),         MILLSCOPE_MEMBER(S, restitution),      MILLSCOPE_MEMBER(S, friction),
      MILLSCOPE_MEMBER(S, added_cap),    MILLSCOPE_MEMBER(S, history),          MILLSCOPE_MEMBER(S, force),
      MILLSCOPE_MEMBER(S, normal_force), MILLSCOPE_MEMBER(S, normal_stiffness), MILLSCOPE_MEMBER(S, elastic_energy),
      MILLSCOPE_MEMBER(S, power),        MILLSCOPE_MEMBER(S, elastic_sum),      MILLSCOPE_MEMBER(S, power_sum)};
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
  static constexpr Member members[] = {
      MILLSCOPE_MEMBER(S, info),     MILLSCOPE_MEMBER(S, create),          MILLSCOPE_MEMBER(S, destroy),     MILLSCOPE_MEMBER(S, reach),
      MILLSCOPE_MEMBER(S, evaluate), MILLSCOPE_MEMBER(S, evaluate_scalar), MILLSCOPE_MEMBER(S, contact_time)};
};

inline constexpr std::uint64_t kContactLawLayout = layout_hash(Kind::contact_law, {kMaxHistory, kMaxChannels, kLanes},
                                                               PairStructs<PairTermInfo, Channel, ContactBatch, ContactLawTable>{});

}  // namespace millscope
