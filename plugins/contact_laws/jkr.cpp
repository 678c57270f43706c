// Elastic contact with adhesion inside the contact area (Johnson, Kendall & Roberts 1971).
//
// symbol   here      meaning
// w        –         work of adhesion of the two surfaces, J/m²
// c        c_        √(2π w/E*), √m
// s        s         (c R*)^{1/3}, √m
// y        y         √a/s: the root of the contact radius, made free of units
// D        d         δ_n/(c s)
//
//   δ_n = a²/R* − √(2π w a/E*)                     ⇔  y⁴ − y = D, the larger root
//   F   = 4/3 E* a³/R* − √(8π w E* a³)             =  2π w R* (4/3 y⁶ − 2 y³), at least −3/2 π w R*
//   U   = ∫ F dδ_n                                 =  E* c³ R* s (8/15 y¹⁰ − 4/3 y⁷ + ½ y⁴ − y₀⁴/5), y₀³ = ¼
//   S_t = 8 G* a,   |S_t δ_t| ≤ μ (F_n + 2 · 3/2 π w R*)   (Thornton 1991)
//
// The surfaces jump into contact at δ_n = 0, y = 1, and part at y³ = ¼, D = −0.4725, a gap: history remembers whether they touch. What
// both jumps take, 0.3 and 0.0315 of E* c³ R* s, is the channel `adhesion`; U is counted from separation. The damping is Hertz's at
// stiffness 2 E* a, so e is reached where adhesion does not count. Ferrari: y = ½ (√(2m) + √(√(2/m) − 2m)) with m the positive root of m³ +
// D m − ⅛ = 0, polished by three Newton steps.
#include <numbers>

#include "options.hpp"
#include "tangential_spring.hpp"

namespace millscope::laws {
namespace {

constexpr double kSmallestAdhesion = 1e-15;             // J/m², stands for 0: D stays finite, the force is Hertz's to the last digits
constexpr double kLeast = -0.75 * 0.6299605249474366;   // D where the surfaces part: y³ = 1/4
constexpr double kJumpIn = 0.3;                         // energy lost where they meet and where they part, over E* c³ R* s
constexpr double kJumpOut = 0.2 * 0.15749013123685915;  // y⁴/5

constexpr Parameter kParameters[] = {
    restitution_parameter,
    static_friction_parameter,
    pair_parameter("surface_energy", "J/m^2", kRequired, 0.0, 1000.0, "Work of adhesion w of the two surfaces; pull-off force 3/2 pi w R*.",
                   "Johnson, Kendall & Roberts 1971, doi:10.1098/rspa.1971.0141"),
    allow_tension_parameter,
    cap_parameter,
};

constexpr Hypothesis kHypotheses[] = {
    {"adhesion", "The beads stick to each other or to the liner: surfaces attract when they touch.", "F_pull = 3/2 pi w R*",
     "Johnson, Kendall & Roberts 1971, doi:10.1098/rspa.1971.0141", "surface_energy", 0.0, 0.0, 0.2, "cohesion"},
};

/// The larger root of y⁴ − y = D for D ≥ kLeast.
template <class R>
R contact_root(const R& d) {
  const R third(1.0 / 3.0), sixteenth(1.0 / 16.0);
  const R part = d * third;
  const R u =
      lanewise([](double x) { return std::cbrt(x); }, sixteenth + square_root(maximum(R(1.0 / 256.0) + part * part * part, R(0.0))));
  R m = maximum(u - part / u, R(1e-300));
  m = select(d > R(1.0), minimum(m, R(0.125) / d), m);  // u − D/(3u) cancels for a firm contact
  for (int step = 0; step < 3; ++step) {
    const R slope = R(3.0) * m * m + d;
    const auto steep = absolute(slope) > R(1e-6);  // at kLeast the root is double and Cardano's is as good as it gets
    m = select(steep, m - (m * m * m + d * m - R(0.125)) / select(steep, slope, R(1.0)), m);
  }
  const R root = square_root(R(2.0) * m);
  return R(0.5) * (root + square_root(maximum(R(2.0) / root - R(2.0) * m, R(0.0))));
}

class Jkr {
 public:
  static constexpr int kHistory = 4, kChannels = 5;
  static constexpr PairTermInfo kInfo = pair_term({{"slip_x", -1}, {"slip_y", -1}, {"slip_z", -1}, {"touching", 1}},
                                                  {{"normal_damping", ChannelPart::normal, ChannelNature::dissipative},
                                                   {"tangential_damping", ChannelPart::tangential, ChannelNature::dissipative},
                                                   {"friction", ChannelPart::tangential, ChannelNature::dissipative},
                                                   {"stiffness_change", ChannelPart::tangential, ChannelNature::elastic},
                                                   {"adhesion", ChannelPart::normal, ChannelNature::dissipative}});

