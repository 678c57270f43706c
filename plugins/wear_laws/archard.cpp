// Archard's law: a sliding bead takes away in proportion to what it presses and how far it slides.
//
// symbol  here        meaning
// k       share_      wear coefficient, 1
// H       hardness_   of the wall, Pa
// F_n     pressing    N
// s       –           distance slid, m: sliding speed times the time step
//
//   V = k F_n s / H
//
// Archard 1953, in the form in which Archard & Hirst 1956 give k. Sliding counts, not the small motion of a contact that sticks.
#include "millscope/wear_law_adapter.hpp"

namespace millscope::wear_laws {
namespace {

constexpr Parameter kParameters[] = {
    pair_parameter("wear_coefficient", "1", kRequired, 0.0, 1.0,
                   "Archard's k. Of steel on steel 1e-4 to 1e-2 dry, less where it is greased; a slurry's is measured.",
                   "Archard & Hirst 1956, doi:10.1098/rspa.1956.0144"),
    pair_parameter("hardness", "Pa", kRequired, 1e5, 1e12, "Indentation hardness H of the wall; 200 HB is 1.96 GPa."),
};

class Archard {
 public:
  Archard(const Parameters& values, const PairContext&) : per_work_(values.number("wear_coefficient") / values.number("hardness")) {}

  double worn_volume(const Rubbing& r) const { return per_work_ * r.pressing * r.sliding * r.time_step; }

 private:
  double per_work_;  ///< k/H, 1/Pa
};

constexpr Descriptor kDescriptor = describe<Archard>({
    .name = "archard",
    .version = "1.0",
    .doc = "Wear by sliding, in proportion to load and distance.",
    .equation = "V = k F_n s / H",
    .citation = "Archard 1953, doi:10.1063/1.1721448",
    .parameters = kParameters,
});

}  // namespace
}  // namespace millscope::wear_laws

MILLSCOPE_PLUGINS(&millscope::wear_laws::kDescriptor)
