#include "tests/calibrate/made_up_mill.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <random>

namespace testing {

using namespace millscope;
using namespace millscope::calibrate;

Folder::Folder() {
  static int number = 0;
  path = std::filesystem::temp_directory_path() / fmt::format("millscope_calibrate_{}_{}", ::getpid(), ++number);
  std::filesystem::create_directories(path);
}
Folder::~Folder() {
  std::error_code ignored;
  std::filesystem::remove_all(path, ignored);
}
std::filesystem::path Folder::write(const std::string& name, const std::string& text) const {
  std::ofstream(path / name) << text;
  return path / name;
}

Study study_of(const Folder& folder, const std::string& parameters, const std::string& more) {
  folder.write("base.yaml", "schema_version: 1\n");
  folder.write("r75.yaml", "files: [a.a]\n");
  folder.write("r50.yaml", "files: [b.a]\n");
  return read_study(folder.write("study.yaml",
                                 "base: base.yaml\n"
                                 "conditions:\n"
                                 "  dry75: {set: {mill.speed: 75 %critical}, recording: r75.yaml, role: fit}\n"
                                 "  dry50: {set: {mill.speed: 50 %critical}, recording: r50.yaml, role: held_out}\n"
                                 "parameters:\n" +
                                     parameters + more));
}

std::string drum_case(int beads, double end) {
  return fmt::format(R"(schema_version: 1
materials: {{glass: {{density: 2500, young_modulus: 1e8, poisson_ratio: 0.23}}}}
beads: {{charge: {{material: glass, diameter: 4 mm}}}}
fill: {{count: {}}}
contact: {{law: {{kind: hertz_mindlin}}}}
pairs: {{glass~glass: {{restitution: 0.8, static_friction: 0.3}}}}
body_forces: {{gravity: {{kind: gravity}}}}
mill: {{diameter: 200 mm, speed: 2 rad/s}}
geometry: {{shell: {{kind: cylinder, radius: 100 mm, length: 50 mm, end_faces: false, material: glass, motion: mill}}}}
domain: {{periodic: {{z: [0, 50 mm]}}}}
time: {{end_s: {}, analyze_from_s: 0}}
)",
                     beads, end);
}

MadeUpMill::MadeUpMill(const Study& study, const Eigen::VectorXd& truth, double noise) : study_(study), truth_(truth), noise_(noise) {}

Observation MadeUpMill::observation(const Eigen::VectorXd& point, const std::string& settings) const {
  std::mt19937_64 random(std::hash<std::string>{}(settings));
  std::normal_distribution<double> normal;
  Observation o;
  const Eigen::Index n = 6;
  o.value.resize(n);
  o.covariance = noise_ * noise_ * Eigen::MatrixXd::Identity(n, n);
  const Eigen::VectorXd t = (point - study_.low()).cwiseQuotient(study_.high() - study_.low());
  for (Eigen::Index i = 0; i < n; ++i) {
    double v = 0;  // the first parameters matter most; the last one hardly at all
    for (Eigen::Index p = 0; p < t.size(); ++p)
      v += std::cos(0.7 * static_cast<double>(i * (p + 1))) * (t[p] + 0.3 * t[p] * t[p]) / std::pow(3.0, static_cast<double>(p));
    o.value[i] = v + noise_ * normal(random);
    o.observables.push_back({fmt::format("summary {}", i), "1", i == 0 ? ObservableKind::power : ObservableKind::x});
  }
  o.power = {30 + 5 * o.value[0], 5 * noise_, "made up"};
  for (int b = 0; b < 5; ++b) {
    o.x.edges.push_back(b);
    o.x.percent.push_back(20 + 10 * o.value[1 + b % 5] * (b % 2 == 0 ? 1 : -1));
    o.x.sem.push_back(noise_);
  }
  o.x.edges.push_back(5);
  o.speed = o.x;
  o.bead_seconds = 100;
  return o;
}

Machinery MadeUpMill::machinery() {
  Machinery m;
  m.run = [this](std::span<const campaign::Simulation> simulations) {
    std::vector<campaign::Outcome> outcomes;
    for (const campaign::Simulation& s : simulations) {
      campaign::Outcome outcome;
      for (const std::string& setting : s.settings) outcome.key += setting + ";";
      outcome.folder = "run";
      outcome.wall_s = 10;
      outcome.cached = cache_.count(outcome.key) > 0;
      if (!outcome.cached) {
        if (computed_ >= interrupted_after) throw campaign::Interrupted("stopped");
        ++computed_;
        Eigen::VectorXd point(static_cast<Eigen::Index>(study_.parameters.size()));
        for (std::size_t p = 0; p < study_.parameters.size(); ++p) {
          for (const std::string& setting : s.settings) {
            const std::string prefix = study_.parameters[p].path + "=";
            if (setting.rfind(prefix, 0) == 0) point[static_cast<Eigen::Index>(p)] = std::stod(setting.substr(prefix.size()));
          }
        }
        cache_[outcome.key] = point;
      }
      const bool failed = fails && fails(cache_[outcome.key]);
      outcome.state = failed ? campaign::State::failed : campaign::State::done;
      if (failed) outcome.message = "a bead ran away";
      outcomes.push_back(outcome);
    }
    return outcomes;
  };
  m.observe = [this](std::size_t, const campaign::Outcome& outcome, const std::string&) {
    return observation(cache_.at(outcome.key), outcome.key);
  };
  m.slots = 2;
  return m;
}

std::vector<Observation> MadeUpMill::recorded() const { return {study_.conditions.size(), observation(truth_, "recording")}; }

}  // namespace testing
