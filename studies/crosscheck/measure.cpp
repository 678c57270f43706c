#include "studies/crosscheck/measure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>

#include "kernel/base/statistics.hpp"
#include "kernel/output/directory.hpp"
#include "kernel/output/summary.hpp"
#include "studies/analysis/analysis.hpp"
#include "studies/analysis/mill.hpp"

namespace millscope::crosscheck {
namespace {

namespace fs = std::filesystem;
using Vector = std::array<double, 3>;

constexpr double kParts[] = {0.1, 0.5, 0.9};  // of the beads, by which distributions are told

Vector vector_at(std::span<const float> values, std::size_t i) {
  return {static_cast<double>(values[3 * i]), static_cast<double>(values[3 * i + 1]), static_cast<double>(values[3 * i + 2])};
}

double square(const Vector& v) { return v[0] * v[0] + v[1] * v[1] + v[2] * v[2]; }

/// One instant of all beads.
struct Instant {
  std::span<const float> place, velocity, spin;
};

/// Means of instants.
class Means {
 public:
  Means(const output::FrameBeads& beads, const analysis::MillOfCase& mill) : beads_(beads), mill_(mill) {}

  void add(const Instant& now) {
    add_energies(now);
    add_distributions(now);
    contacts_ += contacts_per_bead(now.place, beads_, mill_.period);
    ++count_;
  }

  std::vector<Quantity> quantities() const {
    const auto mean = [&](double sum) { return count_ > 0 ? sum / static_cast<double>(count_) : std::numeric_limits<double>::quiet_NaN(); };
    std::vector<Quantity> all{{kTranslation, "J", mean(translation_)},
                              {"rotational energy", "J", mean(rotation_)},
                              {"angular momentum about the axis", "kg m^2/s", mean(momentum_)},
                              {"contacts per bead", "1", mean(contacts_)}};
    const char *const names[] = {"speed", "x", "y"}, *const units[] = {"m/s", "m", "m"};
    for (std::size_t kind = 0; kind < 3; ++kind) {
      for (std::size_t part = 0; part < std::size(kParts); ++part)
        all.push_back({fmt::format("{}: {:.0f} % of the beads below", names[kind], 100 * kParts[part]), units[kind],
                       mean(distributions_[kind][part])});
    }
    return all;
  }

 private:
  void add_energies(const Instant& now) {
    const Vector &axis = mill_.motion.axis, &point = mill_.motion.point;
    for (std::size_t i = 0; i < beads_.size(); ++i) {
      const double mass = beads_.mass[i], inertia = 0.4 * mass * beads_.radius[i] * beads_.radius[i];
      const Vector x = vector_at(now.place, i), v = vector_at(now.velocity, i), w = vector_at(now.spin, i);
      const Vector arm{x[0] - point[0], x[1] - point[1], x[2] - point[2]};
      const Vector cross{arm[1] * v[2] - arm[2] * v[1], arm[2] * v[0] - arm[0] * v[2], arm[0] * v[1] - arm[1] * v[0]};
      translation_ += 0.5 * mass * square(v);
      rotation_ += 0.5 * inertia * square(w);
      for (std::size_t k = 0; k < 3; ++k) momentum_ += axis[k] * (mass * cross[k] + inertia * w[k]);
    }
  }

  void add_distributions(const Instant& now) {
    std::array<std::vector<double>, 3> values;
    for (std::size_t i = 0; i < beads_.size(); ++i) {
      const Vector x = vector_at(now.place, i);
      values[0].push_back(std::sqrt(square(vector_at(now.velocity, i))));
      values[1].push_back(x[0]), values[2].push_back(x[1]);
    }
    for (std::size_t kind = 0; kind < 3; ++kind) {
      std::sort(values[kind].begin(), values[kind].end());
      for (std::size_t part = 0; part < std::size(kParts); ++part)
        distributions_[kind][part] += base::interpolated_quantile(values[kind], kParts[part]);
    }
  }

