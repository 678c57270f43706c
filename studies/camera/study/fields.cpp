// Coverage: does the field that one bead's recording gives, with its own 90 % intervals, agree with the true field of the whole charge?
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "studies/camera/study/study.hpp"

namespace millscope::studies {
namespace {

constexpr double kFewestVisits = 10;
const std::vector<std::string> kFields = {"occupancy", "velocity_x", "velocity_y", "speed"};

/// Agreement of one field over cells and beads.
struct Agreement {
  double cells = 0, inside = 0, below = 0;
  void add(double value, double sem, double low, double high, double truth) {
    if (!std::isfinite(sem) || !(sem > 0) || !std::isfinite(truth)) return;
    cells += 1;
    inside += truth >= low && truth <= high ? 1 : 0;
    below += value < truth ? 1 : 0;
  }
  nlohmann::json json() const { return {{"cells", cells}, {"coverage", inside / cells}, {"share_below_truth", below / cells}}; }
};

/// Time-weighted mean of value − truth over cells, in classes of true speed.
struct Bias {
  std::vector<double> edges{0, 0.25, 0.5, 0.75, 1, 1.5, 10};
  std::vector<double> weight = std::vector<double>(6, 0.0), difference = weight, level = weight;
  void add(double value, double truth, double time) {
    for (std::size_t k = 0; k + 1 < edges.size(); ++k) {
      if (truth < edges[k] || truth >= edges[k + 1]) continue;
      weight[k] += time;
      difference[k] += time * (value - truth);
      level[k] += time * truth;
    }
  }
  nlohmann::json json() const {
    nlohmann::json rows = nlohmann::json::array();
    double w = 0, d = 0, l = 0;
    for (std::size_t k = 0; k < weight.size(); ++k) {
      w += weight[k], d += difference[k], l += level[k];
      if (weight[k] > 0) {
        rows.push_back({{"from_m_per_s", edges[k]},
                        {"to_m_per_s", edges[k + 1]},
                        {"share", weight[k]},
                        {"bias_m_per_s", difference[k] / weight[k]},
                        {"relative", difference[k] / level[k]}});
      }
    }
    for (auto& row : rows) row["share"] = row["share"].get<double>() / w;
    return {{"bias_m_per_s", d / w}, {"relative", d / l}, {"classes", rows}};
  }
};

const ResultArray& field(const ResultSet& results, const std::string& name) {
  const ResultArray* found = results.find("pept_grid", name);
  if (found == nullptr) throw config::UserError(fmt::format("pept_grid gives no '{}'", name));
  return *found;
}

/// The bead's true mean speed in each cell against what the recording says of the same time: what the camera alone does.
void add_bias(const ResultSet& seen, const ResultSet& exact, Bias& bias) {
  const ResultArray &speed = field(seen, "speed"), &truth = field(exact, "speed"), &time = field(exact, "occupancy"),
                    &visits = field(exact, "visits");
  for (std::size_t i = 0; i < speed.size(); ++i) {
    if (visits.value[i] >= kFewestVisits && std::isfinite(speed.value[i])) bias.add(speed.value[i], truth.value[i], time.value[i]);
  }
}

}  // namespace

nlohmann::json study_fields(const std::filesystem::path& run, const Camera& camera, int cells, std::size_t most_beads,
                            const host::Registry& registry) {
  const SimulatedBeads beads(run, registry);
  const std::string settings = fmt::format("analyzers: {{pept_grid: {{cells_x: {0}, cells_y: {0}}}}}\n", cells);
  const ResultSet truth = analyze_path(run, {}, beads.analyze_from(), settings, registry);
  const Workplace workplace;
  std::vector<Agreement> agreements(kFields.size());
  std::vector<double> coverage_of_bead;
  Bias bias;
  const std::size_t count = std::min(most_beads, beads.tracks().size());
  for (std::size_t k = 0; k < count; ++k) {
    const std::int64_t id = beads.tracks()[k].bead;
    const ResultSet seen = analyze_path(record(beads, camera, {id}, workplace.path(), 1), {}, 0, settings, registry);
    const ResultSet exact = analyze_path(run, {std::to_string(id)}, beads.analyze_from(), settings, registry);
    const ResultArray& visits = field(seen, "visits");
    for (std::size_t f = 0; f < kFields.size(); ++f) {
      const ResultArray &value = field(seen, kFields[f]), &wanted = field(truth, kFields[f]);
      for (std::size_t i = 0; i < value.size(); ++i) {
        if (visits.value[i] < kFewestVisits) continue;
        agreements[f].add(value.value[i], value.sem[i], value.low[i], value.high[i], wanted.value[i]);
      }
    }
    add_bias(seen, exact, bias);
  }
  nlohmann::json fields;
  for (std::size_t f = 0; f < kFields.size(); ++f) fields[kFields[f]] = agreements[f].json();
  return {{"beads", count}, {"cells", cells}, {"fewest_visits", kFewestVisits}, {"fields", fields}, {"speed", bias.json()}};
}

}  // namespace millscope::studies
