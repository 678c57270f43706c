#include "studies/challenge/draw.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "kernel/config/case.hpp"

namespace millscope::challenge {
namespace {

constexpr double kMiddle = 0.7;        // of the range: a truth at its end would be fitted at a limit
constexpr int kTrials = 10000;         // until the constraints hold
constexpr double kTrackStep = 0.0005;  // s: 2 kHz, impacts are cut short by less
constexpr double kFrameStep = 0.02;    // s
constexpr std::uint64_t kSeeds = 1000000000;
constexpr std::uint64_t kConditions = 1000;  // streams kept for the runs of one truth

double draw_nuisance(const diagnose::Nuisance& n, base::RandomStream& random) {
  for (int i = 0; i < kTrials; ++i) {
    const double value = n.mean + n.sigma * random.normal();
    if (value >= n.low && value <= n.high) return value;
  }
  return n.mean;
}

/// What the challenge sets it to, else what the case says.
double made(const Challenge& challenge, const SetsOf& sets, const diagnose::Question& q, const std::string& path,
            const base::Location& where) {
  std::vector<std::string> settings = q.study.conditions.front().settings;
  settings.insert(settings.end(), challenge.truth.begin(), challenge.truth.end());
  settings.insert(settings.end(), sets.settings.begin(), sets.settings.end());
  return diagnose::value_in(config::read_case(q.study.base.string(), settings), path, where);
}

Eigen::VectorXd draw_theta(const Challenge& challenge, const SetsOf& sets, const diagnose::Question& q, base::RandomStream& random) {
  const auto parameters = static_cast<Eigen::Index>(q.study.parameters.size());
  Eigen::VectorXd theta(static_cast<Eigen::Index>(q.dimensions()));
  for (int trial = 0;; ++trial) {
    for (Eigen::Index i = 0; i < parameters; ++i) {
      const calibrate::Parameter& p = q.study.parameters[i];
      theta[i] = diagnose::rounded(p.low + (p.high - p.low) * (0.5 + kMiddle * (random.uniform() - 0.5)));
    }
    if (q.study.allowed(theta.head(parameters))) break;
    if (trial == kTrials)
      throw base::UserError(fmt::format("{}: the study's constraints leave nothing of the middle of its ranges", challenge.file.string()));
  }
  for (std::size_t i = 0; i < q.nuisances.size(); ++i) {
    const diagnose::Nuisance& n = q.nuisances[i];
    theta[parameters + static_cast<Eigen::Index>(i)] =
        n.usual ? made(challenge, sets, q, n.path, n.where) : diagnose::rounded(draw_nuisance(n, random));
  }
  for (Eigen::Index i = 0; sets.kind == Kind::decoy && i < theta.size(); ++i) {
    const std::string& path = i < parameters ? q.study.parameters[i].path : q.nuisances[i - parameters].path;
    const bool is_set = std::any_of(sets.settings.begin(), sets.settings.end(), [&](const auto& s) { return s.starts_with(path + "="); });
    if (is_set) theta[i] = made(challenge, sets, q, path, sets.where);
  }
  return theta;
}

naming::ActiveCandidate draw_effect(const SetsOf& sets, const std::string& name, const diagnose::Question& q, base::RandomStream& random) {
  const auto found = std::find_if(q.candidates.begin(), q.candidates.end(), [&](const auto& c) { return c.name == name; });
  const double strength = found->on_or_off() ? 1 : sets.low + (sets.high - sets.low) * random.uniform();
  return {static_cast<int>(found - q.candidates.begin()), diagnose::rounded_strength(*found, strength)};
}

}  // namespace

std::vector<Truth> draw_truths(const Challenge& challenge, const diagnose::Question& question) {
  std::vector<Truth> truths;
  for (const SetsOf& sets : challenge.sets) {
    for (int i = 0; i < sets.count; ++i) {
      const std::uint64_t stream = kConditions * (1 + truths.size());
      base::RandomStream random(challenge.seed, stream);
      Truth t{sets.kind, sets.name,     draw_theta(challenge, sets, question, random),
              {},        sets.settings, sets.camera.empty() ? challenge.camera : sets.camera,
              stream};
      for (const std::string& name : sets.hypotheses) t.effects.push_back(draw_effect(sets, name, question, random));
      truths.push_back(std::move(t));
    }
  }
  base::RandomStream(challenge.seed, 0).shuffle(truths);
  return truths;
}

base::RandomStream random_of(const Challenge& challenge, const Truth& truth, std::size_t condition) {
  return base::RandomStream(challenge.seed, truth.stream + 1 + condition);
}

campaign::Simulation simulation_of(const Challenge& challenge, const diagnose::Question& q, const Truth& truth, std::size_t condition,
                                   const std::string& label) {
  campaign::Simulation s;
  s.case_file = q.study.base;
  s.label = label;
  s.settings = q.study.conditions[condition].settings;
  for (std::string& setting : q.settings(truth.theta, truth.effects)) s.settings.push_back(std::move(setting));
  s.settings.insert(s.settings.end(), challenge.truth.begin(), challenge.truth.end());
  s.settings.insert(s.settings.end(), truth.settings.begin(), truth.settings.end());
  const config::Case truth_case = config::read_case(s.case_file.string(), s.settings);
  const bool held_out = q.study.conditions[condition].role == calibrate::Role::held_out;
  const double seconds = held_out ? challenge.held_out_seconds : challenge.seconds;
  s.settings.push_back(fmt::format("time.end_s={}", truth_case.time.analyze_from + seconds));
  s.settings.push_back(fmt::format("output.tracks={{beads: {}, every_s: {}}}", challenge.beads, kTrackStep));
  // Beads that are set apart draw their share of the power, which a mill with one tracer does not: frames say how much.
  s.settings.push_back(truth_case.has_tracers() ? fmt::format("output.frames={{every_s: {}}}", kFrameStep) : "output.frames=~");
  s.settings.emplace_back("output.vtk=~");
  s.settings.push_back(fmt::format("seed={}", 1 + random_of(challenge, truth, condition).below(kSeeds)));
  return s;
}

}  // namespace millscope::challenge
