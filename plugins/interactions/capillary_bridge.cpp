// Bridges of liquid between wet beads (Willett, Adams, Johnson & Seville 2000, closed form).
//
// symbol   here         meaning
// γ, θ     –            surface tension, N/m; contact angle, rad
// s        gap          separation of the surfaces, m; 0 while they overlap
// R        –            2 R*, m: that of two equal spheres (Derjaguin); twice the bead's radius at a wall
// V        –            volume of the bridge: volume_ratio L³, L the bead's radius (of two unlike beads 2 R*), m³
// ŝ        stretch      s √(R/V)
// s_c      –            separation at which the bridge breaks, m (Lian, Thornton & Adams 1993)
//
//   F = −2π R γ cos θ/(1 + 1.05 ŝ + 2.5 ŝ²) along n,  s_c = (1 + θ/2) V^{1/3}
//   U = −∫_s^{s_c} |F| ds − |F(0)| max(δ_n, 0) = −|F(0)| (√(V/R) 2/D atan z + max(δ_n, 0)),  D² = 4 · 2.5 − 1.05²,
//   z = D (ŝ_c − ŝ)/(2 + 1.05 (ŝ + ŝ_c) + 5 ŝ ŝ_c)
//
// A bridge forms when the surfaces touch and lives until s_c: history remembers it. Breaking it takes −U(0), which is not given back: the
// channel `bridge`. It is booked at the touch, where U begins: at s_c the host may already have dropped the pair. Volume is neither
// exchanged nor conserved: every touch finds the same liquid.
//
// The law's own F_n grows by what the bridge presses, so with `friction: contact` its cap μ F_n counts that as load; with
// `friction: net` it is taken off the cap.
#include <numbers>

#include "millscope/functions.hpp"
#include "millscope/interaction_adapter.hpp"

namespace millscope::interactions {
namespace {

constexpr double kLinear = 1.05, kSquare = 2.5;  // of Willett's fit, for the full separation

constexpr Parameter kParameters[] = {
    pair_parameter("surface_tension", "N/m", kRequired, 0.0, 10.0, "Of the liquid; water at 20 C: 0.0728. At 0 there are no bridges."),
    pair_parameter("contact_angle", "rad", 0.0, 0.0, 1.57, "Of the liquid on the solid; 0: it wets."),
    number_parameter("volume_ratio", "1", 1e-3, 1e-9, 0.1, "Volume of a bridge over the cube of the bead's radius."),
    choice_parameter("friction", "contact|net", "contact",
                     "Normal force that limits friction: with what the bridge presses, or the net one."),
};

constexpr Hypothesis kHypotheses[] = {
    {"capillary_bridge", "The beads are wet: bridges of liquid hold them together after they touch.",
     "F = 2 pi R gamma cos(theta)/(1 + 1.05 s + 2.5 s^2)", "Willett et al. 2000, doi:10.1021/la000657y", "surface_tension", 0.0, 0.0, 0.08,
     "cohesion|adhesion"},
};

/// atan y/x for x > 0, 0 ≤ y/x < 2.85 (here below D/1.05 = 2.842) from operations that IEEE fixes; error below 1e-13. Where y/x > tan π/8,
/// it is π/4 + atan((y − x)/(y + x)). The angle is halved once; then comes the series.
template <class R>
R arctangent(const R& y, const R& x) {
  const auto far = y > R(std::numbers::sqrt2 - 1.0) * x;  // tan π/8
  const R up = select(far, y - x, y), along = select(far, y + x, x), half = up / (along + square_root(along * along + up * up));
  return select(far, R(0.25 * std::numbers::pi), R(0.0)) + R(2.0) * half * inverse_odd_series<8>(-(half * half));
}

class CapillaryBridge {
 public:
  static constexpr int kHistory = 1, kChannels = 1;
  static constexpr PairTermInfo kInfo = pair_term({{"bridge", 1}}, {{"bridge", ChannelPart::normal, ChannelNature::dissipative}});

  CapillaryBridge(const Parameters& values, const PairContext& pair)
      : force_(4.0 * std::numbers::pi * values.number("surface_tension") * std::cos(values.number("contact_angle"))),
        length_(pair.with_wall ? 1.0 : 2.0),
        stretch_(std::sqrt(2.0 / (values.number("volume_ratio") * length_ * length_ * length_))),
        rupture_((1.0 + 0.5 * values.number("contact_angle")) * std::cbrt(values.number("volume_ratio")) * length_),
        whole_(integral(0.0) / stretch_),
        net_(values.text("friction") == "net") {}

  double reach(double radius) const { return force_ > 0.0 ? rupture_ * radius : 0.0; }

  template <class R>
  void pre(const PairState<R>& pair, R (&history)[1], PreResponse<R, 1>& out) const {
    const R zero(0.0), one(1.0);
    const R overlap = maximum(pair.overlap, zero), gap = maximum(-pair.overlap, zero) / pair.radius;
    const auto before = history[0] > zero;
    const auto bridged = (pair.overlap > zero) || (before && gap <= R(rupture_));
    const R held = select(bridged, one, zero);

    const R stretch = minimum(gap, R(rupture_)) * R(stretch_);
    const R contact = R(force_) * pair.radius;
    const R force = held * contact / (one + stretch * (R(kLinear) + R(kSquare) * stretch));
    out.added_force = -force;
    if (net_) out.added_cap = -force;
    R left(whole_);  // of the integral, in R*
    const auto stretched = bridged && (gap > zero);
    if (any(stretched)) left = select(stretched, integral(stretch) * R(1.0 / stretch_), left);
    out.elastic_energy = -(held * contact * (pair.radius * left + overlap));
    const auto fresh = bridged && !before && pair.time_step > zero;
    if (any(fresh)) out.power[0] = select(fresh, contact * pair.radius * R(whole_) / pair.time_step, zero);
    history[0] = held;
  }

 private:
  /// ∫ dŝ/(1 + 1.05 ŝ + 2.5 ŝ²) from ŝ to ŝ_c.
  template <class R>
  R integral(const R& stretch) const {
    const R end(rupture_ * stretch_), root(std::sqrt(4.0 * kSquare - kLinear * kLinear));
    const R below = R(2.0) + R(kLinear) * (stretch + end) + R(2.0 * kSquare) * stretch * end;
    return R(2.0) / root * arctangent(root * (end - stretch), below);
  }

  double force_;    ///< |F(0)|/R*, N/m
  double length_;   ///< L/R*
  double stretch_;  ///< √(R/V) R*
  double rupture_;  ///< s_c/R*
  double whole_;    ///< |U(0)|/(|F(0)| R*)
  bool net_;
};

constexpr Descriptor kDescriptor = describe<CapillaryBridge>({
    .name = "capillary_bridge",
    .version = "1.0",
    .doc = "Attraction by bridges of liquid that form on touch and break at a distance.",
    .equation = "F = -2 pi R gamma cos(theta)/(1 + 1.05 s + 2.5 s^2), s = gap sqrt(R/V), R = 2 R*, until (1 + theta/2) V^(1/3)",
    .citation = "Willett et al. 2000, doi:10.1021/la000657y; Lian et al. 1993, doi:10.1006/jcis.1993.1452",
    .parameters = kParameters,
    .hypotheses = kHypotheses,
});

}  // namespace
}  // namespace millscope::interactions

MILLSCOPE_PLUGINS(&millscope::interactions::kDescriptor)
