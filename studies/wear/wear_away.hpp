// The surface moves into the metal by what it has lost.
#pragma once

#include <vector>

#include "studies/wear/worn_mesh.hpp"

namespace millscope::wear {

/// Takes `volume`, m³ of all pitches together, [row · stretches + stretch], from the profile. Each stretch moves along its normal by
/// volume over area; where two stretches cut into the same metal (a lifter's edge) it goes once, and all moves of the row are made larger
/// until the row has lost what the law said. Returns the greatest distance moved along a normal, m.
double wear_away(Profile& p, const Stretches& s, const std::vector<double>& volume);

/// m³ of metal between an earlier profile and a later one, between each direction and the next.
std::vector<double> volumes_between(const Profile& before, const Profile& after);

}  // namespace millscope::wear
