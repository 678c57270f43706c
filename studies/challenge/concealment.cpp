#include "studies/challenge/concealment.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "kernel/base/statistics.hpp"
#include "kernel/output/summary.hpp"
#include "studies/analysis/analysis.hpp"
#include "studies/calibrate/objective.hpp"
#include "studies/challenge/record.hpp"

namespace millscope::challenge {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr double kLongFrameStep = 0.02;  // s
constexpr std::size_t kEnoughEmpty = 10;
constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
constexpr double kQuantile = 0.9;

/// What a long run shows.
struct Look {
  double shoulder = 0, toe = 0;  ///< degrees
  calibrate::Observation seen;   ///< power and distributions alone
};

const std::vector<double>& values_of(const analysis::ResultSet& results, const std::string& analyzer, const std::string& name) {
  const analysis::ResultArray* found = results.find(analyzer, name);
  if (found == nullptr) throw base::UserError(fmt::format("the analyzer {} tells no '{}' of a long run", analyzer, name));
  return found->value;
}

Look look_at(const fs::path& run, const host::Registry& registry) {
  const analysis::ResultSet results = analysis::analyze(analysis::request_of_means(run, {"charge_features", "distributions"}), registry);
  const auto angle = [&](const std::string& name) { return values_of(results, "charge_features", name).at(0); };
  const auto histogram = [&](const std::string& axis) {
    return calibrate::Histogram{
        values_of(results, "distributions", axis + "_edges"), values_of(results, "distributions", axis + "_percent"), {}};
  };
  Look look{angle("departure_shoulder"), angle("bulk_toe"), {}};
  look.seen.power.value = power_of(run, registry).value;
  look.seen.x = histogram("x"), look.seen.speed = histogram("speed_ratio");
  return look;
}

Concealment compared(const Look& truth, const Look& base) {
  const double power = truth.seen.power.value;
  return {100 * (base.seen.power.value - power) / power, base.shoulder - truth.shoulder, base.toe - truth.toe,
          calibrate::chagas2015(truth.seen, base.seen, {}).value()};
}

std::vector<std::string> for_long(std::vector<std::string> settings, double from, double seconds) {
  for (const std::string& more :
       {fmt::format("time.end_s={}", from + seconds), fmt::format("output.frames={{every_s: {}}}", kLongFrameStep),
        std::string("output.tracks=~"), std::string("output.vtk=~")})
    settings.push_back(more);
  return settings;
}

/// The truth as it was recorded, but longer; the base as the practice retuned it. Nothing: the diagnosis does not tell it.
std::vector<campaign::Simulation> long_runs(const diagnose::Question& q, const Marked& m, std::size_t condition, double seconds) {
  const calibrate::Condition& at = q.study.conditions[condition];
  Eigen::VectorXd theta(static_cast<Eigen::Index>(q.dimensions()));
  const std::vector<naming::Coordinate> coordinates = q.coordinates();
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    const auto found = m.found->practice.find(coordinates[i].name);
    if (found == m.found->practice.end()) return {};
    theta[static_cast<Eigen::Index>(i)] = found->second;
  }
  campaign::Simulation truth, base;
  truth.case_file = base.case_file = q.study.base;
  truth.settings = m.answer.made.at(at.name).at("settings").get<std::vector<std::string>>();
  base.settings = at.settings;
  for (std::string& setting : q.settings(theta, {})) base.settings.push_back(std::move(setting));
  const double from = config::read_case(q.study.base.string(), base.settings).time.analyze_from;
  truth.settings = for_long(std::move(truth.settings), from, seconds), base.settings = for_long(std::move(base.settings), from, seconds);
  truth.label = m.answer.set + ", truth", base.label = m.answer.set + ", retuned base";
  return {truth, base};
}

void write(const fs::path& sets, const std::map<std::string, Concealment>& all, const std::string& condition, double seconds) {
  Json list = Json::object();
  for (const auto& [set, c] : all)
    list[set] = {{"power_percent", c.power_percent}, {"shoulder_deg", c.shoulder_deg}, {"toe_deg", c.toe_deg}, {"chagas2015", c.chagas}};
  output::write_json(sets / kConcealmentFile, {{"schema_version", 1}, {"condition", condition}, {"seconds", seconds}, {"sets", list}});
}

}  // namespace

void conceal(const diagnose::Question& q, const fs::path& sets, const host::Registry& registry, const ConcealOptions& options) {
  const std::size_t condition = q.study.with_role(calibrate::Role::fit).at(0);
  std::map<std::string, Concealment> all = read_concealment(sets);
  std::vector<campaign::Simulation> simulations;
  std::vector<std::string> names;
  for (const Marked& m : read_sets(sets)) {
    if (!m.found || !m.found->failure.empty() || all.count(m.answer.set) > 0) continue;
    std::vector<campaign::Simulation> both = long_runs(q, m, condition, options.seconds);
    all[m.answer.set] = {kUnknown, kUnknown, kUnknown, kUnknown};
    if (both.empty()) continue;
    std::move(both.begin(), both.end(), std::back_inserter(simulations));
    names.push_back(m.answer.set);
  }
  const std::vector<campaign::Outcome> outcomes =
      simulations.empty() ? std::vector<campaign::Outcome>() : campaign::run(simulations, options.campaign);
  for (std::size_t k = 0; k < names.size(); ++k) {
    const campaign::Outcome &truth = outcomes[2 * k], &base = outcomes[2 * k + 1];
    if (truth.state == campaign::State::failed || base.state == campaign::State::failed) continue;
    all[names[k]] = compared(look_at(truth.folder, registry), look_at(base.folder, registry));
  }
  write(sets, all, q.study.conditions[condition].name, options.seconds);
}

bool Unsuspicious::holds(const Concealment& c) const {
  return std::fabs(c.power_percent) <= power_percent && std::fabs(c.shoulder_deg) <= degrees && std::fabs(c.toe_deg) <= degrees &&
         c.chagas <= chagas;
}

std::map<std::string, Unsuspicious> unsuspicious(const std::vector<Marked>& sets) {
  std::map<std::string, std::vector<double>> empty;
  for (const Marked& m : sets) {
    std::vector<double>& own = empty[m.study];
    if (m.answer.kind == Kind::none && m.concealment && std::isfinite(m.concealment->chagas)) own.push_back(m.concealment->chagas);
  }
  std::map<std::string, Unsuspicious> out;
  for (auto& [study, chagas] : empty) {
    Unsuspicious& limits = out[study];
    std::sort(chagas.begin(), chagas.end());
    if (chagas.size() >= kEnoughEmpty) limits.chagas = base::interpolated_quantile(chagas, kQuantile);
  }
  return out;
}

}  // namespace millscope::challenge
