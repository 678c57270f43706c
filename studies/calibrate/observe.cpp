#include "studies/calibrate/observe.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernel/base/parallel.hpp"
#include "studies/analysis/mirror.hpp"
#include "studies/calibrate/json.hpp"
#include "studies/calibrate/power.hpp"
#include "studies/calibrate/recorded_identity.hpp"
#include "studies/camera/camera.hpp"
#include "studies/camera/ctrack_writer.hpp"
#include "studies/campaign/identity.hpp"
#include "studies/inspect/mill_motion.hpp"

namespace millscope::calibrate {
namespace {

namespace fs = std::filesystem;
using base::UserError;

constexpr std::size_t kLeastPoints = 30;  // of a bead that the camera saw too little of

/// The frame of a simulation is known: a link that shifts it is left out, as a recording's shift is taken off.
camera::Camera without_frame(const camera::Camera& camera) {
  std::vector<camera::CameraLink> links;
  for (const camera::CameraLink& link : camera.links()) {
    if (link.plugin.name() != "frame_error") links.push_back(link);
  }
  return camera::Camera(std::move(links));
}

recording::Condition condition_of(const BeadPaths& paths) {
  const analysis::MillOfCase& mill = paths.mill();
  const AnalyzerContext& c = mill.context;
  recording::Condition condition;
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

/// How one run is filmed.
struct Film {
  camera::Camera camera;
  std::uint64_t seed = 0;
  const Smoothing& smoothing;  ///< by which it is cleaned
};

/// s between the points of a path: where a camera samples it, and does nothing before but blur it, half of the shortest span of either,
/// from 0.5 to 1.7 ms: three parts of the usual 5 ms between frames, in which straight lines are off by 3 µm at 10 m/s² and by 140 µm in an
/// impact, where the camera's noise is some 300 µm. Else 0.5 ms.
double path_step(const camera::Camera& camera) {
  constexpr double kShortest = 0.5e-3, kLongest = 1.7e-3;
  double shortest = 2 * kLongest;
  for (const camera::CameraLink& link : camera.links()) {
    const bool samples = link.plugin.name() == "sampling";
    if (!samples && link.plugin.name() != "location_blur") return kShortest;
    if (link.span > 0) shortest = std::min(shortest, link.span);
    if (samples && link.span > 0) return std::clamp(shortest / 2, kShortest, kLongest);
  }
  return kShortest;
}

/// What the camera makes of the beads, as it would be read from files and cleaned by the recording's own rules.
recording::Recording film(const BeadPaths& paths, const Film& how, int threads) {
  std::vector<recording::Run> seen(paths.size());
  const double step = path_step(how.camera);
  base::for_each_item(paths.size(), base::worker_count(threads, paths.size()), [&](std::size_t i, std::size_t) {
    const recording::Run run = camera::observe(paths.path(i, step), how.camera, paths.context(i, how.seed));
    if (run.size() >= kLeastPoints) seen[i] = camera::as_written(run);
  });
  recording::Recording recording;
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
  recording.frame = recording::MillFrame{};
  recording.gap_limit = how.smoothing.gap_limit;
  recording.travel = how.smoothing.travel;
  return recording::clean_recording(std::move(recording));
}

/// The axis as it was found in the recording, from rides along the shell: it is off by as much there (docs/inspect.md). A run without such
/// rides has none that could be compared.
void find_axis(const RecordedCondition& r, double angular_velocity, recording::Recording& recording) {
  const auto found = inspect::axis_by_rides(recording, r.axis_path, angular_velocity, r.axis_noise);
  if (!found)
    throw UserError(fmt::format(
        "{}: too few of the simulated beads ride along the shell for the axis to be found as in the recording; state the axis in the "
        "recording's frame",
        recording.file.string()));
  recording.frame->axis = *found;
}

/// The study's own section `analyzers` as text; empty: it has none.
std::string own_analyzers_of(const Study& study) {
  const auto own = study.root.valid() ? study.root.find("analyzers") : std::nullopt;
  return own ? dump(*own) : std::string();
}

/// At a finished run. `camera`: text of links before those of the recording's camera; may be empty.
struct Look {
  const campaign::Outcome& run;
  const std::string& camera;
};

}  // namespace

struct Observer::Impl {
  Processing how;
  fs::path cache;
  Recordings recordings;
  std::vector<RecordedCondition> recorded = {};
  std::vector<camera::Camera> camera = {};  ///< of each condition; of a figure: none
  std::vector<AnalyzerContext> mill = {};   ///< of the study's case in each condition

  /// A slice is scaled to the recorded mill; a run whose filling is varied keeps what that does to the power, one of another length does
  /// not.
  double power_factor(std::size_t condition, const BeadPaths& paths) const {
    const double length = paths.mill().context.mill_length;
    const double longer = length > 0 && mill[condition].mill_length > 0 ? length / mill[condition].mill_length : 1;
    return recorded[condition].mass / (mill[condition].charge_mass * longer) * paths.power_ratio();
  }

