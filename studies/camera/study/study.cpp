#include "studies/camera/study/study.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>

#include "kernel/config/document.hpp"
#include "studies/analysis/engine.hpp"
#include "studies/analysis/open_source.hpp"
#include "studies/camera/synthesize.hpp"

namespace millscope::camera {

namespace fs = std::filesystem;

Workplace::Workplace() {
  std::string name = (fs::temp_directory_path() / "millscope-camera-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) throw base::UserError(fmt::format("{}: cannot be made; set TMPDIR to a directory with room", name));
  path_ = name;
}

Workplace::~Workplace() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

analysis::ResultSet analyze_path(const fs::path& path, const std::vector<std::string>& tracers, double from, const std::string& settings,
                                 const host::Registry& registry) {
  const config::Node node = config::parse_document(settings, "study settings");
  analysis::SourceRequest request;
  request.path = path;
  request.tracers = tracers;
  if (from > 0) request.from = from;
  if (const auto section = node.find("trajectory")) {
    request.trajectory = analysis::read_trajectory_options(*section);
    request.trajectory_given = true;
  }
  const analysis::OpenedSource opened = analysis::open_source(request, registry);
  const analysis::AnalyzerChoice choice = analysis::choose_analyzers(node, true, {}, registry, opened.source->context());
  analysis::EngineOptions options;
  options.threads = 1;
  return analysis::run_analyzers(*opened.source, choice.instances, options);
}

fs::path record(const SimulatedBeads& beads, const Camera& camera, const std::vector<std::int64_t>& ids, const fs::path& folder,
                std::uint64_t seed) {
  for (const CameraLink& link : camera.links()) {
    if (link.plugin.name() == "frame_error")
      throw base::UserError("the study needs a camera whose frame is the mill's: remove frame_error");
  }
  SynthesisRequest request;
  request.file = folder / "seen.a";
  request.beads = ids;
  request.seed = seed;
  request.overwrite = true;
  const fs::path recording = synthesize(beads, camera, request).recording;
  std::ofstream(recording, std::ios::app) << "frame: {axis: [0 mm, 0 mm]}\n";
  return recording;
}

}  // namespace millscope::camera

int main(int count, char** words) {
  using namespace millscope;
  using namespace millscope::camera;
  const std::vector<std::string> arguments(words + 1, words + count);
  try {
    const host::Registry registry;
    if ((arguments.size() == 5 || arguments.size() == 6) && arguments[0] == "fields") {
      const Camera camera = read_camera(arguments[2], registry);
      const FieldStudy study{std::stoi(arguments[3]), std::stoul(arguments[4]), arguments.size() == 6 ? std::stod(arguments[5]) : 0.0};
      fmt::print("{}\n", study_fields(arguments[1], camera, study, registry).dump(1));
      return 0;
    }
    if (arguments.size() == 3 && arguments[0] == "power") {
      fmt::print("{}\n", study_power(arguments[1], arguments[2], registry).dump(1));
      return 0;
    }
    fmt::print(stderr, "usage: millscope_camera_study fields RUN CAMERA.yaml CELLS BEADS [GAP_LIMIT_S] | power RUN CAMERA.yaml\n");
    return 2;
  } catch (const std::exception& e) {
    fmt::print(stderr, "millscope_camera_study: {}\n", e.what());
    return 1;
  }
}
