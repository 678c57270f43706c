#include "studies/doe/coding.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>

#include "kernel/base/error.hpp"

namespace millscope::doe {
namespace {

using Index = Eigen::Index;

struct Levels {
  double low, high, middle;  ///< the written level next to the mid-range, or the mid-range
  double tolerance;
};

Levels levels_of(const base::Column& column) {
  const auto [low, high] = std::minmax_element(column.value.begin(), column.value.end());
  Levels levels{*low, *high, (*low + *high) / 2, column.half_digit * (1 + 1e-9) + 1e-9 * (*high - *low)};
  for (const double value : column.value) {
    const double off = std::abs(value - (levels.low + levels.high) / 2);
    if (off <= levels.tolerance && off < 0.25 * (levels.high - levels.low)) levels.middle = value;
  }
  return levels;
}

Design empty_design(const std::vector<FactorColumn>& columns) {
  Design design;
  design.coded.setZero(static_cast<Index>(columns[0].column.value.size()), static_cast<Index>(columns.size()));
  design.kind.resize(columns[0].column.value.size());
  return design;
}

/// A composite plan as far as it is understood: signs of runs, steps of the corners, axial distances as written.
struct Composite {
  Design design;
  std::vector<Levels> levels;
  std::vector<double> step;
  std::set<std::vector<int>> corners;
  struct Axial {
    Index run, factor;
    double distance, tolerance;  ///< coded, as written; what rounding may have changed
  };
  std::vector<Axial> axial;
};

/// Signs of all factors against their middles.
std::vector<int> signs_of(const std::vector<FactorColumn>& columns, const std::vector<Levels>& levels, std::size_t run) {
  std::vector<int> signs;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const double off = columns[i].column.value[run] - levels[i].middle;
    signs.push_back(off == 0 ? 0 : off < 0 ? -1 : 1);
  }
  return signs;
}

/// Corners, axial and centre runs by how many factors leave the middle.
bool sort_runs(Composite& plan, const std::vector<FactorColumn>& columns) {
  for (std::size_t run = 0; run < plan.design.kind.size(); ++run) {
    const std::vector<int> signs = signs_of(columns, plan.levels, run);
    const std::size_t moved = signs.size() - std::count(signs.begin(), signs.end(), 0);
    if (moved != 0 && moved != 1 && moved != signs.size()) return false;
    plan.design.kind[run] = moved == 0 ? "centre" : moved == 1 ? "axial" : "factorial";
    if (moved == signs.size()) plan.corners.insert(signs);
    for (std::size_t i = 0; i < signs.size(); ++i) plan.design.coded(static_cast<Index>(run), static_cast<Index>(i)) = signs[i];
  }
  return !plan.corners.empty();
}

/// The step of each factor: half the distance of its two corner levels, which all corners must share.
bool find_steps(Composite& plan, const std::vector<FactorColumn>& columns) {
  for (std::size_t i = 0; i < columns.size(); ++i) {
    double low = plan.levels[i].high, high = plan.levels[i].low;
    const auto corner = [&](std::size_t run) { return plan.design.kind[run] == "factorial"; };
    for (std::size_t run = 0; run < plan.design.kind.size(); ++run) {
      if (!corner(run)) continue;
      low = std::min(low, columns[i].column.value[run]);
      high = std::max(high, columns[i].column.value[run]);
    }
    const double step = (high - low) / 2;
    if (step <= 0 || std::abs((high + low) / 2 - plan.levels[i].middle) > plan.levels[i].tolerance) return false;
    for (std::size_t run = 0; run < plan.design.kind.size(); ++run) {
      const double value = columns[i].column.value[run];
      if (corner(run) && value != low && value != high) return false;
    }
    plan.step.push_back(step);
  }
  return true;
}

/// Axial distances; both sides of every factor must be there.
bool find_axial(Composite& plan, const std::vector<FactorColumn>& columns) {
  std::set<std::pair<Index, bool>> sides;
  for (std::size_t run = 0; run < plan.design.kind.size(); ++run) {
    if (plan.design.kind[run] != "axial") continue;
    Index factor = 0;
    const Index row = static_cast<Index>(run);
    plan.design.coded.row(row).cwiseAbs().maxCoeff(&factor);
    sides.insert({factor, plan.design.coded(row, factor) > 0});
    plan.axial.push_back({row, factor, std::abs(columns[factor].column.value[run] - plan.levels[factor].middle) / plan.step[factor],
                          plan.levels[factor].tolerance / plan.step[factor]});
  }
  return sides.size() == 2 * columns.size();
}

bool all_are(const Composite& plan, double distance, bool exactly) {
  return std::all_of(plan.axial.begin(), plan.axial.end(),
                     [=](const auto& a) { return std::abs(a.distance - distance) <= (exactly ? 1e-9 : a.tolerance); });
}

/// The distance that a plan of this size usually has and that the written ones round; 0: none.
double usual_distance(const Composite& plan, std::string& name) {
  if (all_are(plan, 1, true)) return name = "face-centred", 1;
  const double balanced = std::pow(static_cast<double>(plan.corners.size()), 0.25);
  if (all_are(plan, balanced, false)) return name = "rotatable", balanced;
  const double spherical = std::sqrt(static_cast<double>(plan.step.size()));
  if (all_are(plan, spherical, false)) return name = "spherical", spherical;
  return 0;
}

double asked_distance(const Composite& plan, const std::string& axial) {
  if (axial == "rotatable") return std::pow(static_cast<double>(plan.corners.size()), 0.25);
  double value = 0;
  const auto [end, error] = std::from_chars(axial.data(), axial.data() + axial.size(), value);
  if (error != std::errc() || end != axial.data() + axial.size() || !(value > 0 && value < 100)) {
    throw base::UserError(fmt::format("--axial '{}': give auto, as-written, rotatable, or a number of steps", axial));
  }
  return value;
}

std::string span_of(const Composite& plan) {
  const auto [least, most] =
      std::minmax_element(plan.axial.begin(), plan.axial.end(), [](const auto& a, const auto& b) { return a.distance < b.distance; });
  return most->distance - least->distance < 1e-9 ? fmt::format("{:.4g}", least->distance)
                                                 : fmt::format("{:.4g} to {:.4g}", least->distance, most->distance);
}

/// Puts the axial runs at their coded places and says how.
void place_axial(Composite& plan, const std::string& axial, std::vector<std::string>& notes) {
  std::string name = "as asked";
  const double distance = axial == "auto" ? usual_distance(plan, name) : axial == "as-written" ? 0 : asked_distance(plan, axial);
  for (const auto& a : plan.axial) plan.design.coded(a.run, a.factor) *= distance > 0 ? distance : a.distance;
  if (distance == 0) {
    notes.push_back(fmt::format("axial runs at {} steps, as written", span_of(plan)));
  } else if (all_are(plan, distance, true)) {
    notes.push_back(fmt::format("axial runs at ±{:.4f} steps ({})", distance, name));
  } else {
    notes.push_back(fmt::format(
        "axial runs at ±{:.4f} steps ({}): as written they stand at {} steps, {}; --axial as-written takes them literally", distance, name,
        span_of(plan), all_are(plan, distance, false) ? "which is the same within the last digit of the table" : "which is not the same"));
  }
}

}  // namespace

