// What a base case may lack: which hypotheses apply, what switches them on, how far they reach.
#include "studies/diagnose/question/candidates.hpp"

#include <fmt/format.h>
#include <catch2/catch.hpp>
#include <fstream>

#include "kernel/config/units.hpp"
#include "kernel/config/writer.hpp"
#include "made_up_study.hpp"
#include "studies/calibrate/outputs.hpp"

using namespace millscope;
using namespace millscope::diagnose;
using namespace millscope::naming;
using Catch::WithinAbs;
using Catch::WithinRel;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;
using testing::Scratch;

namespace {

const std::string kMill = MILLSCOPE_SOURCE_DIR "/configs/mill10/case.yaml";

Library library(const std::vector<std::string>& settings = {}, const std::string& file = kMill) {
  return library_of(config::read_case(file, settings), registry());
}

const Candidate* find(const Library& l, const std::string& name) {
  for (const Candidate& c : l.candidates) {
    if (c.name == name) return &c;
  }
  return nullptr;
}

std::string why_not(const Library& l, const std::string& name) {
  for (const std::string& line : l.left_out) {
    if (line.rfind(name + ":", 0) == 0) return line.substr(name.size() + 2);
  }
  return "";
}

}  // namespace

TEST_CASE("hypotheses of plugins that the base lacks apply, others say why they do not") {
  const Library l = library();
  for (const char* name : {"adhesion", "air_drag", "capillary_bridge", "cohesion", "fluid_pool", "lubrication", "rolling_friction",
                           "rolling_resistance", "bead_shape", "speed_dependent_friction", "lifter_friction", "lifter_wear",
                           "lifter_face_angle", "end_faces_at_rest", "unlike_tracer", "size_spread", "contact_stiffness"}) {
    INFO(name << ": " << why_not(l, name));
    CHECK(find(l, name) != nullptr);
  }
  CHECK(std::is_sorted(l.candidates.begin(), l.candidates.end(), [](const auto& a, const auto& b) { return a.name < b.name; }));
  CHECK_THAT(why_not(l, "location_blur"), StartsWith("an effect of the camera; of these only nuisances camera.frame_error.* are tested"));
  CHECK_THAT(why_not(l, "speed_dependent_restitution"),
             StartsWith("needs pairs.glass~glass.reference_restitution; give it in the base case or under hypotheses."));
}

TEST_CASE("a case can be written with every candidate, and reads as the simulations of the bank do") {
  const Scratch folder;
  const std::string file = (folder / "case.yaml").string();
  for (const Candidate& c : library().candidates) {
    std::vector<std::string> settings{"pairs.glass~glass.static_friction=0.27", "fill.filling=31 %"};
    for (const std::string& s : settings_of(c, 0.5)) settings.push_back(s);
    std::ofstream(file) << calibrate::case_with("With an effect.", kMill, settings, folder.path);
    INFO(c.name << "\n" << std::ifstream(file).rdbuf());
    CHECK(config::difference(config::load_document(kMill, settings), config::load_document(file)).empty());
    CHECK_NOTHROW(config::read_case(file));
  }
}

TEST_CASE("a target that does not apply says what it needs") {
  const std::string shell = "geometry.liner.";
  CHECK(why_not(library({"stiffness_factor=1"}), "contact_stiffness") == "needs softened contacts: a stiffness_factor below 1");
  const Library smooth = library({shell + "lifters=0"});
  CHECK(find(smooth, "lifter_wear") == nullptr);
  CHECK_THAT(why_not(smooth, "lifter_wear"), StartsWith("needs a geometry of kind mill with lifters"));
  CHECK_THAT(why_not(smooth, "lifter_face_angle"), StartsWith("needs a geometry of kind mill with lifters whose faces"));
  CHECK_THAT(why_not(library({shell + "end_faces=false"}), "end_faces_at_rest"),
             StartsWith("needs a geometry of kind mill whose end_faces"));
  const Library all = library();
  for (const char* name : {"contact_stiffness", "end_faces_at_rest", "lifter_face_angle", "lifter_friction", "lifter_wear", "size_spread",
                           "speed_ripple", "unlike_tracer"})
    CHECK((find(all, name) == nullptr) != why_not(all, name).empty());
}