  Jkr(const Parameters& values, const PairContext& pair)
      : young_(pair.effective_young),
        shear_(8.0 * pair.effective_shear),
        restitution_(values.number("restitution")),
        friction_(values.number("static_friction")),
        damping_(hertz_damping(restitution_)),
        adhesion_(std::max(values.number("surface_energy"), kSmallestAdhesion)),
        c_(std::sqrt(2.0 * std::numbers::pi * adhesion_ / young_)),
        normal_root_(std::sqrt(2.0 * young_)),
        shear_root_(std::sqrt(shear_)),
        softness_(1.0 / shear_),
        pull_off_(1.5 * std::numbers::pi * adhesion_),
        energy_(young_ * c_ * c_),
        tension_(values.flag("allow_tension")),
        cap_(cap_choice(values)) {}

  double reach(double radius) const { return -kLeast * c_ * std::cbrt(c_ * radius); }
  double restitution() const { return restitution_; }
  double friction() const { return friction_; }
  double contact_time(double radius, double mass, double speed) const {
    return 2.87 * std::pow(mass * mass / (radius * young_ * young_ * speed), 0.2);
  }

  template <class R>
  void force(const Contact<R>& c, R (&history)[4], Response<R, 5>& out) const {
    const R zero(0.0), one(1.0);
    const R s = lanewise([](double x) { return std::cbrt(x); }, R(c_) * c.radius);
    const R length_scale = R(c_) * s;
    const R d = c.overlap / length_scale;
    const auto before = history[3] > zero;
    const auto touching = (c.overlap > zero) || (before && d >= R(kLeast));
    const R held = select(touching, one, zero);

    const R y = contact_root(maximum(d, R(kLeast)));
    const R y2 = y * y, y3 = y2 * y, y4 = y2 * y2;
    const R contact = held * s * s * y2;
    const R pull_off = R(pull_off_) * c.radius;
    const R energy = R(energy_) * c.radius * length_scale;
    const R slope = maximum(R(4.0) * y3 - one, R(1e-3));  // dδ/dy; vanishes where the surfaces part

    const R normal_speed = dot(c.velocity, c.normal);
    R damping(damping_);
    if (!c.own_e) damping = lanewise(hertz_damping, c.restitution);
    const R root = damping * square_root(c.mass * contact);
    const R elastic = held * (R(4.0 / 3.0) * pull_off) * (R(4.0 / 3.0) * y3 * y3 - R(2.0) * y3);
    R total = elastic - R(normal_root_) * root * normal_speed;
    if (!tension_) total = maximum(total, minimum(elastic, zero));  // damping adds no pull of its own
    const R limit = c.friction * maximum(total + held * R(2.0) * pull_off + c.added_cap, zero);

    Contact<R> shifted = c;  // the tangential spring lives as long as the surfaces touch, also across a gap
    shifted.overlap = select(touching, one, -one);
    const Spring<R> spring{
        R(shear_) * contact,         R(shear_root_) * root, limit,
        maximum(contact, R(1e-100)), R(softness_),          R(-2.0) * normal_speed * contact * s * s * y / (length_scale * slope)};
    R slip[3] = {history[0], history[1], history[2]};
    const Shear<R> shear = pull_spring(shifted, normal_speed, spring, cap_, slip);
    for (int k = 0; k < 3; ++k) history[k] = slip[k];
    history[3] = held;

    out.force = total * c.normal + shear.force;
    out.normal_force = total;
    out.normal_stiffness = held * R(young_) * s * s * y2 * (R(8.0) * y3 - R(6.0)) / slope;
    const R stored = energy * (R(8.0 / 15.0) * y4 * y4 * y2 - R(4.0 / 3.0) * y4 * y3 + R(0.5) * y4 - R(kJumpOut));
    out.elastic_energy = held * stored + shear.elastic_energy;
    const R taken = one + entry_share(c, maximum(out.normal_stiffness, zero), shear.per_mass);
    out.power[0] = (elastic - total) * normal_speed * taken;
    out.power[1] = shear.damping;
    out.power[2] = shear.friction;
    out.power[3] = shear.stiffness_change;
    // Both jumps are booked at the touch, where U begins: at separation, its zero, the host may already have dropped the pair.
    out.power[4] = energy * select(touching && !before, R(kJumpIn + kJumpOut), zero) * c.per_time_step;
  }

 private:
  double young_, shear_, restitution_, friction_, damping_, adhesion_, c_, normal_root_, shear_root_, softness_, pull_off_, energy_;
  bool tension_;
  Cap cap_;
};

constexpr Descriptor kDescriptor = describe<Jkr>({
    .name = "jkr",
    .version = "1.0",
    .doc = "Elastic contact with surface energy: sticks until a pull-off force, across a gap too; no-slip tangential spring.",
    .equation = "F = 4 E* a^3/(3 R*) - sqrt(8 pi w E* a^3), d = a^2/R* - sqrt(2 pi w a/E*), |F_t| <= mu (F_n + 2 F_pull)",
    .citation = "Johnson, Kendall & Roberts 1971, doi:10.1098/rspa.1971.0141; Thornton 1991, doi:10.1088/0022-3727/24/11/007",
    .parameters = kParameters,
    .hypotheses = kHypotheses,
});

}  // namespace
}  // namespace millscope::laws

MILLSCOPE_PLUGINS(&millscope::laws::kDescriptor)
