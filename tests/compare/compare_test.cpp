// What `compare` concludes, and what it refuses.
#include "studies/compare/compare.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "host/temporary.hpp"
#include "made_up.hpp"
#include "studies/analysis/mirror.hpp"
#include "studies/compare/elements.hpp"

using namespace millscope;
using compare_test::make_results;
using host_test::refusal;

namespace {

const compare::ComparedObservable* find(const compare::Comparison& c, const std::string& name) {
  for (const compare::ComparedObservable& o : c.observables) {
    if (o.name == name) return &o;
  }
  return nullptr;
}

bool mentions(const std::vector<std::string>& texts, const std::string& part) {
  for (const std::string& text : texts) {
    if (text.find(part) != std::string::npos) return true;
  }
  return false;
}

analysis::ResultArray& array_named(analysis::ResultSet& results, const std::string& name) {
  for (analysis::ResultArray& a : results.arrays) {
    if (a.analyzer + "." + a.name == name) return a;
  }
  throw std::runtime_error("no " + name);
}

}  // namespace

TEST_CASE("two runs of the same mill do not differ") {
  const compare::Comparison c = compare::compare(make_results({.seed = 1}), make_results({.seed = 2}), {});
  CHECK(c.verdict_kind == compare::Verdict::no_difference);
  CHECK(c.verdict == "no difference at 5 % family-wise in 8 observables");
  CHECK(c.given.size() == 1);
  CHECK(c.notes.empty());
  CHECK(mentions(c.not_judged, "pept_grid.kind: names, not numbers"));
}

TEST_CASE("a power that differs is found, and nothing else is") {
  const compare::Comparison c =
      compare::compare(make_results({.seed = 3}), make_results({.seed = 4, .power = 0.6}), {});  // 5.4 standard errors
  REQUIRE(c.verdict_kind == compare::Verdict::differ);
  CHECK(c.verdict == "1 of 8 observables differ at 5 % family-wise; strongest: power.power_gravity");
  const compare::ComparedElement& e = c.observables[0].elements[0];
  CHECK(e.b - e.a == Approx(0.6).margin(0.35));
  CHECK(e.test.high - e.test.low == Approx(2 * 1.665 * 0.5 * std::sqrt(2.0 / 40)).epsilon(0.25));  // Student's 95 % point at 78
}

TEST_CASE("a region that differs is named as an engineer would") {
  const compare::Comparison c =
      compare::compare(make_results({.seed = 5}), make_results({.seed = 6, .speed = 0.05}), {});  // 2.2 standard errors in a cell
  REQUIRE(c.verdict_kind == compare::Verdict::differ);
  CHECK(c.observables[0].name == "pept_grid.speed by region");
  const compare::ComparedElement& e = c.observables[0].elements[c.observables[0].strongest];
  CHECK(e.where.find("0–45° past 6 o'clock") != std::string::npos);
  CHECK(find(c, "pept_grid.velocity_x by region")->adjusted_p > 0.05);
}

TEST_CASE("cells are named by place, radius and clock") {
  const millscope::base::MillPlace clockwise{0.15, -1};
  CHECK(compare::place_text(-0.105, 0.0, clockwise) == "x −105 mm, y 0 mm (0.70 R, 90° past 6 o'clock)");
  CHECK(compare::place_text(0.105, 0.0, {0.15, 1}) == "x 105 mm, y 0 mm (0.70 R, 90° past 6 o'clock)");
  CHECK(compare::place_text(0.075, -0.1299, clockwise) == "x 75 mm, y −130 mm (1.00 R, 30° before 6 o'clock)");
  CHECK(compare::place_text(0.01, 0.02, {}) == "x 10 mm, y 20 mm");
}

TEST_CASE("of two senses one is mirrored, and it is said") {
  const analysis::ResultSet a = make_results({.seed = 7}), b = make_results({.seed = 8, .power = 0.6});
  std::vector<std::string> done;
  const analysis::ResultSet turned = analysis::mirrored(b, done);
  CHECK(turned.meta.context.omega == 6);
  const compare::Comparison plain = compare::compare(a, b, {}), across = compare::compare(a, turned, {});
  REQUIRE(across.observables.size() == plain.observables.size());
  for (std::size_t i = 0; i < plain.observables.size(); ++i) {
    const compare::ComparedObservable &x = plain.observables[i], &y = across.observables[i];
    CHECK(x.name == y.name);
    CHECK(x.adjusted_p == y.adjusted_p);
    REQUIRE(x.elements.size() == y.elements.size());
    for (std::size_t k = 0; k < x.elements.size(); ++k) CHECK(x.elements[k].b == Approx(y.elements[k].b).margin(1e-12));
  }
  CHECK(plain.notes.empty());
  REQUIRE(across.notes.size() == 1);
  CHECK(across.notes[0].find("A turns clockwise, B counter-clockwise: B is mirrored") == 0);
  CHECK(across.notes[0].find("power.centre_of_mass_x") != std::string::npos);
  CHECK(across.notes[0].find("power.power_gravity") == std::string::npos);
}

