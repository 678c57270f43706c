#include "studies/compare/elements.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "studies/compare/family_test.hpp"
#include "studies/picture/results_pictures.hpp"
#include "studies/picture/scale.hpp"

namespace millscope::compare {
namespace {

constexpr std::size_t kFewestCells = 4;  // of a region
constexpr double kFewestBlocks = 10;     // effective ones that a single number must rest on
constexpr double kFewestOfMany = 10;     // and a value among many, whose error the others support
constexpr double kRounding = 1e-12;      // fractions and percents below it are zero

std::uint8_t flags_of(const analysis::ResultArray& array, std::size_t i) {
  return i < array.flags.size() ? array.flags[i] : static_cast<std::uint8_t>(analysis::kNoUncertainty);
}
double error_of(const analysis::ResultArray& array, std::size_t i) { return i < array.sem.size() ? array.sem[i] : 0; }
bool is_exact(const analysis::ResultArray& array, std::size_t i) { return error_of(array, i) == 0; }
/// The same in every block.
bool is_the_same(const analysis::ResultArray& array, std::size_t i) { return (flags_of(array, i) & analysis::kNoUncertainty) != 0; }

/// Rounding errors are no differences.
double cleaned(double value, const std::string& unit) { return (unit == "1" || unit == "%") && std::abs(value) < kRounding ? 0 : value; }

bool shows_motion(const std::string& unit) { return unit == "m/s" || unit == "rad/s" || unit == "m^2/s^2" || unit == "m/s^2"; }

void append_draws(std::vector<std::vector<float>>& columns, const analysis::ResultArray& array, std::size_t i) {
  std::vector<float> column;
  const std::size_t n = array.size();
  for (std::size_t r = 0; r < array.draws.size() / n; ++r) column.push_back(array.draws[r * n + i]);
  columns.push_back(std::move(column));
}

std::vector<float> draw_major(const std::vector<std::vector<float>>& columns) {
  std::vector<float> out;
  for (std::size_t r = 0; !columns.empty() && r < columns.front().size(); ++r) {
    for (const auto& column : columns) out.push_back(column[r]);
  }
  return out;
}

/// Builds one observable, element by element.
class Builder {
 public:
  Builder(const analysis::ResultSet& a, const analysis::ResultSet& b, const ResultPair& pair)
      : results_(a), pair_(pair), a_(a.arrays[pair.a]), b_(b.arrays[pair.b]), mill_(mill_place(a)) {
    begin();
  }

  PreparedObservable build() {
    if (picture::category_names(a_).empty()) {
      for (std::size_t i = 0; i < a_.size(); ++i) add_value(i);
    }
    return finished();
  }

  PreparedObservable build_regions() {
    if (a_.shape.size() != 2) return {};
    const PreparedObservable whole = build();
    const std::vector<std::vector<float>> cells_a = std::move(draws_a_), cells_b = std::move(draws_b_);
    out_ = {}, draws_a_.clear(), draws_b_.clear();
    begin();
    out_.compared.name += " by region";
    out_.compared.by_region = true;
    add_regions({whole.compared.elements, whole.tested, cells_a, cells_b});
    return finished();
  }

 private:
  void begin() {
    out_.compared.array_a = pair_.a, out_.compared.array_b = pair_.b;
    out_.compared.name = a_.analyzer + "." + a_.name;
    out_.compared.unit = a_.unit;
  }
  PreparedObservable finished() {
    out_.tested.draws_a = draw_major(draws_a_), out_.tested.draws_b = draw_major(draws_b_);
    return std::move(out_);
  }

  void add_value(std::size_t i) {
    const double a = cleaned(a_.value[i], a_.unit), b = cleaned(b_.value[i], b_.unit);
    if (!std::isfinite(a) || !std::isfinite(b) || (a == 0 && b == 0)) return;
    if (a == b && (is_the_same(a_, i) || is_the_same(b_, i))) return;  // 100 % below the last edge
    if (is_exact(a_, i) && is_exact(b_, i)) {
      out_.exact_differences += std::abs(a - b) > 1e-9 * std::max(std::abs(a), std::abs(b)) ? 1 : 0;
      return;
    }
    if (!is_fit(a_, i) || !is_fit(b_, i)) {
      ++out_.compared.too_few;
      return;
    }
    append_draws(draws_a_, a_, i), append_draws(draws_b_, b_, i);
    add({where_text(results_, a_, i, mill_), i, a, b, {}}, {error_of(a_, i), a_.effective_blocks[i]},
        {error_of(b_, i), b_.effective_blocks[i]});
  }

  bool is_fit(const analysis::ResultArray& array, std::size_t i) const {
    // Exact on one side only (no visit in any block, all visits alike) is no knowledge, but a visit that did not come.
    const bool unusable = (flags_of(array, i) & (analysis::kOftenUndefined | analysis::kNoUncertainty)) != 0 || !(error_of(array, i) > 0);
    return !array.draws.empty() && !unusable && array.effective_blocks[i] >= (array.size() < kMany ? kFewestBlocks : kFewestOfMany);
  }

  struct Precision {
    double error, blocks;
  };
  void add(ComparedElement element, const Precision& a, const Precision& b) {
    TestedObservable& t = out_.tested;
    t.difference.push_back(element.b - element.a);
    t.error_a.push_back(a.error), t.error_b.push_back(b.error);
    t.blocks_a.push_back(std::max(2.0, a.blocks)), t.blocks_b.push_back(std::max(2.0, b.blocks));
    out_.compared.elements.push_back(std::move(element));
  }

  /// What a map's cells have become.
  struct Cells {
    const std::vector<ComparedElement>& elements;
    const TestedObservable& tested;
    const std::vector<std::vector<float>>&draws_a, &draws_b;
  };

