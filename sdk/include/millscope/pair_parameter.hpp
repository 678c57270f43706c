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
  static constexpr Member members[] = {MILLSCOPE_MEMBER(S, history_count), MILLSCOPE_MEMBER(S, reserved), MILLSCOPE_MEMBER(S, histories)};
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
  static constexpr Member members[] = {MILLSCOPE_MEMBER(S, count),   MILLSCOPE_MEMBER(S, time_step), MILLSCOPE_MEMBER(S, overlap),
                                       MILLSCOPE_MEMBER(S, normal),  MILLSCOPE_MEMBER(S, velocity),  MILLSCOPE_MEMBER(S, radius),
                                       MILLSCOPE_MEMBER(S, mass),    MILLSCOPE_MEMBER(S, history),   MILLSCOPE_MEMBER(S, restitution),
                                       MILLSCOPE_MEMBER(S, friction)};
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
  static constexpr Member members[] = {MILLSCOPE_MEMBER(S, info), MILLSCOPE_MEMBER(S, create), MILLSCOPE_MEMBER(S, destroy),
                                       MILLSCOPE_MEMBER(S, evaluate)};
};

inline constexpr std::uint64_t kPairParameterLayout =
    layout_hash(Kind::pair_parameter, {kMaxHistory, kLanes}, PairStructs<PairParameterInfo, PairParameterBatch, PairParameterTable>{});

}  // namespace millscope
