// The project's own plugins, opened directly.
#pragma once

#include "millscope/conformance.hpp"

namespace laws_test {

using namespace millscope;
using namespace millscope::conformance;

inline std::string plugin_directory() { return std::string(MILLSCOPE_BINARY_DIR) + "/lib/millscope/plugins"; }

inline const Descriptor& plugin(const std::string& name) { return open_plugin(best_build(plugin_directory(), name), name); }

/// "key=value key=value": numbers or choices.
inline ValueSet values_of(const Descriptor& d, const std::string& text) {
  ValueSet values(d);
  values.read(text);
  return values;
}

using Law = Held<ContactLawTable>;

inline Law make_law(const std::string& name, const std::string& text, const PairContext& pair = bead_pair()) {
  const Descriptor& d = plugin(name);
  const ValueSet values = values_of(d, text);
  return Law(*static_cast<const ContactLawTable*>(d.table), values.view(), pair);
}

/// Every law with every option, with the settings that its options ask for.
struct Case {
  const char* law;
  const char* values;
  bool sum_is_capped;
};

inline const Case kCases[] = {
    {"hertz_mindlin", "restitution=0.8 static_friction=0.34", false},
    {"hertz_mindlin", "restitution=0.8 static_friction=0.34 cap=sum", true},
    {"hertz_mindlin", "restitution=0.5 static_friction=0.34 allow_tension=0", false},
    {"hertz_mindlin", "restitution=0.5 static_friction=0.34 friction_in_tension=1", false},
    {"hertz_mindlin", "restitution=0.5 static_friction=0.34 allow_tension=0 cap=sum", true},
    {"hertz_mindlin_deresiewicz", "restitution=0.8 static_friction=0.34", false},
    {"hertz_mindlin_deresiewicz", "restitution=0.8 static_friction=0.34 cap=sum", true},
    {"linear_spring_dashpot", "restitution=0.8 static_friction=0.34 normal_stiffness=20000", false},
    {"linear_spring_dashpot", "restitution=0.8 static_friction=0.34 largest_overlap=0.05 cap=sum", true},
    {"linear_spring_dashpot", "restitution=0.5 static_friction=0.34 contact_time=3e-4 allow_tension=0 cap=sum", true},
    {"jkr", "restitution=0.8 static_friction=0.34 surface_energy=0.5", false},
    {"jkr", "restitution=0.8 static_friction=0.34 surface_energy=0.5 cap=sum", true},
    {"jkr", "restitution=0.8 static_friction=0.34 surface_energy=0 allow_tension=0", false},
};

}  // namespace laws_test