TEST_CASE("an unknown sense is taken for the other's, and it is said") {
  analysis::ResultSet b = make_results({.seed = 8});
  b.meta.context.omega = 0;
  CHECK(mentions(compare::compare(make_results({.seed = 7}), b, {}).notes, "the turning sense of B is unknown"));
}

TEST_CASE("with too few blocks there is no verdict") {
  const compare::Comparison c = compare::compare(make_results({.seed = 1, .blocks = 5}), make_results({.seed = 2, .power = 50}), {});
  CHECK(c.verdict_kind == compare::Verdict::cannot_tell);
  CHECK(c.verdict == "cannot tell: no result rests on 10 independent blocks in both (A has 5 blocks, B 40); analyse longer spans");
  CHECK(mentions(c.not_judged, "power.power_gravity: rests on fewer than 10 independent blocks"));
}

TEST_CASE("given quantities and conditions that differ are told, not judged") {
  const compare::Comparison c = compare::compare(make_results({.seed = 1}), make_results({.seed = 2, .omega = -5, .critical = 7.5}), {});
  REQUIRE(c.given.size() == 2);
  CHECK(c.given.front() == "models.critical_speed: 8.0000 rad/s in A, 7.5000 rad/s in B");
  CHECK(mentions(c.notes, "the turning speed is 57.30 rpm in A and 47.75 rpm in B"));
  CHECK(find(c, "models.critical_speed") == nullptr);
}

TEST_CASE("how much data there are is told, never judged") {
  // 40 s against 160 s: 75 standard errors.
  const analysis::ResultSet a = make_results({.seed = 1}), b = make_results({.seed = 2, .blocks = 160});
  const compare::Comparison c = compare::compare(a, b, {});
  CHECK(c.verdict_kind == compare::Verdict::no_difference);
  CHECK(find(c, "power.seconds") == nullptr);
  CHECK(mentions(c.given, "power.seconds: "));
  CHECK(mentions(c.given, "how much data"));
  // Nor does its shape stand in the way.
  analysis::ResultSet other = b;
  array_named(other, "power.seconds").unit = "min";
  CHECK_NOTHROW(compare::compare(a, other, {}));
  // Without the bit it is a difference like any other.
  analysis::ResultSet plain_a = a, plain_b = b;
  array_named(plain_a, "power.seconds").traits = array_named(plain_b, "power.seconds").traits = 0;
  CHECK(compare::compare(plain_a, plain_b, {}).verdict_kind == compare::Verdict::differ);
}

TEST_CASE("a cell that one side never visited is not judged") {
  // As `analyze` writes it, and as earlier results had it: exactly zero.
  for (const std::uint8_t flags : {std::uint8_t{analysis::kNoUncertainty}, std::uint8_t{0}}) {
    analysis::ResultSet a = make_results({.seed = 1});
    const analysis::ResultSet b = make_results({.seed = 2});
    analysis::ResultArray& x = array_named(a, "distributions.x_percent");
    const double none = flags == 0 ? 0 : std::numeric_limits<double>::quiet_NaN();
    x.value[0] = 0, x.sem[0] = x.low[0] = x.high[0] = none, x.flags[0] = flags, x.effective_blocks[0] = 40;
    for (std::size_t r = 0; r < x.draws.size(); r += x.size()) x.draws[r] = 0;
    const compare::Comparison c = compare::compare(a, b, {.only = {"distributions.x_percent"}});
    REQUIRE(c.observables.size() == 1);
    CHECK(c.observables[0].elements.size() == x.size() - 1);
    CHECK(c.observables[0].too_few == 1);
    CHECK(c.verdict_kind == compare::Verdict::no_difference);
  }
}

