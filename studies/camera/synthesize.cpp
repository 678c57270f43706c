#include "studies/camera/synthesize.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "kernel/output/file.hpp"
#include "studies/camera/ctrack_writer.hpp"

namespace millscope::camera {
namespace {

using base::UserError;
namespace fs = std::filesystem;

constexpr double kFineStep = 0.55e-3;  // s: tracks of 2 kHz and a little more

std::vector<std::size_t> chosen_tracks(const SimulatedBeads& beads, const std::vector<std::int64_t>& ids) {
  std::vector<std::size_t> chosen;
  const auto& tracks = beads.tracks();
  if (ids.empty()) {
    for (std::size_t i = 0; i < tracks.size(); ++i) chosen.push_back(i);
  }
  for (const std::int64_t id : ids) {
    const auto found = std::find_if(tracks.begin(), tracks.end(), [id](const output::TrackInfo& t) { return t.bead == id; });
    if (found == tracks.end()) {
      std::string known;
      for (std::size_t i = 0; i < std::min<std::size_t>(tracks.size(), 10); ++i)
        known += fmt::format("{}{}", i > 0 ? ", " : "", tracks[i].bead);
      throw UserError(
          fmt::format("--bead {}: the run did not follow this bead; it followed {}{}", id, known, tracks.size() > 10 ? ", …" : ""));
    }
    chosen.push_back(found - tracks.begin());
  }
  return chosen;
}

fs::path numbered(const fs::path& file, std::size_t number, std::size_t count) {
  if (count == 1) return file;
  return file.parent_path() / fmt::format("{}_{}{}", file.stem().string(), number, file.extension().string());
}

}  // namespace

std::vector<fs::path> synthesis_targets(const SimulatedBeads& beads, const SynthesisRequest& request) {
  const std::size_t count = chosen_tracks(beads, request.beads).size();
  std::vector<fs::path> targets;
  for (std::size_t k = 0; k < count; ++k) targets.push_back(numbered(request.file, k + 1, count));
  targets.push_back(fs::path(request.file).replace_extension(".yaml"));
  return targets;
}

Synthesis synthesize(const SimulatedBeads& beads, const Camera& camera, const SynthesisRequest& request) {
  const std::vector<std::size_t> chosen = chosen_tracks(beads, request.beads);
  const std::vector<fs::path> targets = synthesis_targets(beads, request);
  if (!request.overwrite) std::for_each(targets.begin(), targets.end(), output::refuse_existing);
  const double from = request.from.value_or(beads.analyze_from());
  Synthesis result;
  std::vector<std::string> names, texts;
  double coarsest = 0;
  for (std::size_t k = 0; k < chosen.size(); ++k) {
    const output::TrackSamples path = beads.path(chosen[k], from);
    const std::string& name = beads.tracks()[chosen[k]].name;
    if (path.size() < 2)
      throw UserError(fmt::format("{}: {} has no sample after {} s; choose an earlier --from", beads.directory().string(), name, from));
    const double span = path.time.back() - path.time.front();
    coarsest = std::max(coarsest, span / static_cast<double>(path.size() - 1));
    const recording::Run run = observe(path, camera, beads.context(chosen[k], request.seed));
    if (run.size() == 0)
      throw UserError(
          fmt::format("{}: the camera saw nothing of {} in {:.3g} s; loosen its cut or its gaps", beads.directory().string(), name, span));
    result.locations += run.size();
    result.seconds += span;
    result.files.push_back(targets[k]);
    names.push_back(result.files.back().filename().string());
    texts.push_back(ctrack_text(run));
  }
  if (coarsest > kFineStep) {
    result.notes.push_back(fmt::format(
        "the tracks have a sample every {:.2g} ms; below 2 kHz impacts are cut short: run with --set output.tracks.every_s=0.0005",
        1e3 * coarsest));
  }
  result.recording = targets.back();
  recording::Condition condition = beads.condition();
  condition.tracer = {beads.tracks()[chosen[0]].diameter, beads.tracks()[chosen[0]].density};
  condition.geometry = fs::absolute(condition.geometry).lexically_proximate(fs::absolute(result.recording).parent_path());
  for (std::size_t k = 0; k < texts.size(); ++k) output::write_file(result.files[k], texts[k], request.overwrite);
  output::write_file(
      result.recording,
      recording_text(names, condition, fmt::format("Simulated beads of {} seen by a virtual camera.", beads.directory().string())),
      request.overwrite);
  return result;
}

}  // namespace millscope::camera
