#include "studies/calibrate/recorded.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string_view>

#include "kernel/base/hash.hpp"
#include "kernel/base/program.hpp"
#include "kernel/base/text.hpp"
#include "kernel/output/summary.hpp"
#include "studies/analysis/open_source.hpp"
#include "studies/calibrate/velocity_profile.hpp"
#include "studies/camera/estimate_camera.hpp"
#include "studies/inspect/mill_motion.hpp"
#include "studies/trajectory/trajectory.hpp"

namespace millscope::calibrate {
namespace {

using base::UserError;
using Json = nlohmann::ordered_json;

constexpr const char* kExactCamera = "observations: {rate: {kind: sampling, rate: 1000 Hz, shape: 1000}}\n";
constexpr double kEvenStep = 0.002;  // s between the even times: recordings have a location every 5 ms

/// Everything that the results of a recording depend on.
std::string identity(const studies::Recording& recording, const Processing& how, std::size_t condition) {
  const Study& study = how.study;
  std::vector<std::string> parts{observing_program(), kAnalyzers, std::to_string(study.observing.draws),
                                 std::to_string(study.observing.beads), study.observing.camera};
  if (std::filesystem::is_regular_file(study.observing.camera)) parts.push_back(base::text_of(study.observing.camera));
  if (study.observing.z_low) parts.push_back(fmt::format("{:.17g} {:.17g}", *study.observing.z_low, *study.observing.z_high));
  parts.push_back(studies::file_hash(study.base) + studies::file_hash(recording.file));
  for (const studies::Run& run : recording.runs) parts.push_back(run.name + studies::file_hash(run.source));
  for (const std::string& name : study.objective.without) parts.push_back("without " + name);
  for (const Term& term : study.objective.terms) parts.push_back(term.name());
  if (const auto own = study.root.valid() ? study.root.find("analyzers") : std::nullopt) parts.push_back(dump(*own));
  const auto& settings = study.conditions[condition].settings;
  parts.insert(parts.end(), settings.begin(), settings.end());
  // A plugin that is not asked changes nothing; a study with analyzers of its own may ask any.
  const bool own_analyzers = !study.objective.terms.empty() || (study.root.valid() && study.root.has("analyzers"));
  for (const host::PluginRecord& r : how.registry.records()) {
    const bool asked = own_analyzers || std::string_view(kAnalyzers).find(r.name + ":") != std::string_view::npos;
    if (r.kind == "observation" || (r.kind == "analyzer" && asked)) parts.push_back(r.name + r.code_hash);
  }
  return hash_of(parts);
}

/// The camera's text, and what it is found to lose.
struct RecordingCamera {
  std::string text;
  studies::CameraLosses loss;
};

RecordingCamera camera_of(const studies::Recording& recording, const Study& study) {
  if (study.observing.camera == "exact") return {kExactCamera, {}};
  if (study.observing.camera != "recording") return {base::text_of(study.observing.camera), {}};
  try {
    const studies::CameraEstimate estimate = studies::estimate_camera(recording);
    std::string text = studies::camera_text(estimate, recording.file.string());
    // No recording tells its location window; about one over the rate is usual, and nearer to the truth than none.
    if (const std::size_t blur = text.find("# blur: {"); blur != std::string::npos) text.erase(blur, 2);
    return {text, estimate.loss};
  } catch (const UserError& e) {
    throw UserError(fmt::format("the camera cannot be estimated: {}; give one with 'observe: {{camera: FILE.yaml}}'", e.what()));
  }
}

/// Where the axis was found from the points, its error moves the centre of mass and with it the power.
void add_axis_error(const studies::Recording& recording, RecordedCondition& r) {
  if (recording.frame) return;
  const auto axis = studies::estimate_motion(recording).axis[0].estimate;
  if (!axis) return;
  const double error = axis->standard_error();
  Observation& o = r.observation;
  const double watts = r.mass * 9.81 * std::fabs(r.omega) * error;
  for (Eigen::Index i = 0; i < o.value.size(); ++i) {
    const Observable& what = o.observables[static_cast<std::size_t>(i)];
    if (what.group == "power" && !r.measured_power) o.covariance(i, i) += watts * watts;
    if (what.name == "centre of mass x") o.covariance(i, i) += std::pow(1e3 * error, 2);
  }
  if (!r.measured_power) o.power.sem = std::hypot(o.power.sem, watts);
  o.notes.push_back(fmt::format("the axis is known to ±{:.2g} mm, which is counted in the centre of mass{}", 1e3 * error,
                                r.measured_power ? "" : " and the power"));
}

/// The charge's mass: as recorded; where the recording does not tell, that of the case.
double charge_mass(const studies::ResultSet& results, const Processing& how, std::size_t condition, Observation& o) {
  if (results.meta.context.charge_mass > 0) return results.meta.context.charge_mass;
  const double mass =
      studies::read_mill_of_case(how.study.base, how.registry, how.study.conditions[condition].settings).context.charge_mass;
  o.notes.push_back(
      fmt::format("the recording does not tell the mass of its charge (filling, porosity, density, length): powers are those of the "
                  "simulated {:.4g} kg",
                  mass));
  return mass;
}

void set_power(const studies::Recording& recording, const studies::ResultSet& results, RecordedCondition& r) {
  Observation& o = r.observation;
  if (recording.condition.power) {
    o.power = {recording.condition.power->value, recording.condition.power->sem, "measured"};
  } else {
    const studies::ResultArray* specific = results.find("power", "specific_power_gravity");
    o.power = {r.mass * specific->value.at(0), r.mass * specific->sem.at(0), "M g <x> Omega of the tracer"};
  }
  for (Eigen::Index i = 0; i < o.value.size(); ++i) {
    if (o.observables[static_cast<std::size_t>(i)].group != "power" || !r.measured_power) continue;
    o.value[i] = o.power.value;
    o.covariance.row(i).setZero();  // the meter knows nothing of the tracer
    o.covariance.col(i).setZero();
    o.covariance(i, i) = std::max(o.power.sem * o.power.sem, std::pow(1e-6 * o.power.value, 2));
  }
}

Json to_json(const RecordedCondition& r) {
  return {{"observation", to_json(r.observation)},
          {"summaries", to_json(r.summaries)},
          {"camera", r.camera},
          {"noise", r.noise},
          {"noise_correlation", r.noise_correlation},
          {"gap_limit", r.gap_limit},
          {"place", {r.place.low, r.place.high, r.place.middle}},
          {"mass", r.mass},
          {"omega", r.omega},
          {"measured_power", r.measured_power}};
}

RecordedCondition recorded_from(const Json& j, const std::string& identity) {
  RecordedCondition r;
  r.observation = observation_from(j.at("observation"));
  r.summaries = summaries_from(j.at("summaries"));
  r.camera = j.at("camera");
  r.noise = j.at("noise").get<std::array<double, 3>>();
  r.noise_correlation = j.at("noise_correlation");
  r.gap_limit = j.at("gap_limit");
  r.place = {j.at("place").at(0), j.at("place").at(1), j.at("place").at(2)};
  r.mass = j.at("mass");
  r.omega = j.at("omega");
  r.measured_power = j.at("measured_power");
  r.identity = identity;
  return r;
}

/// Nine tenths of the locations along the axis, and the middle from which the camera's noise is counted; of a slice that repeats all of it,
/// as its beads are where their nearest image is.
AxialPlace place_of(const studies::Recording& recording, const Observing& observing) {
  if (const auto& slice = recording.condition.slice) return {slice->low, slice->high, slice->middle()};
  std::vector<double> z;
  for (const studies::Run& run : recording.runs) {
    for (const double value : run.position[2]) {
      if (!observing.z_low || (value >= *observing.z_low && value <= *observing.z_high)) z.push_back(value);
    }
  }
  if (z.empty()) throw UserError(fmt::format("{}: no location lies between z_low and z_high; correct 'observe'", recording.file.string()));
  std::sort(z.begin(), z.end());
  const auto at = [&](double part) { return z[static_cast<std::size_t>(part * static_cast<double>(z.size() - 1))]; };
  const bool ends = recording.frame && recording.frame->high > recording.frame->low;
  return {at(0.05), at(0.95), ends ? 0.5 * (recording.frame->low + recording.frame->high) : at(0.5)};
}

studies::TrajectoryOptions options_of(const RecordedCondition& r, const Observing& observing) {
  studies::TrajectoryOptions options;
  options.step = kEvenStep;
  options.gap_limit = r.gap_limit;
  options.noise = r.noise;
  options.noise_correlation = r.noise_correlation;
  if (observing.z_low) options.low = *observing.z_low, options.high = *observing.z_high;
  return options;
}

RecordedCondition look(const studies::Recording& recording, std::size_t condition, const Processing& how) {
  RecordedCondition r;
  const Observing& observing = how.study.observing;
  const RecordingCamera camera = camera_of(recording, how.study);
  r.camera = camera.text;
  const studies::NoiseEstimate noise = studies::estimate_noise_model(recording.runs, recording.gap_limit);
  r.noise = noise.standard_deviation;
  r.noise_correlation = noise.correlation;
  r.gap_limit = recording.gap_limit;
  const studies::ResultSet results = process(recording, options_of(r, observing), how);
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
  for (const studies::ResultBlock& block : results.meta.blocks) r.observation.bead_seconds += block.duration;
  set_power(recording, results, r);
  const std::string losses = studies::losses_text(camera.loss, std::fabs(r.omega) * results.meta.context.mill_radius);
  if (!losses.empty()) r.observation.notes.push_back(losses + "; simulated beads are seen with the same loss");
  add_axis_error(recording, r);
  return r;
}

}  // namespace

std::string observing_program() {
  constexpr std::array<std::string_view, 6> kRooms{"studies/recording", "studies/trajectory", "studies/inspect",
                                                   "studies/camera",    "studies/analysis",   "studies/calibrate"};
  const std::span<const std::string_view> kernel = base::kernel_folders();
  std::vector<std::string_view> rooms(kernel.begin(), kernel.end());
  rooms.insert(rooms.end(), kRooms.begin(), kRooms.end());
  std::string text;
  for (const auto& [part, value] : base::program_parts(rooms)) text += part + "\n" + value + "\n";
  return text;
}

std::string hash_of(const std::vector<std::string>& texts) {
  base::Hash hash;
  for (const std::string& text : texts) hash.add(text).add("\xff");
  return hash.text();
}

std::string dump(const config::Node& node) {
  if (node.is_null()) return "~";
  if (node.is_scalar()) return node.text();
  std::string out = "{";
  if (node.is_sequence()) {
    for (const config::Node& item : node.items()) out += dump(item) + ",";
    return out + "}";
  }
  for (const std::string& key : node.keys()) out += key + ":" + dump(node.at(key)) + ",";
  return out + "}";
}

studies::ResultSet results_of_recording(std::size_t condition, const RecordedCondition& recorded, const Processing& how) {
  return process(studies::read_recording(how.study.conditions[condition].recording), options_of(recorded, how.study.observing), how);
}

RecordedCondition look_at_recording(std::size_t condition, const Processing& how, const std::filesystem::path& cache) {
  if (const auto profile = read_profile(how.study.conditions[condition].recording)) return look_at_profile(*profile, condition, how);
  const studies::Recording recording = studies::read_recording(how.study.conditions[condition].recording);
  const std::string id = identity(recording, how, condition);
  const std::filesystem::path file = cache / ("recording-" + id + ".json");
  if (std::filesystem::exists(file)) {
    const Json known = output::read_json(file);
    if (!known.is_discarded()) return recorded_from(known, id);
  }
  RecordedCondition r = look(recording, condition, how);
  r.identity = id;
  output::write_json(file, to_json(r));
  return r;
}

}  // namespace millscope::calibrate