TEST_CASE("a ripple comes once in a turn at every speed") {
  for (const std::string speed : {"75 %critical", "50 %critical"}) {
    const Library l = library();  // of the base's own speed
    std::vector<std::string> settings = settings_of(*find(l, "speed_ripple"), 0.5);
    settings.push_back("mill.speed=" + speed);
    const config::Case c = config::read_case(kMill, settings);
    CHECK_THAT(c.geometry[0].motion.rotation->ripple->frequency, WithinRel(std::fabs(c.mill->speed) / (2 * M_PI), 1e-9));
  }
}

TEST_CASE("what is in the base is no candidate") {
  const Library l = library({"contact.interactions.roll.kind=rolling_epsd", "pairs.glass~glass.rolling_friction=0.01",
                             "pairs.glass~liner.rolling_friction=0.01", "body_forces.air.kind=air_drag", "contact.law={kind: jkr}",
                             "pairs.glass~glass.surface_energy=0.01", "pairs.glass~liner.surface_energy=0.01"});
  CHECK(find(l, "rolling_resistance") == nullptr);
  CHECK(why_not(l, "rolling_resistance") == "rolling_epsd is in the base case already");
  CHECK(why_not(l, "air_drag") == "air_drag is in the base case already");
  CHECK(why_not(l, "adhesion") == "jkr is in the base case already");
  CHECK(find(l, "rolling_friction") != nullptr);
}

TEST_CASE("every candidate gives a case that can be run, at both ends of its range") {
  const std::vector<const Descriptor*> descriptors = registry().descriptors();
  for (const Candidate& c : library().candidates) {
    for (const double strength : {c.range.low, c.range.high}) {
      INFO(c.name << " at " << strength);
      const config::Case with = config::read_case(kMill, settings_of(c, strength));
      CHECK_NOTHROW(config::finish(with, descriptors));
      CHECK_NOTHROW(config::resolved_yaml(with, descriptors));
    }
    CHECK_FALSE(c.sentence.empty());
    CHECK(c.far != c.null_value);
  }
}

TEST_CASE("a parameter of pairs is set for every pair, one of the plugin once") {
  const Library l = library();
  REQUIRE(find(l, "rolling_resistance") != nullptr);
  CHECK(settings_of(*find(l, "rolling_resistance"), 0.25) == std::vector<std::string>{"contact.interactions.rolling_epsd.kind=rolling_epsd",
                                                                                      "pairs.glass~glass.rolling_friction=0.05",
                                                                                      "pairs.glass~liner.rolling_friction=0.05"});
  REQUIRE(find(l, "air_drag") != nullptr);
  CHECK(settings_of(*find(l, "air_drag"), 1) ==
        std::vector<std::string>{"body_forces.air_drag.kind=air_drag", "body_forces.air_drag.strength=3"});
  CHECK(find(l, "rolling_resistance")->excludes == std::vector<std::string>{"rolling_friction", "bead_shape"});
  CHECK(find(l, "capillary_bridge")->excludes == std::vector<std::string>{"cohesion", "adhesion"});
}

TEST_CASE("a range may go downwards") {
  const Candidate* c = nullptr;
  const Library l = library();
  REQUIRE((c = find(l, "speed_dependent_friction")) != nullptr);
  CHECK(c->null_value == 1);
  CHECK(c->far == 0.2);
  CHECK(c->range.low == 0);
  CHECK_THAT(c->value(0.5), WithinRel(0.6, 1e-12));
  CHECK_THAT(settings_of(*c, 1).back(), Contains("kinetic_ratio=0.2"));
}

