#include "studies/challenge/concealment.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

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

/// The condition of the long runs, from when on and how long they are looked at.
struct Long {
  const calibrate::Condition& at;
  double from, seconds;
};

std::vector<std::string> for_long(std::vector<std::string> settings, const Long& how) {
  for (const std::string& more :
       {fmt::format("time.end_s={}", how.from + how.seconds), fmt::format("output.frames={{every_s: {}}}", kLongFrameStep),
        std::string("output.tracks=~"), std::string("output.vtk=~")})
    settings.push_back(more);
  return settings;
}

/// The truth as it was recorded, but longer.
campaign::Simulation truth_of(const diagnose::Question& q, const Marked& m, const Long& how) {
  campaign::Simulation truth;
  truth.case_file = q.study.base;
  truth.label = m.answer.set + ", truth";
  truth.settings = for_long(m.answer.made.at(how.at.name).at("settings").get<std::vector<std::string>>(), how);
  return truth;
}

/// The base as it was tuned. Nothing: the diagnosis does not tell it.
std::optional<campaign::Simulation> base_of(const diagnose::Question& q, const std::map<std::string, double>& tuned, const Long& how) {
  const std::vector<naming::Coordinate> coordinates = q.coordinates();
  Eigen::VectorXd theta(static_cast<Eigen::Index>(coordinates.size()));
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    const auto found = tuned.find(coordinates[i].name);
    if (found == tuned.end()) return std::nullopt;
    theta[static_cast<Eigen::Index>(i)] = found->second;
  }
  campaign::Simulation base;
  base.case_file = q.study.base;
  base.settings = how.at.settings;
  for (std::string& setting : q.settings(theta, {})) base.settings.push_back(std::move(setting));
  base.settings = for_long(std::move(base.settings), how);
  return base;
}

/// One comparison that is still to be made: places of its two simulations among all.
struct Pending {
  std::string set;
  Tuned tuned;
  std::size_t truth, base;
};
struct Plan {
  std::vector<campaign::Simulation> simulations;
  std::vector<Pending> pending;
};

/// Plans what is not known of a set. What its diagnosis does not tell is noted as that.
void add_runs(const diagnose::Question& q, const Marked& m, const Long& how, Practice& known, Plan& plan) {
  std::map<std::string, double> refitted;
  for (const auto& [name, interval] : m.found->retuned) refitted[name] = interval.value;
  std::optional<std::size_t> truth;
  const auto add = [&](Tuned tuned, const std::map<std::string, double>& parameters, const char* label) {
    if (known.*tuned) return;
    known.*tuned = Concealment{kUnknown, kUnknown, kUnknown, kUnknown};
    std::optional<campaign::Simulation> base = base_of(q, parameters, how);
    if (!base) return;
    if (!truth) {
      truth = plan.simulations.size();
      plan.simulations.push_back(truth_of(q, m, how));
    }
    base->label = m.answer.set + label;
    plan.pending.push_back({m.answer.set, tuned, *truth, plan.simulations.size()});
    plan.simulations.push_back(std::move(*base));
  };
  add(&Practice::to_power, m.found->practice, ", base retuned to power");
  add(&Practice::to_all, refitted, ", base refitted to everything");
}

/// What stands there is kept, so it has to be of the same runs.
void refuse_others(const fs::path& sets, const Long& how) {
  const fs::path file = sets / kConcealmentFile;
  if (!fs::exists(file)) return;
  const Json j = output::read_json(file);
  const std::string condition = j.value("condition", "");
  const double seconds = j.value("seconds", 0.0);
  if (condition == how.at.name && seconds == how.seconds) return;
  throw base::UserError(
      fmt::format("{}: has long runs of {:g} s at '{}', these would be of {:g} s at '{}'; give --seconds {:g}, or take the file away",
                  file.string(), seconds, condition, how.seconds, how.at.name, seconds));
}

