// The tables of the kinds that act on pairs: contact_law, interaction, pair_parameter.
//
// One object of a law is made for each unordered pair of materials, so its parameters are plain numbers. The host hands it batches
// of contacts, arrays of doubles padded to a multiple of kLanes; padding has overlap −1 and positive R*, m*, velocity 0, and its
// results are ignored.
//
// Signs: the normal n points from j to i; velocity is that of i relative to j at the contact point; force acts on i (−force on j).
#pragma once

#include "millscope/abi.hpp"

namespace millscope {

inline constexpr int kMaxHistory = 6;
inline constexpr int kMaxChannels = 6;

struct Material {
  const char* name;
  double density;  ///< kg/m³
  double young;    ///< E, Pa, after softening
  double poisson;  ///< ν
};

/// What a law knows of its pair. A wall is body j with R = ∞ and m = ∞, so R* = R_i and m* = m_i.
struct PairContext {
  Material first, second;
  double effective_young;   ///< E*: 1/E* = (1−ν₁²)/E₁ + (1−ν₂²)/E₂, Pa
  double effective_shear;   ///< G*: 1/G* = (2−ν₁)/G₁ + (2−ν₂)/G₂, Pa
  double smallest_radius;   ///< smallest R* among the contacts of this pair, m
  double largest_radius;    ///< largest R*, m
  double smallest_mass;     ///< smallest m*, kg
  double largest_mass;      ///< largest m*, kg
  double typical_speed;     ///< a closing speed to expect, m/s
  std::uint32_t with_wall;  ///< 1: the second body is a wall
  std::uint32_t reserved;
};

/// What is left of a law's history when a pair's owner is exchanged: +1 unchanged, −1 the sign flips.
struct ContactLawInfo {
  std::uint32_t history_count;
  std::uint32_t channel_count;
  std::int32_t history_sign[kMaxHistory];
  const char* history_name[kMaxHistory];
  const char* channel_name[kMaxChannels];
};

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

struct ContactLawTable {
  ContactLawInfo info;
  Status (*create)(const Values*, const PairContext*, void** self, Failure*);
  void (*destroy)(void* self);
  double (*reach)(const void* self, double radius);  ///< largest gap at which the law acts, m, ≥ 0
  void (*evaluate)(const void* self, ContactBatch*);
  void (*evaluate_scalar)(const void* self, ContactBatch*);                            ///< the oracle of the tests
  double (*contact_time)(const void* self, double radius, double mass, double speed);  ///< s, estimate; 0: none
};

/// Interactions see both bodies' spins and may turn them.
struct InteractionBatch {
  std::int64_t count;
  double time_step;
  const double* overlap;
  const double* normal[3];
  const double* velocity[3];
  const double* spin_i[3];  ///< ω_i, rad/s
  const double* spin_j[3];
  const double* radius_i;          ///< m
  const double* radius_j;          ///< m; 0 for a wall
  const double* radius;            ///< R*
  const double* mass;              ///< m*
  const double* normal_force;      ///< post: total F_n of law and pre interactions
  const double* normal_stiffness;  ///< post
  double* history[kMaxHistory];
  double* added_force;  ///< pre, added to: force along n, N, positive pushes apart
  double* added_cap;    ///< pre, added to: N
  double* moment_i[3];  ///< post, added to: N m on i
  double* moment_j[3];  ///< post, added to: N m on j
  double elastic_sum;
  double power_sum[kMaxChannels];
};

struct InteractionTable {
  ContactLawInfo info;
  Status (*create)(const Values*, const PairContext*, void** self, Failure*);
  void (*destroy)(void* self);
  double (*reach)(const void* self, double radius);
  void (*evaluate)(const void* self, InteractionBatch*);
  void (*evaluate_scalar)(const void* self, InteractionBatch*);
};

/// e or μ as a function of the pair's state.
struct PairParameterBatch {
  std::int64_t count;
  double time_step;
  const double* overlap;
  const double* normal[3];
  const double* velocity[3];
  const double* radius;
  const double* mass;
  double* history[kMaxHistory];
  double* restitution;  ///< out when the plugin has kGivesRestitution
  double* friction;     ///< out when the plugin has kGivesFriction
};

struct PairParameterTable {
  ContactLawInfo info;
  Status (*create)(const Values*, const PairContext*, void** self, Failure*);
  void (*destroy)(void* self);
  void (*evaluate)(const void* self, PairParameterBatch*);
};

inline constexpr std::uint64_t kContactLawLayout =
    hash_numbers({1, sizeof(ContactBatch), sizeof(ContactLawTable), sizeof(PairContext), sizeof(Value), sizeof(Parameter),
                  offsetof(ContactBatch, history), offsetof(ContactBatch, force), offsetof(ContactBatch, power_sum),
                  offsetof(ContactLawTable, evaluate), kMaxHistory, kMaxChannels});
inline constexpr std::uint64_t kInteractionLayout =
    hash_numbers({2, sizeof(InteractionBatch), sizeof(InteractionTable), sizeof(PairContext), sizeof(Value), sizeof(Parameter),
                  offsetof(InteractionBatch, history), offsetof(InteractionBatch, moment_i), kMaxHistory, kMaxChannels});
inline constexpr std::uint64_t kPairParameterLayout = hash_numbers(
    {3, sizeof(PairParameterBatch), sizeof(PairParameterTable), sizeof(PairContext), sizeof(Value), sizeof(Parameter), kMaxHistory});

/// What the host's loader also checks: counts within the limits, names given, signs +1 or −1.
constexpr bool info_is_sane(const ContactLawInfo& info) {
  if (info.history_count > kMaxHistory || info.channel_count > kMaxChannels) return false;
  for (std::uint32_t h = 0; h < info.history_count; ++h) {
    if (info.history_name[h] == nullptr || info.history_sign[h] * info.history_sign[h] != 1) return false;
  }
  for (std::uint32_t k = 0; k < info.channel_count; ++k) {
    if (info.channel_name[k] == nullptr) return false;
  }
  return true;
}

/// True when the class's kInfo is sane and agrees with its kHistory and kChannels.
template <class Law>
inline constexpr bool kInfoIsSane = info_is_sane(Law::kInfo) && Law::kInfo.history_count == Law::kHistory&& Law::kInfo.channel_count
                                                                    == Law::kChannels;

}  // namespace millscope