  void add_regions(const Cells& cells) {
    const picture::CellAxis y = picture::cell_axis(results_, a_, 0), x = picture::cell_axis(results_, a_, 1);
    if (!picture::is_cross_section(y, x)) return;
    std::vector<std::size_t> place(a_.size(), cells.elements.size());  // of each cell among the elements
    for (std::size_t k = 0; k < cells.elements.size(); ++k) place[cells.elements[k].index] = k;
    const std::vector<base::Region> regions = base::regions_of(y.edges, x.edges, mill_);
    for (std::size_t r = 0; r < regions.size(); ++r) {
      std::vector<std::size_t> judged;
      for (const std::size_t cell : regions[r].cells) {
        if (place[cell] < cells.elements.size()) judged.push_back(place[cell]);
      }
      if (judged.size() >= kFewestCells) add_region({regions[r].name, r, 0, 0, {}}, judged, cells);
    }
  }

  void add_region(ComparedElement element, const std::vector<std::size_t>& judged, const Cells& cells) {
    const TestedObservable& t = cells.tested;
    std::vector<double> weight;
    for (const std::size_t k : judged) {
      weight.push_back(shows_motion(a_.unit) ? 1 / (std::pow(t.error_a[k], 2) + std::pow(t.error_b[k], 2)) : 1);
    }
    const double sum = std::accumulate(weight.begin(), weight.end(), 0.0);
    Precision a{0, 0}, b{0, 0};
    std::vector<float> of_a(cells.draws_a.front().size(), 0), of_b(cells.draws_b.front().size(), 0);
    for (std::size_t m = 0; m < judged.size(); ++m) {
      const std::size_t k = judged[m];
      const double w = weight[m] / sum;
      element.a += w * cells.elements[k].a, element.b += w * cells.elements[k].b;
      a.blocks += w * t.blocks_a[k], b.blocks += w * t.blocks_b[k];
      accumulate(of_a, cells.draws_a[k], w), accumulate(of_b, cells.draws_b[k], w);
    }
    a.error = deviation(of_a), b.error = deviation(of_b);
    if (!(a.error + b.error > 0)) return;
    draws_a_.push_back(std::move(of_a)), draws_b_.push_back(std::move(of_b));
    add(std::move(element), a, b);
  }

  static void accumulate(std::vector<float>& sum, const std::vector<float>& draws, double weight) {
    for (std::size_t r = 0; r < sum.size(); ++r) {
      if (!std::isnan(draws[r])) sum[r] += static_cast<float>(weight) * draws[r];
    }
  }
  static double deviation(const std::vector<float>& draws) {
    double mean = 0, squares = 0;
    for (const float d : draws) mean += static_cast<double>(d) / static_cast<double>(draws.size());
    for (const float d : draws) squares += std::pow(static_cast<double>(d) - mean, 2);
    return std::sqrt(squares / static_cast<double>(draws.size() - 1));
  }

  const analysis::ResultSet& results_;
  ResultPair pair_;
  const analysis::ResultArray &a_, &b_;
  base::MillPlace mill_;
  std::vector<std::vector<float>> draws_a_, draws_b_;
  PreparedObservable out_;
};

std::string along(const picture::CellAxis& axis, std::size_t i) {
  const double low = axis.edges[i], high = axis.edges[i + 1];
  const picture::DisplayUnit unit = picture::display_unit(axis.unit, std::max(std::abs(axis.edges.front()), std::abs(axis.edges.back())));
  if (axis.label == "number") return fmt::format("number {}", i + 1);
  return fmt::format("{} {}{}{}", axis.label, picture::significant_text(unit.factor * std::midpoint(low, high), 3),
                     unit.text.empty() ? "" : " ", unit.text);
}

}  // namespace

base::MillPlace mill_place(const analysis::ResultSet& results) {
  return base::mill_place(results.meta.context.mill_radius, results.meta.context.omega);
}

std::string place_text(double x, double y, const base::MillPlace& mill) {
  const std::string place = fmt::format("x {} mm, y {} mm", picture::number_text(1e3 * x, 1), picture::number_text(1e3 * y, 1));
  return mill.known() ? fmt::format("{} ({})", place, base::place_in_mill(x, y, mill)) : place;
}

std::string where_text(const analysis::ResultSet& results, const analysis::ResultArray& array, std::size_t index,
                       const base::MillPlace& mill) {
  if (array.shape.empty()) return "";
  std::vector<picture::CellAxis> axes;
  for (std::size_t d = 0; d < array.shape.size(); ++d) axes.push_back(picture::cell_axis(results, array, d));
  std::vector<std::size_t> at(axes.size());
  for (std::size_t d = axes.size(); d-- > 0; index /= array.shape[d]) at[d] = index % array.shape[d];
  if (axes.size() == 2 && picture::is_cross_section(axes[0], axes[1])) {
    const auto middle = [&](std::size_t d) { return std::midpoint(axes[d].edges[at[d]], axes[d].edges[at[d] + 1]); };
    return place_text(middle(1), middle(0), mill);
  }
  std::string text;
  for (std::size_t d = 0; d < axes.size(); ++d) text += (d == 0 ? "" : ", ") + along(axes[d], at[d]);
  return text;
}

PreparedObservable prepare_observable(const analysis::ResultSet& a, const analysis::ResultSet& b, const ResultPair& pair) {
  return Builder(a, b, pair).build();
}

PreparedObservable prepare_regions(const analysis::ResultSet& a, const analysis::ResultSet& b, const ResultPair& pair) {
  return Builder(a, b, pair).build_regions();
}

}  // namespace millscope::compare
