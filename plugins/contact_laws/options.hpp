// Parameters and channels that the contact laws have in common.
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
inline constexpr Parameter friction_in_tension_parameter =
    flag_parameter("friction_in_tension", false,
                   "What friction does while damping pulls parting bodies: false: nothing; true: as much as mu |F_n|, as in LIGGGHTS.");
inline constexpr Parameter cap_parameter =
    choice_parameter("cap", "spring|sum", "spring",
                     "What mu F_n limits: the spring alone (damping acts while it does not slide), or spring and damping together.");

/// Where the energy of a tangential spring goes whose stiffness follows the overlap.
inline constexpr std::initializer_list<Channel> kSpringChannels = {
    {"normal_damping", ChannelPart::normal, ChannelNature::dissipative},
    {"tangential_damping", ChannelPart::tangential, ChannelNature::dissipative},
    {"friction", ChannelPart::tangential, ChannelNature::dissipative},
    {"stiffness_change", ChannelPart::tangential, ChannelNature::elastic}};

/// Its slip changes sign when the pair's owner is exchanged.
inline constexpr PairTermInfo kSpringInfo = pair_term({{"slip_x", -1}, {"slip_y", -1}, {"slip_z", -1}}, kSpringChannels);

}  // namespace millscope::laws
