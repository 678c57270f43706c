#include "studies/calibrate/observe.hpp"

#include <fmt/format.h>

#include <cmath>
#include <map>

#include "kernel/base/parallel.hpp"
#include "kernel/output/summary.hpp"
#include "studies/analysis/mirror.hpp"
#include "studies/calibrate/recorded.hpp"
#include "studies/calibrate/velocity_profile.hpp"
#include "studies/camera/camera.hpp"
#include "studies/camera/ctrack_writer.hpp"
#include "studies/campaign/identity.hpp"

namespace millscope::calibrate {
namespace {

namespace fs = std::filesystem;
using base::UserError;
using Json = nlohmann::ordered_json;

constexpr std::size_t kLeastPoints = 30;  // of a bead that the camera saw too little of

/// The frame of a simulation is known: a link that shifts it is left out, as a recording's shift is taken off.
studies::Camera without_frame(const studies::Camera& camera) {
  std::vector<studies::CameraLink> links;
  for (const studies::CameraLink& link : camera.links()) {
    if (link.plugin.name() != "frame_error") links.push_back(link);
  }
  return studies::Camera(std::move(links));
}

studies::Condition condition_of(const BeadPaths& paths) {
  const studies::MillOfCase& mill = paths.mill();
  const AnalyzerContext& c = mill.context;
  studies::Condition condition;
  condition.angular_velocity = c.omega;
  condition.speed = std::fabs(c.omega);
  if (c.filling > 0) condition.filling = c.filling, condition.porosity = c.porosity;
  condition.bead_diameter = 2 * c.bead_radius;
  condition.bead_density = c.bead_density;
  condition.tracer = {2 * c.bead_radius, c.bead_density};
  if (c.mill_radius > 0) condition.mill_diameter = 2 * c.mill_radius;
  condition.geometry = fs::absolute(paths.case_file());
  return condition;
}

/// Every run is filmed with chance of its own: what all runs shared would be in no scatter between them and pass for missing physics. The
/// chance is the case's, whatever program computed it, so that what two programs differ by is not the camera's.
std::uint64_t camera_seed(const std::string& key) { return std::stoull(hash_of({"camera", campaign::case_of(key)}), nullptr, 16); }

/// What the camera makes of the beads, as it would be read from files.
studies::Recording film(const BeadPaths& paths, const studies::Camera& camera, std::uint64_t seed, int threads) {
  std::vector<studies::Run> seen(paths.size());
  base::for_each_item(paths.size(), base::worker_count(threads, paths.size()), [&](std::size_t i, std::size_t) {
    const studies::Run run = studies::observe(paths.path(i), camera, paths.context(i, seed));
    if (run.size() >= kLeastPoints) seen[i] = studies::as_written(run);
  });
  studies::Recording recording;
  recording.file = paths.case_file();
  for (std::size_t i = 0; i < seen.size(); ++i) {
    if (seen[i].size() == 0) continue;
    seen[i].name = fmt::format("b{}", i);
    seen[i].source = fmt::format("{}: bead {}", paths.case_file().string(), paths.id(i));
    recording.runs.push_back(std::move(seen[i]));
  }
  if (recording.runs.empty())
    throw UserError(fmt::format("{}: the camera saw none of the beads for long enough; loosen it", paths.case_file().string()));
  recording.condition = condition_of(paths);
  recording.frame = studies::MillFrame{};
  return studies::clean_recording(std::move(recording));
}

/// Power of the whole simulated charge over the analysed time, from the run's own summary, times `factor`.
PowerFigure whole_charge_power(const fs::path& run, double factor) {
  const Json j = output::read_json(run / "summary.json");
  const auto power = j.is_object() && j.contains("power_W") ? j["power_W"] : Json{};
  if (!power.is_object() || !power.contains("com") || !power["com"].is_number()) {
    throw UserError(fmt::format("{}: its summary.json tells no power; the run has not come to its end", run.string()));
  }
  const double sem = power.contains("com_sem") && power["com_sem"].is_number() ? power["com_sem"].get<double>() : 0.0;
  return {factor * power["com"].get<double>(), factor * sem,
          fmt::format("whole simulated charge, times {:.4g} for the recorded mass", factor)};
}

void set_power(Observation& o, const PowerFigure& power) {
  o.power = power;
  for (Eigen::Index i = 0; i < o.value.size(); ++i) {
    if (o.observables[static_cast<std::size_t>(i)].group != "power") continue;
    o.value[i] = power.value;
    o.covariance.row(i).setZero();
    o.covariance.col(i).setZero();
    o.covariance(i, i) = std::pow(std::max(power.sem, 1e-6 * std::fabs(power.value)), 2);
  }
}

}  // namespace

namespace {

/// How one run is filmed.
struct Look {
  std::string key;     ///< of the run in the cache
  std::string camera;  ///< text of links before those of the recording's camera; may be empty
};

}  // namespace

struct Observer::Impl {
  const Study& study;
  const host::Registry& registry;
  fs::path cache;
  int threads;
  std::vector<RecordedCondition> recorded;
  std::vector<AnalyzerContext> mill = {};  ///< of the study's case in each condition

