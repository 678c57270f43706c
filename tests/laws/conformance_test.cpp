// The conformance suite over every law, interaction and option, and the same bits from every instruction set.
#include <catch2/catch.hpp>

#include "laws/plugins.hpp"

using namespace laws_test;

namespace {

Setting setting_for(const Case& c) {
  Setting setting;
  setting.sum_is_capped = c.sum_is_capped;
  if (std::string(c.law) == "jkr") setting.cap_offset = 3.0 * 3.14159265358979 * 0.5 * setting.pair.largest_radius;
  return setting;
}

bool runs_here(const std::string& folder) {
  __builtin_cpu_init();
  return folder == "v2" || (folder == "v3" && __builtin_cpu_supports("x86-64-v3")) ||
         (folder == "v4" && __builtin_cpu_supports("x86-64-v4"));
}

/// What a law makes of the same contacts in forty steps, by the build in this folder.
Contacts run_build(const Case& c, const std::string& folder) {
  const Descriptor& d = open_plugin(plugin_directory() + "/" + folder + "/lib" + c.law + ".so", c.law);
  const ValueSet values = values_of(d, c.values);
  const Setting setting;
  const Law law(*static_cast<const ContactLawTable*>(d.table), values.view(), setting.pair);
  Contacts contacts = random_contacts(setting);
  for (int step = 0; step < 40; ++step) {
    contacts.step(law, 5e-6);
    conformance::move(contacts, 5e-6);
  }
  return contacts;
}

}  // namespace

TEST_CASE("every contact law holds to the conformance suite with every option") {
  for (const Case& c : kCases) {
    const Descriptor& d = plugin(c.law);
    const ValueSet values = values_of(d, c.values);
    INFO(c.law << " " << c.values);
    for (const Violation& v : check_contact_law(d, values.view(), setting_for(c))) {
      UNSCOPED_INFO(v.check << ": " << v.message);
      CHECK(v.check.empty());
    }
  }
}

TEST_CASE("every interaction holds to the conformance suite with every option") {
  const std::pair<const char*, const char*> cases[] = {
      {"rolling_constant_torque", "rolling_friction=0.05"},
      {"rolling_constant_torque", "rolling_friction=0.05 length=radius"},
      {"rolling_epsd", "rolling_friction=0.05"},
      {"rolling_epsd", "rolling_friction=0.05 damping_ratio=0.3 length=radius"},
      {"bead_shape", "aspect_ratio=1.3"},
      {"bead_shape", "aspect_ratio=1 damping_ratio=0.2"},
      {"cohesion_sjkr", "cohesion_energy_density=50000"},
      {"cohesion_sjkr", "cohesion_energy_density=50000 friction=net"},
      {"capillary_bridge", "surface_tension=0.07"},
      {"capillary_bridge", "surface_tension=0.07 contact_angle=0.5 volume_ratio=0.01 friction=net"},
      {"capillary_bridge", "surface_tension=0.07 volume_ratio=1e-9"},
      {"lubrication", "viscosity=0.01"},
      {"lubrication", "viscosity=10 cut=0.1 range=0.2"},
  };
  for (const auto& [name, text] : cases) {
    const Descriptor& d = plugin(name);
    const ValueSet values = values_of(d, text);
    INFO(name << " " << text);
    for (const Violation& v : check_interaction(d, values.view())) {
      UNSCOPED_INFO(v.check << ": " << v.message);
      CHECK(v.check.empty());
    }
  }
}

