// Coverage: does the field that one bead's recording gives, with its own 90 % intervals, agree with the true field of the whole charge?
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "studies/camera/study/study.hpp"

namespace millscope::camera {
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

const analysis::ResultArray& field(const analysis::ResultSet& results, const std::string& name) {
  const analysis::ResultArray* found = results.find("pept_grid", name);
  if (found == nullptr) throw base::UserError(fmt::format("pept_grid gives no '{}'", name));
  return *found;
}

/// The bead's true mean speed in each cell against what the recording says of the same time: what the camera alone does.
void add_bias(const analysis::ResultSet& seen, const analysis::ResultSet& exact, Bias& bias) {
  const analysis::ResultArray &speed = field(seen, "speed"), &truth = field(exact, "speed"), &time = field(exact, "occupancy"),
                              &visits = field(exact, "visits");
  for (std::size_t i = 0; i < speed.size(); ++i) {
    if (visits.value[i] >= kFewestVisits && std::isfinite(speed.value[i])) bias.add(speed.value[i], truth.value[i], time.value[i]);
  }
}

/// What one bead's recording says of every field.
struct BeadFields {
  std::vector<analysis::ResultArray> fields;  ///< in the order of kFields
  std::vector<double> visits;
};

/// Agreement with the truth in the cells that `counts` accepts for a bead.
template <class Counts>
nlohmann::json agreement(const std::vector<BeadFields>& beads, const analysis::ResultSet& truth, const Counts& counts) {
  nlohmann::json result;
  for (std::size_t f = 0; f < kFields.size(); ++f) {
    const analysis::ResultArray& wanted = field(truth, kFields[f]);
    Agreement all;
    for (const BeadFields& bead : beads) {
      const analysis::ResultArray& found = bead.fields[f];
      for (std::size_t i = 0; i < found.size(); ++i) {
        if (counts(bead, i)) all.add(found.value[i], found.sem[i], found.low[i], found.high[i], wanted.value[i]);
      }
    }
    result[kFields[f]] = all.json();
  }
  return result;
}

}  // namespace

nlohmann::json study_fields(const std::filesystem::path& run, const Camera& camera, const FieldStudy& study,
                            const host::Registry& registry) {
  const SimulatedBeads beads(run, registry);
  const std::string settings = fmt::format("analyzers: {{pept_grid: {{cells_x: {0}, cells_y: {0}}}}}\n", study.cells);
  const std::string trajectory = study.gap_limit > 0 ? fmt::format("trajectory: {{gap_limit: {}}}\n", study.gap_limit) : "";
  const analysis::ResultSet truth = analyze_path(run, {}, beads.analyze_from(), settings, registry);
  const Workplace workplace;
  std::vector<BeadFields> recorded;
  std::vector<double> mean_visits(field(truth, "visits").size(), 0.0);
  Bias bias;
  const std::size_t count = std::min(study.most_beads, beads.tracks().size());
  for (std::size_t k = 0; k < count; ++k) {
    const std::int64_t id = beads.tracks()[k].bead;
    const analysis::ResultSet seen = analyze_path(record(beads, camera, {id}, workplace.path(), 1), {}, 0, settings + trajectory, registry);
    const analysis::ResultSet exact = analyze_path(run, {std::to_string(id)}, beads.analyze_from(), settings, registry);
    BeadFields bead;
    for (const std::string& name : kFields) bead.fields.push_back(field(seen, name));
    bead.visits = field(seen, "visits").value;
    for (std::size_t i = 0; i < mean_visits.size(); ++i) mean_visits[i] += bead.visits[i] / static_cast<double>(count);
    recorded.push_back(std::move(bead));
    add_bias(seen, exact, bias);
  }
  // The cells with ten visits on average are the same for all beads; those that one bead happens to visit ten times are the lucky ones,
  // whose occupancy is too high.
  const auto usual = [&](const BeadFields&, std::size_t i) { return mean_visits[i] >= kFewestVisits; };
  const auto lucky = [](const BeadFields& bead, std::size_t i) { return bead.visits[i] >= kFewestVisits; };
  return {{"beads", count},
          {"cells", study.cells},
          {"fewest_visits", kFewestVisits},
          {"cells_by_mean_visits", agreement(recorded, truth, usual)},
          {"cells_by_own_visits", agreement(recorded, truth, lucky)},
          {"speed", bias.json()}};
}

}  // namespace millscope::camera
