#include "studies/calibrate/summaries.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <set>
#include <utility>

#include "kernel/base/error.hpp"
#include "kernel/base/mill_regions.hpp"
#include "kernel/base/statistics.hpp"
#include "studies/diagnose/naming/covariance.hpp"

namespace millscope::calibrate {
namespace {

using analysis::ResultArray;
using analysis::ResultSet;
using base::UserError;

constexpr double kShare = 12.5;           // % of the time in a group of bins
constexpr std::size_t kRegions = 6;       // most visited ones
constexpr double kLeastDeviation = 1e-9;  // of a value's magnitude: an exact number must not make a covariance singular

const ResultArray& array_of(const ResultSet& results, const std::string& analyzer, const std::string& name) {
  const ResultArray* found = results.find(analyzer, name);
  if (found == nullptr) throw UserError(fmt::format("{}.{}: the analyzers give no such result here", analyzer, name));
  return *found;
}

bool left_out(const Study& study, ObservableKind kind) {
  const auto& without = study.objective.without;
  return std::find(without.begin(), without.end(), kind) != without.end();
}

/// Neighbouring bins together, up to an eighth of the time.
void add_distribution(const ResultSet& recorded, const std::string& axis, ObservableKind kind, double shown, const std::string& unit,
                      std::vector<Summary>& out) {
  const ResultArray& percent = array_of(recorded, "distributions", axis + "_percent");
  const std::vector<double>& edges = array_of(recorded, "distributions", axis + "_edges").value;
  std::vector<Summary> groups;
  Summary open{{"", "%", kind}, Summary::sum, "distributions", axis + "_percent", "", {}, 1};
  double share = 0;
  for (std::size_t b = 0; b < percent.size(); ++b) {
    open.cells.push_back(b);
    share += percent.value[b];
    if (share < kShare && b + 1 < percent.size()) continue;
    open.observable.name =
        fmt::format("{} {:.3g} to {:.3g}{}", name_of(kind), shown * edges[open.cells.front()], shown * edges[b + 1], unit);
    groups.push_back(open);
    open.cells.clear();
    share = 0;
  }
  if (groups.size() > 1) groups.pop_back();  // follows from the others: all together are 100 %
  out.insert(out.end(), groups.begin(), groups.end());
}

void add_regions(const ResultSet& recorded, const Study& study, std::vector<Summary>& out) {
  const ResultArray& occupancy = array_of(recorded, "pept_grid", "occupancy");
  const base::MillPlace mill = base::mill_place(recorded.meta.context.mill_radius, recorded.meta.context.omega);
  std::vector<base::Region> regions = base::regions_of(recorded.axis(occupancy, 0)->value, recorded.axis(occupancy, 1)->value, mill);
  const auto share = [&](const base::Region& r) {
    return std::accumulate(r.cells.begin(), r.cells.end(), 0.0,
                           [&](double s, std::size_t c) { return s + (std::isnan(occupancy.value[c]) ? 0.0 : occupancy.value[c]); });
  };
  std::stable_sort(regions.begin(), regions.end(), [&](const auto& a, const auto& b) { return share(a) > share(b); });
  if (regions.size() > kRegions) regions.resize(kRegions);
  for (const base::Region& r : regions) {
    if (!left_out(study, ObservableKind::occupancy))
      out.push_back({{"occupancy " + r.name, "%", ObservableKind::occupancy}, Summary::sum, "pept_grid", "occupancy", "", r.cells, 100});
    if (!left_out(study, ObservableKind::region_speed))
      out.push_back(
          {{"speed " + r.name, "m/s", ObservableKind::region_speed}, Summary::mean, "pept_grid", "speed", "occupancy", r.cells, 1});
  }
}

/// A straight line between the values on both sides of a place; NaN where one of them is missing or rests on too little.
template <class Value>
double between(const std::vector<double>& axis, const ResultArray& values, const Value& at, double place) {
  const auto above = std::lower_bound(axis.begin(), axis.end(), place);
  if (above == axis.end() || (above == axis.begin() && place < axis.front())) return std::numeric_limits<double>::quiet_NaN();
  const auto k = above - axis.begin();
  const auto known = [&](std::size_t i) {
    const bool vague = i < values.flags.size() && (values.flags[i] & (analysis::kOftenUndefined | analysis::kNoUncertainty)) != 0;
    return vague ? std::numeric_limits<double>::quiet_NaN() : at(values, i);
  };
  if (axis[k] == place) return known(k);
  const double share = (place - axis[k - 1]) / (axis[k] - axis[k - 1]);
  return (1 - share) * known(k - 1) + share * known(k);
}

double evaluate(const ResultSet& results, const Summary& s, std::optional<std::size_t> draw) {
  const ResultArray& values = array_of(results, s.analyzer, s.result);
  const auto at = [&](const ResultArray& array, std::size_t c) {
    return array.value[c] + (draw ? static_cast<double>(array.draws[*draw * array.size() + c]) : 0.0);
  };
  if (s.kind == Summary::number) return s.factor * at(values, 0);
  if (s.kind == Summary::along) {
    const std::vector<double>& axis = results.axis(values, 0)->value;
    double all = 0;
    for (const double place : s.places) all += between(axis, values, at, place);
    return s.factor * all / static_cast<double>(s.places.size());
  }
  double sum = 0, weight = 0;
  const ResultArray* weights = s.kind == Summary::mean ? &array_of(results, s.analyzer, s.weight) : nullptr;
  for (const std::size_t c : s.cells) {
    const double value = at(values, c), w = weights != nullptr ? std::max(0.0, at(*weights, c)) : 1.0;
    if (!std::isfinite(value) || !std::isfinite(w) || (weights != nullptr && w == 0)) continue;
    sum += w * value;
    weight += w;
  }
  return s.factor * (weights != nullptr ? sum / weight : sum);
}

Histogram histogram(const ResultSet& results, const std::string& axis) {
  const ResultArray& percent = array_of(results, "distributions", axis + "_percent");
  Histogram h{array_of(results, "distributions", axis + "_edges").value, percent.value, percent.sem};
  std::replace_if(
      h.sem.begin(), h.sem.end(), [](double e) { return !std::isfinite(e); }, 0.0);  // a bin without a visit
  return h;
}

double median_blocks(const ResultSet& results) {
  std::vector<double> blocks;
  for (const char* axis : {"x_percent", "y_percent"}) {
    for (const double b : array_of(results, "distributions", axis).effective_blocks) {
      if (std::isfinite(b)) blocks.push_back(b);
    }
  }
  if (blocks.empty()) return static_cast<double>(results.meta.blocks.size());
  return base::quantile(blocks, 0.5);
}

/// Draws of the summaries; where a draw leaves one undefined (a region without a visit) it counts as no deviation.
Eigen::MatrixXd drawn(const ResultSet& results, const std::vector<Summary>& summaries, const Eigen::VectorXd& value) {
  const auto draws = static_cast<Eigen::Index>(results.meta.draws);
  Eigen::MatrixXd all(draws, value.size());
  for (Eigen::Index d = 0; d < draws; ++d) {
    for (Eigen::Index i = 0; i < value.size(); ++i) {
      const double v = evaluate(results, summaries[i], d);
      all(d, i) = std::isfinite(v) ? v : std::isfinite(value[i]) ? value[i] : 0;
    }
  }
  return all;
}

}  // namespace

bool becomes_summary(const std::string& analyzer, const std::string& result, const std::vector<Term>& terms) {
  static const std::set<std::pair<std::string, std::string>> kOwn{
      {"distributions", "x_percent"}, {"distributions", "y_percent"}, {"distributions", "speed_ratio_percent"},
      {"pept_grid", "occupancy"},     {"pept_grid", "speed"},         {"power", "specific_power_gravity"},
      {"power", "centre_of_mass_x"},  {"power", "centre_of_mass_y"}};
  return kOwn.contains({analyzer, result}) ||
         std::any_of(terms.begin(), terms.end(), [&](const Term& t) { return t.analyzer == analyzer && t.result == result; });
}

std::vector<Summary> choose_summaries(const ResultSet& recorded, const Study& study, const SummaryChoice& choice) {
  std::vector<Summary> out;
  if (!left_out(study, ObservableKind::power))
    out.push_back({{"power", "W", ObservableKind::power}, Summary::number, "power", "specific_power_gravity", "", {}, choice.mass});
  if (!left_out(study, ObservableKind::centre)) {
    if (choice.measured_power)
      out.push_back({{kCentreX, "mm", ObservableKind::centre}, Summary::number, "power", "centre_of_mass_x", "", {}, 1e3});
    out.push_back({{kCentreY, "mm", ObservableKind::centre}, Summary::number, "power", "centre_of_mass_y", "", {}, 1e3});
  }
  const auto distribution = [&](ObservableKind kind, const char* axis, double shown, const char* unit) {
    if (!left_out(study, kind)) add_distribution(recorded, axis, kind, shown, unit, out);
  };
  distribution(ObservableKind::x, "x", 1e3, " mm");
  distribution(ObservableKind::y, "y", 1e3, " mm");
  distribution(ObservableKind::speed, "speed_ratio", 1, " of the shell's");
  add_regions(recorded, study, out);
  for (const Term& term : study.objective.terms) {
    const ResultArray* array = recorded.find(term.analyzer, term.result);
    if (array == nullptr || !array->shape.empty() || array->is_axis) {
      throw UserError(
          term.where,
          fmt::format("term '{}': {}; name a single number of an analyzer that runs on recordings ('millscope analyze' lists them)",
                      term.name(), array == nullptr ? "the analyzers give no such result for the recording" : "is no single number"));
    }
    out.push_back({{term.name(), array->unit, ObservableKind::term}, Summary::number, term.analyzer, term.result, "", {}, 1});
  }
  return out;
}

Observation summarise(const ResultSet& results, const std::vector<Summary>& summaries) {
  Observation o;
  o.of = results.meta.description;
  o.value.resize(static_cast<Eigen::Index>(summaries.size()));
  for (std::size_t i = 0; i < summaries.size(); ++i) {
    const double value = evaluate(results, summaries[i], std::nullopt);
    if (!std::isfinite(value) && summaries[i].kind != Summary::mean) {
      throw UserError(fmt::format("'{}' is undefined in {}{}", summaries[i].observable.name, results.meta.description,
                                  summaries[i].kind == Summary::along
                                      ? ": too few beads were seen there; narrow 'from' and 'to' of the profile to where beads always are"
                                      : ""));
    }
    o.observables.push_back(summaries[i].observable);
    o.value[static_cast<Eigen::Index>(i)] = value;
  }
  o.blocks = median_blocks(results);
  if (results.meta.draws < 2 || results.meta.blocks.size() < 2)
    throw UserError(fmt::format("{}: too short for an uncertainty: it holds fewer than two blocks", results.meta.description));
  o.resampled = naming::covariance_of(drawn(results, summaries, o.value));
  o.covariance = few_blocks_factor(o.blocks) * naming::shrunk(o.resampled, o.blocks);
  for (Eigen::Index i = 0; i < o.value.size(); ++i) {
    const double size = std::isfinite(o.value[i]) ? std::fabs(o.value[i]) : 0;
    o.covariance(i, i) = std::max(o.covariance(i, i), std::pow(kLeastDeviation * std::max(size, 1e-3), 2));
  }
  o.x = histogram(results, "x");
  o.speed = histogram(results, "speed_ratio");
  return o;
}

}  // namespace millscope::calibrate
