#include "kernel/run/simulation.hpp"

#include <fmt/core.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <cstring>

#include "kernel/base/hash.hpp"
#include "kernel/config/writer.hpp"
#include "kernel/output/archive.hpp"
#include "kernel/output/directory.hpp"
#include "kernel/output/file.hpp"
#include "kernel/output/summary.hpp"
#include "kernel/run/estimate.hpp"
#include "kernel/run/progress.hpp"
#include "kernel/run/recorder.hpp"
#include "kernel/run/soundness.hpp"
#include "kernel/run/warm_start.hpp"

namespace millscope::run {
namespace {

using base::UserError;
using Json = nlohmann::ordered_json;
using Clock = std::chrono::steady_clock;

std::atomic<bool> stop_requested{false};
static_assert(std::atomic<bool>::is_always_lock_free);

constexpr const char* kSummary = "summary.json";
constexpr int kMostHalvings = 2;  // of the time step, where beads run away before the analysis begins

/// A run while it goes on.
struct Session {
  Assembly assembly;
  std::filesystem::path directory;
  std::unique_ptr<Recorder> recorder;
  RunOptions options;
  bool may_start_again = false;  ///< with a shorter step, when a bead runs away early
  std::int64_t case_fingerprint = 0;
  std::optional<double> checkpoint_time{};  ///< s, of the newest checkpoint
  double wall_before = 0;                   ///< s of stepping in earlier sessions
  std::int64_t first_step = 0;
  Clock::time_point started = Clock::now();

