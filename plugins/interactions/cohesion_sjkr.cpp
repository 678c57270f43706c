// Cohesion in proportion to the contact area: the simplified JKR of the open DEM codes.
//
// symbol   here      meaning
// k        density_  cohesion energy density, J/m³ = Pa
// D        distance  R_i + R_j − δ_n, m
// A        area      of the circle in which the two spheres cut each other (sphere and plane for a wall), m²
// V        volume    of the lens (the cap), m³; dV/dδ_n = A
//
//   F = −k A along n,   U = −k V
//   A = π/4 δ (2R_i − δ)(2R_j − δ)(2R_i + 2R_j − δ)/D²,   wall: A = π δ (2R_i − δ)
//   V = π δ² (D² + 2 D (R_i + R_j) − 3 (R_i − R_j)²)/(12 D),   wall: V = π δ² (R_i − δ/3)
//
// The law's own F_n grows by what cohesion presses, so with `friction: contact` its cap μ F_n counts the cohesion as load (as in LIGGGHTS
// without `tangential_reduce`); with `friction: net` k A is taken off the cap, which then follows the net force.
#include <numbers>

#include "millscope/interaction_adapter.hpp"

namespace millscope::interactions {
namespace {

constexpr Parameter kParameters[] = {
    pair_parameter("cohesion_energy_density", "J/m^3", kRequired, 0.0, kUnbounded, "Attractive force per contact area."),
    choice_parameter("friction", "contact|net", "contact",
                     "Normal force that limits friction: with what cohesion presses, or the net one."),
};

constexpr Hypothesis kHypotheses[] = {
    {"cohesion", "Beads in touch attract each other in proportion to the contact area.", "F = -k A",
     "Kloss et al. 2012, doi:10.1504/PCFD.2012.047457", "cohesion_energy_density", 0.0, 0.0, 1e5, "adhesion"},
};

class CohesionSjkr {
 public:
  static constexpr int kHistory = 0, kChannels = 0;
  static constexpr PairTermInfo kInfo = pair_term({}, {});

  CohesionSjkr(const Parameters& values, const PairContext&)
      : density_(values.number("cohesion_energy_density")), net_(values.text("friction") == "net") {}

  double reach(double) const { return 0.0; }

  template <class R>
  void pre(const PairState<R>& pair, R*, PreResponse<R, 0>& out) const {
    const R zero(0.0), two(2.0);
    const R overlap = maximum(pair.overlap, zero);
    const auto wall = pair.radius_j <= zero;
    const R sum = pair.radius_i + pair.radius_j, difference = pair.radius_i - pair.radius_j;
    const R distance = maximum(sum - overlap, R(1e-100));
    const R lens =
        R(0.25 * std::numbers::pi) * overlap * (two * pair.radius_i - overlap) * (two * pair.radius_j - overlap) * (two * sum - overlap);
    const R area = select(wall, R(std::numbers::pi) * overlap * (two * pair.radius_i - overlap), lens / (distance * distance));
    const R span = distance * distance + two * distance * sum - R(3.0) * difference * difference;
    const R volume =
        R(std::numbers::pi) * overlap * overlap * select(wall, pair.radius_i - overlap * R(1.0 / 3.0), span / (R(12.0) * distance));
    const R force = R(density_) * area;
    out.added_force = -force;
    if (net_) out.added_cap = -force;
    out.elastic_energy = R(-density_) * volume;
  }

 private:
  double density_;
  bool net_;
};

constexpr Descriptor kDescriptor = describe<CohesionSjkr>({
    .name = "cohesion_sjkr",
    .version = "1.0",
    .doc = "Attraction in proportion to the area of contact.",
    .equation = "F = -k A",
    .citation = "Kloss et al. 2012, doi:10.1504/PCFD.2012.047457",
    .parameters = kParameters,
    .hypotheses = kHypotheses,
});

}  // namespace
}  // namespace millscope::interactions

MILLSCOPE_PLUGINS(&millscope::interactions::kDescriptor)
