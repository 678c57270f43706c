// What the textbook says of this mill: critical speed, filling and mass, and the power models of Bond, Austin–Concha and Morrell
// (equations.hpp), each with a flag that tells whether the mill lies in the model's range.
//
// The speed is the mean of the analysed frames where they carry it. What is unknown leaves out the results that need it.
#include "analyzers/common/grid.hpp"
#include "analyzers/common/mill.hpp"
#include "analyzers/models/equations.hpp"

namespace millscope::analyzers {
namespace {

constexpr Parameter kParameters[] = {
    optional(number_parameter("filling", "1", kRequired, 1e-6, 1,
                              "Filling J on the bare shell's volume; without it the condition's, or that of the charge's mass.")),
    optional(number_parameter("porosity", "1", kRequired, 0, 0.99,
                              "Porosity of the bed at rest, 0.37 in Chagas 2015; without it the condition's.")),
    optional(
        number_parameter("length", "m", kRequired, 1e-6, kUnbounded, "Inner length of the mill; without it that between the end faces.")),
    number_parameter("bond_factor", "1", 1.08, 0.1, 10, "A of Bond's equation: 1 wet overflow, 1.16 wet grate, 1.08 dry grate."),
};

/// A number or 0: unknown.
struct Mill {
  double diameter = 0, length = 0, bead = 0, density = 0, mass = 0, filling = 0, porosity = 0;
  bool porosity_known = false;
};

Mill mill_of(const Parameters& p, const AnalyzerContext& context) {
  Mill mill;
  mill.diameter = 2 * shell_radius(context);
  mill.length = p.given("length") ? p.number("length") : known_length(context);
  mill.bead = 2 * context.bead_radius;
  mill.density = context.bead_density;
  mill.mass = context.charge_mass;
  mill.porosity_known = p.given("porosity") || context.porosity > 0;
  mill.porosity = p.given("porosity") ? p.number("porosity") : context.porosity;
  mill.filling = p.given("filling") ? p.number("filling") : context.filling;
  if (!(mill.bead > 0)) throw Refusal("the size of the beads is unknown: give the condition's bead_diameter in the recording's YAML");
  if (mill.bead >= mill.diameter) throw Refusal("the beads are as large as the mill: check bead_diameter and mill_diameter");
  return mill;
}

class Models {
 public:
  static constexpr std::uint64_t kNeeds = 0;

  Models(const Parameters& p, const AnalyzerContext& context)
      : mill_(mill_of(p, context)), omega_(context.omega), bond_factor_(p.number("bond_factor")) {
    const double volume = models::volume(mill_.diameter, mill_.length);
    const bool complete = mill_.length > 0 && mill_.density > 0 && mill_.porosity_known;
    if (complete && mill_.mass > 0) filling_of_mass_ = models::filling(mill_.mass, mill_.density, volume, mill_.porosity);
    if (complete && mill_.filling > 0) mass_of_filling_ = models::mass(mill_.filling, mill_.density, volume, mill_.porosity);
    if (!(mill_.filling > 0)) mill_.filling = filling_of_mass_;
    if (!(mill_.mass > 0)) mill_.mass = mass_of_filling_;
  }

  std::vector<ArrayInfo> arrays() const { return {additive("time", "s"), additive("angle", "rad")}; }

  void accumulate(const FrameBlock& block, double* const* sums) const {
    for (std::int64_t f = 0; f < block.frame_count; ++f) {
      double weight = 0;
      for (std::int64_t s = block.first[f]; s < block.first[f + 1]; ++s) weight += block.weight[s];
      *sums[0] += weight;
      *sums[1] += weight * (block.omega != nullptr ? block.omega[f] : omega_);
    }
  }