  double wall() const { return wall_before + seconds_since(started); }
};

void save_ledger(output::ArchiveWriter& archive, const dem::Ledger& ledger) {
  std::vector<double> numbers;
  std::vector<std::int64_t> counts;
  for (const dem::PairLedger& p : ledger.pairs) {
    numbers.insert(numbers.end(), p.dissipated.begin(), p.dissipated.end());
    numbers.push_back(p.impact_energy);
    counts.push_back(p.collisions);
    counts.insert(counts.end(), p.spectrum.begin(), p.spectrum.end());
  }
  archive.write("window/ledger_numbers", numbers);
  archive.write("window/ledger_counts", counts);
}

dem::Ledger load_ledger(const output::ArchiveReader& archive, const dem::Ledger& shape) {
  dem::Ledger ledger = shape;
  const std::vector<double> numbers = archive.read<double>("window/ledger_numbers");
  const std::vector<std::int64_t> counts = archive.read<std::int64_t>("window/ledger_counts");
  std::size_t n = 0, c = 0;
  for (dem::PairLedger& p : ledger.pairs) {
    for (double& d : p.dissipated) d = numbers.at(n++);
    p.impact_energy = numbers.at(n++);
    p.collisions = counts.at(c++);
    for (std::int64_t& s : p.spectrum) s = counts.at(c++);
  }
  return ledger;
}

static_assert(sizeof(Sample) % sizeof(double) == 0);

/// What the checkpoint had counted of the analysis' window; nothing where the window is another one.
void restore_window(Session& s, const output::ArchiveReader& archive) {
  dem::System& system = *s.assembly.system;
  if (archive.read_value<std::int64_t>("analyze_step") != s.assembly.analyze_step) return system.forget_wear();
  const std::vector<double> numbers = archive.read<double>("window/samples");
  s.recorder->samples().resize(numbers.size() * sizeof(double) / sizeof(Sample));
  if (!numbers.empty()) std::memcpy(static_cast<void*>(s.recorder->samples().data()), numbers.data(), numbers.size() * sizeof(double));
  if (archive.read_value<std::int64_t>("window/started")) s.recorder->set_window_start(load_ledger(archive, system.ledger()));
}

/// Of all that a resumed run must share with the run that wrote the checkpoint: the resolved case without what `--set` may change, and
/// the surfaces, whose files may have been replaced.
std::int64_t fingerprint(const Assembly& a, const host::Registry& registry) {
  config::Case c = a.c;
  c.name.clear();
  c.time.end = c.time.analyze_from = 0;
  c.run.threads = 0;
  c.output = {};
  base::Hash hash;
  hash.add(config::resolved_yaml(c, registry.descriptors()));
  return static_cast<std::int64_t>(add_surfaces(a, hash).value());
}

void write_checkpoint(Session& s) {
  s.recorder->flush();
  output::ArchiveWriter archive(output::checkpoint_path(s.directory));
  s.assembly.system->save([&archive](const std::string& name, const double* v,
                                     std::size_t n) { archive.write("system/" + name, std::span<const double>(v, n)); },
                          [&archive](const std::string& name, const std::int64_t* v, std::size_t n) {
                            archive.write("system/" + name, std::span<const std::int64_t>(v, n));
                          });
  archive.write_value("wall_s", s.wall());
  archive.write_value("case", s.case_fingerprint);
  archive.write_value<std::int64_t>("first_step", s.assembly.first_step);
  archive.write_value<std::int64_t>("analyze_step", s.assembly.analyze_step);
  archive.write_value("time_s", s.assembly.system->time());
  archive.write_value("surfaces", surfaces_of(s.assembly));
  const std::vector<Sample>& samples = s.recorder->samples();
  archive.write("window/samples",
                std::span<const double>(reinterpret_cast<const double*>(samples.data()), samples.size() * sizeof(Sample) / sizeof(double)));
  archive.write_value<std::int64_t>("window/started", s.recorder->window_start() ? 1 : 0);
  if (s.recorder->window_start()) save_ledger(archive, *s.recorder->window_start());
  archive.seal();  // all that a full disk can spoil, before the older checkpoint goes
  output::rotate_checkpoints(s.directory);
  archive.commit();
  s.checkpoint_time = s.assembly.system->time();
}

Json summary_of(Session& s) {
  const Assembly& a = s.assembly;
  const dem::System& system = *a.system;
  const std::int64_t steps = system.step() - a.first_step;
  const std::int64_t stepped = system.step() - s.first_step;
  const double wall = seconds_since(s.started);
  Json j;
  j["schema_version"] = 1;
  j["name"] = a.c.name;
  j["particles"] = a.bead_count;
  j["charge_mass_kg"] = system.total_mass();
  j["steps"] = steps;
  j["dt_s"] = a.time_step;
  j["dt_rayleigh_fraction"] = a.time_step / a.rayleigh_time;
  j["simulated_s"] = system.time();
  j["settle_s"] = static_cast<double>(std::max<std::int64_t>(0, -a.first_step)) * a.time_step;
  if (a.c.start) j["start"] = {{"run", a.c.start->run}, {"develop_s", a.c.start->develop}};
  j["wall_s"] = s.wall();
  j["particle_steps_per_s"] = wall > 0 ? static_cast<double>(a.bead_count) * static_cast<double>(stepped) / wall : 0.0;
  j["threads"] = system.threads();
  j["partitions"] = system.settings().partitions;
  j["rebuilds"] = system.rebuilds();
  j["state_hash"] = fmt::format("{:016x}", system.state_hash());
  j["mill_speed_rad_per_s"] = a.mill_speed;
  j["stiffness_factor"] = a.c.stiffness_factor;
  j["doubts"] = Json::array();  // before the means that they are of
  j.update(window_summary(a, s.recorder->samples()));
  const dem::Ledger now = system.ledger();
  double fastest = 0;
  for (std::size_t p = 0; p < now.pairs.size(); ++p) fastest = std::max(fastest, now.pairs[p].largest_closing_speed);
  if (fastest > 0) {
    const double shortest = shortest_contact(a, fastest);
    j["contact"] = {{"largest_closing_speed_m_per_s", fastest},
                    {"shortest_contact_s", shortest},
                    {"steps_per_shortest_contact", shortest / a.time_step}};
  }
  if (s.recorder->window_start() && !s.recorder->samples().empty()) {
    const double span = system.time() - s.recorder->samples().front().time;
    if (span > 0) j["pairs"] = collision_summary(a, now, *s.recorder->window_start(), span);
  }
  j["doubts"] = doubts_of(soundness_of(a, j));
  return j;
}

void write_summary(Session& s, const host::Registry& registry) {
  Json j = summary_of(s);
  std::vector<output::PluginRecord> plugins;
  for (const host::PluginRecord& r : registry.records()) plugins.push_back({r.name, r.version, r.path, r.file_hash, r.code_hash});
  j["provenance"] = output::provenance(s.options.command_line, plugins);
  output::write_json(s.directory / kSummary, j);
}

/// A bead ran away before anything that is asked for was computed. `half_step`: as --set.
struct RanAway {
  std::string message, half_step;
};

/// The message about a bead, completed by what is left of the run.
std::string with_what_is_left(const Session& s, const UserError& e) {
  const std::string kept = s.checkpoint_time
                               ? fmt::format("the checkpoint at {:.6g} s is kept in {}", *s.checkpoint_time, s.directory.string())
                               : fmt::format("no checkpoint had been written to {}", s.directory.string());
  return fmt::format("{}; {}", e.what(), kept);
}

/// One step.
void advance(Session& s) {
  try {
    s.assembly.system->advance();
  } catch (const dem::Runaway& e) {
    const bool early = s.assembly.system->step() < s.assembly.analyze_step;
    if (!early || !s.may_start_again || s.assembly.c.run.allow_unstable) throw UserError(with_what_is_left(s, e));
    const config::TimeCase& time = s.assembly.c.time;
    throw RanAway{e.what(), time.step ? fmt::format("time.step_s={:.17g}", 0.5 * *time.step)
                                      : fmt::format("time.step_fraction={:.17g}", 0.5 * time.step_fraction)};
  } catch (const UserError& e) {
    if (e.exit_code() != base::kExitBadInput) throw;
    throw UserError(with_what_is_left(s, e));
  }
}

/// Steps until the end or until a stop is asked for.
Outcome step_to_end(Session& s, const host::Registry& registry) {
  dem::System& system = *s.assembly.system;
  Progress progress(s.assembly, s.options.quiet, s.options.terminal);
  const auto& checkpoint = s.assembly.c.output.checkpoint;
  Clock::time_point last_checkpoint = Clock::now();
  const auto observe = [&s](const dem::System& state) { s.recorder->observe(state); };
  while (system.step() < s.assembly.end_step) {
    if (s.recorder->wants(system.step())) {
      system.observe = observe;
    } else {
      system.observe = nullptr;
    }
    advance(s);
    if (is_stop_requested() && system.step() < s.assembly.end_step) {
      write_checkpoint(s);
      progress.finish("stopped; continue with: millscope resume " + s.directory.string());
      return Outcome::interrupted;
    }
    if (system.step() % 64 != 0) continue;
    progress.update(system.step(), s.first_step);
    if (checkpoint && seconds_since(last_checkpoint) >= checkpoint->every_wall) {
      write_checkpoint(s);
      last_checkpoint = Clock::now();
    }
  }
  system.observe = nullptr;
  write_checkpoint(s);
  write_summary(s, registry);
  s.recorder->close();
  progress.finish("");
  return Outcome::finished;
}

void write_resolved(const Session& s, const host::Registry& registry) {
  output::write_file(s.directory / output::kResolvedCase, config::resolved_yaml(s.assembly.c, registry.descriptors()));
}

/// The newest sound checkpoint. `damaged`: it is the previous one, because the newest cannot be read.
std::unique_ptr<output::ArchiveReader> open_checkpoint(const std::filesystem::path& directory, bool quiet, bool& damaged) {
  const std::filesystem::path newest = output::newest_checkpoint(directory), previous = output::previous_checkpoint_path(directory);
  damaged = false;
  try {
    return std::make_unique<output::ArchiveReader>(newest);
  } catch (const UserError& e) {
    if (newest == previous || !std::filesystem::exists(previous)) throw;
    try {
      auto older = std::make_unique<output::ArchiveReader>(previous);
      damaged = true;
      if (!quiet) fmt::print(stderr, "{} is damaged; continuing from the one before it\n", newest.string());
      return older;
    } catch (const UserError&) {
      throw UserError(fmt::format("{}: neither this checkpoint nor the one before it can be read; start the run again with another -o",
                                  newest.string()));
    }
  }
}

Outcome run_once(const std::string& case_file, const host::Registry& registry, const RunOptions& options, bool may_start_again) {
  Session s{assemble(config::read_case(case_file, options.overrides), registry, {options.threads, options.instruction_set}), options.output,
            nullptr, options, may_start_again};
  Recorder::check(s.assembly);
  insert_beads(s.assembly);
  output::OutputDirectory directory(options.output, options.force ? output::Mode::overwrite : output::Mode::fresh,
                                    disk_estimate(s.assembly));
  begin(s.assembly);
  s.case_fingerprint = fingerprint(s.assembly, registry);
  directory.start();
  try {
    write_resolved(s, registry);
    s.recorder = std::make_unique<Recorder>(s.assembly, s.directory, std::nullopt);
  } catch (...) {
    directory.undo();
    throw;
  }
  s.first_step = s.assembly.first_step;
  s.started = Clock::now();
  return step_to_end(s, registry);
}

}  // namespace

bool is_stop_requested() { return stop_requested.load(std::memory_order_relaxed); }
void request_stop() { stop_requested.store(true, std::memory_order_relaxed); }

Outcome run_case(const std::string& case_file, const host::Registry& registry, const RunOptions& options) {
  RunOptions again = options;
  for (int halvings = 0;; ++halvings) {
    try {
      return run_once(case_file, registry, again, halvings < kMostHalvings);
    } catch (const RanAway& bead) {
      fmt::print(stderr, "millscope: {}. Starting again with half the time step: {}\n", bead.message, bead.half_step);
      again.overrides.push_back(bead.half_step);
      again.force = true;  // what the first attempt left
    }
  }
}

Outcome resume_run(const host::Registry& registry, const RunOptions& options) {
  for (const std::string& o : options.overrides) {
    const std::string key = o.substr(0, o.find('='));
    if (key != "time.end_s" && key != "time.analyze_from_s" && key != "run.threads") {
      throw UserError("resume: --set " + key +
                      " would change the run that is continued; only time.end_s, time.analyze_from_s and run.threads may "
                      "change; start a new run for the rest");
    }
  }
  output::OutputDirectory directory(options.output, output::Mode::resume);
  bool damaged = false;
  const auto opened = open_checkpoint(options.output, options.quiet, damaged);
  const output::ArchiveReader& archive = *opened;
  Session s{assemble(config::read_case((options.output / output::kResolvedCase).string(), options.overrides), registry,
                     {options.threads, options.instruction_set}),
            options.output, nullptr, options};
  s.case_fingerprint = fingerprint(s.assembly, registry);
  if (archive.read_value<std::int64_t>("case") != s.case_fingerprint) {
    throw UserError(fmt::format(
        "{}: it or a mesh that it names is no longer what the checkpoint was written with; put it back, or start a new run with "
        "another -o",
        (options.output / output::kResolvedCase).string()));
  }
  dem::System& system = *s.assembly.system;
  system.restore([&archive](const std::string& name) { return archive.read<double>("system/" + name); },
                 [&archive](const std::string& name) { return archive.read<std::int64_t>("system/" + name); });
  // The analysis may have been moved since.
  if (archive.has("first_step")) s.assembly.first_step = archive.read_value<std::int64_t>("first_step");
  // A run that ended before it could write its summary is brought to its end.
  const std::filesystem::path summary = options.output / kSummary;
  if (system.step() > s.assembly.end_step || (system.step() == s.assembly.end_step && std::filesystem::exists(summary))) {
    throw UserError(fmt::format(
        "{}: the run has reached its end at {:.6g} s already; to go on, give a later one: millscope resume {} --set time.end_s={:.4g}",
        options.output.string(), system.time(), options.output.string(), 2 * system.time()));
  }
  if (s.assembly.analyze_step < system.step() && archive.read_value<std::int64_t>("analyze_step") != s.assembly.analyze_step) {
    throw UserError(fmt::format(
        "--set time.analyze_from_s: the new window begins at {:.6g} s, before the checkpoint at {:.6g} s, whose samples are gone; "
        "give a later time or start a new run",
        static_cast<double>(s.assembly.analyze_step) * s.assembly.time_step, system.time()));
  }
  directory.start();
  s.checkpoint_time = system.time();
  // What is at the very time of the checkpoint has not been written yet: half a step decides. First of all, because it may refuse.
  s.recorder = std::make_unique<Recorder>(s.assembly, s.directory, system.time() - 0.5 * s.assembly.time_step);
  // A damaged newest checkpoint must not become the previous one, which is now the only one.
  if (damaged) std::filesystem::rename(output::previous_checkpoint_path(options.output), output::checkpoint_path(options.output));
  std::filesystem::remove(summary);  // is there when, and only when, the run has reached its end
  restore_window(s, archive);
  write_resolved(s, registry);
  s.wall_before = archive.read_value<double>("wall_s");
  s.first_step = system.step();
  s.started = Clock::now();
  return step_to_end(s, registry);
}

}  // namespace millscope::run
