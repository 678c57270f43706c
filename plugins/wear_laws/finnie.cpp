// Finnie's law: a bead that strikes at a slant cuts. What it takes away depends on its speed and its angle.
//
// symbol  here        meaning
// m, v    –           mass of the bead, kg, and its speed against the wall as they touch, m/s
// α       –           angle between its path and the wall; sin α = closing/v, cos α = along/v
// p       –           flow stress of the wall, taken as its hardness, Pa
// c       –           share of the beads that cut as in the theory
// K       kRatio      normal over tangential force of a cut, 2
// ψ       kLength     length over depth of a cut, 2
//
//   V = c m v²/(ψ p K) (sin 2α − 6/K sin² α)   for tan α ≤ K/6
//   V = c m v²/(ψ p K) · K/6 cos² α            for tan α > K/6
//
// Finnie 1960. Most is taken at 17°, nothing at 90°: what a blow straight on the wall breaks away is not in it.
#include "millscope/wear_law_adapter.hpp"

namespace millscope::wear_laws {
namespace {

constexpr double kRatio = 2, kLength = 2;

constexpr Parameter kParameters[] = {
    pair_parameter("cutting_share", "1", kRequired, 0.0, 1.0,
                   "Share c of the impacts that cut as in the theory; of sharp grains some tenths, of blunt ones less."),
    pair_parameter("hardness", "Pa", kRequired, 1e5, 1e12,
                   "Flow stress p of the wall, about its indentation hardness; 200 HB is 1.96 GPa."),
};

class Finnie {
 public:
  Finnie(const Parameters& values, const PairContext&)
      : per_energy_(values.number("cutting_share") / (kLength * values.number("hardness") * kRatio)) {}

  double worn_volume(const Rubbing& r) const {
    if (!r.first || !(r.closing > 0)) return 0;
    const double cut =
        r.closing * 6 <= kRatio * r.along ? 2 * r.closing * r.along - 6 / kRatio * r.closing * r.closing : kRatio / 6 * r.along * r.along;
    return per_energy_ * r.mass * cut;
  }

 private:
  double per_energy_;  ///< c/(ψ p K), 1/Pa
};

constexpr Descriptor kDescriptor = describe<Finnie>({
    .name = "finnie",
    .version = "1.0",
    .doc = "Wear by impacts at a slant, which cut.",
    .equation = "V = c m v^2/(4 p) (sin 2a - 3 sin^2 a) for tan a <= 1/3, else c m v^2/(4 p) cos^2 a / 3",
    .citation = "Finnie 1960, doi:10.1016/0043-1648(60)90055-7",
    .parameters = kParameters,
});

}  // namespace
}  // namespace millscope::wear_laws

MILLSCOPE_PLUGINS(&millscope::wear_laws::kDescriptor)
