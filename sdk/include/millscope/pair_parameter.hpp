// The table of a pair_parameter: e or μ as a function of the pair's state.
#pragma once

#include "millscope/pair_term.hpp"

namespace millscope {

/// What a pair_parameter keeps; it books no energy.
struct PairParameterInfo {
  std::uint32_t history_count;
  std::uint32_t reserved;
  History histories[kMaxHistory];
};
template <>
struct Layout<PairParameterInfo> {
  using S = PairParameterInfo;
  static constexpr std::size_t offsets[] = {offsetof(S, history_count), offsetof(S, reserved), offsetof(S, histories)};
};

/// From a list: pair_parameter_info({{"impact_speed", 1}}).
constexpr PairParameterInfo pair_parameter_info(std::initializer_list<History> histories) {
  PairParameterInfo info{};
  for (const History& history : histories) info.histories[info.history_count++] = history;
  return info;
}

constexpr bool is_sane(const PairParameterInfo& info) { return are_sane(info.histories, info.history_count); }

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
template <>
struct Layout<PairParameterBatch> {
  using S = PairParameterBatch;
  static constexpr std::size_t offsets[] = {offsetof(S, count),       offsetof(S, time_step), offsetof(S, overlap), offsetof(S, normal),
                                            offsetof(S, velocity),    offsetof(S, radius),    offsetof(S, mass),    offsetof(S, history),
                                            offsetof(S, restitution), offsetof(S, friction)};
};

struct PairParameterTable {
  PairParameterInfo info;
  Status (*create)(const Values*, const PairContext*, void** self, Failure*);
  void (*destroy)(void* self);
  void (*evaluate)(const void* self, PairParameterBatch*);
};
template <>
struct Layout<PairParameterTable> {
  using S = PairParameterTable;
  static constexpr std::size_t offsets[] = {offsetof(S, info), offsetof(S, create), offsetof(S, destroy), offsetof(S, evaluate)};
};

inline constexpr std::uint64_t kPairParameterLayout =
    layout_hash(Kind::pair_parameter, {kMaxHistory}, PairStructs<PairParameterInfo, PairParameterBatch, PairParameterTable>{});

}  // namespace millscope
