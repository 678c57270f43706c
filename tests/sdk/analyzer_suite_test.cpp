// The suite of analyzers finds what is wrong with one.
#include "millscope/conformance/analyzer.hpp"

#include "millscope/analyzer_adapter.hpp"
#include "sdk/suite.hpp"

using namespace sdk_test;

namespace {

enum class Fault {
  none,
  sets,
  remembers,
  counts_blocks,
  unweighted,
  impure,
  no_unit,
  no_array_unit,
  no_doc,
  bad_name,
  twice,
  axis,
  more_than_needed
};

/// Mean height of the beads, wrong in one thing.
template <Fault fault>
struct Height {
  static constexpr std::uint64_t kNeeds = 0;
  Height(const Parameters&, const AnalyzerContext&) {}
  std::vector<ArrayInfo> arrays() const {
    return {additive("weight", "s"), additive("height", fault == Fault::no_array_unit ? "" : "m s", {4}), additive("blocks", "1")};
  }

  void accumulate(const FrameBlock& block, double* const* sums) const {
    if (fault == Fault::remembers) ++calls_;
    if (fault == Fault::counts_blocks) sums[2][0] += 1.0;
    if (fault == Fault::sets) sums[0][0] = 0.0;
    if (fault == Fault::more_than_needed && block.velocity[0] == nullptr) throw Refusal("");
    for (std::int64_t i = 0; i < block.first[block.frame_count]; ++i) {
      const double weight = fault == Fault::unweighted ? 1.0 : block.weight[i];
      sums[0][0] += weight;
      sums[1][block.id[i] % 4] += weight * (block.position[1][i] + calls_);
    }
  }

  void finish(const double* const* sums, Results& results) const {
    if (fault == Fault::impure) ++calls_;
    const double edges[5] = {0, 1, 2, 3, 4};
    results.add("edges", "1", edges, {fault == Fault::axis ? 2ULL : 5ULL}, "Edges of the groups.");
    results.add("heights", fault == Fault::no_unit ? "" : "m s", sums[1], {4}, fault == Fault::no_doc ? "" : "Of four groups.", {"edges"});
    results.add(fault == Fault::bad_name ? "Bead time"
                : fault == Fault::twice  ? "edges"
                                         : "bead_time",
                "s", sums[0][0] + calls_, "All beads.");
  }

  mutable double calls_ = 0;
};

template <Fault fault>
Violations violations_of() {
  static constexpr Descriptor descriptor = describe<Height<fault>>({.name = "height"});
  return check_analyzer(descriptor, kNoValues);
}

}  // namespace

TEST_CASE("a right analyzer passes the suite") {
  CHECK_FALSE(names(violations_of<Fault::none>(), ""));
  CHECK(violations_of<Fault::none>().empty());
}

TEST_CASE("the suite finds what is wrong with an analyzer") {
  CHECK(names(violations_of<Fault::sets>(), "additivity"));
  CHECK(names(violations_of<Fault::remembers>(), "no memory"));
  CHECK(names(violations_of<Fault::counts_blocks>(), "blocks join"));
  CHECK(names(violations_of<Fault::unweighted>(), "zero weight"));
  CHECK(names(violations_of<Fault::impure>(), "finish is pure"));
  CHECK(names(violations_of<Fault::no_unit>(), "units"));
  CHECK(names(violations_of<Fault::no_array_unit>(), "units"));
  CHECK(names(violations_of<Fault::no_doc>(), "docs"));
  CHECK(names(violations_of<Fault::bad_name>(), "names"));
  CHECK(names(violations_of<Fault::twice>(), "names"));
  CHECK(names(violations_of<Fault::axis>(), "axes"));
  CHECK(names(violations_of<Fault::more_than_needed>(), "refusal"));
}

TEST_CASE("a plugin of another kind, or of another SDK, is refused") {
  static constexpr Descriptor other = [] {
    Descriptor d = describe<Height<Fault::none>>({.name = "height"});
    d.layout ^= 1;
    return d;
  }();
  CHECK_THROWS_WITH(check_analyzer(other, kNoValues), Catch::Contains("another SDK"));
  static constexpr Descriptor kind = [] {
    Descriptor d = describe<Height<Fault::none>>({.name = "height"});
    d.kind = static_cast<std::uint32_t>(Kind::geometry);
    return d;
  }();
  CHECK_THROWS_WITH(check_analyzer(kind, kNoValues), Catch::Contains("another kind"));
}
