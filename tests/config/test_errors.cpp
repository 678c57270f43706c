// Every kind of mistake in a case: one line with the place, the reason and the remedy.
#include "tests/config/helpers.hpp"

using namespace millscope::config;
using testing::case_with;
using testing::refusal;

TEST_CASE("the study's nylon is refused with the reason") {
  CHECK(refusal(case_with("  nylon", "  nylon: {density: 1100, shear_modulus: 0.76 GPa, poisson_ratio: 0.76}")) ==
        "case.yaml:5: 'materials.nylon.poisson_ratio' is 0.76; it must be above -1 and below 0.5; no isotropic solid is stable outside; "
        "look the value up again in its source");
}

TEST_CASE("materials") {
  CHECK(refusal(case_with("  nylon", "  nylon: {densty: 1100, shear_modulus: 0.76 GPa, poisson_ratio: 0.4}")) ==
        "case.yaml:5: unknown key 'densty' in 'materials.nylon'; did you mean 'density'?");
  CHECK(refusal(case_with("  nylon", "  nylon: {density: 1100, poisson_ratio: 0.4}")) ==
        "case.yaml:5: missing key 'young_modulus' in 'materials.nylon'; expected: 'young_modulus' or 'shear_modulus', e.g. 26 GPa");
  CHECK(refusal(case_with("  nylon", "  nylon: {density: 0, young_modulus: 1, poisson_ratio: 0.4}")) ==
        "case.yaml:5: 'materials.nylon.density' is 0 kg/m^3; it must be above 0 kg/m^3");
  CHECK(refusal(case_with("  nylon", "  nylon: {density: 1, young_modulus: 1, shear_modulus: 1, poisson_ratio: 0.4}")) ==
        "case.yaml:5: 'materials.nylon' gives both 'young_modulus' and 'shear_modulus'; one follows from the other by E = 2 G (1 + nu); "
        "keep one");
  CHECK(refusal(case_with("  nylon", "  a b: {density: 1, young_modulus: 1, poisson_ratio: 0.4}")) ==
        "case.yaml:5: 'a b' cannot name a material; use letters, digits, '_' and '-', beginning with a letter");
  CHECK(refusal(case_with("groups", "groups: {liner: [hdpe, nylo]}")) ==
        "case.yaml:6: 'groups.liner.1' is the unknown material 'nylo'; did you mean 'nylon'?");
  CHECK(refusal(case_with("groups", "groups: {liner: [hdpe], lifters: [hdpe]}")) ==
        "case.yaml:6: 'groups.lifters.0' is in the group 'liner' already; a material has one group");
}

TEST_CASE("beads and fill") {
  CHECK(refusal(case_with("beads", "beads: {a: {material: glas, diameter: 5 mm}}")) ==
        "case.yaml:7: 'beads.a.material' is the unknown material 'glas'; did you mean 'glass'?");
  CHECK(refusal(case_with("beads", "beads: {a: {material: glass}}")) ==
        "case.yaml:7: 'beads.a' gives none of 'diameter', 'sizes' and 'distribution'; give exactly one");
  CHECK(refusal(case_with("beads", "beads: {a: {material: glass, sizes: [{diameter: 1 mm, fraction: 90 %}]}}")) ==
        "case.yaml:7: 'beads.a.sizes' has fractions that add up to 90 %; they must make 100 %");
  CHECK(refusal(case_with("beads", "beads: {a: {material: glass, diameter: 1 mm, share: 60 %}, b: {material: glass, diameter: 2 mm}}")) ==
        "case.yaml:7: missing key 'share' in 'beads.b'; expected: the class's part of the charge, e.g. 40 %; needed with several classes");
  CHECK(refusal(case_with("beads", "beads: {a: {material: glass, distribution: {kind: normal, mean: 5 mm, deviation: 2 mm}}}")) ==
        "case.yaml:7: 'beads.a.distribution' reaches diameters below 0 within three deviations; give 'low'");
  CHECK(refusal(case_with("fill", "fill: {filling: 31.3, porosity: 0.37}")) ==
        "case.yaml:8: 'fill.filling' is 31.3; it must be above 0 and at most 1; J is a part of the bare shell's volume; write 31.3 % for a "
        "percentage");
  CHECK(refusal(case_with("fill", "fill: {filling: 31.3 %, count: 5}")) ==
        "case.yaml:8: 'fill' gives several of 'count', 'mass', 'filling' and 'file'; give exactly one");
  CHECK(refusal(case_with("fill", "fill: {count: 2.5}")) == "case.yaml:8: 'fill.count' is '2.5'; a whole number is expected");
}

TEST_CASE("pairs and plugins") {
  CHECK(refusal(case_with("  default", "  glass~linr: {restitution: 0.5}")) ==
        "case.yaml:13: pair 'glass~linr' names the unknown material or group 'linr'; did you mean 'liner'?");
  CHECK(refusal(case_with("  default", "  glass: {restitution: 0.5}")) ==
        "case.yaml:13: pair 'glass' names no pair; write material~material, e.g. glass~glass, or default");
  CHECK(refusal(case_with("  default", "  default: {restitution: 1.5}")) ==
        "case.yaml:13: 'pairs.default.restitution' is 1.5; it must be from 0.01 to 1; Ratio of normal speeds after and before.");
  CHECK(refusal(case_with("  default", "  default: {restitution: 0.5, frction: 1}")) ==
        "case.yaml:13: unknown key 'frction' in 'pairs.default'; did you mean 'friction'?");
  CHECK(refusal(case_with("contact", "contact: {law: {kind: sprngs, stiffness: 1}}")) ==
        "case.yaml:9: 'contact.law.kind' is 'sprngs', which no loaded plugin of this kind provides; did you mean 'springs'?");
  CHECK(refusal(case_with("contact", "contact: {law: {stiffness: 1}}")) ==
        "case.yaml:9: missing key 'kind' in 'contact.law'; expected: the name of a contact law, e.g. hertz_mindlin");
  CHECK(refusal(case_with("contact", "contact: {law: {kind: springs, stiffness: 1 kN/m, frict: 1}}")) ==
        "case.yaml:9: unknown key 'frict' in 'contact.law'; known: kind, stiffness, cap, allow_tension");
  CHECK(
      refusal(case_with("contact", "contact: {law: {kind: springs, stiffness: 1}, interactions: {r: {kind: rolling}}}")) ==
      "case.yaml:9: 'contact.interactions.r.kind' is 'rolling', which no loaded plugin of this kind provides; load one with --plugin-dir");
}

