// Bbosa's power against the exact one, as the camera's noise and the size of the cells grow.
#include <fmt/format.h>

#include "kernel/config/units.hpp"
#include "studies/camera/study/study.hpp"

namespace millscope::camera {
namespace {

const std::vector<int> kCells = {15, 25, 50, 100};
const std::vector<double> kNoise = {0, 0.5, 1, 2};  // times the camera's

std::string settings_of(const char* trajectory) {
  std::string text = "analyzers:\n";
  for (const int n : kCells) text += fmt::format("  power_{0}: {{kind: power, cells_x: {0}, cells_y: {0}}}\n", n);
  return text + trajectory;
}

/// Bbosa's sums for every size of cells, over `exact`.
nlohmann::json ratios(const analysis::ResultSet& results, double exact) {
  nlohmann::json all;
  for (const analysis::ResultArray& a : results.arrays) {
    if (a.name.starts_with("power_") && a.shape.empty() && a.analyzer.starts_with("power_")) {
      all[a.analyzer.substr(6)][a.name.substr(6)] = {{"over_exact", a.value[0] / exact}, {"sem", a.sem.empty() ? 0.0 : a.sem[0] / exact}};
    }
  }
  return all;
}

/// The camera with all its noise multiplied.
Camera louder(const std::string& file, double factor, const host::Registry& registry) {
  const config::Node root = config::load_document(file);
  std::vector<std::string> overrides;
  const config::Node observations = root.at("observations");
  for (const std::string& name : observations.keys()) {
    const config::Node link = observations.at(name);
    if (link.at("kind").text() != "noise") continue;
    for (const char* key : {"white", "correlated"}) {
      const auto node = link.find(key);
      if (!node) continue;
      const auto v = config::read_vector(*node, "m");
      overrides.push_back(fmt::format("observations.{}.{}=[{}, {}, {}]", name, key, factor * v[0], factor * v[1], factor * v[2]));
    }
  }
  return read_camera(file, registry, overrides);
}

}  // namespace

nlohmann::json study_power(const std::filesystem::path& run, const std::string& camera_file, const host::Registry& registry) {
  const SimulatedBeads beads(run, registry);
  const analysis::ResultSet charge = analyze_path(run, {}, beads.analyze_from(), settings_of(""), registry);
  const double exact = charge.find("power_50", "power_gravity")->value[0];
  nlohmann::json result{{"exact_W", exact}, {"whole_charge", ratios(charge, exact)}};
  const analysis::ResultSet tracks = analyze_path(run, {"all"}, beads.analyze_from(), settings_of(""), registry);
  // Against the power of these very beads, so that their number does not matter.
  const double of_beads = tracks.find("power_50", "power_gravity")->value[0];
  result["beads_W"] = of_beads;
  result["beads"] = ratios(tracks, of_beads);
  const Workplace workplace;
  for (const double noise : kNoise) {
    const auto recording = record(beads, louder(camera_file, noise, registry), {}, workplace.path(), 1);
    for (const char* kind : {"smoothing", "cubic"}) {
      const analysis::ResultSet seen =
          analyze_path(recording, {}, 0, settings_of(fmt::format("trajectory: {{kind: {}}}\n", kind).c_str()), registry);
      result["seen"].push_back({{"noise", noise}, {"spline", kind}, {"cells", ratios(seen, of_beads)}});
    }
  }
  return result;
}

}  // namespace millscope::camera