TEST_CASE("the builds for v2, v3 and v4 give the same bits") {
  for (const Case& c : kCases) {
    INFO(c.law << " " << c.values);
    const Contacts reference = run_build(c, "v2");
    for (const char* folder : {"v3", "v4"}) {
      if (!runs_here(folder)) continue;
      INFO(folder);
      const Contacts other = run_build(c, folder);
      for (std::size_t axis = 0; axis < 3; ++axis) CHECK(other.force[axis] == reference.force[axis]);
      for (std::size_t h = 0; h < kMaxHistory; ++h) CHECK(other.history[h] == reference.history[h]);
      for (std::size_t k = 0; k < kMaxChannels; ++k) CHECK(other.power[k] == reference.power[k]);
      CHECK(other.elastic_energy == reference.elastic_energy);
      CHECK(other.normal_stiffness == reference.normal_stiffness);
    }
  }
}

TEST_CASE("what a pair's own restitution gives, a restitution per contact gives too") {
  for (const char* name : {"hertz_mindlin", "hertz_mindlin_deresiewicz", "linear_spring_dashpot", "jkr"}) {
    std::string extra;
    if (std::string(name) == "linear_spring_dashpot") extra = " normal_stiffness=20000";
    if (std::string(name) == "jkr") extra = " surface_energy=0.1";
    const Law own = make_law(name, "restitution=0.6 static_friction=0.3" + extra),
              other = make_law(name, "restitution=0.9 static_friction=0.3" + extra);
    double slots[8][8] = {};
    double restitution[8], force[2][3][8];
    for (int k = 0; k < 8; ++k) {
      slots[0][k] = 1e-5 * (k + 1);
      slots[1][k] = 1.0;
      slots[2][k] = 0.1 * (k - 3);
      slots[3][k] = 0.05 * k;
      slots[4][k] = 2e-3;
      slots[5][k] = 1e-4;
      restitution[k] = 0.6;
    }
    double zero[8] = {}, history[2][kMaxHistory][8] = {};
    for (int which = 0; which < 2; ++which) {
      ContactBatch b{};
      b.count = 8;
      b.time_step = 1e-6;
      b.overlap = slots[0];
      b.normal[0] = slots[1], b.normal[1] = b.normal[2] = zero;
      b.velocity[0] = slots[2], b.velocity[1] = slots[3], b.velocity[2] = zero;
      b.radius = slots[4], b.mass = slots[5];
      b.restitution = which == 0 ? nullptr : restitution;
      for (int h = 0; h < kMaxHistory; ++h) b.history[h] = history[which][h];
      for (int a = 0; a < 3; ++a) b.force[a] = force[which][a];
      const Law& law = which == 0 ? own : other;
      law.table().evaluate(law.get(), &b);
    }
    INFO(name);
    for (int a = 0; a < 3; ++a) {
      for (int k = 0; k < 8; ++k) CHECK(force[0][a][k] == force[1][a][k]);
    }
  }
}

TEST_CASE("a contact law refuses what makes no sense and says the remedy") {
  CHECK_THROWS_WITH(make_law("linear_spring_dashpot", "restitution=0.8 static_friction=0.3"), Catch::Contains("exactly one of"));
  CHECK_THROWS_WITH(make_law("linear_spring_dashpot", "restitution=0.8 static_friction=0.3 normal_stiffness=1e4 contact_time=1e-4"),
                    Catch::Contains("exactly one of"));
  CHECK_THROWS_WITH(make_law("hertz_mindlin", "restitution=0.8 static_friction=0.3 tangential=mindlin_deresiewicz"),
                    Catch::Contains("law: {kind: hertz_mindlin_deresiewicz}"));
  for (const char* name : {"hertz_mindlin", "hertz_mindlin_deresiewicz", "linear_spring_dashpot", "jkr"}) {
    const Descriptor& d = plugin(name);
    for (std::uint64_t i = 0; i < d.parameter_count; ++i) {
      const Parameter& p = d.parameters[i];
      if (std::string(p.name) == "restitution") CHECK((p.minimum > 0.0 && p.maximum == 1.0));
      if (std::string(p.name) == "static_friction") CHECK(p.minimum == 0.0);
      CHECK((p.scope == Scope::pair || p.type == ValueType::choice || p.type == ValueType::boolean));
    }
  }
}
