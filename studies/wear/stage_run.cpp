#include "studies/wear/stage_run.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "kernel/base/error.hpp"
#include "kernel/config/writer.hpp"
#include "kernel/output/file.hpp"
#include "kernel/output/summary.hpp"
#include "kernel/run/mesh_case.hpp"
#include "studies/analysis/analysis.hpp"

namespace millscope::wear {
namespace {

namespace fs = std::filesystem;
using base::UserError;

constexpr double kFrameEvery = 0.02;  // s: about half of the time in which a charge forgets its kinetic energy
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// Mean of what seeds say; NaN where one of them says nothing.
struct Mean {
  double value = 0, error = 0;
};
Mean mean_of(const std::vector<double>& values) {
  Mean m;
  const auto n = static_cast<double>(values.size());
  for (const double v : values) m.value += v / n;
  for (const double v : values) m.error += (v - m.value) * (v - m.value);
  m.error = n > 1 ? std::sqrt(m.error / (n * (n - 1))) : 0;
  return m;
}

struct Charge {
  double power = kNone, power_error = kNone, shoulder = kNone, toe = kNone;
};

/// Power from the summary; shoulder and toe from charge_features, where the charge has them.
Charge charge_of(const fs::path& run, const host::Registry& registry) {
  Charge c;
  const nlohmann::ordered_json summary = output::read_json(run / "summary.json");
  if (summary.is_object() && summary.contains("power_W") && summary["power_W"].contains("torque")) {
    c.power = summary["power_W"]["torque"].get<double>();
    c.power_error = summary["power_W"].value("torque_sem", kNone);
  }
  analysis::AnalysisRequest request;
  request.path = run;
  request.only = {"charge_features"};
  request.overrides = {"resampling.draws=20"};  // the errors are those between seeds
  request.threads = 1;
  try {
    for (const analysis::ResultArray& result : analysis::analyze(request, registry).arrays) {
      if (result.name == "departure_shoulder") c.shoulder = result.value[0];
      if (result.name == "bulk_toe") c.toe = result.value[0];
    }
  } catch (const UserError&) {
    return c;  // too few frames, or a charge that does not turn
  }
  return c;
}

}  // namespace

fs::path Stages::write_case(int number, const Profile& p, const Stretches& s) const {
  const fs::path folder = request_.output / "stages" / fmt::format("{:02d}", number);
  fs::create_directories(folder);
  config::Case c = given_.c;
  c.name = fmt::format("{}, worn, stage {}", given_.c.name, number);
  c.fill.count = given_.bead_count;  // the charge stays the same though the mill gets wider
  c.fill.filling.reset(), c.fill.mass.reset();
  const Mesh mesh = mesh_of(p, s);
  const Surface surface = mesh.surface();
  run::put_mesh_in_place({surface, given_.geometries[body_].slots}, c.geometry[body_].plugin, c.domain, folder);
  c.output.frames.emplace();
  c.output.frames->every = kFrameEvery, c.output.frames->from = c.time.analyze_from;
  c.output.tracks.reset(), c.output.vtk.reset();
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
  std::vector<double> power, shoulder, toe;
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    if (outcomes[i].state == campaign::State::failed) {
      throw UserError(
          fmt::format("{}: {}; what is finished is kept, and --retry-failed tries again", simulations[i].label, outcomes[i].message));
    }
    told.runs.push_back(outcomes[i].folder);
    told.losses.push_back(loss_of(run::read_wear(outcomes[i].folder / run::kWearFile, given_.c.geometry[body_].plugin.name), p, s));
    const Charge charge = charge_of(outcomes[i].folder, registry_);
    power.push_back(charge.power), shoulder.push_back(charge.shoulder), toe.push_back(charge.toe);
    told.power_error = charge.power_error;
  }
  const Mean mean = mean_of(power);
  told.power = mean.value;
  if (power.size() > 1) told.power_error = mean.error;
  told.shoulder = mean_of(shoulder).value;
  told.toe = mean_of(toe).value;
  return told;
}

}  // namespace millscope::wear
