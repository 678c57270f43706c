#include "studies/wear/wear.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numeric>

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
constexpr double kLeastSmooth = 0.05;  // of a bead's diameter

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

/// What turns round an axis and has a surface may wear; where several do, the user says which.
std::size_t body_of(const Request& r, const run::Assembly& a) {
  if (a.c.contact.wear.empty()) {
    throw UserError(fmt::format(
        "{}: has no wear law; add contact.wear, e.g. {{sliding: {{kind: archard}}}}, and its values under pairs (docs/wear.md)", a.c.file));
  }
  if (a.c.start)
    throw UserError(a.c.start->node.where(), "a worn liner is another wall than that of the run it would begin from; leave 'start' out");
  std::vector<std::string> names;
  std::size_t body = 0;
  for (std::size_t g = 0; g < a.geometries.size(); ++g) {
    const config::GeometryCase& geometry = a.c.geometry[g];
    const bool turns = geometry.motion.rotation && geometry.motion.rotation->speed != 0;
    const bool round = a.geometries[g].interior.is_cylinder != 0 && a.geometries[g].surface.triangle_count > 0;
    if (!turns || !round || (!r.body.empty() && geometry.plugin.name != r.body)) continue;
    names.push_back(geometry.plugin.name);
    body = g;
  }
  if (names.size() == 1) return body;
  if (names.empty() && !r.body.empty()) throw UserError(fmt::format("--body {}: no round geometry of this name turns", r.body));
  if (names.empty())
    throw UserError(fmt::format("{}: no round geometry turns, so there is no mill to wear; give the liner 'motion: mill'", a.c.file));
  throw UserError(fmt::format("{}: several geometries turn: {}; say with --body which one wears, the others stay new", a.c.file,
                              fmt::join(names, ", ")));
}

double sum_of(const std::vector<double>& values) { return std::accumulate(values.begin(), values.end(), 0.0); }

/// What is lost, m³/s of all pitches together, with its standard error; NaN where one pitch of one run tells none. Pitches of one run share
/// its charge, so the error is the larger one of that between pitches and that between runs.
struct Rate {
  std::vector<double> mean, error;
  double faces = 0, sum_error = 0;
};

/// Standard error of the mean of samples, each a list; for each place of the lists, and for their sums at the end.
std::vector<double> errors_of(const std::vector<std::vector<double>>& samples) {
  const std::size_t places = samples[0].size();
  const auto n = static_cast<double>(samples.size());
  std::vector<double> mean(places + 1, 0.0), error(places + 1, 0.0);
  const auto value = [&](const std::vector<double>& sample, std::size_t k) { return k < places ? sample[k] : sum_of(sample); };
  for (const std::vector<double>& sample : samples) {
    for (std::size_t k = 0; k <= places; ++k) mean[k] += value(sample, k) / n;
  }
  for (const std::vector<double>& sample : samples) {
    for (std::size_t k = 0; k <= places; ++k) error[k] += (value(sample, k) - mean[k]) * (value(sample, k) - mean[k]);
  }
  for (double& e : error) e = n > 1 ? std::sqrt(e / (n * (n - 1))) : kNone;
  return error;
}

Rate rate_of(const std::vector<Loss>& losses, const Profile& p, const Stretches& s, double smoothing) {
  std::vector<std::vector<double>> of_pitches, of_runs;
  Rate rate;
  for (const Loss& loss : losses) {
    rate.faces += loss.faces / static_cast<double>(losses.size());
    of_runs.emplace_back(loss.of_pitch[0].size(), 0.0);
    for (std::vector<double> pitch : loss.of_pitch) {
      smooth(pitch, p, s, smoothing);
      for (std::size_t k = 0; k < pitch.size(); ++k) of_runs.back()[k] += pitch[k] / p.pitches;
      of_pitches.push_back(std::move(pitch));
    }
  }
  rate.mean.assign(of_runs[0].size(), 0.0);
  for (const std::vector<double>& run : of_runs) {
    for (std::size_t k = 0; k < run.size(); ++k) rate.mean[k] += p.pitches * run[k] / static_cast<double>(of_runs.size());
  }
  rate.error = errors_of(of_pitches);
  const std::vector<double> between = errors_of(of_runs);
  for (std::size_t k = 0; k < rate.error.size(); ++k) rate.error[k] = p.pitches * std::fmax(rate.error[k], between[k]);
  rate.sum_error = rate.error.back();
  rate.error.pop_back();
  return rate;
}

