// pept synthesize, pept camera: the virtual camera over simulated beads, and the camera of a given recording.
#include <fmt/core.h>

#include "app/commands.hpp"
#include "kernel/base/error.hpp"
#include "kernel/output/file.hpp"
#include "studies/camera/estimate_camera.hpp"
#include "studies/camera/synthesize.hpp"

namespace millscope::app {
namespace {

namespace po = boost::program_options;

std::string camera_of(const std::string& recording) {
  return camera::camera_text(camera::estimate_camera(recording::read_recording(recording)), recording);
}

/// Where an estimated camera is written: beside the file to be made.
std::filesystem::path camera_file(const std::filesystem::path& file) {
  return file.parent_path() / (file.stem().string() + "_camera.yaml");
}

/// Before any work, and before any file is written.
void refuse_targets(const Options& options, const camera::SimulatedBeads& beads, const camera::SynthesisRequest& request) {
  if (request.overwrite) return;
  for (const std::filesystem::path& target : camera::synthesis_targets(beads, request)) output::refuse_existing(target);
  if (options.has("like")) output::refuse_existing(camera_file(request.file));
}

/// The camera that the user names, or one that is estimated, with its text.
camera::Camera chosen_camera(const Options& options, const host::Registry& registry, const std::filesystem::path& file, std::string& text) {
  if (options.has("camera") == options.has("like")) {
    throw base::UserError("give either --camera camera.yaml or --like RECORDING; configs/cameras holds examples");
  }
  if (options.has("camera")) return camera::read_camera(options.text("camera"), registry, options.list("set"));
  text = camera_of(options.text("like"));
  return camera::parse_camera(text, camera_file(file).string(), registry, options.list("set"));
}

}  // namespace

int pept_synthesize(const Arguments& arguments) {
  Options options(
      "pept synthesize OUT -o FILE.a --camera CAMERA.yaml",
      "Writes what a camera would have recorded of the beads that a simulation followed (output.tracks): FILE.a, with several beads "
      "FILE_1.a, FILE_2.a, …, and FILE.yaml with the simulated condition, ready for 'pept inspect' and 'analyze'.",
      "millscope pept synthesize demo-out -o bead.a --camera configs/cameras/study.yaml");
  options.positional("OUT", "directory of a run");
  options.add()("output,o", po::value<std::string>()->value_name("FILE.a"), "file to write");
  options.add()("camera", po::value<std::string>()->value_name("CAMERA.yaml"), "a chain of observations");
  options.add()("like", po::value<std::string>()->value_name("RECORDING"),
                "the camera of this recording, estimated; written to FILE_camera.yaml");
  options.add()("bead", po::value<std::vector<std::string>>()->value_name("ID"),
                "only this bead (may be repeated; default: all that were followed)");
  options.add()("seed", po::value<std::string>()->value_name("N")->default_value("1"), "another seed gives another noise");
  options.add()("from", po::value<double>()->value_name("S"), "leave out what comes before, s (default: time.analyze_from_s of the case)");
  options.add()("force", "overwrite files");
  options.with_overrides("replace a value of the camera (may be repeated), e.g. --set observations.noise.growth=0");
  options.with_plugins();
  if (!options.parse(arguments)) return kDone;
  const host::Registry registry = options.registry();
  const camera::SimulatedBeads beads(options.text("OUT"), registry);
  camera::SynthesisRequest request;
  request.file = options.text("output");
  request.seed = options.seed("seed");
  request.overwrite = options.has("force");
  if (options.has("from")) request.from = options.number("from");
  for (const std::string& id : options.list("bead")) {
    std::size_t used = 0;
    try {
      request.beads.push_back(std::stoll(id, &used));
    } catch (const std::exception&) {
      used = 0;
    }
    if (used == 0 || used != id.size()) throw base::UserError(fmt::format("--bead {}: is no number of a bead", id));
  }
  refuse_targets(options, beads, request);
  std::string estimated;
  const camera::Camera camera = chosen_camera(options, registry, request.file, estimated);
  const camera::Synthesis done = camera::synthesize(beads, camera, request);
  if (!estimated.empty()) {
    output::write_file(camera_file(request.file), estimated, request.overwrite);
    fmt::print("wrote {}\n", camera_file(request.file).string());
  }
  for (const std::string& note : done.notes) fmt::print(stderr, "note: {}\n", note);
  fmt::print("wrote {} ({} locations of {} beads, {:.4g} s)\n", done.recording.string(), done.locations, done.files.size(), done.seconds);
  return kDone;
}

int pept_camera(const Arguments& arguments) {
  Options options(
      "pept camera RECORDING [-o CAMERA.yaml]",
      "Estimates the camera of a recording: rate, losses of fast and far beads, white and correlated noise, gaps, outliers, the axis; each "
      "with its standard error. The YAML can be edited and laid over simulated beads with 'pept synthesize --camera'.",
      "millscope pept camera run1.a -o camera.yaml");
  options.positional("RECORDING", "a recording (.a, .csv, .tsv, .txt, .gz of one) or a recording.yaml with several");
  options.add()("output,o", po::value<std::string>()->value_name("CAMERA.yaml"), "file to write (default: standard output)");
  options.add()("json", "JSON with all standard errors instead of YAML");
  options.add()("force", "overwrite the file");
  if (!options.parse(arguments)) return kDone;
  const camera::CameraEstimate estimate = camera::estimate_camera(recording::read_recording(options.text("RECORDING")));
  const std::string text =
      options.has("json") ? camera::camera_json(estimate).dump(2) + "\n" : camera::camera_text(estimate, options.text("RECORDING"));
  if (options.has("output")) {
    output::write_file(options.text("output"), text, options.has("force"));
  } else {
    fmt::print("{}", text);
  }
  return kDone;
}

}  // namespace millscope::app
