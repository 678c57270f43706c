// The suite of pair parameters finds what is wrong with one.
#include "millscope/conformance/pair_parameter.hpp"

#include "millscope/pair_parameter_adapter.hpp"
#include "sdk/suite.hpp"

using namespace sdk_test;

namespace {

enum class Fault { none, above_one, negative, never_finite, sign, frame, neighbours, jump, other_column };

/// Restitution that falls with the closing speed, wrong in one thing.
template <Fault fault>
struct Falling {
  static constexpr int kHistory = 1;
  static constexpr PairParameterInfo kInfo = pair_parameter_info({{"fastest", 1}});
  static constexpr std::uint64_t kGives = kGivesRestitution;
  Falling(const Parameters&, const PairContext&) {}

  template <class R>
  void values(const ParameterState<R>& pair, R (&fastest)[1], PairValues<R>& out) const {
    const R zero(0.0), one(1.0), speed = dot(pair.velocity, pair.normal);
    const R closing = fault == Fault::sign ? pair.velocity.x : maximum(-speed, zero);
    fastest[0] = maximum(fastest[0], closing);
    out.restitution = one / (one + (fault == Fault::sign ? absolute(closing + R(0.1)) : fastest[0]));
    if (fault == Fault::above_one) out.restitution = select(pair.overlap > zero, out.restitution, R(1.5));
    if (fault == Fault::negative) out.restitution = one - fastest[0];
    if (fault == Fault::never_finite) fastest[0] = fastest[0] / zero;
    if (fault == Fault::frame) out.restitution = one / (one + absolute(pair.velocity.z));
    if (fault == Fault::neighbours) out.restitution = out.restitution / (one + R(1e-3 * lane_sum(closing)));
    if (fault == Fault::jump) out.restitution = select(closing > R(0.2), R(0.5), R(0.9));
  }
};

/// Writes a column that its features do not name.
struct Friction : Falling<Fault::none> {
  static constexpr std::uint64_t kGives = kGivesRestitution | kGivesFriction;
  using Falling::Falling;
};

template <Fault fault>
Violations violations_of() {
  static constexpr Descriptor descriptor = describe<Falling<fault>>({.name = "falling"});
  return check_pair_parameter(descriptor, kNoValues);
}

}  // namespace

TEST_CASE("a right pair parameter passes the suite") {
  CHECK_FALSE(names(violations_of<Fault::none>(), ""));
  CHECK(violations_of<Fault::none>().empty());
}

TEST_CASE("the suite finds what is wrong with a pair parameter") {
  CHECK(names(violations_of<Fault::above_one>(), "range"));
  CHECK(names(violations_of<Fault::negative>(), "range"));
  CHECK(names(violations_of<Fault::never_finite>(), "finite"));
  CHECK(names(violations_of<Fault::sign>(), "symmetry"));
  CHECK(names(violations_of<Fault::frame>(), "frame indifference"));
  CHECK(names(violations_of<Fault::neighbours>(), "slot by slot"));
  CHECK(names(violations_of<Fault::jump>(), "continuity"));
  static constexpr Descriptor more = [] {
    Descriptor d = describe<Friction>({.name = "more"});
    d.features = kGivesRestitution;
    return d;
  }();
  CHECK(names(check_pair_parameter(more, kNoValues), "only what it gives"));
}
