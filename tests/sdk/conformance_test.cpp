#include "millscope/conformance.hpp"

#include <catch2/catch.hpp>

#include "millscope/contact_law_adapter.hpp"
#include "millscope/interaction_adapter.hpp"

using namespace millscope;
using namespace millscope::conformance;

namespace {

enum class Fault { none, packed, touch, normal_sign, frame, history, cap, energy, stiffness, damping, ledger };

/// A Hertz law with damping and a tangential spring, wrong in one thing.
template <Fault fault>
struct Hertz {
  static constexpr int kHistory = 3, kChannels = 2;
  static constexpr int kSign = fault == Fault::history ? 1 : -1;
  static constexpr PairTermInfo kInfo = pair_term(
      {{"x", kSign}, {"y", kSign}, {"z", kSign}},
      {{"viscous", ChannelPart::normal, ChannelNature::dissipative}, {"sliding", ChannelPart::tangential, ChannelNature::dissipative}});
  Hertz(const Parameters&, const PairContext& pair) : young_(pair.effective_young) {}
  double restitution() const { return 1; }
  double friction() const { return 0.3; }
  double reach(double) const { return 0; }
  double contact_time(double, double, double) const { return 0; }

  template <class R>
  void force(const Contact<R>& c, R (&spring)[3], Response<R, 2>& out) const {
    const R zero(0.0), k(1e4), overlap = fault == Fault::touch ? c.overlap : maximum(c.overlap, zero);
    const R root = square_root(c.radius * maximum(overlap, zero)), elastic = R(4.0 / 3.0 * young_) * root * overlap;
    const R stiffness = R(2.0 * young_) * root, opening = dot(c.velocity, c.normal);
    const R damped = R(fault == Fault::damping ? -0.2 : 0.2) * square_root(stiffness * c.mass) * opening;
    R normal = maximum(elastic - damped, zero);
    if (fault == Fault::packed && sizeof(R) != sizeof(double)) normal = normal * R(1.0 + 1e-15);
    if (fault == Fault::touch) normal = select(c.overlap <= zero, R(1e-9), normal);
    Vec<R> s = Vec<R>{spring[0], spring[1], spring[2]} + c.time_step * (c.velocity - opening * c.normal);
    s = s - dot(s, c.normal) * c.normal;
    const R stretch = length(s), cap = R(fault == Fault::cap ? 1.5 : 1.0) * c.friction * maximum(normal, zero) / k;
    s = select(stretch > cap, cap / maximum(stretch, R(1e-300)), R(1.0)) * s;
    const R kept = minimum(stretch, cap);
    spring[0] = s.x, spring[1] = s.y, spring[2] = s.z;
    out.force = normal * c.normal - k * s;
    if (fault == Fault::normal_sign) out.force.x = absolute(out.force.x);
    if (fault == Fault::frame) out.force.z *= R(1.01);
    out.normal_force = normal;
    out.normal_stiffness = (fault == Fault::stiffness ? R(1.5) : R(1.0)) * stiffness;
    out.elastic_energy = R(fault == Fault::energy ? 0.5 : 0.4) * elastic * overlap + R(0.5) * k * kept * kept;
    out.power[0] = (elastic - normal) * opening * R(fault == Fault::ledger ? 0.5 : 1.0);
    out.power[1] = R(0.5) * k * (stretch * stretch - kept * kept) / c.time_step;
    if (fault != Fault::touch) out.power[1] = select(c.overlap > zero, out.power[1], zero);
  }
  double young_;
};

template <Fault fault>
bool finds(const char* check) {
  static constexpr Descriptor descriptor = describe<Hertz<fault>>({.name = "hertz"});
  bool found = false;
  for (const Violation& v : check_contact_law(descriptor, {nullptr, 0})) {
    UNSCOPED_INFO(v.check << ": " << v.message);
    found = found || v.check == check;
  }
  return found;
}

enum class Wrong { none, packed, touch, moment, frame, friction };

/// A rolling torque, wrong in one thing.
template <Wrong wrong>
struct Rolling {
  static constexpr int kHistory = 0, kChannels = 1;
  static constexpr PairTermInfo kInfo = pair_term({}, {{"rolling", ChannelPart::rolling, ChannelNature::dissipative}});
  Rolling(const Parameters&, const PairContext&) {}
  double reach(double) const { return 0; }
  template <class R>
  void post(const PairState<R>& p, R*, PostResponse<R, 1>& out) const {
    const Vec<R> spin = p.spin_i - p.spin_j, rolling = spin - dot(spin, p.normal) * p.normal;
    const R speed = length(rolling), zero(0.0);
    R factor = select(p.overlap > zero, R(0.01) * p.radius * p.normal_force / maximum(speed, R(1e-6)), zero);
    if (wrong == Wrong::packed && sizeof(R) != sizeof(double)) factor = factor * R(1.0 + 1e-15);
    if (wrong == Wrong::touch) factor = factor + R(1e-9);
    out.moment_i = -factor * rolling;
    out.moment_j = (wrong == Wrong::moment ? R(0.5) * factor : factor) * rolling;
    if (wrong == Wrong::frame) out.moment_i.x += select(p.overlap > zero, R(1e-3), zero) * factor;
    out.power[0] = R(wrong == Wrong::friction ? -1.0 : 1.0) * factor * speed * speed;
  }
};

template <Wrong wrong>
Violations violations_of() {
  static constexpr Descriptor descriptor = describe<Rolling<wrong>>({.name = "rolling"});
  return check_interaction(descriptor, {nullptr, 0});
}

template <Wrong wrong>
bool finds_in_interaction(const char* check) {
  bool found = false;
  for (const Violation& v : violations_of<wrong>()) {
    UNSCOPED_INFO(v.check << ": " << v.message);
    found = found || v.check == check;
  }
  return found;
}

}  // namespace

TEST_CASE("a right contact law passes the suite") {
  static constexpr Descriptor descriptor = describe<Hertz<Fault::none>>({.name = "hertz"});
  for (const Violation& v : check_contact_law(descriptor, {nullptr, 0})) FAIL_CHECK(v.check << ": " << v.message);
}

TEST_CASE("the suite finds what is wrong with a contact law") {
  CHECK(finds<Fault::packed>("scalar = packed"));
  CHECK(finds<Fault::touch>("nothing without contact"));
  CHECK(finds<Fault::normal_sign>("antisymmetry"));
  CHECK(finds<Fault::frame>("frame indifference"));
  CHECK(finds<Fault::history>("history signs"));
  CHECK(finds<Fault::cap>("Coulomb's cap"));
  CHECK(finds<Fault::energy>("elastic force = dU/d(overlap)"));
  CHECK(finds<Fault::stiffness>("normal stiffness = dF_n/d(overlap)"));
  CHECK(finds<Fault::damping>("dissipation >= 0"));
  CHECK(finds<Fault::ledger>("ledger"));
}

TEST_CASE("a right interaction passes the suite") {
  for (const Violation& v : violations_of<Wrong::none>()) FAIL_CHECK(v.check << ": " << v.message);
}

TEST_CASE("the suite finds what is wrong with an interaction") {
  CHECK(finds_in_interaction<Wrong::packed>("scalar = packed"));
  CHECK(finds_in_interaction<Wrong::touch>("nothing beyond reach"));
  CHECK(finds_in_interaction<Wrong::moment>("antisymmetry"));
  CHECK(finds_in_interaction<Wrong::frame>("frame indifference"));
  CHECK(finds_in_interaction<Wrong::friction>("dissipation >= 0"));
}