std::optional<Coded> code_two_level(const std::vector<FactorColumn>& columns) {
  Coded coded{empty_design(columns), PlanKind::two_level, {}};
  std::vector<Levels> levels;
  for (const FactorColumn& c : columns) {
    levels.push_back(levels_of(c.column));
    coded.design.factors.push_back(
        {c.name, (levels.back().low + levels.back().high) / 2, (levels.back().high - levels.back().low) / 2, ""});
  }
  for (std::size_t run = 0; run < coded.design.kind.size(); ++run) {
    std::size_t in_middle = 0;
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const double value = columns[i].column.value[run];
      const bool low = value == levels[i].low, high = value == levels[i].high;
      if (!low && !high && (value != levels[i].middle || ++in_middle != i + 1)) return std::nullopt;
      coded.design.coded(static_cast<Index>(run), static_cast<Index>(i)) = low ? -1 : high ? 1 : 0;
    }
    if (in_middle != 0 && in_middle != columns.size()) return std::nullopt;
    coded.design.kind[run] = in_middle > 0 ? "centre" : "factorial";
  }
  return coded;
}

std::optional<Coded> code_composite(const std::vector<FactorColumn>& columns, const std::string& axial) {
  if (columns.size() < 2) return std::nullopt;
  Composite plan;
  plan.design = empty_design(columns);
  for (const FactorColumn& c : columns) plan.levels.push_back(levels_of(c.column));
  if (!sort_runs(plan, columns) || !find_steps(plan, columns) || !find_axial(plan, columns)) return std::nullopt;
  Coded coded{{}, PlanKind::central_composite, {}};
  place_axial(plan, axial, coded.notes);
  for (std::size_t i = 0; i < columns.size(); ++i)
    plan.design.factors.push_back({columns[i].name, plan.levels[i].middle, plan.step[i], ""});
  coded.design = std::move(plan.design);
  return coded;
}

Coded code_range(const std::vector<FactorColumn>& columns) {
  Coded coded{empty_design(columns), PlanKind::other, {}};
  coded.design.kind.assign(coded.design.kind.size(), "spread");
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const Levels levels = levels_of(columns[i].column);
    const Factor factor{columns[i].name, (levels.low + levels.high) / 2, (levels.high - levels.low) / 2, ""};
    for (std::size_t run = 0; run < coded.design.kind.size(); ++run) {
      coded.design.coded(static_cast<Index>(run), static_cast<Index>(i)) = (columns[i].column.value[run] - factor.centre) / factor.step;
    }
    coded.design.factors.push_back(factor);
  }
  return coded;
}

}  // namespace millscope::doe
