#include "studies/compare/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kernel/base/columns.hpp"
#include "kernel/output/file.hpp"
#include "studies/picture/results_pictures.hpp"
#include "studies/picture/scale.hpp"

namespace millscope::compare {
namespace {

using Json = nlohmann::ordered_json;

std::string p_text(double p) { return p < 0.001 ? "<0.001" : fmt::format("{:.3f}", p); }

/// Values of one observable in one unit.
class Numbers {
 public:
  Numbers(const std::string& unit, double largest) : unit_(picture::display_unit(unit, largest)) {}
  std::string operator()(double value) const { return picture::significant_text(value * unit_.factor, 3); }
  const std::string& unit() const { return unit_.text; }

 private:
  picture::DisplayUnit unit_;
};

base::Row row_of(const ComparedObservable& o, std::size_t rank, double level) {
  const ComparedElement& e = o.elements[o.strongest];
  const Numbers shown(o.unit, std::max(std::abs(e.a), std::abs(e.b)));
  return {fmt::format("{}{}", rank, o.adjusted_p <= level ? " *" : ""),  o.name,       shown(e.a),           shown(e.b), shown(e.b - e.a),
          fmt::format("{} … {}", shown(e.test.low), shown(e.test.high)), shown.unit(), p_text(o.adjusted_p), e.where};
}

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json source_json(const analysis::ResultSet& results) {
  return {{"name", results.meta.name},
          {"source", results.meta.source},
          {"description", results.meta.description},
          {"blocks", results.meta.blocks.size()},
          {"omega_rad_s", number(results.meta.context.omega)}};
}

Json observable_json(const ComparedObservable& o, double level) {
  const ComparedElement& e = o.elements[o.strongest];
  return {{"name", o.name},
          {"unit", o.unit},
          {"differs", o.adjusted_p <= level},
          {"adjusted_p", o.adjusted_p},
          {"p", o.p},
          {"judged", o.elements.size()},
          {"too_few_blocks", o.too_few},
          {"strongest",
           {{"where", e.where},
            {"a", e.a},
            {"b", e.b},
            {"difference", e.b - e.a},
            {"error", e.test.error},
            {"low", e.test.low},
            {"high", e.test.high}}}};
}

const char* verdict_name(Verdict verdict) {
  return verdict == Verdict::differ ? "differ" : verdict == Verdict::no_difference ? "no_difference" : "cannot_tell";
}

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

std::string element_columns(const ComparedElement& e) {
  return fmt::format("{},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g}", quoted(e.where), e.a, e.b, e.b - e.a, e.test.error, e.test.low,
                     e.test.high);
}

}  // namespace

std::string comparison_table(const Comparison& comparison, std::size_t rows) {
  if (comparison.observables.empty()) return "";
  std::vector<base::Row> table{{"rank", "observable", "A", "B", "B − A", fmt::format("{:.0f} % interval", 100 * comparison.options.confidence),
                          "unit", "p adjusted", "where"}};
  for (std::size_t i = 0; i < std::min(rows, comparison.observables.size()); ++i) {
    table.push_back(row_of(comparison.observables[i], i + 1, comparison.options.level));
  }
  std::string text = base::columns_to_left(table);
  if (comparison.observables.size() > rows) text += fmt::format("… and {} more\n", comparison.observables.size() - rows);
  return text;
}

Json comparison_json(const Comparison& c) {
  Json json{{"verdict", verdict_name(c.verdict_kind)},
            {"sentence", c.verdict},
            {"level", c.options.level},
            {"confidence", c.options.confidence},
            {"a", source_json(c.a)},
            {"b", source_json(c.b)},
            {"notes", c.notes},
            {"given_quantities_that_differ", c.given},
            {"not_judged", c.not_judged}};
  json["observables"] = Json::array();
  for (const ComparedObservable& o : c.observables) json["observables"].push_back(observable_json(o, c.options.level));
  return json;
}

void write_comparison(const Comparison& c, const std::filesystem::path& directory) {
  std::filesystem::create_directories(directory);
  constexpr const char* kColumns = "where,a,b,difference,error,low,high";
  std::string observables = fmt::format("rank,observable,unit,differs,adjusted_p,p,judged,too_few_blocks,{}\n", kColumns);
  std::string elements = fmt::format("observable,unit,index,adjusted_p,p,{}\n", kColumns);
  for (std::size_t i = 0; i < c.observables.size(); ++i) {
    const ComparedObservable& o = c.observables[i];
    observables += fmt::format("{},{},{},{},{:.6g},{:.6g},{},{},{}\n", i + 1, o.name, o.unit, o.adjusted_p <= c.options.level ? 1 : 0,
                               o.adjusted_p, o.p, o.elements.size(), o.too_few, element_columns(o.elements[o.strongest]));
    for (const ComparedElement& e : o.elements) {
      elements += fmt::format("{},{},{},{:.6g},{:.6g},{}\n", o.name, o.unit, e.index, e.test.adjusted_p, e.test.p, element_columns(e));
    }
  }
  output::write_file(directory / "observables.csv", observables);
  output::write_file(directory / "elements.csv", elements);
  output::write_file(directory / "comparison.json", comparison_json(c).dump(2) + "\n");
}

}  // namespace millscope::compare
