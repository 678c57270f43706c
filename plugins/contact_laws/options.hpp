// Parameters, channels and descriptor fields that the contact laws have in common.
#pragma once

#include "millscope/contact_law.hpp"
#include "millscope/parameters.hpp"
#include "restitution.hpp"

namespace millscope::laws {

inline constexpr Parameter restitution_parameter =
    pair_parameter("restitution", "1", kRequired, kSmallestRestitution, 1.0, "Coefficient of normal restitution e, above 0 and up to 1.");
inline constexpr Parameter static_friction_parameter =
    pair_parameter("static_friction", "1", kRequired, 0.0, kUnbounded, "Coulomb's coefficient of friction mu.");
inline constexpr Parameter allow_tension_parameter = flag_parameter(
    "allow_tension", true,
    "Whether damping may pull parting bodies: true gives the nominal restitution (and what other codes do); false clips F_n at 0.");
inline constexpr Parameter cap_parameter =
    choice_parameter("cap", "spring|sum", "spring",
                     "What mu F_n limits: the spring alone (damping acts while it does not slide), or spring and damping together.");

/// The slip of the tangential spring (it flips when the pair's owner is exchanged) and where the energy goes.
inline constexpr ContactLawInfo kSpringInfo = {3,
                                               4,
                                               {-1, -1, -1, 1, 1, 1},
                                               {"slip_x", "slip_y", "slip_z", "", "", ""},
                                               {"normal_damping", "tangential_damping", "friction", "stiffness_change", "", ""}};

template <std::size_t N>
constexpr Descriptor law_descriptor(const char* name, const ContactLawTable* table, const Parameter (&parameters)[N]) {
  Descriptor d = make_descriptor(Kind::contact_law, kContactLawLayout, table, sizeof(ContactLawTable));
  d.name = name;
  d.version = "1.0";
  d.parameters = parameters;
  d.parameter_count = N;
  return d;
}

}  // namespace millscope::laws