TEST_CASE("what is told over times that one side has more of is passed over and listed") {
  analysis::ResultSet a = make_results({.seed = 1}), b = make_results({.seed = 2});
  array_named(a, "distributions.x_edges").unit = array_named(b, "distributions.x_edges").unit = "s";
  CHECK(find(compare::compare(a, b, {}), "distributions.x_percent") != nullptr);  // times that end alike are a grid like any other
  for (double& edge : array_named(b, "distributions.x_edges").value) edge *= 1.5;
  const compare::Comparison c = compare::compare(a, b, {});
  CHECK(find(c, "distributions.x_percent") == nullptr);
  CHECK(mentions(c.not_judged, "distributions.x_percent: its times end with what was analysed"));
}

TEST_CASE("other grids and units are refused, with the remedy") {
  const analysis::ResultSet a = make_results({.seed = 1});
  const std::string grids = refusal([&] { compare::compare(a, make_results({.seed = 2, .cells = 10}), {.only = {"pept_grid"}}); });
  CHECK(grids.find("pept_grid.speed: the grids differ: y_edges is 13 values from −0.1500 to 0.1500 m in A and 11 values") == 0);
  CHECK(grids.find("--without pept_grid") != std::string::npos);
  CHECK_NOTHROW(compare::compare(a, make_results({.seed = 2, .cells = 10}), {.without = {"pept_grid", "distributions"}}));
  analysis::ResultSet b = make_results({.seed = 2});
  array_named(b, "power.power_gravity").unit = "kW";
  CHECK(refusal([&] { compare::compare(a, b, {}); }).find("power.power_gravity: the units differ: W in A, kW in B") == 0);
  b = make_results({.seed = 2});
  for (double& edge : array_named(b, "distributions.x_edges").value) edge *= 1.01;
  CHECK(refusal([&] { compare::compare(a, b, {}); }).find("distributions.x_percent: the grids differ") == 0);
  b.meta.source = "recording";  // whose mill was found a hundredth larger: its size is what differs, not a setting
  b.meta.context.mill_radius = 1.01 * a.meta.context.mill_radius;
  CHECK(refusal([&] { compare::compare(a, b, {}); }).find("state it for both, 'condition: {mill_diameter: 0.3030 m}'") !=
        std::string::npos);
}

TEST_CASE("frames too far apart for the recording's camera are compared where no camera is needed") {
  const analysis::ResultSet a = make_results({.seed = 1});
  analysis::ResultSet b = make_results({.seed = 2});
  b.meta.source = analysis::kCoarseFrames;
  const compare::Comparison c = compare::compare(a, b, {});
  REQUIRE_FALSE(c.observables.empty());
  for (const compare::ComparedObservable& o : c.observables) CHECK(o.name.starts_with("pept_grid.velocity_x"));
  CHECK(mentions(c.not_judged, "power.power_gravity: needs the recording's camera"));
  CHECK(mentions(c.notes, "every 5 ms"));
  CHECK(refusal([&] { compare::compare(b, a, {.only = {"power"}}); }).find("needs the recording's camera: let your program write frames") !=
        std::string::npos);
  // Against another simulation nothing is missing.
  analysis::ResultSet simulated = a;
  simulated.meta.source = "simulation";
  CHECK_FALSE(mentions(compare::compare(simulated, b, {}).not_judged, "needs the recording's camera"));
}

TEST_CASE("what is not there cannot be chosen") {
  const analysis::ResultSet a = make_results({.seed = 1}), b = make_results({.seed = 2});
  CHECK(refusal([&] { compare::compare(a, b, {.only = {"pept_gird"}}); }).find("--only pept_gird: neither of the results has it") == 0);
  CHECK(compare::compare(a, b, {.only = {"pept_grid.speed"}}).observables.size() == 2);
  CHECK(compare::compare(a, b, {.without = {"pept_grid", "power.power_gravity"}}).observables.size() == 3);
  analysis::ResultSet less = b;
  std::erase_if(less.arrays, [](const analysis::ResultArray& x) { return x.name == "power_gravity"; });
  CHECK(mentions(compare::compare(a, less, {}).not_judged, "power.power_gravity: only in A"));
}

TEST_CASE("rounding errors of a fraction are no difference") {
  analysis::ResultSet a = make_results({.seed = 1}), b = make_results({.seed = 2});
  for (analysis::ResultSet* r : {&a, &b}) {
    analysis::ResultArray& outside = array_named(*r, "power.centre_of_mass_x");
    outside.name = "outside_fraction", outside.unit = "1";
    outside.value[0] = r == &a ? 4e-15 : -60e-15, outside.sem[0] = 2e-15;
    for (float& draw : outside.draws) draw *= 1e-12F;
  }
  CHECK(find(compare::compare(a, b, {}), "power.outside_fraction") == nullptr);
}