  void finish(const double* const* sums, Results& results) const {
    const double critical = models::critical_speed(mill_.diameter, mill_.bead), speed = std::fabs(ratio(*sums[1], *sums[0])) / critical;
    results.add("critical_speed", "rad/s", critical, "42.3/sqrt(D - d) rpm (Chagas 2015, Eq. 3.1).");
    if (omega_ != 0) results.add("critical_fraction", "1", speed, "Turning speed over critical speed.");
    if (mill_.porosity_known) results.add("porosity", "1", mill_.porosity, "Porosity of the bed at rest, as given.");
    if (filling_of_mass_ > 0) results.add("filling_from_mass", "1", filling_of_mass_, "J = V_beads/(V_mill (1 - porosity)) (Eq. 3.2).");
    if (mass_of_filling_ > 0) results.add("mass_from_filling", "kg", mass_of_filling_, "M = (1 - porosity) J V_mill rho (Eq. 4.1).");
    if (!(mill_.filling > 0)) return;
    results.add("filling", "1", mill_.filling, "Filling J on the bare shell's volume that the power models use.");
    if (omega_ != 0) add_powers(results, speed);
  }

 private:
  void add_powers(Results& results, double c) const {
    const double J = mill_.filling;
    if (mill_.length > 0 && mill_.density > 0) {
      const std::string doc = "Bond (Eq. 3.3, with the factor J), A = " + std::to_string(bond_factor_) + ".";
      results.add("power_bond", "W", models::bond(bond_factor_, J, c, mill_.density, mill_.diameter, mill_.length), doc.c_str());
      add_flag(results, "bond_in_range",
               {{mill_.diameter < 2.4, "the mill is smaller than 2.4 m, from which on Bond fitted; "},
                {J > 0.5, "the filling is above 0.5; "},
                {c > 0.9, "the speed is above 90 % of critical; "}});
    }
    if (mill_.mass > 0) {
      results.add("power_austin_concha", "W", models::austin_concha(mill_.mass, mill_.diameter, J, c), "Austin and Concha 1994 (Eq. 3.4).");
      add_flag(results, "austin_concha_in_range",
               {{J > 0.6, "the filling is above 0.6; "},
                {c <= 0.1, "the speed is below 10 % of critical, where the model vanishes; "},
                {c > 1, "the mill turns faster than critical; "}});
    }
    if (mill_.length > 0 && mill_.density > 0 && mill_.porosity_known) add_morrell(results, c);
  }

  void add_morrell(Results& results, double c) const {
    const double bulk = mill_.density * (1 - mill_.porosity), J = mill_.filling;
    const auto power = [&](double constant) { return models::morrell(constant, mill_.diameter, mill_.length, bulk, J, c); };
    results.add("power_morrell_overflow", "W", power(models::kOverflow),
                "Morrell 1996, net power of an overflow mill, K = 7.98 (Eq. 3.5).");
    results.add("power_morrell_grate", "W", power(models::kGrate), "Morrell 1996, net power of a grate mill, K = 9.10 (Eq. 3.5).");
    add_flag(results, "morrell_in_range",
             {{mill_.diameter < 0.85, "the mill is smaller than 0.85 m, the smallest that Morrell fitted; "},
              {!(models::morrell_a(c) > J), "the filling is above that of no power at this speed; "},
              {c > models::morrell_limit(J), "the speed is above that of no power at this filling; "}});
  }

  struct Reason {
    bool holds;
    const char* text;
  };
  /// 1 in range, 0 out of it; the doc says why.
  static void add_flag(Results& results, const char* name, std::initializer_list<Reason> reasons) {
    std::string why;
    for (const Reason& reason : reasons) {
      if (reason.holds) why += reason.text;
    }
    const std::string doc =
        why.empty() ? "1: the mill lies in the model's range." : "0: out of range: " + why + "do not trust the model here.";
    results.add(name, "1", why.empty() ? 1 : 0, doc.c_str());
  }

  Mill mill_;
  double omega_, bond_factor_, filling_of_mass_ = 0, mass_of_filling_ = 0;
};

constexpr Descriptor kDescriptor = describe<Models>({
    .name = "models",
    .version = "0.1.0",
    .doc = "Critical speed, filling, mass, and the power models of Bond, Austin-Concha and Morrell, with their ranges.",
    .equation = "N_c = 42.3/sqrt(D - d) rpm; M = (1 - porosity) J V rho; Bond, Austin-Concha, Morrell as in the manual",
    .citation = "Bond 1961; Austin and Concha 1994; Morrell 1996; Chagas 2015, Eq. 3.1-3.5 and 4.1, corrected",
    .parameters = kParameters,
});

}  // namespace
}  // namespace millscope::analyzers

MILLSCOPE_PLUGINS(&millscope::analyzers::kDescriptor)
