#include "studies/wear/wear.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kernel/base/error.hpp"
#include "kernel/run/assembly.hpp"
#include "studies/wear/stage_run.hpp"
#include "studies/wear/wear_away.hpp"

namespace millscope::wear {
namespace {

namespace fs = std::filesystem;
using base::UserError;

constexpr double kCellsInSmooth = 4;  // a cell is that part of the smoothing length
constexpr double kGone = 0.1;         // of a lifter's height: what is left of one that is gone
constexpr double kLifter = 0.2;       // of a bead's radius: what is lower is no lifter
constexpr double kMostOfStep = 0.15;  // of a lifter's height, in one step
constexpr double kHour = 3600;

void check(const Request& r) {
  if (!(r.hours > 0 && r.hours <= 1e7))
    throw UserError(fmt::format("--hours {:g}: give the hours of running, above 0, e.g. 4000", r.hours));
  if (r.steps < 1 || r.steps > 1000) throw UserError(fmt::format("--steps {}: give 1 to 1000", r.steps));
  if (r.seeds < 1 || r.seeds > 100) throw UserError(fmt::format("--seeds {}: give 1 to 100", r.seeds));
  if (!(r.smooth >= 0 && r.smooth < 1))
    throw UserError(fmt::format("--smooth {:g}: give a length in m, below 1; 0 takes a bead's radius", r.smooth));
  if (r.rows < 0 || r.rows > 1000) throw UserError(fmt::format("--rows {}: give 1 to 1000, or 0 for the usual", r.rows));
  if (r.pitches < 0 || r.pitches > 1000) throw UserError(fmt::format("--pitches {}: give 1 to 1000, or 0 to have them counted", r.pitches));
}

std::size_t body_of(const run::Assembly& a) {
  if (a.c.contact.wear.empty()) {
    throw UserError(fmt::format(
        "{}: has no wear law; add contact.wear, e.g. {{sliding: {{kind: archard}}}}, and its values under pairs (docs/wear.md)", a.c.file));
  }
  const std::optional<int> body = a.wall_body_of_mill();
  if (!body) throw UserError(fmt::format("{}: no geometry turns, so there is no mill to wear; give the liner 'motion: mill'", a.c.file));
  return static_cast<std::size_t>(*body);
}

/// Mean over pitches and seeds of what is lost, smoothed, with its standard error, m³/s of all pitches together.
struct Rate {
  std::vector<double> mean, error;
  double faces = 0, sum_error = 0;
};

Rate rate_of(const std::vector<Loss>& losses, const Profile& p, const Stretches& s, double smoothing) {
  std::vector<std::vector<double>> samples;
  Rate rate;
  for (const Loss& loss : losses) {
    rate.faces += loss.faces / static_cast<double>(losses.size());
    for (std::vector<double> pitch : loss.of_pitch) {
      smooth(pitch, p, s, smoothing);
      samples.push_back(std::move(pitch));
    }
  }
  const auto n = static_cast<double>(samples.size()), pitches = static_cast<double>(p.pitches);
  std::vector<double> sums;
  rate.mean.assign(samples[0].size(), 0.0), rate.error = rate.mean;
  for (const std::vector<double>& sample : samples) {
    for (std::size_t k = 0; k < sample.size(); ++k) rate.mean[k] += sample[k] / n;
  }
  double mean_sum = 0, square = 0;
  for (const double m : rate.mean) mean_sum += m;
  for (const std::vector<double>& sample : samples) {
    double sum = 0;
    for (std::size_t k = 0; k < sample.size(); ++k) {
      rate.error[k] += (sample[k] - rate.mean[k]) * (sample[k] - rate.mean[k]);
      sum += sample[k];
    }
    square += (sum - mean_sum) * (sum - mean_sum);
  }
  const double freedom = std::max(n * (n - 1), 1.0);
  for (std::size_t k = 0; k < rate.mean.size(); ++k) {
    rate.mean[k] *= pitches;
    rate.error[k] = pitches * std::sqrt(rate.error[k] / freedom);
  }
  rate.sum_error = pitches * std::sqrt(square / freedom);
  return rate;
}

double sum_of(const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values) sum += v;
  return sum;
}

/// Standard errors of the radius grow by those of this step's loss, each stretch's on the direction where it begins.
void add_errors(std::vector<double>& errors, const Profile& p, const Stretches& s, const Rate& rate, double seconds) {
  for (std::size_t row = 0; row < p.rows; ++row) {
    const std::vector<double> lengths = lengths_of(p, s, row);
    for (std::size_t c = 0; c < p.columns; ++c) {
      const std::size_t k = s.first[c];
      const double depth = rate.error[row * s.count() + k] * seconds / (p.pitches * p.row_length() * lengths[k]);
      double& e = errors[row * p.columns + c];
      e = std::hypot(e, depth);
    }
  }
}

double deepest(const Profile& p) {
  const std::vector<double> mean = p.mean_row();
  return *std::max_element(mean.begin(), mean.end());
}

double mass_between(const Profile& before, const Profile& after, const std::vector<double>& density) {
  Profile part = before;
  double mass = 0;
  for (std::size_t slot = 0; slot < density.size(); ++slot) {
    for (std::size_t c = 0; c < before.columns; ++c) {
      if (before.material[c] != slot) continue;
      double area = 0;
      for (std::size_t row = 0; row < before.rows; ++row)
        area += after.at(row, c) * after.at(row, c + 1) - before.at(row, c) * before.at(row, c + 1);
      mass += density[slot] * 0.5 * std::sin(before.step()) * area * before.row_length() * before.pitches;
    }
  }
  return mass;
}

std::vector<double> densities_of(const run::Assembly& a, std::size_t body) {
  std::vector<double> all;
  for (const std::string& slot : a.geometries[body].slots) all.push_back(a.c.material(a.c.geometry[body].material_of(slot)).density);
  return all;
}

Resolution resolution_of(const Request& r, const run::Assembly& a, std::size_t body) {
  const Interior& in = a.geometries[body].interior;
  const double length = in.high[2] - in.low[2];
  Resolution resolution{r.smooth / kCellsInSmooth, 1, r.pitches};
  if (r.rows > 0) {
    resolution.rows = static_cast<std::size_t>(r.rows);
  } else if (!a.c.domain.periodic[2]) {
    resolution.rows = static_cast<std::size_t>(std::max(1.0, std::round(length / (2 * a.c.largest_diameter()))));
  }
  return resolution;
}

/// When a liner is worn out.
struct Limits {
  double height;        ///< of the lifters when new, m
  double least_lifter;  ///< what is lower is no lifter, m
  double plate;         ///< m; 0: not known

