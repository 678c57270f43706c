// The suite of wear laws finds what is wrong with one.
#include "millscope/conformance/wear_law.hpp"

#include "millscope/wear_law_adapter.hpp"
#include "sdk/suite.hpp"

using namespace sdk_test;

namespace {

enum class Fault { none, gains, never_finite, at_rest, neighbours };

/// Archard's law, wrong in one thing.
template <Fault fault>
struct Sliding {
  Sliding(const Parameters&, const PairContext&) {}
  double worn_volume(const Rubbing& r) const {
    const double volume = 1e-13 * r.pressing * r.sliding * r.time_step;
    if (fault == Fault::gains) return volume - 1e-20;
    if (fault == Fault::never_finite) return volume / r.pressing;
    if (fault == Fault::at_rest) return volume + 1e-20;
    if (fault == Fault::neighbours) return last_ = volume + 0.1 * last_;
    return volume;
  }
  mutable double last_ = 0;
};

template <Fault fault>
Violations violations_of() {
  static constexpr Descriptor descriptor = describe<Sliding<fault>>({.name = "sliding"});
  return check_wear_law(descriptor, kNoValues);
}

/// Reads the velocity in the frame of space.
struct Askew {
  static void evaluate(const void*, WearBatch* b) {
    for (std::int64_t i = 0; i < b->count; ++i) b->volume[i] = std::fabs(b->velocity[2][i]);
  }
};

}  // namespace

TEST_CASE("a right wear law passes the suite") { CHECK(violations_of<Fault::none>().empty()); }

TEST_CASE("the suite finds what is wrong with a wear law") {
  CHECK(names(violations_of<Fault::gains>(), "range"));
  CHECK(names(violations_of<Fault::never_finite>(), "range"));
  CHECK(names(violations_of<Fault::at_rest>(), "a cause"));
  CHECK(names(violations_of<Fault::neighbours>(), "bead by bead"));
  static WearLawTable table = make_wear_law_table<Sliding<Fault::none>>();
  table.evaluate = &Askew::evaluate;
  static const Descriptor askew = [] {
    Descriptor d = describe<Sliding<Fault::none>>({.name = "askew"});
    d.table = &table;
    return d;
  }();
  CHECK(names(check_wear_law(askew, kNoValues), "frame indifference"));
}
