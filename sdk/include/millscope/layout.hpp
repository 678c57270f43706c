// The layout hash of a kind: whether host and plugin mean the same bytes.
//
// Every struct that crosses the boundary lists its members, once, beside its definition:
//
//   template <>
//   struct Layout<Surface> {
//     using S = Surface;
//     static constexpr Member members[] = {MILLSCOPE_MEMBER(S, vertex_count), MILLSCOPE_MEMBER(S, vertices), …};
//   };
//
// A kind's hash is made of the sizes of all its structs and of the names and offsets of their members. Two members exchanged, one added,
// removed or widened: each changes it, and plugins of that kind are refused until they are rebuilt. tests/sdk counts the members, so that
// none can be left out of a list.
#pragma once

#include "millscope/abi.hpp"

namespace millscope {

/// A member by its name, so that two of one size cannot change places unseen.
struct Member {
  const char* name;
  std::size_t offset;
};
#define MILLSCOPE_MEMBER(Struct, name) \
  ::millscope::Member { #name, offsetof(Struct, name) }

/// The members of a struct that crosses; specialised beside each.
template <class Struct>
struct Layout;

/// The hash of a struct's layout, continued from `hash`.
template <class Struct>
constexpr std::uint64_t hash_layout(std::uint64_t hash) {
  hash = hash_number(hash, sizeof(Struct));
  for (const Member& member : Layout<Struct>::members) {
    for (const char* c = member.name; *c != 0; ++c) hash = hash_number(hash, static_cast<std::uint64_t>(*c));
    hash = hash_number(hash, member.offset);
  }
  return hash;
}

template <>
struct Layout<Parameter> {
  using S = Parameter;
  static constexpr Member members[] = {MILLSCOPE_MEMBER(S, name),     MILLSCOPE_MEMBER(S, unit),    MILLSCOPE_MEMBER(S, doc),
                                       MILLSCOPE_MEMBER(S, citation), MILLSCOPE_MEMBER(S, choices), MILLSCOPE_MEMBER(S, fallback_text),
                                       MILLSCOPE_MEMBER(S, fallback), MILLSCOPE_MEMBER(S, minimum), MILLSCOPE_MEMBER(S, maximum),
                                       MILLSCOPE_MEMBER(S, type),     MILLSCOPE_MEMBER(S, scope),   MILLSCOPE_MEMBER(S, optional),
                                       MILLSCOPE_MEMBER(S, reserved)};
};
template <>
struct Layout<Value> {
  using S = Value;
  static constexpr Member members[] = {MILLSCOPE_MEMBER(S, name), MILLSCOPE_MEMBER(S, text), MILLSCOPE_MEMBER(S, number),
                                       MILLSCOPE_MEMBER(S, given), MILLSCOPE_MEMBER(S, reserved)};
};
template <>
struct Layout<Values> {
  using S = Values;
  static constexpr Member members[] = {MILLSCOPE_MEMBER(S, items), MILLSCOPE_MEMBER(S, count)};
};
template <>
struct Layout<Failure> {
  using S = Failure;
  static constexpr Member members[] = {MILLSCOPE_MEMBER(S, message)};
};
template <>
struct Layout<Hypothesis> {
  using S = Hypothesis;
  static constexpr Member members[] = {MILLSCOPE_MEMBER(S, name),      MILLSCOPE_MEMBER(S, sentence),   MILLSCOPE_MEMBER(S, equation),
                                       MILLSCOPE_MEMBER(S, citation),  MILLSCOPE_MEMBER(S, parameter),  MILLSCOPE_MEMBER(S, null_value),
                                       MILLSCOPE_MEMBER(S, prior_low), MILLSCOPE_MEMBER(S, prior_high), MILLSCOPE_MEMBER(S, excludes),
                                       MILLSCOPE_MEMBER(S, two_sided), MILLSCOPE_MEMBER(S, reserved)};
};
template <>
struct Layout<Descriptor> {
  using S = Descriptor;
  static constexpr Member members[] = {MILLSCOPE_MEMBER(S, magic),
                                       MILLSCOPE_MEMBER(S, size),
                                       MILLSCOPE_MEMBER(S, abi_version),
                                       MILLSCOPE_MEMBER(S, reserved),
                                       MILLSCOPE_MEMBER(S, kind),
                                       MILLSCOPE_MEMBER(S, layout),
                                       MILLSCOPE_MEMBER(S, features),
                                       MILLSCOPE_MEMBER(S, name),
                                       MILLSCOPE_MEMBER(S, version),
                                       MILLSCOPE_MEMBER(S, compiler),
                                       MILLSCOPE_MEMBER(S, doc),
                                       MILLSCOPE_MEMBER(S, equation),
                                       MILLSCOPE_MEMBER(S, citation),
                                       MILLSCOPE_MEMBER(S, parameters),
                                       MILLSCOPE_MEMBER(S, parameter_count),
                                       MILLSCOPE_MEMBER(S, hypotheses),
                                       MILLSCOPE_MEMBER(S, hypothesis_count),
                                       MILLSCOPE_MEMBER(S, table),
                                       MILLSCOPE_MEMBER(S, table_size)};
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