  bool has_lifters() const { return height > least_lifter; }
  std::string reason(const Stage& s) const {
    if (has_lifters() && s.relief < kGone * height)
      return fmt::format("the lifters are gone after {:.0f} h: {:.2g} mm of {:.3g} are left", s.hours, 1e3 * s.relief, 1e3 * height);
    if (plate > 0 && s.plate_lost >= plate) return fmt::format("the plate of {:.3g} mm is through after {:.0f} h", 1e3 * plate, s.hours);
    return "";
  }
};

Stage new_liner(const Request& r, const run::Assembly& a, std::size_t body) {
  Stage s;
  s.profile =
      profile_of(a.geometries[body].surface, a.geometries[body].interior, resolution_of(r, a, body), a.c.geometry[body].plugin.name);
  s.error.assign(s.profile.radius.size(), 0.0);
  s.relief = s.profile.relief();
  return s;
}

void tell(Stage& s, const Told& told) {
  s.power = told.power, s.power_error = told.power_error, s.shoulder = told.shoulder, s.toe = told.toe;
  s.runs = told.runs;
}

/// Some hours later. Returns the greatest distance moved, m.
double go_on(Stage& now, const Rate& rate, const Stretches& s, double hours) {
  const double seconds = hours * kHour;
  std::vector<double> volume = rate.mean;
  for (double& v : volume) v *= seconds;
  const Profile before = now.profile;
  const double moved = wear_away(now.profile, s, volume);
  add_errors(now.error, before, s, rate, seconds);
  now.hours += hours;
  now.volume += volume_between(before, now.profile);
  now.law_volume += sum_of(volume);
  now.face_volume += rate.faces * seconds;
  now.volume_error = std::hypot(now.volume_error, rate.sum_error * seconds);
  now.relief = now.profile.relief();
  return moved;
}

std::string line_of(const Stage& s) {
  return fmt::format("{:.0f} h: power {:.4g} W, lifters {:.3g} mm high, {:.3g} kg lost", s.hours, s.power, 1e3 * s.relief, s.mass);
}

}  // namespace

Found wear(const Request& request, const host::Registry& registry) {
  check(request);
  const run::Assembly a = run::assemble(config::read_case(request.case_file.string(), request.settings), registry);
  const std::size_t body = body_of(a);
  Request r = request;
  if (r.campaign.cache.empty()) r.campaign.cache = r.output / "cache";
  if (!(r.smooth > 0)) r.smooth = 0.5 * a.c.largest_diameter();
  const Stages stages(r, registry, a, body);
  Found found{a.c.name, a.c.geometry[body].plugin.name, a.geometries[body].slots, {}, r.smooth, "", {}};
  Stage now = new_liner(r, a, body);
  const Profile first = now.profile;
  const Limits limits{first.relief(), kLifter * 0.5 * a.c.largest_diameter(), r.plate};
  const std::vector<double> density = densities_of(a, body);
  double largest_step = 0;
  for (int step = 0;; ++step) {
    const Stretches s = stretches_of(now.profile);
    const Told told = stages.run(step, now.profile, s);
    tell(now, told);
    found.stages.push_back(now);
    if (r.say) r.say(line_of(now));
    found.stopped = limits.reason(now);
    if (!found.stopped.empty() || step == r.steps) break;
    largest_step = std::max(largest_step, go_on(now, rate_of(told.losses, now.profile, s, r.smooth), s, r.hours / r.steps));
    now.mass = mass_between(first, now.profile, density);
    now.plate_lost = deepest(now.profile) - deepest(first);
  }
  if (limits.has_lifters() && largest_step > kMostOfStep * limits.height) {
    found.doubts.push_back(fmt::format("one step took up to {:.2g} mm, more than {:.0f} % of a lifter's height: give more --steps",
                                       1e3 * largest_step, 100 * kMostOfStep));
  }
  return found;
}

}  // namespace millscope::wear
