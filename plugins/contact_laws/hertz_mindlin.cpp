// Hertz's normal spring (hertz.hpp) and Mindlin's tangential spring for a contact that does not slip.
//
//   F_t = −S_t δ_t − 2√(5/6)|β| √(S_t m*) v_t, |S_t δ_t| ≤ μ F_n,   S_t = 8 G* a
//   U   = 8/15 E* a δ_n² + ½ S_t δ_t²
//
// Mindlin 1949. The whole slip is held by the stiffness of the present contact, although a part of the contact joined it later. Where an
// impact slides that changes nothing; nearer to the normal the surface turns back too little (docs/theory.md, oblique impacts).
#include "hertz.hpp"

namespace millscope::laws {
namespace {

constexpr Parameter kParameters[] = {
    restitution_parameter,
    static_friction_parameter,
    choice_parameter("tangential", "no_slip|mindlin_deresiewicz", "no_slip",
                     "Tangential spring. Partial slip is the law hertz_mindlin_deresiewicz; here that word is refused."),
    allow_tension_parameter,
    friction_in_tension_parameter,
    cap_parameter,
};

struct NoSlip {
  static constexpr int kHistory = 3;
  static constexpr PairTermInfo kInfo = kSpringInfo;
  template <class R>
  [[gnu::always_inline]] static inline Shear<R> pull(const Contact<R>& c, const R& normal_speed, const Spring<R>& spring, Cap cap,
                                                     R (&history)[3]) {
    return pull_spring(c, normal_speed, spring, cap, history);
  }
};

class HertzMindlin : public Hertz<NoSlip> {
 public:
  HertzMindlin(const Parameters& values, const PairContext& pair) : Hertz(values, pair) {
    if (values.text("tangential") == "no_slip") return;
    throw Refusal(
        "tangential: mindlin_deresiewicz was a closed form without the history of the slip and lost too much; write "
        "law: {kind: hertz_mindlin_deresiewicz} and leave out 'tangential'");
  }
};

constexpr Descriptor kDescriptor = describe<HertzMindlin>({
    .name = "hertz_mindlin",
    .version = "1.0",
    .doc = "Hertz's normal spring, Mindlin's tangential spring, viscous damping from the coefficient of restitution.",
    .equation = "F_n = 4/3 E* sqrt(R*) d^1.5 - 2 sqrt(5/6) |b| sqrt(S_n m*) v_n; F_t = -S_t d_t - 2 sqrt(5/6) |b| sqrt(S_t m*) v_t",
    .citation = "Hertz 1882; Mindlin 1949; Tsuji, Tanaka & Ishida 1992, doi:10.1016/0032-5910(92)88030-L; Chagas 2015, Eq. 3.6-3.12",
    .parameters = kParameters,
});

}  // namespace
}  // namespace millscope::laws

MILLSCOPE_PLUGINS(&millscope::laws::kDescriptor)
