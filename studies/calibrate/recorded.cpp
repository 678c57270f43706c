#include "studies/calibrate/recorded.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "kernel/base/statistics.hpp"
#include "studies/calibrate/json.hpp"
#include "studies/calibrate/power.hpp"
#include "studies/calibrate/recorded_camera.hpp"
#include "studies/calibrate/recorded_identity.hpp"
#include "studies/calibrate/recordings.hpp"
#include "studies/inspect/estimate.hpp"

namespace millscope::calibrate {
namespace {

using base::UserError;

/// Part of the radius by which axes found from rides differ between mills that are alike but for the stiffness of their contacts:
/// 0.09 mm in one of 150 mm (docs/challenge.md).
constexpr double kUnlike = 0.001;

/// Where the axis was found from the points, its error moves the centre of mass and with it the power. What all such axes are off by
/// together is no error: simulated beads find theirs in the same way (observe.cpp).
void add_axis_error(const Recorded& recorded, RecordedCondition& r) {
  const inspect::MillMotion& motion = recorded.motion();
  if (recorded.tracks().frame || !motion.axis[0].estimate) return;
  const bool by_rides = motion.rides > 0;
  if (by_rides && motion.path_radius.estimate) r.axis_path = motion.path_radius.estimate->value, r.axis_noise = motion.noise;
  std::array<double, 2> error{};
  for (std::size_t i = 0; i < 2; ++i)
    error[i] = by_rides ? std::hypot(motion.axis_scatter[i], kUnlike * r.axis_path) : motion.axis[i].estimate->standard_error();
  Observation& o = r.observation;
  const double watts = r.mass * 9.81 * std::fabs(r.omega) * error[0];
  Eigen::Index i = 0;
  for (const Observable& what : o.observables) {
    if (what.kind == ObservableKind::power && !r.measured_power) o.covariance(i, i) += watts * watts;
    if (what.name == kCentreX) o.covariance(i, i) += std::pow(1e3 * error[0], 2);
    if (what.name == kCentreY) o.covariance(i, i) += std::pow(1e3 * error[1], 2);
    ++i;
  }
  if (!r.measured_power) o.power.sem = std::hypot(o.power.sem, watts);
  o.notes.push_back(fmt::format("the axis is known to ±{:.2g} and ±{:.2g} mm, which is counted in the centre of mass{}{}", 1e3 * error[0],
                                1e3 * error[1], r.measured_power ? "" : " and the power",
                                by_rides ? "; simulated beads find theirs in the same way" : ""));
}

/// The charge's mass: as recorded; where the recording does not tell, that of the case.
double charge_mass(const analysis::ResultSet& results, const Processing& how, std::size_t condition, Observation& o) {
  if (results.meta.context.charge_mass > 0) return results.meta.context.charge_mass;
  const double mass =
      analysis::read_mill_of_case(how.study.base, how.registry, how.study.conditions[condition].settings).context.charge_mass;
  o.notes.push_back(
      fmt::format("the recording does not tell the mass of its charge (filling, porosity, density, length): powers are those of the "
                  "simulated {:.4g} kg",
                  mass));
  return mass;
}

/// Nine tenths of the locations along the axis, and the middle from which the camera's noise is counted; of a slice that repeats all of it,
/// as its beads are where their nearest image is.
AxialPlace place_of(const recording::Recording& recording, const Observing& observing) {
  if (const auto& slice = recording.condition.slice) return {slice->low, slice->high, slice->middle()};
  std::vector<double> z;
  for (const recording::Run& run : recording.runs) {
    for (const double value : run.position[2]) {
      if (!observing.z_low || (value >= *observing.z_low && value <= *observing.z_high)) z.push_back(value);
    }
  }
  if (z.empty()) throw UserError(fmt::format("{}: no location lies between z_low and z_high; correct 'observe'", recording.file.string()));
  const bool ends = recording.frame && recording.frame->high > recording.frame->low;
  return {base::quantile_below(z, 0.05), base::quantile_below(z, 0.95),
          ends ? 0.5 * (recording.frame->low + recording.frame->high) : base::quantile_below(z, 0.5)};
}

RecordedCondition look(const Recorded& recorded, std::size_t condition, const Processing& how) {
  RecordedCondition r;
  const recording::Recording& recording = recorded.tracks();
  const Observing& observing = how.study.observing;
  const RecordingCamera camera = camera_of(recorded, how.study);
  r.camera = camera.text;
  r.smoothing = smoothing_of(recording);
  const analysis::ResultSet results = results_of_recording(recorded, r, how);
  r.smoothing.blocks = results.meta.lengths;
  r.place = place_of(recording, observing);
  r.omega = results.meta.context.omega;
  r.measured_power = recording.condition.power.has_value();
  std::vector<std::string> notes = results.meta.notes;
  r.mass = charge_mass(results, how, condition, r.observation);
  notes.insert(notes.end(), r.observation.notes.begin(), r.observation.notes.end());
  r.summaries = choose_summaries(results, how.study, {r.measured_power, r.mass});
  r.observation = summarise(results, r.summaries);
  require_defined(r.observation);
  r.observation.notes = notes;
  for (const analysis::ResultBlock& block : results.meta.blocks) r.observation.bead_seconds += block.duration;
  if (r.measured_power)
    set_metered_power(r.observation, {recording.condition.power->value, recording.condition.power->sem, "measured"});
  else
    r.observation.power = beads_power(results, r.mass, "M g <x> Omega of the tracer");
  const std::string losses = camera::losses_text(camera.loss, std::fabs(r.omega) * results.meta.context.mill_radius);
  if (!losses.empty()) r.observation.notes.push_back(losses + "; simulated beads are seen with the same loss");
  add_axis_error(recorded, r);
  return r;
}

}  // namespace

analysis::ResultSet results_of_recording(const Recorded& recorded, const RecordedCondition& known, const Processing& how) {
  const recording::Recording& tracks = recorded.tracks();
  std::optional<analysis::MillOfCase> mill;
  if (!tracks.condition.geometry.empty()) mill = analysis::read_mill_of_case(tracks.condition.geometry, how.registry);
  return process({tracks, analysis::know_mill(tracks, mill, recorded.motion()), Side::recorded}, known.smoothing, how);
}

RecordedCondition look_at_recording(std::size_t condition, const Recorded& recorded, const Processing& how,
                                    const std::filesystem::path& cache) {
  if (!recorded.of_tracks()) return look_at_figure(recorded.figure(), condition, how);
  const std::string id = identity_of(recorded.tracks(), how, condition);
  const std::filesystem::path file = cache / ("recording-" + id + ".json");
  if (auto known = read_cached<RecordedCondition>(file)) return *std::move(known);
  RecordedCondition r = look(recorded, condition, how);
  r.identity = id;
  write_cached(file, r);
  return r;
}

}  // namespace millscope::calibrate
