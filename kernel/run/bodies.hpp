// The geometries of a case as bodies: created, checked against the case, with the places that they sweep.
#pragma once

#include <vector>

#include "kernel/run/assembly.hpp"

namespace millscope::run {

/// Creates every geometry. Throws UserError for a part that a geometry does not have, for one that does not fit the periodic domain, and
/// for a motion of an endless one whose speed has no bound.
std::vector<GeometryUse> make_geometries(const config::Case& c, const host::Registry& registry);

/// `ahead`: of the walls' clock, s (config::Case::walls_ahead).
dem::Motion motion_of(const config::MotionCase& motion, double ahead = 0);

/// Greatest distance of the surface's vertices from the axis of rotation, m.
double greatest_distance(const Surface& surface, const dem::Motion& motion);

/// Bounds of all places that a body's surface takes until the run's end (s).
config::Box swept(const Surface& surface, const dem::Motion& motion, double end);

}  // namespace millscope::run
