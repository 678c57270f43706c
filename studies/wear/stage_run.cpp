#include "studies/wear/stage_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kernel/base/error.hpp"
#include "kernel/config/writer.hpp"
#include "kernel/output/file.hpp"
#include "kernel/output/summary.hpp"
#include "kernel/run/derived_case.hpp"
#include "studies/analysis/analysis.hpp"

namespace millscope::wear {
namespace {

namespace fs = std::filesystem;
using base::UserError;

/// What the charge of one run does; NaN: not told.
struct Charge {
  double power = kNone, power_error = kNone, shoulder = kNone, toe = kNone;
  std::string trouble;  ///< why shoulder and toe are not known
};

/// Power from the summary; shoulder and toe from charge_features.
Charge charge_of(const fs::path& run, const host::Registry& registry) {
  Charge c;
  const nlohmann::ordered_json summary = output::read_json(run / "summary.json");
  if (summary.is_object() && summary.contains("power_W")) {
    c.power = output::number_in(summary["power_W"], "torque");
    c.power_error = output::number_in(summary["power_W"], "torque_sem");
  }
  analysis::AnalysisRequest request = analysis::request_of_means(run, {"charge_features"});  // the errors are those between seeds
  request.threads = 1;
  try {
    for (const analysis::ResultArray& result : analysis::analyze(request, registry).arrays) {
      if (result.name == "departure_shoulder") c.shoulder = result.value[0];
      if (result.name == "bulk_toe") c.toe = result.value[0];
    }
  } catch (const UserError& e) {
    c.trouble = e.what();
  }
  return c;
}

/// Means over the runs. The power's error is the larger one of what the runs say of themselves and of what they differ by.
void add_charges(const std::vector<Charge>& charges, Told& told) {
  const auto n = static_cast<double>(charges.size());
  double between = 0, within = 0;
  for (const Charge& c : charges) {
    told.power += c.power / n, told.shoulder += c.shoulder / n, told.toe += c.toe / n;
    within += c.power_error * c.power_error / (n * n);
    if (!c.trouble.empty()) told.doubts.push_back("shoulder and toe are not known: " + c.trouble);
  }
  for (const Charge& c : charges) between += (c.power - told.power) * (c.power - told.power) / std::max(n * (n - 1), 1.0);
  told.power_error = std::sqrt(std::fmax(within, between));
}

}  // namespace

fs::path Stages::write_case(int number, const Profile& p, const Stretches& s) const {
  const fs::path folder = request_.output / "stages" / fmt::format("{:02d}", number);
  fs::create_directories(folder);
  config::Case c = given_.c;
  c.name = fmt::format("{}, worn, stage {}", given_.c.name, number);
  run::fill_by_count(c, given_.bead_count);  // the charge stays the same though the mill gets wider
  if (!given_.c.fill.file.empty()) c.fill.settle = config::FillCase{}.settle;
  const Mesh mesh = mesh_of(p, s);
  const Surface surface = mesh.surface();
  run::put_mesh_in_place({surface, given_.geometries[body_].slots}, c.geometry[body_].plugin, c.domain, folder);
  run::write_frames_for_means(c);
  const fs::path file = folder / "case.yaml";
  output::write_file(file, config::resolved_yaml(c, registry_.descriptors()));
  return file;
}

Told Stages::run(int number, const Profile& p, const Stretches& s) const {
  const fs::path file = write_case(number, p, s);
  std::vector<campaign::Simulation> simulations;
  for (int seed = 0; seed < request_.seeds; ++seed) {
    simulations.push_back({file,
                           {fmt::format("seed={}", given_.c.seed + static_cast<std::uint64_t>(seed))},
                           fmt::format("stage {}, start {}", number, seed + 1)});
  }
  const std::vector<campaign::Outcome> outcomes = campaign::run(simulations, request_.campaign);
  Told told;
  std::vector<Charge> charges;
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    if (outcomes[i].state == campaign::State::failed) {
      throw UserError(
          fmt::format("{}: {}; what is finished is kept, and --retry-failed tries again", simulations[i].label, outcomes[i].message));
    }
    told.runs.push_back(outcomes[i].folder);
    told.losses.push_back(loss_of(run::read_wear(outcomes[i].folder / run::kWearFile, given_.c.geometry[body_].plugin.name), p, s));
    charges.push_back(charge_of(outcomes[i].folder, registry_));
  }
  add_charges(charges, told);
  return told;
}

}  // namespace millscope::wear
