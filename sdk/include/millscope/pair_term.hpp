// What contact_law, interaction and pair_parameter have in common: the pair that they act on, their histories, their channels.
//
// One object is made for each unordered pair of materials, so its parameters are plain numbers. The host hands it batches of contacts,
// arrays of doubles padded to a multiple of kLanes; padding has overlap −1 and positive R*, m*, velocity 0, and its results are ignored.
//
// Signs: the normal n points from j to i; velocity is that of i relative to j at the contact point; force acts on i (−force on j).
#pragma once

#include "millscope/layout.hpp"
#include "millscope/pack.hpp"

namespace millscope {

inline constexpr int kMaxHistory = 6;
inline constexpr int kMaxChannels = 6;

struct Material {
  const char* name;
  double density;  ///< kg/m³
  double young;    ///< E, Pa, after softening
  double poisson;  ///< ν
};
template <>
struct Layout<Material> {
  using S = Material;
  static constexpr Member members[] = {MILLSCOPE_MEMBER(S, name), MILLSCOPE_MEMBER(S, density), MILLSCOPE_MEMBER(S, young),
                                       MILLSCOPE_MEMBER(S, poisson)};
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
template <>
struct Layout<PairContext> {
  using S = PairContext;
  static constexpr Member members[] = {
      MILLSCOPE_MEMBER(S, first),           MILLSCOPE_MEMBER(S, second),          MILLSCOPE_MEMBER(S, effective_young),
      MILLSCOPE_MEMBER(S, effective_shear), MILLSCOPE_MEMBER(S, smallest_radius), MILLSCOPE_MEMBER(S, largest_radius),
      MILLSCOPE_MEMBER(S, smallest_mass),   MILLSCOPE_MEMBER(S, largest_mass),    MILLSCOPE_MEMBER(S, typical_speed),
      MILLSCOPE_MEMBER(S, with_wall),       MILLSCOPE_MEMBER(S, reserved)};
};

/// One number that is kept per contact while the pair is within reach.
struct History {
  const char* name;
  std::int32_t sign;  ///< when the pair's owner is exchanged: +1 unchanged, −1 it changes sign (a component of a vector)
  std::uint32_t reserved = 0;
};
template <>
struct Layout<History> {
  using S = History;
  static constexpr Member members[] = {MILLSCOPE_MEMBER(S, name), MILLSCOPE_MEMBER(S, sign), MILLSCOPE_MEMBER(S, reserved)};
};

/// Which relative motion feeds a channel. At a wall the work of `normal` counts as impact, the rest as shear.
enum class ChannelPart : std::uint32_t { normal, tangential, rolling };

/// What becomes of the energy. `dissipative`: lost, the power is never negative. `elastic`: it may come back (a spring whose stiffness
/// changes), the power has either sign.
enum class ChannelNature : std::uint32_t { dissipative, elastic };

/// Where energy goes.
struct Channel {
  const char* name;
  ChannelPart part;
  ChannelNature nature;
};
template <>
struct Layout<Channel> {
  using S = Channel;
  static constexpr Member members[] = {MILLSCOPE_MEMBER(S, name), MILLSCOPE_MEMBER(S, part), MILLSCOPE_MEMBER(S, nature)};
};

/// What a law or an interaction keeps and where it books energy; the first `…_count` entries count.
struct PairTermInfo {
  std::uint32_t history_count, channel_count;
  History histories[kMaxHistory];
  Channel channels[kMaxChannels];
};
template <>
struct Layout<PairTermInfo> {
  using S = PairTermInfo;
  static constexpr Member members[] = {MILLSCOPE_MEMBER(S, history_count), MILLSCOPE_MEMBER(S, channel_count),
                                       MILLSCOPE_MEMBER(S, histories), MILLSCOPE_MEMBER(S, channels)};
};

/// The structs of a kind that acts on pairs.
template <class... Own>
using PairStructs = KindStructs<Material, PairContext, History, Own...>;

/// From lists: pair_term({{"slip_x", -1}}, {{"normal_damping", ChannelPart::normal, ChannelNature::dissipative}}).
constexpr PairTermInfo pair_term(std::initializer_list<History> histories, std::initializer_list<Channel> channels) {
  PairTermInfo info{};
  for (const History& history : histories) info.histories[info.history_count++] = history;
  for (const Channel& channel : channels) info.channels[info.channel_count++] = channel;
  return info;
}

constexpr bool are_sane(const History* histories, std::uint32_t count) {
  if (count > kMaxHistory) return false;
  for (std::uint32_t h = 0; h < count; ++h) {
    if (histories[h].name == nullptr || (histories[h].sign != 1 && histories[h].sign != -1)) return false;
  }
  return true;
}

constexpr bool are_sane(const Channel* channels, std::uint32_t count) {
  if (count > kMaxChannels) return false;
  for (std::uint32_t k = 0; k < count; ++k) {
    if (channels[k].name == nullptr || channels[k].part > ChannelPart::rolling || channels[k].nature > ChannelNature::elastic) return false;
  }
  return true;
}

/// What the host's loader also checks: counts within the limits, names given, signs +1 or −1, roles known.
constexpr bool is_sane(const PairTermInfo& info) {
  return are_sane(info.histories, info.history_count) && are_sane(info.channels, info.channel_count);
}

/// True when the class's kInfo is sane and agrees with its kHistory and kChannels.
template <class Term>
inline constexpr bool kTermIsSane = is_sane(Term::kInfo) && Term::kInfo.history_count == Term::kHistory&& Term::kInfo.channel_count
                                                                == Term::kChannels;

}  // namespace millscope