  /// The run's beads through the recording's camera and the same processing, turned to the recording's sense.
  analysis::ResultSet seen(std::size_t condition, const BeadPaths& paths, const Look& look, const Processing& processing) const {
    const RecordedCondition& r = recorded[condition];
    const std::string name = "camera of condition '" + how.study.conditions[condition].name + "'";
    const camera::Camera first = look.camera.empty() ? camera::Camera() : camera::parse_camera(look.camera, name, how.registry);
    recording::Recording recording = film(paths, {first.before(camera[condition]), camera_seed(look.run.key), r.smoothing}, how.threads);
    if (r.axis_path > 0) find_axis(r, paths.mill().context.omega, recording);
    const analysis::ResultSet results =
        process({recording, analysis::stated_mill(recording, paths.mill()), Side::simulated}, r.smoothing, processing);
    std::vector<std::string> done;
    return paths.mill().context.omega * r.omega < 0 ? analysis::mirrored(results, done) : results;
  }

  /// The charge as a whole, without a camera.
  Observation figure(const RecordedCondition& r, const fs::path& run) const {
    Observation o = summarise(figure_of_run(run, r, how), r.summaries);
    o.power = whole_charge_power(run, 1);
    return o;
  }

  Observation simulated(std::size_t condition, const Look& look) const {
    const RecordedCondition& r = recorded[condition];
    const fs::path& run = look.run.folder;
    if (!r.analyzers.empty()) return figure(r, run);
    const BeadPaths paths(run, how.study.observing.beads, r.place, how.registry);
    const analysis::ResultSet results = seen(condition, paths, look, how);
    Observation o = summarise(results, r.summaries);
    o.bead_seconds = paths.seconds() * static_cast<double>(paths.size());
    if (r.measured_power)
      set_metered_power(o, whole_charge_power(run, power_factor(condition, paths)));
    else
      o.power = beads_power(results, r.mass, fmt::format("M g <x> Omega of the beads seen, M = {:.4g} kg as recorded", r.mass));
    if (paths.mill().context.omega * r.omega < 0) o.notes.push_back("the simulation turns the other way and was mirrored");
    return o;
  }
};

Observer::Observer(const Study& study, const host::Registry& registry, Recordings recordings, ObserverOptions options)
    : impl_(new Impl{{study, registry, options.threads, analyzers_of(study, registry), own_analyzers_of(study), false},
                     std::move(options.cache),
                     std::move(recordings)}) {
  fs::create_directories(impl_->cache);
  const std::size_t conditions = study.conditions.size();
  if (options.say) {
    std::vector<std::string> names;
    for (const Condition& condition : study.conditions) names.push_back(condition.name);
    options.say(fmt::format("looking at what was recorded: {}", fmt::join(names, ", ")));
  }
  // Side by side, each with its part of the threads.
  const std::size_t workers = base::worker_count(options.threads, conditions);
  Processing how = impl_->how;
  how.threads = static_cast<int>(base::worker_count(options.threads, std::numeric_limits<std::size_t>::max()) / workers);
  impl_->recorded.resize(conditions);
  base::for_each_item(conditions, workers, [&](std::size_t c, std::size_t) {
    impl_->recorded[c] = look_at_recording(c, *impl_->recordings[c], how, impl_->cache);
  });
  for (std::size_t c = 0; c < conditions; ++c) {
    const std::string& name = study.conditions[c].name;
    const std::string where = study.observing.camera_is_file() ? study.observing.camera : fmt::format("camera of condition '{}'", name);
    impl_->camera.push_back(impl_->recordings[c]->of_tracks()
                                ? without_frame(camera::parse_camera(impl_->recorded[c].camera, where, registry))
                                : camera::Camera());
    impl_->mill.push_back(analysis::read_mill_of_case(study.base, registry, study.conditions[c].settings).context);
  }
}

Observer::~Observer() = default;

bool Observer::turns_other_way(std::size_t condition) const { return impl_->mill[condition].omega * impl_->recorded[condition].omega < 0; }

const Recorded& Observer::recording(std::size_t condition) const { return *impl_->recordings[condition]; }

const Observation& Observer::recorded(std::size_t condition) const { return impl_->recorded[condition].observation; }

Observation Observer::simulated(std::size_t condition, const campaign::Outcome& run, const std::string& camera) const {
  std::vector<std::string> depends{impl_->recorded[condition].identity, fmt::format("{:.17g}", impl_->mill[condition].charge_mass),
                                   fmt::format("{:.17g}", impl_->mill[condition].mill_length)};
  if (!camera.empty()) depends.push_back(camera);
  const std::string id = run.key + "-" + hash_of(depends);
  const fs::path file = impl_->cache / ("simulation-" + id + ".json");
  if (auto known = read_cached<Observation>(file)) return *std::move(known);
  const Observation o = impl_->simulated(condition, {run, camera});
  write_cached(file, o);
  return o;
}

analysis::ResultSet Observer::results(std::size_t condition, const campaign::Outcome& run, const std::string& analyzers,
                                      const std::string& camera) const {
  Processing how = impl_->how;
  how.analyzers = analyzers_of(analyzers, how.registry);
  how.all_uncertain = true;
  const RecordedCondition& r = impl_->recorded[condition];
  if (run.folder.empty()) return results_of_recording(*impl_->recordings[condition], r, how);
  const BeadPaths paths(run.folder, how.study.observing.beads, r.place, how.registry);
  return impl_->seen(condition, paths, {run, camera}, how);
}

std::vector<std::string> observed_outputs() {
  return {fmt::format("output.frames.every_s={}", kFrameStep), "output.tracks=~", "output.vtk=~"};
}

}  // namespace millscope::calibrate