TEST_CASE("mill, geometry, motion") {
  CHECK(refusal(case_with("mill", "mill: {speed: 75 %critical}")) ==
        "case.yaml:15: 'mill.speed' is '75 %critical', but the critical speed needs 'mill.diameter'; add it");
  CHECK(refusal(case_with("mill", "mill: {diameter: 4 mm, speed: 1}")) ==
        "case.yaml:15: 'mill.diameter' is 0.004 m; it must be above 0.005 m; it must be larger than the largest bead");
  CHECK(refusal(case_with("mill", "mill: {speed: -5 rad/s}")) ==
        "case.yaml:15: 'mill.speed' is -5 rad/s; it must be at least 0 rad/s; the sense of turning is said by 'direction'");
  CHECK(refusal(testing::kCase, {"geometry.liner.motion=fixed"}) ==
        "case.yaml:16: 'geometry' has no body that turns with the mill, though 'mill.speed' is given; add 'motion: mill' to the liner");
  CHECK(refusal(testing::kCase, {"mill=~"}) ==
        "case.yaml:17: 'geometry.liner.motion' follows the mill's speed, but there is no section 'mill'; add it");
  CHECK(refusal(testing::kCase, {"geometry.liner.motion={rotation: {axis: [0, 0, 0]}}"})
            .find("'geometry.liner.motion.rotation.axis' has no length; give a direction such as [0, 0, 1]") != std::string::npos);
  CHECK(refusal(case_with("  liner: ", "  liner: {kind: tube, file: a, motion: mill}")) ==
        "case.yaml:17: missing key 'material' in 'geometry.liner'; expected: the name of a material, or 'materials: {slot: name}'");
}

TEST_CASE("time, domain, output, run") {
  CHECK(refusal(case_with("time", "time: {end_s: 4, analyze_from_s: 5}")) ==
        "case.yaml:19: 'time.analyze_from_s' is 5 s; it must be at least 0 s and below 4 s; the analysis needs a span before time.end_s = "
        "4 s");
  CHECK(refusal(case_with("time", "time: {analyze_from_s: 5}")) ==
        "case.yaml:19: missing key 'end_s' in 'time'; expected: the end of the run, e.g. 4 s");
  CHECK(refusal(case_with("time", "time: {end_s: 4, step_fraction: 20}")) ==
        "case.yaml:19: 'time.step_fraction' is 20; it must be above 0 and at most 1; a step beyond the Rayleigh time is unstable; 20 % is "
        "usual");
  CHECK(refusal(case_with("time", "time: {end_s: 4, step_s: 1 us, step_fraction: 20 %}")) ==
        "case.yaml:19: 'time' gives both 'step_s' and 'step_fraction'; keep one");
  CHECK(refusal(case_with("domain", "domain: {periodic: {z: [20 mm, 0]}}")) ==
        "case.yaml:18: 'domain' ends along z where it begins or before (0.02 to 0 m); the low end comes first");
  CHECK(refusal(case_with("output", "output: {vtk: on}")) == "case.yaml:20: 'output.vtk' is 'on'; it must be one of off");
  CHECK(refusal(testing::kCase, {"run.skin=0"}) ==
        "--set run.skin=0: 'run.skin' is 0; it must be above 0 and at most 2; it is a part of the largest bead's diameter");
  CHECK(refusal(testing::kCase, {"run.thread=2"}) == "--set run.thread=2: unknown key 'thread' in 'run'; did you mean 'threads'?");
  CHECK(refusal(testing::kCase, {"tme.end_s=2"}) == "--set tme.end_s=2: unknown key 'tme'; did you mean 'time'?");
  CHECK(refusal(testing::kCase, {"stiffness_factor=2"}) ==
        "--set stiffness_factor=2: 'stiffness_factor' is 2; it must be above 0 and at most 1; 1 is the real stiffness, less is softer");
}

TEST_CASE("the head of a case") {
  CHECK(refusal("") == "case.yaml:1: missing key 'schema_version'; expected: the version of the file's shape: 1");
  CHECK(refusal(case_with("schema_version", "schema_version: 2")) ==
        "case.yaml:1: 'schema_version' is 2; this millscope reads 1; use a newer millscope");
  CHECK(refusal(case_with("body_forces", "")) ==
        "case.yaml:1: missing key 'body_forces'; expected: {gravity: {kind: gravity}}, or {} for none");
  CHECK(refusal(case_with("domain", "domian: {}")) == "case.yaml:18: unknown key 'domian'; did you mean 'domain'?");
  CHECK(testing::message_of([] { read_case("/nonexistent/case.yaml"); }) == "/nonexistent/case.yaml: no such file; check the path");
}
