// Hertz's normal spring (hertz.hpp) and Mindlin and Deresiewicz's tangential force with partial slip and its history (partial_slip.hpp).
#include "hertz.hpp"
#include "partial_slip.hpp"

namespace millscope::laws {
namespace {

constexpr Parameter kParameters[] = {restitution_parameter, static_friction_parameter, allow_tension_parameter,
                                     friction_in_tension_parameter, cap_parameter};

constexpr Descriptor kDescriptor = describe<Hertz<PartialSlip>>({
    .name = "hertz_mindlin_deresiewicz",
    .version = "1.0",
    .doc = "Hertz's normal spring; a tangential force with partial slip that tells loading, unloading and reloading apart.",
    .equation = "F_t = -8 G* a (4/9 u_c + 5/9 u_o), |u_c| <= X, |u_o| <= 2/5 X, X = 3/2 mu F_n/(8 G* a); u_o moves with a",
    .citation = "Mindlin & Deresiewicz 1953, J. Appl. Mech. 20, 327; Jager 1995, Arch. Appl. Mech. 65, 478; Popov & Hess 2015, "
                "doi:10.1007/978-3-642-53876-6; Maw, Barber & Fawcett 1976, doi:10.1016/0043-1648(76)90201-5",
    .parameters = kParameters,
});

}  // namespace
}  // namespace millscope::laws

MILLSCOPE_PLUGINS(&millscope::laws::kDescriptor)
