#include "made_up_study.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <fstream>

#include "kernel/base/random.hpp"

namespace millscope::diagnose {
namespace {

constexpr Index kObservables = 16;

VectorXd direction(std::uint64_t number) {
  base::RandomStream random(4711, number);
  return random.normals(kObservables);
}

std::map<std::string, std::string> map_of(const std::string& key) {
  std::map<std::string, std::string> settings;
  for (std::size_t begin = 0; begin < key.size();) {
    const std::size_t end = std::min(key.find('\n', begin), key.size()), equals = key.find('=', begin);
    settings[key.substr(begin, equals - begin)] = key.substr(equals + 1, end - equals - 1);
    begin = end + 1;
  }
  return settings;
}

/// "\ncamera.frame_error.offset_x=0.001" and so on, of the one link {kind: frame_error, offset_x: 0.001, …} of a camera file's text.
std::string camera_settings(const std::string& camera) {
  std::string settings;
  for (std::size_t comma = camera.find(", "); comma != std::string::npos; comma = camera.find(", ", comma + 1)) {
    const std::size_t colon = camera.find(": ", comma), end = camera.find_first_of(",}", colon);
    settings +=
        fmt::format("\ncamera.frame_error.{}={}", camera.substr(comma + 2, colon - comma - 2), camera.substr(colon + 2, end - colon - 2));
  }
  return settings;
}

}  // namespace

const host::Registry& registry() {
  static const host::Registry loaded;
  return loaded;
}

std::filesystem::path write_study(const testing::Scratch& folder, const std::string& sections) {
  std::ofstream(folder / "r.yaml") << "files: [a.a]\n";
  std::ofstream(folder / "study.yaml") << "base: " MILLSCOPE_SOURCE_DIR
                                          "/configs/mill10/case.yaml\n"
                                          "conditions:\n"
                                          "  speed75: {set: {mill.speed: 75 %critical}, recording: r.yaml, role: fit}\n"
                                          "  speed60: {set: {mill.speed: 60 %critical}, recording: r.yaml, role: fit}\n"
                                          "  speed50: {set: {mill.speed: 50 %critical}, recording: r.yaml, role: held_out}\n"
                                          "parameters:\n"
                                          "  pairs.glass~glass.static_friction: {name: bead_friction, range: [0.1, 0.6]}\n"
                                          "  pairs.glass~liner.static_friction: {name: wall_friction, range: [0.15, 0.6]}\n"
                                       << sections;
  return folder / "study.yaml";
}

Question question_of(const testing::Scratch& folder, const std::string& sections) {
  return read_question(write_study(folder, sections), {}, registry());
}

MadeUpMill::MadeUpMill(const Question& q, std::vector<Physics> physics, const std::vector<std::string>& truth, double recording_noise)
    : theta_(q.coordinates()),
      physics_(std::move(physics)),
      truth_(truth),
      recording_noise_(recording_noise),
      conditions_(q.study.conditions.size()) {
  for (const calibrate::Parameter& p : q.study.parameters) paths_.push_back(p.path);
  for (const Nuisance& n : q.nuisances) paths_.push_back(n.path);
}

calibrate::Observation MadeUpMill::observation(std::size_t condition, const std::string& key, double noise) const {
  const std::map<std::string, std::string> settings = map_of(key);
  VectorXd y = VectorXd::Zero(kObservables);
  const std::uint64_t own = 100 * (condition + 1);
  std::vector<double> coded;
  for (std::size_t i = 0; i < paths_.size(); ++i) {
    const auto found = settings.find(paths_[i]);
    const double left_alone = theta_[i].usual ? theta_[i].coded(*theta_[i].usual) : 0;
    const double u = found == settings.end() ? left_alone : theta_[i].coded(std::stod(found->second));
    coded.push_back(u);
    if (i == 1 && idle == condition) continue;
    y += (3 - static_cast<double>(i)) * direction(own + i) * u + 0.4 * direction(own + 10 + i) * u * u;
  }
  for (const Physics& p : physics_) {
    const auto found = settings.find(p.path), other = settings.find(p.beside);
    const double share = p.beside.empty() ? 1 : other == settings.end() ? 0 : std::stod(other->second) / p.beside_far;
    if (found != settings.end())
      y += share * p.size * (1 + p.growth * (1 + coded.at(p.coordinate))) * (std::stod(found->second) - p.null_value) /
           (p.far - p.null_value) * direction(p.direction.at(condition));
  }
  base::RandomStream random(std::hash<std::string>{}(key) + seed, condition);
  y += noise * random.normals(kObservables);
  y[0] += 50;  // W: powers are above 0
  calibrate::Observation o;
  o.value = y;
  o.covariance = noise * noise * MatrixXd::Identity(kObservables, kObservables);
  for (Index i = 0; i < kObservables; ++i)
    o.observables.push_back({fmt::format("summary {}", i), "1", i == 0 ? calibrate::ObservableKind::power : calibrate::ObservableKind::x});
  o.resampled = o.covariance, o.blocks = 200;
  o.power = {y[0], noise, "made up"};
  o.bead_seconds = 100;
  return o;
}

calibrate::Machinery MadeUpMill::machinery() {
  calibrate::Machinery w;
  w.run = [this](std::span<const campaign::Simulation> simulations) {
    std::vector<campaign::Outcome> outcomes;
    for (const campaign::Simulation& s : simulations) {
      campaign::Outcome o;
      o.key = fmt::format("{}", fmt::join(s.settings, "\n"));
      o.cached = !cache_.emplace(o.key, map_of(o.key)).second;
      const bool failed = fails && fails(cache_.at(o.key));
      o.state = failed ? campaign::State::failed : campaign::State::done;
      if (failed) o.message = "a bead ran away";
      outcomes.push_back(o);
    }
    return outcomes;
  };
  w.observe = [this](std::size_t condition, const campaign::Outcome& o, const std::string& camera) {
    return observation(condition, o.key + camera_settings(camera), run_noise);
  };
  return w;
}

Evidence MadeUpMill::evidence() const {
  Evidence evidence;
  for (std::size_t c = 0; c < conditions_; ++c)
    evidence.recorded.push_back(observation(c, fmt::format("{}", fmt::join(truth_, "\n")), recording_noise_));
  return evidence;
}

}  // namespace millscope::diagnose
