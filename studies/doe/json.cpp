// An analysis as JSON; NaN and infinity become null when it is written.
#include <string>

#include "studies/doe/analysis.hpp"

namespace millscope::doe {
namespace {

using Json = nlohmann::ordered_json;
using Index = Eigen::Index;

Json vector_json(const Eigen::VectorXd& values) { return std::vector<double>(values.begin(), values.end()); }

/// A value for each factor, by name.
Json by_factor(const std::vector<Factor>& factors, const Eigen::VectorXd& values) {
  Json json = Json::object();
  for (std::size_t i = 0; i < factors.size(); ++i) json[factors[i].name] = values[static_cast<Index>(i)];
  return json;
}

Json sum_json(const SumOfSquares& sum) {
  return {{"sum_of_squares", sum.value},       {"df", sum.df}, {"mean_square", sum.mean_square()}, {"F", sum.F}, {"p", sum.p},
          {"significant_at", sum.confidence()}};
}

Json residuals_json(const std::vector<Residual>& residuals, const std::vector<std::string>& labels) {
  Json json = Json::array();
  for (std::size_t run = 0; run < residuals.size(); ++run) {
    const Residual& r = residuals[run];
    json.push_back({{"run", labels[run]},
                    {"residual", r.value},
                    {"leverage", r.leverage},
                    {"studentised", r.studentised},
                    {"p_among_all", r.p},
                    {"stands_out", r.stands_out}});
  }
  return json;
}

Json result_json(const Anova& anova) {
  Json effects = Json::array();
  for (const Effect& e : anova.effects) {
    Json effect = {{"name", e.name}, {"alias", e.alias}, {"effect", e.value}, {"standard_error", e.standard_error}, {"pooled", e.pooled}};
    effect.update(sum_json(e.sum));
    effects.push_back(std::move(effect));
  }
  return {{"model", anova.model == TwoLevelModel::main_effects ? "main" : "interactions"},
          {"mean", anova.mean},
          {"effects", effects},
          {"curvature", anova.curvature ? sum_json(*anova.curvature) : Json()},
          {"residual", sum_json(anova.residual)},
          {"lack_of_fit", sum_json(anova.lack_of_fit)},
          {"pure_error", sum_json(anova.pure_error)},
          {"total", sum_json(anova.total)},
          {"notes", anova.notes}};
}

Json region_json(const StationaryRegion& region, const std::vector<Factor>& factors) {
  Json bounded = Json::object();
  for (std::size_t i = 0; i < factors.size(); ++i) bounded[factors[i].name] = static_cast<bool>(region.bounded[i]);
  return {{"method", "Box and Hunter 1954"},
          {"confidence", region.confidence},
          {"low", by_factor(factors, natural(factors, region.low))},
          {"high", by_factor(factors, natural(factors, region.high))},
          {"bounded", bounded},
          {"share_of_box", region.share}};
}

Json stationary_json(const Surface& s) {
  if (!s.stationary) return {};
  const StationaryPoint& p = *s.stationary;
  Json axes = Json::array();
  for (const Axis& a : p.axes)
    axes.push_back({{"curvature", a.curvature},
                    {"standard_error", a.standard_error},
                    {"direction", by_factor(s.factors, a.direction)},
                    {"flat", a.flat}});
  return {{"kind", name_of(p.kind)},
          {"natural", by_factor(s.factors, p.natural)},
          {"coded", by_factor(s.factors, p.coded)},
          {"value", p.value},
          {"inside", p.inside},
          {"axes", axes},
          {"region", p.region ? region_json(*p.region, s.factors) : Json()},
          {"sentence", p.sentence}};
}

Json result_json(const Surface& s) {
  Json coefficients = Json::array();
  for (const Coefficient& c : s.coefficients) {
    coefficients.push_back({{"name", c.name},
                            {"value", c.value},
                            {"standard_error", c.standard_error},
                            {"partial_sum_of_squares", c.partial},
                            {"sequential_sum_of_squares", c.sequential},
                            {"F", c.F},
                            {"p", c.p}});
  }
  Json covariance = Json::array();
  for (Index row = 0; row < s.covariance.rows(); ++row) covariance.push_back(vector_json(s.covariance.row(row).transpose()));
  return {{"model", "quadratic"},
          {"coefficients_coded", coefficients},
          {"covariance", covariance},
          {"regression", sum_json(s.model)},
          {"residual", sum_json(s.residual)},
          {"lack_of_fit", sum_json(s.lack_of_fit)},
          {"pure_error", sum_json(s.pure_error)},
          {"total", sum_json(s.total)},
          {"rejected", s.rejected},
          {"lack_of_fit_sentence", s.lack_of_fit_sentence},
          {"r_squared", s.r_squared},
          {"adjusted_r_squared", s.adjusted_r_squared},
          {"stationary_point", stationary_json(s)},
          {"notes", s.notes}};
}

Json plan_json(const RecognisedTable& t) {
  Json factors = Json::array(), runs = Json::array();
  for (const Factor& f : t.design.factors) factors.push_back({{"name", f.name}, {"centre", f.centre}, {"step", f.step}});
  for (std::size_t run = 0; run < t.labels.size(); ++run) {
    runs.push_back({{"run", t.labels[run]},
                    {"kind", t.design.kind[run]},
                    {"coded", vector_json(t.design.coded.row(static_cast<Index>(run)).transpose())}});
  }
  return {{"description", t.description},
          {"factors", factors},
          {"resolution", t.design.resolution},
          {"defining_relation", t.generators},
          {"aliases", t.design.aliases},
          {"notes", t.notes},
          {"runs", runs}};
}

Json descent_json(const TableAnalysis& analysis, const Anova& anova) {
  Json path = Json::array();
  for (const Effect& e : anova.effects) {
    if (e.factors.size() != 1 || e.pooled || e.sum.p > analysis.descent.largest_p || e.value == 0) continue;
    for (const auto& point : steepest_descent(anova, analysis.descent.step, analysis.descent.steps, analysis.descent.largest_p)) {
      path.push_back(by_factor(anova.factors, natural(anova.factors, point)));
    }
    break;
  }
  return path;
}

}  // namespace

nlohmann::ordered_json analysis_json(const TableAnalysis& analysis) {
  Json responses = Json::array();
  for (std::size_t r = 0; r < analysis.results.size(); ++r) {
    Json json{{"name", analysis.table.responses[r]}};
    std::visit(
        [&](const auto& result) {
          json.update(result_json(result));
          json["residuals"] = residuals_json(result.residuals, analysis.table.labels);
        },
        analysis.results[r]);
    if (const auto* anova = std::get_if<Anova>(&analysis.results[r])) json["steepest_descent"] = descent_json(analysis, *anova);
    responses.push_back(std::move(json));
  }
  return {{"schema_version", 1},
          {"table", analysis.file},
          {"plan", plan_json(analysis.table)},
          {"confidence", analysis.confidence},
          {"responses", responses}};
}

}  // namespace millscope::doe