TEST_CASE("lifters may be worn, and their faces stand otherwise, to both sides") {
  const Library l = library();
  const Candidate *wear = find(l, "lifter_wear"), *angle = find(l, "lifter_face_angle");
  REQUIRE(wear != nullptr);
  REQUIRE(angle != nullptr);
  CHECK(settings_of(*wear, 0) == std::vector<std::string>{"geometry.liner.lifter_height=0.005"});
  CHECK(settings_of(*wear, 1) == std::vector<std::string>{"geometry.liner.lifter_height=0.003"});
  const double degree = std::acos(-1.0) / 180;
  CHECK_THAT(angle->null_value, WithinRel(60 * degree, 1e-12));
  CHECK_THAT(angle->value(1), WithinRel(75 * degree, 1e-12));
  CHECK_THAT(angle->value(angle->range.low), WithinRel(45 * degree, 1e-12));
  // A face that stands at 80 degrees can be steeper by 9 only: the far end is the one below.
  const Library steep = library({"geometry.liner.lifter_face_angle=80 deg"});
  REQUIRE(find(steep, "lifter_face_angle") != nullptr);
  const Candidate& s = *find(steep, "lifter_face_angle");
  CHECK_THAT(std::min(s.value(1), s.value(s.range.low)), WithinRel(65 * degree, 1e-9));
  CHECK_THAT(std::max(s.value(1), s.value(s.range.low)), WithinRel(89 * degree, 1e-9));
  // On a narrow base shallow faces would meet below the top: the range ends where a tenth of the base is left.
  const Library narrow = library({"geometry.liner.lifter_width=8 mm"});
  REQUIRE(find(narrow, "lifter_face_angle") != nullptr);
  const Candidate& n = *find(narrow, "lifter_face_angle");
  CHECK_THAT(n.value(1), WithinRel(75 * degree, 1e-12));
  CHECK_THAT(std::tan(n.value(n.range.low)), WithinRel(10 / (0.9 * 8), 1e-9));
  const Library upright = library({"geometry.liner.lifter_face_angle=89 deg"});
  if (const Candidate* u = find(upright, "lifter_face_angle")) CHECK(std::isfinite(u->range.low));
  CHECK(find(library({"geometry.liner.lifters=0"}), "lifter_wear") == nullptr);
}

TEST_CASE("lifters rub by a part of what the shell does, whatever that is") {
  const Library l = library();
  const Candidate* c = find(l, "lifter_friction");
  REQUIRE(c != nullptr);
  CHECK_THAT(c->value(c->range.low), WithinRel(2, 1e-12));
  const auto friction = [](const config::Case& with, const char* other) {
    return config::read_number(with.pairs.lookup("glass", other).at("static_friction"), "1");
  };
  for (const double shell : {0.3, 0.5}) {
    std::vector<std::string> settings = settings_of(*c, 0.5);
    settings.push_back(fmt::format("pairs.glass~liner.static_friction={}", shell));
    const config::Case with = config::read_case(kMill, settings);
    CHECK(with.geometry[0].material_of("shell") == "liner");
    CHECK(with.geometry[0].material_of("lifter") == "lifters");
    CHECK(with.material("lifters").young == with.material("liner").young);
    CHECK_THAT(friction(with, "lifters"), WithinRel(0.6 * shell, 1e-12));
    CHECK(friction(with, "liner") == shell);
  }
  // What else a bead feels at the shell it feels at the lifters.
  std::vector<std::string> both = settings_of(*c, 1);
  for (const std::string& s : settings_of(*find(l, "rolling_resistance"), 0.5)) both.push_back(s);
  const config::Node at_lifter = config::read_case(kMill, both).pairs.lookup("glass", "lifters");
  CHECK(config::read_number(at_lifter.at("rolling_friction"), "1") == 0.1);
  const Library other =
      library({"materials.rubber={density: 1100, young_modulus: 1 GPa, poisson_ratio: 0.4}",
               "pairs.glass~rubber={restitution: 0.5, static_friction: 0.6}", "geometry.liner.materials={lifter: rubber}"});
  CHECK(find(other, "lifter_friction") == nullptr);
  CHECK_THAT(why_not(other, "lifter_friction"), StartsWith("needs a geometry of kind mill with lifters of the shell's material"));
}

