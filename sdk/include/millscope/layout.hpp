// The layout hash of a kind: whether host and plugin mean the same bytes.
//
// Every struct that crosses the boundary lists the offset of each of its members, once, beside its definition:
//
//   template <>
//   struct Layout<Surface> {
//     using S = Surface;
//     static constexpr std::size_t offsets[] = {offsetof(S, vertex_count), offsetof(S, vertices), …};
//   };
//
// A kind's hash is made of the sizes and offsets of all its structs. Two members exchanged, one added, removed or widened: each changes it,
// and plugins of that kind are refused until they are rebuilt. tests/sdk counts the members, so that none can be left out of a list.
#pragma once

#include "millscope/abi.hpp"

namespace millscope {

/// The offsets of the members of a struct that crosses; specialised beside each.
template <class Struct>
struct Layout;

/// The hash of a struct's layout, continued from `hash`.
template <class Struct>
constexpr std::uint64_t hash_layout(std::uint64_t hash) {
  hash = hash_number(hash, sizeof(Struct));
  for (const std::size_t offset : Layout<Struct>::offsets) hash = hash_number(hash, offset);
  return hash;
}

template <>
struct Layout<Parameter> {
  using S = Parameter;
  static constexpr std::size_t offsets[] = {offsetof(S, name),    offsetof(S, unit),          offsetof(S, doc),      offsetof(S, citation),
                                            offsetof(S, choices), offsetof(S, fallback_text), offsetof(S, fallback), offsetof(S, minimum),
                                            offsetof(S, maximum), offsetof(S, type),          offsetof(S, scope),    offsetof(S, optional),
                                            offsetof(S, reserved)};
};
template <>
struct Layout<Value> {
  using S = Value;
  static constexpr std::size_t offsets[] = {offsetof(S, name), offsetof(S, text), offsetof(S, number), offsetof(S, given),
                                            offsetof(S, reserved)};
};
template <>
struct Layout<Values> {
  using S = Values;
  static constexpr std::size_t offsets[] = {offsetof(S, items), offsetof(S, count)};
};
template <>
struct Layout<Failure> {
  using S = Failure;
  static constexpr std::size_t offsets[] = {offsetof(S, message)};
};
template <>
struct Layout<Hypothesis> {
  using S = Hypothesis;
  static constexpr std::size_t offsets[] = {offsetof(S, name),      offsetof(S, sentence),   offsetof(S, equation),
                                            offsetof(S, citation),  offsetof(S, parameter),  offsetof(S, null_value),
                                            offsetof(S, prior_low), offsetof(S, prior_high), offsetof(S, excludes),
                                            offsetof(S, two_sided), offsetof(S, reserved)};
};
template <>
struct Layout<Descriptor> {
  using S = Descriptor;
  static constexpr std::size_t offsets[] = {offsetof(S, magic),
                                            offsetof(S, size),
                                            offsetof(S, abi_version),
                                            offsetof(S, reserved),
                                            offsetof(S, kind),
                                            offsetof(S, layout),
                                            offsetof(S, features),
                                            offsetof(S, name),
                                            offsetof(S, version),
                                            offsetof(S, compiler),
                                            offsetof(S, doc),
                                            offsetof(S, equation),
                                            offsetof(S, citation),
                                            offsetof(S, parameters),
                                            offsetof(S, parameter_count),
                                            offsetof(S, hypotheses),
                                            offsetof(S, hypothesis_count),
                                            offsetof(S, table),
                                            offsetof(S, table_size)};
};

/// The structs of one kind.
template <class... Structs>
struct StructList {};

/// Hash of a kind: its number, what limits its arrays, and its structs.
template <class... Structs>
constexpr std::uint64_t layout_hash(Kind kind, std::initializer_list<int> limits, StructList<Structs...>) {
  std::uint64_t hash = hash_number(kHashStart, static_cast<std::uint64_t>(kind));
  for (const int limit : limits) hash = hash_number(hash, static_cast<std::uint64_t>(limit));
  ((hash = hash_layout<Structs>(hash)), ...);
  return hash;
}

/// What every kind shares comes first.
template <class... Own>
using KindStructs = StructList<Descriptor, Parameter, Hypothesis, Value, Values, Failure, Own...>;

}  // namespace millscope
