// Linear spring and dashpot, normal and tangential (Cundall & Strack 1979).
//
// symbol   here                meaning
// k_n      normal_stiffness_   N/m
// k_t      –                   κ k_n, κ = stiffness_ratio
// β        –                   ln e/√(ln² e + π²)
// t_c      contact_time        duration of a free collision, s
//
//   F_n = k_n δ_n − 2|β| √(k_n m*) v_n,   F_t = −k_t δ_t − 2|β| √(k_t m*) v_t, |k_t δ_t| ≤ μ F_n
//   t_c = √(m* (π² + ln² e)/k_n),   U = ½ k_n δ_n² + ½ k_t δ_t²
//
// k_n is given, or follows from the largest overlap ξ R* that the pair's heaviest contact may reach at its typical speed,
// k_n = m* v²/(ξ R*)², or from the time of the shortest contact, that of the smallest m*.
#include "options.hpp"
#include "tangential_spring.hpp"

namespace millscope::laws {
namespace {

constexpr Parameter kParameters[] = {
    restitution_parameter,
    static_friction_parameter,
    optional(pair_parameter("normal_stiffness", "N/m", kRequired, 1e-6, kUnbounded, "Normal stiffness k_n; or give one of the next two.")),
    optional(pair_parameter("largest_overlap", "1", kRequired, 1e-6, 1.0, "Overlap over R* that is reached at the pair's typical speed.")),
    optional(pair_parameter("contact_time", "s", kRequired, 1e-12, kUnbounded, "Duration of the shortest free collision of the pair.")),
    pair_parameter("stiffness_ratio", "1", 2.0 / 7.0, 0.0, 2.0, "k_t/k_n; at 2/7 both springs swing in the same time.",
                   "Schafer, Dippel & Wolf 1996, doi:10.1051/jp1:1996129"),
    allow_tension_parameter,
    cap_parameter,
};

double find_stiffness(const Parameters& values, const PairContext& pair) {
  const bool stiffness = values.given("normal_stiffness"), overlap = values.given("largest_overlap"), time = values.given("contact_time");
  if (stiffness + overlap + time != 1) {
    throw Refusal(std::string("linear_spring_dashpot between ") + pair.first.name + " and " + pair.second.name +
                  ": give exactly one of normal_stiffness, largest_overlap and contact_time");
  }
  if (stiffness) return values.number("normal_stiffness");
  if (time) {
    const double logarithm = std::log(values.number("restitution")), duration = values.number("contact_time");
    return pair.smallest_mass * (9.869604401089358 + logarithm * logarithm) / (duration * duration);
  }
  if (!(pair.typical_speed > 0.0)) {
    throw Refusal("linear_spring_dashpot: largest_overlap needs a typical speed above zero; give normal_stiffness or contact_time instead");
  }
  const double rate = pair.typical_speed / (values.number("largest_overlap") * pair.smallest_radius);
  return pair.largest_mass * rate * rate;
}

class LinearSpringDashpot {
 public:
  static constexpr int kHistory = 3, kChannels = 3;
  static constexpr PairTermInfo kInfo = pair_term({{"slip_x", -1}, {"slip_y", -1}, {"slip_z", -1}},
                                                  {{"normal_damping", ChannelPart::normal, ChannelNature::dissipative},
                                                   {"tangential_damping", ChannelPart::tangential, ChannelNature::dissipative},
                                                   {"friction", ChannelPart::tangential, ChannelNature::dissipative}});

  LinearSpringDashpot(const Parameters& values, const PairContext& pair)
      : restitution_(values.number("restitution")),
        friction_(values.number("static_friction")),
        normal_stiffness_(find_stiffness(values, pair)),
        ratio_(values.number("stiffness_ratio")),
        damping_(linear_damping(restitution_)),
        root_(std::sqrt(normal_stiffness_)),
        root_ratio_(std::sqrt(ratio_)),
        softness_(ratio_ > 0.0 ? 1.0 / (ratio_ * normal_stiffness_) : 0.0),
        tension_(values.flag("allow_tension")),
        cap_(cap_choice(values)) {}

  double reach(double) const { return 0.0; }
  double restitution() const { return restitution_; }
  double friction() const { return friction_; }
  double contact_time(double, double mass, double) const {
    const double logarithm = std::log(restitution_);
    return std::sqrt(mass * (9.869604401089358 + logarithm * logarithm) / normal_stiffness_);
  }

  template <class R>
  [[gnu::always_inline]] inline void force(const Contact<R>& c, R (&history)[3], Response<R, 3>& out) const {
    const R zero(0.0), one(1.0);
    const auto touching = c.overlap > zero;
    const R overlap = maximum(c.overlap, zero);
    const R normal_speed = dot(c.velocity, c.normal);
    R damping(damping_);
    if (!c.own_e) damping = lanewise(linear_damping, c.restitution);
    const R dashpot = select(touching, damping * R(root_) * square_root(c.mass), zero);

    const R elastic = R(normal_stiffness_) * overlap;
    R total = elastic - dashpot * normal_speed;
    if (!tension_) total = maximum(total, zero);
    const R limit = c.friction * maximum(total + c.added_cap, zero);
    const R shear_stiffness = select(touching, R(ratio_ * normal_stiffness_), zero);
    const Spring<R> spring{shear_stiffness, R(root_ratio_) * dashpot, limit, one, R(softness_), zero};
    const Shear<R> shear = pull_spring(c, normal_speed, spring, cap_, history);

    out.force = total * c.normal + shear.force;
    out.normal_force = total;
    out.normal_stiffness = select(touching, R(normal_stiffness_), zero);
    out.elastic_energy = R(0.5) * elastic * overlap + shear.elastic_energy;
    R taken = one + entry_share(c, out.normal_stiffness, shear.per_mass);
    if (!tension_) taken = select(total > zero, taken, one);  // no force, no loss
    out.power[0] = (elastic - total) * normal_speed * taken;
    out.power[1] = shear.damping;
    out.power[2] = shear.friction;
  }

 private:
  double restitution_, friction_, normal_stiffness_, ratio_, damping_, root_, root_ratio_, softness_;
  bool tension_;
  Cap cap_;
};

constexpr Descriptor kDescriptor = describe<LinearSpringDashpot>({
    .name = "linear_spring_dashpot",
    .version = "1.0",
    .doc = "Linear springs and dashpots, normal and tangential, damping from the coefficient of restitution.",
    .equation = "F_n = k_n d - 2 |b| sqrt(k_n m*) v_n; F_t = -k_t d_t - 2 |b| sqrt(k_t m*) v_t",
    .citation = "Cundall & Strack 1979, doi:10.1680/geot.1979.29.1.47",
    .parameters = kParameters,
});

}  // namespace
}  // namespace millscope::laws

MILLSCOPE_PLUGINS(&millscope::laws::kDescriptor)
