// Viscous film between two surfaces that approach or part (Reynolds; as a correction at short range: Nguyen & Ladd 2002).
//
// symbol   here      meaning
// μ        –         viscosity of the liquid, Pa s
// h        gap       between the surfaces, m
// h_min    cut_ R*   gap below which roughness lets no more pressure build up, m
// H        range_ R* gap beyond which the film does not count, m
// v_n      speed     separation speed, m/s
//
//   F = −6π μ R*² (1/max(h, h_min) − 1/H) v_n along n for 0 < h < H,  0 in contact: there the law damps
//
// A bead crosses the last micrometres in less than a step, so 1/h is averaged over the way h ∓ ½ v_n Δt of the step, where that is long
// with
//   G(h) = ∫₀^h = h (1/h_min − 1/H) up to h_min,  1 + ln(h/h_min) − h/H above.
// A bead without contact damping that comes at v then leaves with e = 1 − 2 ln(H/h_min)/St, St = m* v/(6π μ R*²), and does not touch at all
// below St = ln(H/h_min). No step takes more than half of v_n, however stiff the film.
#include <numbers>

#include "millscope/functions.hpp"
#include "millscope/interaction_adapter.hpp"

namespace millscope::interactions {
namespace {

constexpr double kShort = 0.25;           // way in a step over the gap up to which Gauss's two points serve: 1/h to 1e-4
constexpr double kGauss = 0.28867513459;  // ½/√3: where they lie

constexpr Parameter kParameters[] = {
    number_parameter("viscosity", "Pa s", 1e-3, 0.0, 100.0, "Of the liquid between the surfaces; water: 1e-3. At 0 there is no film."),
    number_parameter("cut", "1", 1e-3, 1e-6, 0.1, "Smallest gap that counts, over R*: the roughness; usual 1e-3 to 1e-2."),
    number_parameter("range", "1", 0.25, 0.11, 1.0, "Largest gap that counts, over R*."),
};

constexpr Hypothesis kHypotheses[] = {
    {"lubrication", "A viscous film softens impacts: it takes energy before the surfaces touch and after.",
     "F = -6 pi mu R*^2 v_n (1/h - 1/H)", "Nguyen & Ladd 2002, doi:10.1103/PhysRevE.66.046708", "viscosity", 0.0, 0.0, 0.1},
};

class Lubrication {
 public:
  static constexpr int kHistory = 0, kChannels = 1;
  static constexpr PairTermInfo kInfo = pair_term({}, {{"film_damping", ChannelPart::normal, ChannelNature::dissipative}});

  Lubrication(const Parameters& values, const PairContext&)
      : resistance_(6.0 * std::numbers::pi * values.number("viscosity")), cut_(values.number("cut")), range_(values.number("range")) {}

  double reach(double radius) const { return resistance_ > 0.0 ? range_ * radius : 0.0; }

  template <class R>
  void pre(const PairState<R>& pair, R*, PreResponse<R, 1>& out) const {
    const R zero(0.0), half(0.5);
    const R speed = dot(pair.velocity, pair.normal);
    const R gap = -pair.overlap / pair.radius, way = speed * pair.time_step / pair.radius;  // over R*
    const auto brief = absolute(way) < R(kShort) * maximum(gap, R(cut_));
    R mean = half * (slope(gap + R(kGauss) * way) + slope(gap - R(kGauss) * way));
    const auto close = !brief && (gap + half * absolute(way) > zero);
    if (any(close)) mean = select(close, (integral(gap + half * way) - integral(gap - half * way)) / select(close, way, R(1.0)), mean);
    const auto inside = gap < R(range_);
    const R factor = select(inside && (brief || close), mean, zero);
    const R gentle = half * pair.mass / maximum(pair.time_step, R(1e-300));
    const R coefficient = minimum(R(resistance_) * pair.radius * factor, gentle);
    out.added_force = -(coefficient * speed);
    out.power[0] = coefficient * speed * speed;
  }

 private:
  /// 1/h − 1/H at a gap, in R*.
  template <class R>
  R slope(const R& gap) const {
    const auto open = (gap > R(0.0)) && (gap < R(range_));
    return select(open, R(1.0) / maximum(gap, R(cut_)) - R(1.0 / range_), R(0.0));
  }

  /// G at a gap, in R*.
  template <class R>
  R integral(const R& gap) const {
    const R h = minimum(maximum(gap, R(0.0)), R(range_));
    const R near = h * R(1.0 / cut_);
    const R far = R(1.0) + logarithm(maximum(near, R(1.0)));
    return select(near < R(1.0), near, far) - h * R(1.0 / range_);
  }

  double resistance_;  ///< 6π μ, Pa s
  double cut_, range_;
};

constexpr Descriptor kDescriptor = describe<Lubrication>({
    .name = "lubrication",
    .version = "1.0",
    .doc = "Normal force of a viscous film between surfaces that approach or part.",
    .equation = "F = -6 pi mu R*^2 v_n (1/max(h, h_min) - 1/H), 0 < h < H",
    .citation = "Nguyen & Ladd 2002, doi:10.1103/PhysRevE.66.046708",
    .parameters = kParameters,
    .hypotheses = kHypotheses,
});

}  // namespace
}  // namespace millscope::interactions

MILLSCOPE_PLUGINS(&millscope::interactions::kDescriptor)
