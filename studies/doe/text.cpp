// An analysis as text.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "kernel/base/error.hpp"
#include "studies/doe/analysis.hpp"
#include "kernel/base/columns.hpp"
#include "studies/picture/scale.hpp"

namespace millscope::doe {
namespace {

using Index = Eigen::Index;
using picture::significant_text;

std::string number(double value) { return std::isinf(value) ? "∞" : significant_text(value, 4); }
std::string blank_if_undefined(double value) { return std::isnan(value) ? "" : number(value); }
std::string p_text(double p) { return std::isnan(p) ? "" : p < 0.0001 ? "<0.0001" : fmt::format("{:.4f}", p); }
std::string percent(double share) { return std::isnan(share) ? "" : fmt::format("{:.1f} %", 100 * share); }

/// Mean square, F, p, confidence level.
base::Row sum_row(base::Row before, const SumOfSquares& sum, bool tested) {
  before.insert(before.end(), {number(sum.value), std::to_string(sum.df), blank_if_undefined(sum.mean_square())});
  if (tested) before.insert(before.end(), {blank_if_undefined(sum.F), p_text(sum.p), percent(sum.confidence())});
  return before;
}

void add_error_rows(std::vector<base::Row>& rows, const base::Row& blanks, const SumOfSquares& residual, const SumOfSquares& lack,
                    const SumOfSquares& pure) {
  const auto row = [&blanks](const char* name) {
    base::Row begin{name};
    begin.insert(begin.end(), blanks.begin(), blanks.end());
    return begin;
  };
  rows.push_back(sum_row(row("residual"), residual, false));
  if (pure.df == 0) return;
  rows.push_back(sum_row(row("  lack of fit"), lack, true));
  rows.push_back(sum_row(row("  pure error"), pure, false));
}

std::string aliases_of(const Effect& e) { return e.alias.empty() ? "" : fmt::format(" (= {})", e.alias); }

std::string pooled_text(const Anova& anova) {
  std::string text;
  for (const Effect& e : anova.effects) {
    if (e.pooled)
      text += fmt::format("{}{}{} effect {}, SS {}", text.empty() ? "" : "; ", e.name, aliases_of(e), number(e.value), number(e.sum.value));
  }
  return text.empty() ? "" : "in the residual: " + text + "\n";
}

std::string descent_text(const Anova& anova, const Descent& descent) {
  std::vector<Eigen::VectorXd> path;
  try {
    path = steepest_descent(anova, descent.step, descent.steps, descent.largest_p);
  } catch (const base::UserError& e) {
    return fmt::format("steepest descent: {}\n", e.what());
  }
  std::vector<base::Row> rows{{"step"}};
  for (const Factor& f : anova.factors) rows[0].push_back(f.name);
  for (std::size_t step = 0; step < path.size(); ++step) {
    rows.push_back({std::to_string(step)});
    for (const double value : natural(anova.factors, path[step])) rows.back().push_back(number(value));
  }
  return fmt::format("steepest descent, to smaller values (factors with p > {:g} stay at their centre)\n{}", descent.largest_p,
                     base::columns_of_numbers(rows));
}

std::string text_of(const Anova& anova, const TableAnalysis& analysis) {
  std::vector<base::Row> rows{{"source", "effect", "std. error", "SS", "df", "mean square", "F", "p", "significant at"}};
  for (const Effect& e : anova.effects) {
    if (!e.pooled) rows.push_back(sum_row({e.name + aliases_of(e), number(e.value), blank_if_undefined(e.standard_error)}, e.sum, true));
  }
  if (anova.curvature) rows.push_back(sum_row({"curvature", "", ""}, *anova.curvature, true));
  add_error_rows(rows, {"", ""}, anova.residual, anova.lack_of_fit, anova.pure_error);
  rows.push_back(sum_row({"total", "", ""}, anova.total, false));
  std::string text = fmt::format("{}, mean of the factorial runs {}\n{}{}",
                                 anova.model == TwoLevelModel::main_effects ? "main effects" : "main effects and interactions",
                                 number(anova.mean), base::columns_of_numbers(rows), pooled_text(anova));
  for (const std::string& note : anova.notes) text += "note: " + note + "\n";
  return text + descent_text(anova, analysis.descent);
}

std::string region_text(const Surface& s, const StationaryRegion& region) {
  std::string text =
      fmt::format("{:g} % confidence region of that point (Box and Hunter), within the range of the runs: ", 100 * region.confidence);
  if (std::isnan(region.low[0])) return text + "no point of it\n";
  for (std::size_t i = 0; i < s.factors.size(); ++i) {
    const Factor& f = s.factors[i];
    const Index at = static_cast<Index>(i);
    text += fmt::format("{}{} {} … {}{}", i > 0 ? ", " : "", f.name, number(f.centre + f.step * region.low[at]),
                        number(f.centre + f.step * region.high[at]), region.bounded[i] ? "" : " (not bounded by these runs)");
  }
  return text + fmt::format("; {:.1f} % of the box\n", 100 * region.share);
}

std::string least_text(const Surface& s) {
  if (s.factors.size() > 8) return "";
  const Eigen::VectorXd least = least_within(s, s.lower, s.upper), place = natural(s.factors, least);
  std::string text = "least fitted value in the range of the runs:";
  for (std::size_t i = 0; i < s.factors.size(); ++i)
    text += fmt::format("{} {} = {}", i > 0 ? "," : "", s.factors[i].name, number(place[static_cast<Index>(i)]));
  const double error = standard_error_at(s, least);
  return text + fmt::format(": {}{}\n", number(value_at(s, least)), std::isnan(error) ? "" : " ± " + significant_text(error, 2));
}

std::string stationary_text(const Surface& s) {
  if (!s.stationary) return "the surface has no curvature, so no stationary point\n" + least_text(s);
  const StationaryPoint& p = *s.stationary;
  std::string text = fmt::format("stationary point: {}; fitted value {}\n", p.sentence, number(p.value));
  if (p.region) text += region_text(s, *p.region);
  return text + least_text(s);
}

std::string text_of(const Surface& s, const TableAnalysis&) {
  std::vector<base::Row> terms{{"term (coded)", "coefficient", "std. error", "partial SS", "sequential SS", "F", "p"}};
  for (const Coefficient& c : s.coefficients) {
    const bool mean = c.factors.empty();
    terms.push_back({c.name, number(c.value), blank_if_undefined(c.standard_error), mean ? "" : number(c.partial),
                     mean ? "" : number(c.sequential), mean ? "" : blank_if_undefined(c.F), mean ? "" : p_text(c.p)});
  }
  std::vector<base::Row> sums{{"source", "SS", "df", "mean square", "F", "p", "significant at"}, sum_row({"model"}, s.model, true)};
  add_error_rows(sums, {}, s.residual, s.lack_of_fit, s.pure_error);
  sums.push_back(sum_row({"total"}, s.total, false));
  std::string text = fmt::format("second-order surface, R² {:.3f}{}\n{}\n{}{}\n", s.r_squared,
                                 std::isnan(s.adjusted_r_squared) ? "" : fmt::format(", adjusted {:.3f}", s.adjusted_r_squared),
                                 base::columns_of_numbers(terms), base::columns_of_numbers(sums), s.lack_of_fit_sentence);
  for (const std::string& note : s.notes) text += "note: " + note + "\n";
  return text + stationary_text(s);
}

const std::vector<Residual>& residuals_of(const Result& result) {
  return std::visit([](const auto& r) -> const std::vector<Residual>& { return r.residuals; }, result);
}

/// Every response's runs that stand out, in one place.
std::string outlier_text(const TableAnalysis& analysis) {
  std::vector<base::Row> rows{{"run", "response", "observed", "fitted", "studentised residual", "p of the largest of all"}};
  for (std::size_t r = 0; r < analysis.results.size(); ++r) {
    const auto& residuals = residuals_of(analysis.results[r]);
    for (std::size_t run = 0; run < residuals.size(); ++run) {
      if (!residuals[run].stands_out) continue;
      const double observed = analysis.table.values[r][static_cast<Index>(run)];
      rows.push_back({analysis.table.labels[run], analysis.table.responses[r], number(observed), number(observed - residuals[run].value),
                      number(residuals[run].studentised), p_text(residuals[run].p)});
    }
  }
  if (rows.size() == 1)
    return fmt::format("runs that stand out (externally studentised residual beyond ±{:g}): none, in any response\n", kStandsOut);
  return fmt::format(
      "runs that stand out (externally studentised residual beyond ±{:g})\n{}Look at these runs before believing the fits: a small p "
      "speaks for a faulty "
      "run, a large one may also mean that the model bends where it should not.\n",
      kStandsOut, base::columns_of_numbers(rows));
}

}  // namespace

std::string analysis_text(const TableAnalysis& analysis) {
  const RecognisedTable& t = analysis.table;
  std::string text = fmt::format("{}: {}\n", analysis.file, t.description);
  std::vector<base::Row> levels{{"factor", "centre", "step (coded 1)"}};
  for (const Factor& f : t.design.factors) levels.push_back({f.name, number(f.centre), number(f.step)});
  text += base::columns_of_numbers(levels);
  if (!t.generators.empty()) text += fmt::format("defining relation: {}\n", fmt::join(t.generators, ", "));
  if (!t.design.aliases.empty()) text += fmt::format("aliases, up to two factors: {}\n", fmt::join(t.design.aliases, "; "));
  for (const std::string& note : t.notes) text += "note: " + note + "\n";
  for (std::size_t r = 0; r < analysis.results.size(); ++r) {
    text += fmt::format("\n== {}: ", t.responses[r]) +
            std::visit([&](const auto& result) { return text_of(result, analysis); }, analysis.results[r]);
  }
  return text + "\n" + outlier_text(analysis);
}

}  // namespace millscope::doe