  const output::FrameBeads& beads_;
  const analysis::MillOfCase& mill_;
  std::size_t count_ = 0;
  double translation_ = 0, rotation_ = 0, momentum_ = 0, contacts_ = 0;
  std::array<std::array<double, std::size(kParts)>, 3> distributions_{};
};

std::vector<Quantity> of_frames(const fs::path& run, const host::Registry& registry) {
  const analysis::MillOfCase mill = analysis::read_mill_of_case(run / output::kResolvedCase, registry);
  const output::FrameReader reader(run / "frames.h5");
  Means means(reader.beads(), mill);
  std::vector<float> place(3 * reader.beads().size()), velocity = place, spin = place;
  for (std::size_t frame = 0; frame < reader.frame_count(); ++frame) {
    reader.read(output::BeadField::position, frame, 1, place);
    reader.read(output::BeadField::velocity, frame, 1, velocity);
    reader.read(output::BeadField::spin, frame, 1, spin);
    means.add({place, velocity, spin});
  }
  return means.quantities();
}

std::vector<Quantity> of_summary(const fs::path& run) {
  const nlohmann::ordered_json summary = output::read_json(run / "summary.json");
  const nlohmann::ordered_json none, &power = summary.is_object() && summary.contains("power_W") ? summary["power_W"] : none;
  std::vector<Quantity> all{{kPowerByTorque, "W", output::number_in(power, "torque")},
                            {kPowerByCentre, "W", output::number_in(power, "com")}};
  for (std::size_t axis = 0; axis < std::size(kCentre); ++axis) {
    const bool known = summary.is_object() && summary.contains("com_m") && summary["com_m"].is_array() && axis < summary["com_m"].size() &&
                       summary["com_m"][axis].is_number();
    all.push_back({kCentre[axis], "m", known ? summary["com_m"][axis].get<double>() : std::numeric_limits<double>::quiet_NaN()});
  }
  return all;
}

/// The single numbers of charge_features: shoulder, toes, centre of circulation, …
std::vector<Quantity> of_charge(const fs::path& run, const host::Registry& registry) {
  analysis::AnalysisRequest request = analysis::request_of_means(run, {"charge_features"});  // the errors are those between seeds
  request.threads = 1;
  std::vector<Quantity> all;
  analysis::ResultSet results;
  try {
    results = analysis::analyze(request, registry);
  } catch (const base::UserError&) {
    return all;  // a mill that does not turn, or no round one, has none of them
  }
  for (const analysis::ResultArray& result : results.arrays) {
    std::string name = result.name;
    std::replace(name.begin(), name.end(), '_', ' ');
    const bool told = std::find(std::begin(kCentre), std::end(kCentre), name) != std::end(kCentre);  // by the summary
    if (told || !result.shape.empty() || result.is_axis || result.has(kBookkeeping)) continue;
    all.push_back({name, result.unit, result.value[0]});
  }
  return all;
}

}  // namespace

double contacts_per_bead(std::span<const float> place, const output::FrameBeads& beads, double period) {
  const std::size_t n = beads.size();
  if (n == 0) return 0;
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return place[3 * a] < place[3 * b]; });
  const double largest = *std::max_element(beads.radius.begin(), beads.radius.end());
  std::size_t touching = 0;
  for (std::size_t a = 0; a < n; ++a) {
    const Vector here = vector_at(place, order[a]);
    const double reach = beads.radius[order[a]];
    for (std::size_t b = a + 1; b < n; ++b) {
      const Vector there = vector_at(place, order[b]);
      if (there[0] - here[0] > reach + largest) break;
      double along = there[2] - here[2];
      if (period > 0) along -= period * std::round(along / period);
      const double sum = reach + beads.radius[order[b]];
      if (square({there[0] - here[0], there[1] - here[1], along}) < sum * sum) ++touching;
    }
  }
  return 2 * static_cast<double>(touching) / static_cast<double>(n);
}

std::vector<std::string> keep_common(std::vector<std::vector<Quantity>>& runs) {
  std::map<std::string, std::size_t> told;
  std::vector<std::string> names, left_out;
  for (const std::vector<Quantity>& run : runs) {
    for (const Quantity& q : run) {
      const auto [at, is_new] = told.emplace(q.name, 0);
      if (is_new) names.push_back(q.name);
      at->second += std::isfinite(q.value) ? 1 : 0;
    }
  }
  for (const std::string& name : names) {
    if (told[name] < runs.size()) left_out.push_back(name);
  }
  for (std::vector<Quantity>& run : runs) std::erase_if(run, [&](const Quantity& q) { return told[q.name] < runs.size(); });
  return left_out;
}

std::vector<Quantity> measure(const fs::path& run, const host::Registry& registry) {
  std::vector<Quantity> all = of_summary(run);
  for (const std::vector<Quantity>& more : {of_frames(run, registry), of_charge(run, registry)})
    all.insert(all.end(), more.begin(), more.end());
  return all;
}

}  // namespace millscope::crosscheck
