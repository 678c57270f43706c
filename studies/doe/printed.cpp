#include "studies/doe/printed.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "kernel/base/error.hpp"
#include "kernel/base/nearest.hpp"
#include "kernel/config/document.hpp"
#include "kernel/base/columns.hpp"
#include "studies/doe/least_squares.hpp"
#include "studies/picture/scale.hpp"

namespace millscope::doe {
namespace {

using base::UserError;

/// Every figure of a result by "term/figure", and the degrees of freedom that each F is tested with.
struct Figures {
  std::map<std::string, double> value;
  std::map<std::string, int> df;
  int against = 0;

  void add(const std::string& term, const SumOfSquares& sum) {
    value[term + "/SS"] = sum.value;
    value[term + "/F"] = sum.F;
    value[term + "/p"] = sum.p;
    df[term] = sum.df;
  }
};

void add_errors(Figures& figures, const SumOfSquares& residual, const SumOfSquares& lack, const SumOfSquares& pure,
                const SumOfSquares& total) {
  figures.add("residual", residual);
  figures.add("lack of fit", lack);
  figures.add("pure error", pure);
  figures.add("total", total);
  figures.against = residual.df;
}

Figures figures_of(const Anova& anova) {
  Figures figures;
  for (const Effect& e : anova.effects) {
    figures.add(e.name, e.sum);
    figures.value[e.name + "/effect"] = e.value;
  }
  if (anova.curvature) figures.add("curvature", *anova.curvature);
  add_errors(figures, anova.residual, anova.lack_of_fit, anova.pure_error, anova.total);
  return figures;
}

Figures figures_of(const Surface& surface) {
  Figures figures;
  for (const Coefficient& c : surface.coefficients) {
    figures.add(c.name, {c.partial, 1, c.F, c.p});
    figures.value[c.name + "/coefficient"] = c.value;
  }
  for (std::size_t i = 0; surface.stationary && i < surface.factors.size(); ++i) {
    figures.value[surface.factors[i].name + "/stationary"] = surface.stationary->natural[static_cast<Eigen::Index>(i)];
  }
  add_errors(figures, surface.residual, surface.lack_of_fit, surface.pure_error, surface.total);
  return figures;
}

/// The cells of the printed table by name.
struct PrintedTable {
  explicit PrintedTable(const base::Table& table)
      : table(table),
        response(table.index_of("response")),
        term(table.index_of("term")),
        figure(table.index_of("figure")),
        printed(table.index_of("printed")),
        number(table.numbers(printed)) {}
  const base::Table& table;
  std::size_t response, term, figure, printed;
  base::Column number;

  std::optional<std::size_t> row_of(const std::string& of_response, const std::string& of_term, const std::string& of_figure) const {
    for (std::size_t row = 0; row < table.rows(); ++row) {
      if (table.cell(row, response) == of_response && table.cell(row, term) == of_term && table.cell(row, figure) == of_figure) return row;
    }
    return std::nullopt;
  }
};

double looked_up(const Figures& figures, const PrintedTable& printed, std::size_t row) {
  const std::string key = printed.table.cell(row, printed.term) + "/" + printed.table.cell(row, printed.figure);
  const auto found = figures.value.find(key);
  if (found != figures.value.end()) return found->second;
  std::vector<std::string> known;
  for (const auto& [name, value] : figures.value) known.push_back(name);
  const std::string nearest = base::nearest(key, known);
  throw UserError(fmt::format("{}: the analysis has no '{}'{}", printed.table.place(row), key,
                              nearest.empty() ? "" : "; did you mean '" + nearest + "'?"));
}

/// What p the printed F allows: F is known to half its last digit.
void hold_against_F(PrintedFigure& figure, const Figures& figures, const PrintedTable& printed, std::size_t row) {
  const auto F = printed.row_of(figure.response, figure.term, "F");
  const auto df = figures.df.find(figure.term);
  const int against = figure.term == "lack of fit" ? figures.df.at("pure error") : figures.against;
  if (figure.figure != "p" || !F || df == figures.df.end() || df->second < 1 || against < 1) return;
  const double half = base::half_digit_of(printed.table.cell(*F, printed.printed)), value = printed.number.value[*F];
  figure.p_of_printed = f_beyond(value, df->second, against);
  const double most = f_beyond(std::max(0.0, value - half), df->second, against), least = f_beyond(value + half, df->second, against);
  const double digit = base::half_digit_of(figure.printed) * (1 + 1e-9);
  figure.contradicts = printed.number.value[row] > most + digit || printed.number.value[row] < least - digit;
}

}  // namespace

std::vector<PrintedFigure> compare_printed(const TableAnalysis& analysis, const base::Table& table) {
  const PrintedTable printed(table);
  std::map<std::string, Figures> of_response;
  for (std::size_t r = 0; r < analysis.results.size(); ++r) {
    of_response[analysis.table.responses[r]] = std::visit([](const auto& result) { return figures_of(result); }, analysis.results[r]);
  }
  std::vector<PrintedFigure> figures;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    PrintedFigure figure{table.cell(row, printed.response), table.cell(row, printed.term), table.cell(row, printed.figure),
                         table.cell(row, printed.printed)};
    const auto found = of_response.find(figure.response);
    if (found == of_response.end()) {
      throw UserError(fmt::format("{}: the analysis has no response '{}'; {}", table.place(row), figure.response,
                                  base::suggestion(figure.response, analysis.table.responses)));
    }
    figure.worked_again = looked_up(found->second, printed, row);
    figure.differs = !(std::abs(figure.worked_again - printed.number.value[row]) <= base::half_digit_of(figure.printed) * (1 + 1e-9));
    hold_against_F(figure, found->second, printed, row);
    figures.push_back(std::move(figure));
  }
  return figures;
}

nlohmann::ordered_json printed_json(const std::vector<PrintedFigure>& figures) {
  auto json = nlohmann::ordered_json::array();
  for (const PrintedFigure& f : figures) {
    json.push_back({{"response", f.response},
                    {"term", f.term},
                    {"figure", f.figure},
                    {"printed", f.printed},
                    {"worked_again", f.worked_again},
                    {"differs", f.differs},
                    {"p_of_printed_F", f.p_of_printed},
                    {"contradicts_F", f.contradicts}});
  }
  return json;
}

std::string printed_text(const std::vector<PrintedFigure>& figures) {
  const auto number = [](double value) { return picture::significant_text(value, 4); };
  std::vector<base::Row> rows{{"response, term", "figure", "printed", "worked again", "", "p of the printed F"}};
  std::size_t differ = 0, contradict = 0;
  for (const PrintedFigure& f : figures) {
    differ += f.differs ? 1 : 0;
    contradict += f.contradicts ? 1 : 0;
    rows.push_back({f.response + ", " + f.term, f.figure, f.printed, number(f.worked_again), f.differs ? "differs" : "agrees",
                    std::isnan(f.p_of_printed) ? "" : number(f.p_of_printed) + (f.contradicts ? ", so the printed p is wrong" : "")});
  }
  return fmt::format(
      "printed figures against this table\n{}{} of {} differ by more than their last digit; {} printed p do not follow from their F\n",
      base::columns_of_numbers(rows), differ, figures.size(), contradict);
}

}  // namespace millscope::doe