void write(const fs::path& sets, const std::map<std::string, Practice>& all, const Long& how) {
  const auto json = [](const std::optional<Concealment>& c) {
    if (!c) return Json();
    return Json{{"power_percent", c->power_percent}, {"shoulder_deg", c->shoulder_deg}, {"toe_deg", c->toe_deg}, {"chagas2015", c->chagas}};
  };
  Json list = Json::object();
  for (const auto& [set, p] : all) list[set] = {{"to_power", json(p.to_power)}, {"to_all", json(p.to_all)}};
  output::write_json(sets / kConcealmentFile,
                     {{"schema_version", 2}, {"condition", how.at.name}, {"seconds", how.seconds}, {"sets", list}});
}

}  // namespace

void conceal(const diagnose::Question& q, const fs::path& sets, const host::Registry& registry, const ConcealOptions& options) {
  const calibrate::Condition& at = q.study.conditions[q.study.with_role(calibrate::Role::fit).at(0)];
  const Long how{at, config::read_case(q.study.base.string(), at.settings).time.analyze_from, options.seconds};
  refuse_others(sets, how);
  std::map<std::string, Practice> all = read_concealment(sets);
  Plan plan;
  for (const Marked& m : read_sets(sets)) {
    const bool asked = m.answer.kind != Kind::decoy;  // a decoy has nothing to conceal
    if (asked && m.found && m.found->failure.empty()) add_runs(q, m, how, all[m.answer.set], plan);
  }
  const std::vector<campaign::Outcome> outcomes =
      plan.simulations.empty() ? std::vector<campaign::Outcome>() : campaign::run(plan.simulations, options.campaign);
  std::map<std::size_t, Look> looks;  // two bases share a truth
  const auto look = [&](std::size_t k) -> const Look& {
    const auto found = looks.find(k);
    return found != looks.end() ? found->second : looks.emplace(k, look_at(outcomes[k].folder, registry)).first->second;
  };
  const auto failed = [&](std::size_t k) { return outcomes[k].state == campaign::State::failed; };
  for (const Pending& p : plan.pending) {
    if (!failed(p.truth) && !failed(p.base)) all[p.set].*p.tuned = compared(look(p.truth), look(p.base));
  }
  write(sets, all, how);
}

bool Unsuspicious::holds(const Concealment& c) const {
  return std::fabs(c.power_percent) <= power_percent && std::fabs(c.shoulder_deg) <= degrees && std::fabs(c.toe_deg) <= degrees &&
         c.chagas <= chagas;
}

std::map<std::string, Unsuspicious> unsuspicious(const std::vector<Marked>& sets, Tuned tuned) {
  std::map<std::string, std::vector<double>> empty;
  for (const Marked& m : sets) {
    std::vector<double>& own = empty[m.peers()];
    const std::optional<Concealment>& c = m.practice.*tuned;
    if (m.answer.kind == Kind::none && c && std::isfinite(c->chagas)) own.push_back(c->chagas);
  }
  std::map<std::string, Unsuspicious> out;
  for (auto& [peers, chagas] : empty) {
    Unsuspicious& limits = out[peers];
    std::sort(chagas.begin(), chagas.end());
    if (chagas.size() >= kEnoughEmpty) limits.chagas = base::interpolated_quantile(chagas, kQuantile);
  }
  return out;
}

const Concealment* Concealed::seen(const Marked& m) const {
  const std::optional<Concealment>& c = m.practice.*tuned_;
  return c && std::isfinite(c->power_percent) ? &*c : nullptr;
}

bool Concealed::operator()(const Marked& m) const {
  const Concealment* c = seen(m);
  return c != nullptr && limits_.at(m.peers()).holds(*c);
}

const char* Concealed::word_for(const Marked& m) const {
  if (!(*this)(m)) return "no";
  return std::isfinite(limits_.at(m.peers()).chagas) ? "yes" : "yes, without Eq. 4.3";
}

}  // namespace millscope::challenge