  /// A slice is scaled to the recorded mill; a run whose filling is varied keeps what that does to the power, one of another length does
  /// not.
  double power_factor(std::size_t condition, const BeadPaths& paths) const {
    const double length = paths.mill().context.mill_length;
    const double longer = length > 0 && mill[condition].mill_length > 0 ? length / mill[condition].mill_length : 1;
    return recorded[condition].mass / (mill[condition].charge_mass * longer) * paths.power_ratio();
  }

  /// The run's beads through the recording's camera and the same processing, turned to the recording's sense.
  studies::ResultSet seen(std::size_t condition, const BeadPaths& paths, const Look& look, const Processing& how) const {
    const RecordedCondition& r = recorded[condition];
    const std::string name = "camera of condition '" + study.conditions[condition].name + "'";
    const bool mirror = paths.mill().context.omega * r.omega < 0;
    const studies::Camera first = look.camera.empty() ? studies::Camera() : studies::parse_camera(look.camera, name, registry);
    const studies::Camera camera = first.before(without_frame(studies::parse_camera(r.camera, name, registry)));
    const studies::Recording recording = film(paths, camera, camera_seed(look.key), threads);
    studies::TrajectoryOptions options;
    options.step = 0.002;
    options.gap_limit = r.gap_limit;
    if (study.observing.camera != "exact") {
      options.noise = r.noise;
      options.noise_correlation = r.noise_correlation;
    }
    const studies::ResultSet results = process_in(studies::stated_mill(recording, paths.mill()), recording, options, how);
    std::vector<std::string> done;
    return mirror ? studies::mirrored(results, done) : results;
  }

  /// The charge as a whole, without a camera.
  Observation profile(const RecordedCondition& r, const fs::path& run) const {
    Observation o = summarise(profile_of_run(run, r, {study, registry, threads}), r.summaries);
    o.power = whole_charge_power(run, 1);
    return o;
  }

  Observation simulated(std::size_t condition, const fs::path& run, const Look& look) const {
    const RecordedCondition& r = recorded[condition];
    if (!r.analyzers.empty()) return profile(r, run);
    const BeadPaths paths(run, study.observing.beads, r.place, registry);
    const studies::ResultSet results = seen(condition, paths, look, {study, registry, threads});
    Observation o = summarise(results, r.summaries);
    o.bead_seconds = paths.seconds() * static_cast<double>(paths.size());
    if (r.measured_power) {
      set_power(o, whole_charge_power(run, power_factor(condition, paths)));
    } else {
      const studies::ResultArray* specific = results.find("power", "specific_power_gravity");
      o.power = {r.mass * specific->value.at(0), r.mass * specific->sem.at(0),
                 fmt::format("M g <x> Omega of the beads seen, M = {:.4g} kg as recorded", r.mass)};
    }
    if (paths.mill().context.omega * r.omega < 0) o.notes.push_back("the simulation turns the other way and was mirrored");
    return o;
  }
};

Observer::Observer(const Study& study, const host::Registry& registry, fs::path cache, int threads,
                   std::function<void(const std::string&)> say)
    : impl_(new Impl{study, registry, std::move(cache), threads, {}, {}}) {
  fs::create_directories(impl_->cache);
  for (std::size_t c = 0; c < study.conditions.size(); ++c) {
    if (say) say(fmt::format("looking at the recording of condition '{}'", study.conditions[c].name));
    impl_->recorded.push_back(look_at_recording(c, {study, registry, threads}, impl_->cache));
    impl_->mill.push_back(studies::read_mill_of_case(study.base, registry, study.conditions[c].settings).context);
  }
}

Observer::~Observer() = default;

bool Observer::turns_other_way(std::size_t condition) const { return impl_->mill[condition].omega * impl_->recorded[condition].omega < 0; }

const Observation& Observer::recorded(std::size_t condition) const { return impl_->recorded[condition].observation; }

Observation Observer::simulated(std::size_t condition, const fs::path& run, const std::string& key, const std::string& camera) const {
  std::vector<std::string> depends{impl_->recorded[condition].identity, fmt::format("{:.17g}", impl_->mill[condition].charge_mass),
                                   fmt::format("{:.17g}", impl_->mill[condition].mill_length)};
  if (!camera.empty()) depends.push_back(camera);
  const std::string id = key + "-" + hash_of(depends);
  const fs::path file = impl_->cache / ("simulation-" + id + ".json");
  if (fs::exists(file)) {
    const Json known = output::read_json(file);
    if (!known.is_discarded()) return observation_from(known);
  }
  const Observation o = impl_->simulated(condition, run, {key, camera});
  output::write_json(file, to_json(o));
  return o;
}

studies::ResultSet Observer::results(std::size_t condition, const fs::path& run, const std::string& key, const std::string& analyzers,
                                     const std::string& camera) const {
  const Processing how{impl_->study, impl_->registry, impl_->threads, analyzers};
  const RecordedCondition& r = impl_->recorded[condition];
  if (run.empty()) return results_of_recording(condition, r, how);
  const BeadPaths paths(run, impl_->study.observing.beads, r.place, impl_->registry);
  return impl_->seen(condition, paths, {key, camera}, how);
}

std::vector<std::string> observed_outputs() {
  return {fmt::format("output.frames.every_s={}", kFrameStep), "output.tracks=~", "output.vtk=~"};
}

}  // namespace millscope::calibrate
