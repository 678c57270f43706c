// Effects and surfaces as pictures.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "kernel/base/error.hpp"
#include "studies/doe/analysis.hpp"
#include "studies/doe/least_squares.hpp"
#include "studies/picture/picture.hpp"

namespace millscope::doe {
namespace {

using Index = Eigen::Index;
constexpr int kCells = 80;

/// Effects with their intervals, pooled ones without.
void draw(const Anova& anova, const std::string& response, const TableAnalysis& analysis, const std::filesystem::path& stem) {
  const double quantile = anova.residual.df > 0 ? t_quantile(1 - analysis.confidence, anova.residual.df) : kUndefined;
  picture::Curve curve{.label = "effect", .x = {}, .value = {}};
  std::string note;
  for (const Effect& e : anova.effects) {
    const double half = quantile * e.standard_error;
    curve.x.push_back(static_cast<double>(curve.x.size() + 1));
    curve.value.push_back(e.value);
    curve.low.push_back(e.value - half);
    curve.high.push_back(e.value + half);
    note += fmt::format("{}{:.0f}: {}{}", note.empty() ? "" : ", ", curve.x.back(), e.name, e.pooled ? " (in the residual)" : "");
  }
  picture::draw_curves({.title = "Effects on " + response,
                        .subtitle = analysis.table.description,
                        .x_label = "effect",
                        .x_unit = "",
                        .value_label = "mean at the high level less mean at the low one",
                        .value_unit = "",
                        .curves = {curve},
                        .band = fmt::format("{:g} % interval", 100 * analysis.confidence),
                        .zero_line = true,
                        .points = true,
                        .note = note},
                       stem);
}

/// The two factors along which the fitted value changes most, the others at their centre.
std::array<Index, 2> widest(const Surface& s) {
  std::vector<std::pair<double, Index>> spans;
  for (Index i = 0; i < s.lower.size(); ++i) {
    double low = value_at(s, Eigen::VectorXd::Zero(s.lower.size())), high = low;
    for (int step = 0; step <= 8; ++step) {
      Eigen::VectorXd x = Eigen::VectorXd::Zero(s.lower.size());
      x[i] = s.lower[i] + (s.upper[i] - s.lower[i]) * step / 8;
      low = std::min(low, value_at(s, x));
      high = std::max(high, value_at(s, x));
    }
    spans.push_back({low - high, i});
  }
  std::sort(spans.begin(), spans.end());
  std::array<Index, 2> found{spans[0].second, spans[1].second};
  std::sort(found.begin(), found.end());
  return found;
}

picture::CellAxis axis_of(const Surface& s, Index i) {
  const Factor& f = s.factors[i];
  picture::CellAxis axis{f.name, f.unit, {}};
  for (int edge = 0; edge <= kCells; ++edge)
    axis.edges.push_back(f.centre + f.step * (s.lower[i] + (s.upper[i] - s.lower[i]) * edge / kCells));
  return axis;
}

std::vector<double> cells_of(const Surface& s, Index across, Index up) {
  std::vector<double> cells;
  Eigen::VectorXd x = Eigen::VectorXd::Zero(s.lower.size());
  const auto middle = [&s](Index i, int cell) { return s.lower[i] + (s.upper[i] - s.lower[i]) * (cell + 0.5) / kCells; };
  for (int row = 0; row < kCells; ++row) {
    for (int column = 0; column < kCells; ++column) {
      x[across] = middle(across, column);
      x[up] = middle(up, row);
      cells.push_back(value_at(s, x));
    }
  }
  return cells;
}

void mark_stationary(picture::MapPicture& picture, const Surface& s, Index across, Index up) {
  if (!s.stationary || !s.stationary->inside) return;
  const StationaryPoint& p = *s.stationary;
  picture.marks.push_back({name_of(p.kind), p.natural[across], p.natural[up]});
  if (!p.region || std::isnan(p.region->low[0])) return;
  const Eigen::VectorXd low = natural(s.factors, p.region->low), high = natural(s.factors, p.region->high);
  picture.outlines.push_back(
      {{low[across], low[up]}, {high[across], low[up]}, {high[across], high[up]}, {low[across], high[up]}, {low[across], low[up]}});
  picture.note = fmt::format("Dashed: the extent of the {:g} % confidence region of the stationary point. ", 100 * s.confidence);
}

void draw(const Surface& s, const std::string& response, const TableAnalysis& analysis, const std::filesystem::path& stem) {
  const auto [across, up] = widest(s);
  picture::MapPicture picture{.title = "Fitted " + response,
                              .subtitle = analysis.table.description + (s.rejected ? " · the quadratic is rejected" : ""),
                              .x = axis_of(s, across),
                              .y = axis_of(s, up),
                              .value = {response, "", cells_of(s, across, up)},
                              .scale = picture::ColorScale::sequential};
  mark_stationary(picture, s, across, up);
  if (s.lower.size() > 2) picture.note += "The other factors stand at their centre.";
  picture::draw_map(picture, stem);
}

/// Letters, digits, '-' and '_' only.
std::string file_name(std::string name) {
  for (char& c : name) c = std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '_' ? c : '_';
  return name;
}

}  // namespace

std::vector<std::filesystem::path> draw_analysis(const TableAnalysis& analysis, const std::filesystem::path& directory) {
  std::vector<std::filesystem::path> drawn;
  for (std::size_t r = 0; r < analysis.results.size(); ++r) {
    const std::string& response = analysis.table.responses[r];
    const auto* surface = std::get_if<Surface>(&analysis.results[r]);
    if (surface && surface->factors.size() < 2) continue;
    drawn.push_back(directory / (file_name(std::filesystem::path(analysis.file).stem().string()) + "-" + file_name(response)));
    std::visit([&](const auto& result) { draw(result, response, analysis, drawn.back()); }, analysis.results[r]);
  }
  return drawn;
}

}  // namespace millscope::doe
