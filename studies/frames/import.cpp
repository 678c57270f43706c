#include "studies/frames/import.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "kernel/base/error.hpp"
#include "kernel/config/imported.hpp"
#include "kernel/output/directory.hpp"
#include "kernel/output/file.hpp"
#include "kernel/output/new_folder.hpp"
#include "kernel/output/summary.hpp"
#include "kernel/run/soundness.hpp"
#include "studies/analysis/mill.hpp"
#include "studies/analysis/results.hpp"
#include "studies/frames/case_text.hpp"
#include "studies/frames/write_run.hpp"

namespace millscope::frames {
namespace {

using base::UserError;
using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

constexpr std::size_t kFewestFrames = 9;  // that a mean with an error needs
constexpr double kSameShell = 0.02;

/// The case can be read, and its liner is a mesh of this mill, in these axes.
void check_case(const MillFile& mill, const fs::path& case_file, const host::Registry& registry) {
  analysis::MillOfCase found;
  try {
    found = analysis::read_mill_of_case(case_file, registry);
  } catch (const UserError& e) {
    // What is wrong is of mill.yaml, not of the file that was made of it and is gone.
    std::string_view what = e.what();
    if (const std::size_t name = what.find(output::kResolvedCase); name != std::string_view::npos)
      what.remove_prefix(what.find(": ", name) + 2);
    throw UserError(fmt::format("{}: {}", mill.file, what));
  }
  const double shell = 0.5 * mill.diameter, bore = found.context.mill_radius;
  if (mill.liner.empty() || std::fabs(bore - shell) <= kSameShell * shell) return;
  throw UserError(
      fmt::format("{}: the liner '{}' has a bore of {:.4g} m radius about the axis, 'diameter' says {:.4g} m; check its unit, 'axis' and "
                  "'centre' ('millscope geometry report')",
                  mill.file, fs::path(mill.liner).filename().string(), bore, shell));
}

double window_start(const MillFile& mill, Spool& spool) {
  const double last = spool.time(spool.size() - 1);
  if (!mill.analyze_from) return spool.size() > 1 ? spool.time(0) : 0;
  if (*mill.analyze_from >= last)
    mill.root.at("time")
        .at("analyze_from")
        .fail(fmt::format("is {:.6g} s, but the last frame is of {:.6g} s; give an earlier time", *mill.analyze_from, last));
  return *mill.analyze_from;
}

/// What there is to doubt of means over these frames. They can be made better by other frames alone.
std::vector<run::Doubt> doubts_of(const Json& summary, double omega) {
  std::vector<run::Doubt> doubts = run::doubts_of(run::soundness_of_summary(summary, omega));
  for (run::Doubt& doubt : doubts) {
    if (doubt.name == "short_window") doubt.remedy = "import frames of a longer time";
    if (doubt.name == "not_steady")
      doubt.remedy = "leave the start out ('time: {analyze_from: …}' in mill.yaml), or import frames of a later time";
  }
  return doubts;
}

const char* text_of(Velocities velocities) {
  return velocities == Velocities::files ? "files" : velocities == Velocities::differences ? "differences" : "none";
}

Json summary_of(const MillFile& mill, const Gather& gathered, const Written& written, const Turning& turning) {
  Json j;
  j["schema_version"] = 1;
  j["name"] = mill.name;
  j["particles"] = std::llround(written.count);
  j["charge_mass_kg"] = written.mass;
  j["simulated_s"] = written.course.until;
  j["mill_speed_rad_per_s"] = turning.omega;
  if (written.course.centre.size() >= kFewestFrames) j.update(run::means_of(written.course));
  j["doubts"] = doubts_of(j, turning.omega);
  j["engine"] = {{"name", config::kImported},
                 {"version", format_of(mill.files.front())},
                 {"files", mill.files.size()},
                 {"interval_s", written.interval},
                 {"velocities", text_of(written.velocities)}};
  j["engine"]["tracks_need_interval_s"] = analysis::kCameraInterval;
  if (!written.no_tracks.empty()) j["engine"]["tracks_absent"] = written.no_tracks;
  if (const auto found = gathered.walls().turning()) j["engine"]["shell_turns_rad_per_s"] = *found;
  return j;
}

}  // namespace

Imported import_frames(const fs::path& mill_file, const fs::path& out, const host::Registry& registry,
                       const std::vector<std::string>& command_line) {
  const MillFile mill = read_mill_file(mill_file);
  output::NewFolder aside(out);
  Imported done;
  {
    Gather gathered(mill, aside.path() / "frames.spool");
    gathered.read();
    std::vector<std::string> notes = gathered.notes();
    const Turning turning = turning_of(mill, gathered, notes);
    const double from = window_start(mill, gathered.spool());
    const Written written = write_run({mill, gathered, turning, from, aside.path()});
    for (std::string& note : notes_of(written, gathered)) notes.push_back(std::move(note));
    const double last = gathered.spool().time(gathered.spool().size() - 1);
    const fs::path case_file = aside.path() / output::kResolvedCase;
    output::write_file(case_file,
                       case_text({mill, gathered.census(), turning, written.count, last > 0 ? last : 1.0, last > 0 ? from : 0.0}));
    check_case(mill, case_file, registry);
    Json j = summary_of(mill, gathered, written, turning);
    j["engine"]["notes"] = notes;
    j["provenance"] = output::provenance(command_line, {});
    output::write_json(aside.path() / "summary.json", j);
    done = {gathered.census().beads().size(), gathered.spool().size(), written.tracks, gathered.spool().time(0), last, std::move(notes)};
  }
  aside.publish();
  return done;
}

}  // namespace millscope::frames