/// Standard errors of the radius grow by those of this step's loss. What moves along its normal moves farther along the radius: by the
/// length of the chord over that of the arc.
void add_errors(std::vector<double>& errors, const Profile& p, const Stretches& s, const Rate& rate, double seconds) {
  for (std::size_t row = 0; row < p.rows; ++row) {
    for (std::size_t c = 0; c < p.columns; ++c) {
      const std::size_t k = s.first[c];
      const double arc = p.step() * p.at(row, c), of_stretch = rate.error[row * s.count() + k] * seconds / (p.pitches * p.row_length());
      double& e = errors[row * p.columns + c];
      e = std::hypot(e, of_stretch * static_cast<double>(s.parts[c]) / arc);
    }
  }
}

double deepest_of(const Profile& p) { return *std::max_element(p.radius.begin(), p.radius.end()); }

/// How far the lifters still stand above the new shell, m.
double lifter_left(const Profile& first, const Profile& now) {
  const std::vector<double> then = first.mean_row(), mean = now.mean_row();
  return std::max(0.0, *std::max_element(then.begin(), then.end()) - *std::min_element(mean.begin(), mean.end()));
}

/// `density`: of each slot, kg/m³.
double mass_between(const Profile& before, const Profile& after, const std::vector<double>& density) {
  const std::vector<double> volumes = volumes_between(before, after);
  double mass = 0;
  for (std::size_t c = 0; c < volumes.size(); ++c) mass += density[before.material[c]] * volumes[c];
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
  if (a.c.domain.periodic[2]) resolution.period = {a.c.domain.box.low[2], a.c.domain.box.high[2]};
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
    if (has_lifters() && s.lifter_left < kGone * height)
      return fmt::format("the lifters are gone after {:.0f} h: {:.2g} mm of {:.3g} stand above the new shell", s.hours, 1e3 * s.lifter_left,
                         1e3 * height);
    if (plate > 0 && s.plate_lost >= plate) return fmt::format("the plate of {:.3g} mm is through after {:.0f} h", 1e3 * plate, s.hours);
    return "";
  }
};

Stage new_liner(const Request& r, const run::Assembly& a, std::size_t body) {
  Stage s;
  s.profile =
      profile_of(a.geometries[body].surface, a.geometries[body].interior, resolution_of(r, a, body), a.c.geometry[body].plugin.name);
  s.error.assign(s.profile.radius.size(), 0.0);
  s.relief = s.lifter_left = s.profile.relief();
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
  now.volume += sum_of(volumes_between(before, now.profile));
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
  const std::size_t body = body_of(request, a);
  Request r = request;
  if (r.campaign.cache.empty()) r.campaign.cache = r.output / "cache";
  if (!(r.smooth > 0)) r.smooth = 0.5 * a.c.largest_diameter();
  fs::remove_all(r.output / "stages");  // all are written again; the cache keeps what was simulated
  const Stages stages(r, registry, a, body);
  Found found{a.c.name, a.c.geometry[body].plugin.name, {}, r.smooth, "", {}};
  if (r.smooth < kLeastSmooth * a.c.smallest_diameter()) {
    throw UserError(fmt::format("--smooth {:.3g} m: give at least {:.2g} m, a tenth of the smallest bead's radius", r.smooth,
                                kLeastSmooth * a.c.smallest_diameter()));
  }
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
    for (const std::string& doubt : told.doubts) found.doubts.push_back(fmt::format("after {:.0f} h: {}", now.hours, doubt));
    if (r.say) r.say(line_of(now));
    found.stopped = limits.reason(now);
    if (!found.stopped.empty() || step == r.steps) break;
    largest_step = std::max(largest_step, go_on(now, rate_of(told.losses, now.profile, s, r.smooth), s, r.hours / r.steps));
    now.mass = mass_between(first, now.profile, density);
    now.lifter_left = lifter_left(first, now.profile);
    now.plate_lost = deepest_of(now.profile) - deepest_of(first);
  }
  if (limits.has_lifters() && largest_step > kMostOfStep * limits.height) {
    found.doubts.push_back(fmt::format("one step took up to {:.2g} mm, more than {:.0f} % of a lifter's height: give more --steps",
                                       1e3 * largest_step, 100 * kMostOfStep));
  }
  return found;
}

}  // namespace millscope::wear
