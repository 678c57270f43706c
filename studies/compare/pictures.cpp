// Difference maps and overlaid curves.
#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "studies/compare/elements.hpp"
#include "studies/compare/report.hpp"
#include "studies/picture/results_pictures.hpp"
#include "studies/picture/scale.hpp"

namespace millscope::compare {
namespace {

std::string name_of(const analysis::ResultSet& results, const char* letter) {
  return results.meta.name.empty() ? letter : fmt::format("{}: {}", letter, results.meta.name);
}

std::string sources(const Comparison& c) {
  return fmt::format("A: {} · B: {}", picture::source_line(c.a.meta), picture::source_line(c.b.meta));
}

std::string p_words(const ComparedObservable& o, double level) {
  const std::string p = o.adjusted_p < 0.001 ? "below 0.001" : fmt::format("{:.3f}", o.adjusted_p);
  return fmt::format("{} at {:.0f} % family-wise (adjusted p {}).", o.adjusted_p <= level ? "differs" : "no difference", 100 * level, p);
}

const ComparedObservable* regions_for(const Comparison& c, const ComparedObservable& cells) {
  for (const ComparedObservable& o : c.observables) {
    if (o.by_region && o.array_a == cells.array_a) return &o;
  }
  return nullptr;
}

/// Borders of the regions of this map that differ.
std::vector<picture::Outline> differing_regions(const Comparison& c, const ComparedObservable& by_region, const picture::CellAxis& y,
                                                const picture::CellAxis& x) {
  const std::vector<base::Region> regions = base::regions_of(y.edges, x.edges, mill_place(c.a));
  std::vector<bool> chosen(regions.size(), false);
  for (const ComparedElement& e : by_region.elements) chosen[e.index] = e.test.adjusted_p <= c.options.level;
  return base::borders_of(regions, chosen, mill_place(c.a));
}

/// What the map shows, in words.
std::string map_note(const Comparison& c, const ComparedObservable& cells, const ComparedObservable* by_region, bool any_framed) {
  std::string note = "Cell by cell: " + p_words(cells, c.options.level);
  if (any_framed) note += " Framed: cells that differ, each by itself.";
  if (by_region == nullptr) return note;
  note += " By region: " + p_words(*by_region, c.options.level);
  if (by_region->adjusted_p <= c.options.level)
    note += fmt::format(" Dashed: regions that differ; strongest {}.", by_region->elements[by_region->strongest].where);
  return note;
}

void draw_difference(const Comparison& c, const ComparedObservable& o, const picture::MillOutline& mill,
                     const std::filesystem::path& stem) {
  const analysis::ResultArray& a = c.a.arrays[o.array_a];
  const picture::CellAxis y = picture::cell_axis(c.a, a, 0), x = picture::cell_axis(c.a, a, 1);
  std::vector<double> difference(a.size(), std::numeric_limits<double>::quiet_NaN());
  std::vector<std::uint8_t> framed(a.size(), 0);
  bool any = false;
  for (const ComparedElement& e : o.elements) {
    difference[e.index] = e.b - e.a;
    framed[e.index] = e.test.adjusted_p <= c.options.level ? 1 : 0;
    any = any || framed[e.index] != 0;
  }
  const ComparedObservable* const by_region = regions_for(c, o);
  picture::draw_map(
      {.title = picture::title_of(a.name) + ": B less A",
       .subtitle = sources(c),
       .x = x,
       .y = y,
       .value = {"difference of " + picture::words_of(a.name), a.unit, std::move(difference)},
       .mill = picture::is_cross_section(y, x) ? mill : picture::MillOutline{},
       .scale = picture::ColorScale::diverging,
       .framed = std::move(framed),
       .outlines = by_region != nullptr ? differing_regions(c, *by_region, y, x) : std::vector<picture::Outline>{},
       .blank = o.too_few > 0 ? fmt::format("no data, or ({} cells) too few independent blocks to judge", o.too_few) : "no data",
       .note = map_note(c, o, by_region, any)},
      stem);
}

void draw_overlay(const Comparison& c, const ComparedObservable& o, const std::filesystem::path& stem) {
  const analysis::ResultArray &a = c.a.arrays[o.array_a], &b = c.b.arrays[o.array_b];
  const picture::CellAxis axis = picture::cell_axis(c.a, a, 0);
  const ComparedElement& first = o.elements[o.strongest];
  picture::draw_curves({.title = picture::title_of(a.name),
                        .subtitle = sources(c),
                        .x_label = axis.label,
                        .x_unit = axis.unit,
                        .value_label = picture::words_of(a.name),
                        .value_unit = a.unit,
                        .curves = {picture::curve_of(c.a, a, name_of(c.a, "A")), picture::curve_of(c.b, b, name_of(c.b, "B"))},
                        .band = fmt::format("{:.0f} % intervals, each for itself", 100 * c.a.meta.confidence),
                        .points = axis.label == "number",
                        .note = fmt::format("B less A: {} Strongest: {}.", p_words(o, c.options.level), first.where)},
                       stem);
}

}  // namespace

std::vector<std::filesystem::path> draw_comparison(const Comparison& c, const std::filesystem::path& directory,
                                                   const picture::MillOutline& mill) {
  std::filesystem::create_directories(directory);
  std::vector<std::filesystem::path> drawn;
  for (const ComparedObservable& o : c.observables) {
    const std::size_t rank = c.a.arrays[o.array_a].shape.size();
    if (o.by_region || (rank != 1 && rank != 2)) continue;
    drawn.push_back(directory / o.name);
    if (rank == 2) {
      draw_difference(c, o, mill, drawn.back());
    } else if (c.a.arrays[o.array_a].size() > 1) {
      draw_overlay(c, o, drawn.back());
    } else {
      drawn.pop_back();
    }
  }
  return drawn;
}

}  // namespace millscope::compare
