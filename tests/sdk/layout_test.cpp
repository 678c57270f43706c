// The layout hashes: every member of every struct is in them, and whatever moves changes them.
#include <catch2/catch.hpp>
#include <type_traits>
#include <utility>

#include "millscope/millscope.hpp"

using namespace millscope;

namespace {

/// Stands for a value of any type, in operands that are never evaluated.
struct Anything {
  template <class T>
  operator T() const;
};

template <class Struct, std::size_t... Index>
constexpr bool takes(std::index_sequence<Index...>) {
  return requires { Struct{{(static_cast<void>(Index), Anything{})}...}; };
}

/// Members of an aggregate: the most initialisers in braces that it takes.
template <class Struct, std::size_t Count = 1>
constexpr std::size_t member_count() {
  if constexpr (takes<Struct>(std::make_index_sequence<Count>{})) {
    return member_count<Struct, Count + 1>();
  } else {
    return Count - 1;
  }
}

template <class Struct>
void check_struct() {
  INFO(__PRETTY_FUNCTION__);
  CHECK(std::is_standard_layout_v<Struct>);
  CHECK(std::is_trivially_copyable_v<Struct>);
  CHECK(std::size(Layout<Struct>::members) == member_count<Struct>());
  CHECK(Layout<Struct>::members[0].offset == 0);
  CHECK(std::is_sorted(std::begin(Layout<Struct>::members), std::end(Layout<Struct>::members),
                       [](const Member& a, const Member& b) { return a.offset < b.offset; }));
}

template <class... Structs>
void check_structs(StructList<Structs...>) {
  (check_struct<Structs>(), ...);
}

struct Bead2 {
  double radius, mass;
  std::uint32_t touching[2];
};
/// Two members of one size exchanged.
struct Exchanged {
  double mass, radius;
  std::uint32_t touching[2];
};
struct Longer {
  double radius, mass;
  std::uint32_t touching[4];
};

template <class Struct>
constexpr std::uint64_t hash_of() {
  return layout_hash(Kind::body_force, {}, StructList<Struct>{});
}

}  // namespace

template <>
struct millscope::Layout<Bead2> {
  static constexpr Member members[] = {MILLSCOPE_MEMBER(Bead2, radius), MILLSCOPE_MEMBER(Bead2, mass), MILLSCOPE_MEMBER(Bead2, touching)};
};
template <>
struct millscope::Layout<Exchanged> {
  static constexpr Member members[] = {MILLSCOPE_MEMBER(Exchanged, mass), MILLSCOPE_MEMBER(Exchanged, radius),
                                       MILLSCOPE_MEMBER(Exchanged, touching)};
};
template <>
struct millscope::Layout<Longer> {
  static constexpr Member members[] = {MILLSCOPE_MEMBER(Longer, radius), MILLSCOPE_MEMBER(Longer, mass),
                                       MILLSCOPE_MEMBER(Longer, touching)};
};

TEST_CASE("every member of every struct that crosses is in its list of offsets") {
  check_structs(PairStructs<PairTermInfo, Channel, ContactBatch, ContactLawTable>{});
  check_structs(StructList<InteractionBatch, InteractionTable, PairParameterInfo, PairParameterBatch, PairParameterTable>{});
  check_structs(StructList<BodyForceBatch, BodyForceTable>{});
  check_structs(StructList<WearBatch, WearLawTable>{});
  check_structs(StructList<CandidateSink, GeometryBeads, GeometryQuery, GeometryContacts, Surface, Interior, GeometryTable>{});
  check_structs(StructList<TrackView, TrackBuffer, TrackSink, TrackContext, ObservationTable>{});
  check_structs(StructList<FrameBlock, AnalyzerContext, ArrayInfo, Result, ResultSink, AnalyzerTable>{});
}

TEST_CASE("the members of a struct are counted as they stand") {
  CHECK(member_count<Bead2>() == 3);
  CHECK(member_count<Value>() == 5);
  CHECK(member_count<Failure>() == 1);
}

TEST_CASE("two members of one size exchanged, or an array that grows, change the layout hash") {
  CHECK(hash_of<Bead2>() != hash_of<Exchanged>());
  CHECK(hash_of<Bead2>() != hash_of<Longer>());
  CHECK(hash_of<Bead2>() != layout_hash(Kind::geometry, {}, StructList<Bead2>{}));
  CHECK(hash_of<Bead2>() != layout_hash(Kind::body_force, {1}, StructList<Bead2>{}));
}

TEST_CASE("each kind has a layout hash of its own") {
  const std::uint64_t all[] = {kContactLawLayout, kInteractionLayout, kPairParameterLayout, kBodyForceLayout,
                               kGeometryLayout,   kObservationLayout, kAnalyzerLayout,      kWearLawLayout};
  for (const std::uint64_t& one : all) CHECK(std::count(std::begin(all), std::end(all), one) == 1);
}
