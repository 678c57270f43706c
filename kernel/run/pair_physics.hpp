// What acts between every two materials of a case: plugin objects with the values of that pair.
#pragma once

#include <vector>

#include "kernel/dem/physics.hpp"
#include "kernel/run/assembly.hpp"

namespace millscope::run {

/// Law, interactions and pair parameters of every two materials of beads, and of every material of beads with every one of walls; their
/// objects stay in the assembly, whose shortest contact is found on the way. Throws UserError.
std::vector<dem::PairPhysics> make_pairs(Assembly& a, const host::Registry& registry);

/// Channels and histories of a contact, the same for every pair. Throws UserError for more histories than a contact can keep.
dem::Layout contact_layout(const Assembly& a, const dem::PairPhysics& pair);

}  // namespace millscope::run