TEST_CASE("a tracer of another density is set apart from a charge that stays as it is") {
  const Candidate* c = nullptr;
  const Library l = library();
  REQUIRE((c = find(l, "unlike_tracer")) != nullptr);
  const config::Case base = config::read_case(kMill), heavy = config::read_case(kMill, settings_of(*c, 1)),
                     light = config::read_case(kMill, settings_of(*c, c->range.low));
  REQUIRE(heavy.beads.size() == 2);
  const config::BeadCase &charge = heavy.beads[0], &tracer = heavy.beads[1];
  CHECK(tracer.tracer);
  CHECK_FALSE(charge.tracer);
  CHECK(charge.density == base.beads[0].density);
  CHECK_THAT(tracer.density, WithinRel(2 * charge.density, 1e-9));
  CHECK_THAT(light.beads[1].density, WithinRel(0.5 * charge.density, 1e-9));
  CHECK_THAT(tracer.number_share, WithinRel(0.05, 1e-9));
  CHECK(config::bead_count(heavy) == config::bead_count(base));
  CHECK(find(library({"beads.glass10.tracer=true"}), "unlike_tracer") == nullptr);
  CHECK(find(library({"stiffness_factor=1"}), "contact_stiffness") == nullptr);
}

TEST_CASE("sizes may spread about a tracer of the nominal one") {
  const Candidate* c = nullptr;
  const Library l = library();
  REQUIRE((c = find(l, "size_spread")) != nullptr);
  const config::Case spread = config::read_case(kMill, settings_of(*c, 1));
  double mean = 0, square = 0;
  for (const config::SizeClass& s : spread.beads[0].sizes) {
    mean += s.number_fraction * s.diameter;
    square += s.number_fraction * s.diameter * s.diameter;
  }
  CHECK_THAT(mean, WithinRel(0.01, 1e-6));
  CHECK_THAT(std::sqrt(square - mean * mean), WithinRel(0.0015, 0.05));
  CHECK(spread.beads[1].sizes[0].diameter == 0.01);
}

TEST_CASE("end faces that turn may be at rest, on or off") {
  const Library l = library();
  const Candidate* c = find(l, "end_faces_at_rest");
  REQUIRE(c != nullptr);
  CHECK(c->on_or_off());
  CHECK(rounded_strength(*c, 1) == 1);
  const std::vector<std::string> settings = settings_of(*c, 1);
  REQUIRE(settings.size() == 3);
  CHECK(settings[0] == "geometry.liner.end_faces=false");
  CHECK_THAT(settings[2], Contains("point: [0, 0, 0.06]") && Contains("material: liner"));
  CHECK(find(library({"geometry.liner.end_faces=false"}), "end_faces_at_rest") == nullptr);
  CHECK(find(library({}, MILLSCOPE_SOURCE_DIR "/configs/demo.yaml"), "end_faces_at_rest") == nullptr);
}

TEST_CASE("strengths stand for values of four digits") {
  Candidate c;
  c.paths = {"a"};
  c.null_value = 0.4, c.far = 0.1;
  const double strength = 0.123456789;
  CHECK(c.value(rounded_strength(c, strength)) == Approx(rounded(c.value(strength))).epsilon(1e-14));
  CHECK(settings_of(c, strength) == settings_of(c, rounded_strength(c, strength)));
  CHECK(rounded(0.123456) == 0.1235);
  CHECK(rounded(0) == 0);
  CHECK(rounded(-1234567) == -1235000);
}
