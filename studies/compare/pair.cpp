#include "studies/compare/pair.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kernel/base/error.hpp"
#include "studies/picture/scale.hpp"

namespace millscope::compare {
namespace {

using base::UserError;

constexpr double kSameGrid = 1e-6;  // of the axis's span

std::string full_name(const analysis::ResultArray& array) { return array.analyzer + "." + array.name; }

bool names(const std::vector<std::string>& list, const analysis::ResultArray& array) {
  return std::any_of(list.begin(), list.end(), [&](const std::string& n) { return n == array.analyzer || n == full_name(array); });
}

bool is_chosen(const CompareOptions& options, const analysis::ResultArray& array) {
  return !array.is_axis && (options.only.empty() || names(options.only, array)) && !names(options.without, array);
}

/// A name that selects nothing is a slip of the pen.
void require_known(const std::vector<std::string>& list, const char* option, const analysis::ResultSet& a, const analysis::ResultSet& b) {
  for (const std::string& name : list) {
    const auto has = [&](const analysis::ResultSet& r) {
      return std::any_of(r.arrays.begin(), r.arrays.end(),
                         [&](const analysis::ResultArray& x) { return x.analyzer == name || full_name(x) == name; });
    };
    if (!has(a) && !has(b))
      throw UserError(fmt::format("--{} {}: neither of the results has it; name an analyzer or ANALYZER.RESULT", option, name));
  }
}

/// One side a recording, the other frames that cannot pass through its camera.
bool lacks_camera(const analysis::ResultMeta& a, const analysis::ResultMeta& b) {
  return (a.source == "recording" && b.source == analysis::kCoarseFrames) ||
         (b.source == "recording" && a.source == analysis::kCoarseFrames);
}

/// What noise and losses of a camera change least: where beads are, and their mean velocities (docs/analyzers.md, pept_grid).
bool stands_without_camera(const analysis::ResultArray& array) {
  return array.name == "occupancy" || array.name == "angular_velocity" || array.name.starts_with("velocity_");
}

std::string camera_remedy() {
  return fmt::format(
      "let your program write frames of numbered beads with velocities every {:.3g} ms, and lay the recording's camera over them "
      "('millscope pept synthesize --like')",
      1e3 * analysis::kCameraInterval);
}

std::string shape_text(const analysis::ResultArray& array) {
  return array.shape.empty() ? "one number" : fmt::format("{} values", fmt::join(array.shape, " × "));
}

std::string range_text(const analysis::ResultArray& axis) {
  return fmt::format("{} from {} to {} {}", shape_text(axis), picture::significant_text(axis.value.front(), 4),
                     picture::significant_text(axis.value.back(), 4), axis.unit);
}

/// What makes grids one. Those of recordings follow the mill's size, which is found from the points where nobody states it.
std::string same_grid_remedy(const std::string& analyzer, const analysis::ResultMeta& a, const analysis::ResultMeta& b) {
  const std::string without = fmt::format("leave it out with --without {}", analyzer);
  const double of_a = 2 * a.context.mill_radius, of_b = 2 * b.context.mill_radius;
  if ((a.source != "recording" && b.source != "recording") || of_a == of_b)
    return fmt::format("analyse both with the same settings of '{}', or {}", analyzer, without);
  return fmt::format(
      "the mill's diameter is {} m in A and {} m in B: state it for both, 'condition: {{mill_diameter: {} m}}' in a recording.yaml, and "
      "analyse again; or {}",
      picture::significant_text(of_a, 4), picture::significant_text(of_b, 4), picture::significant_text(std::max(of_a, of_b), 4), without);
}

void require_same_axis(const analysis::ResultArray& array, const analysis::ResultArray* a, const analysis::ResultArray* b,
                       const std::string& remedy) {
  if (a == nullptr && b == nullptr) return;
  if (a == nullptr || b == nullptr)
    throw UserError(fmt::format("{}: only one of the results has an axis for it; {}", full_name(array), remedy));
  bool same = a->unit == b->unit && a->size() == b->size();
  const double span = std::abs(a->value.back() - a->value.front());
  for (std::size_t i = 0; same && i < a->size(); ++i) same = std::abs(a->value[i] - b->value[i]) <= kSameGrid * span;
  if (!same)
    throw UserError(fmt::format("{}: the grids differ: {} is {} in A and {} in B; {}", full_name(array), a->name, range_text(*a),
                                range_text(*b), remedy));
}

/// Times up to what was analysed, of which one side has more: no setting makes them alike. "" where there are none such.
std::string longer_in_one(const analysis::ResultSet& a, const analysis::ResultSet& b, const ResultPair& pair) {
  const analysis::ResultArray &of_a = a.arrays[pair.a], &of_b = b.arrays[pair.b];
  if (of_a.shape.size() != of_b.shape.size()) return {};
  for (std::size_t d = 0; d < of_a.shape.size(); ++d) {
    const analysis::ResultArray *x = a.axis(of_a, d), *y = b.axis(of_b, d);
    if (x == nullptr || y == nullptr || x->unit != "s" || y->unit != "s") continue;
    const double last_x = x->value.back(), last_y = y->value.back();
    if (std::abs(last_x - last_y) > kSameGrid * std::max(last_x, last_y))
      return fmt::format("its times end with what was analysed, at {} s in A and {} s in B", picture::significant_text(last_x, 4),
                         picture::significant_text(last_y, 4));
  }
  return {};
}

void require_comparable(const analysis::ResultSet& a, const analysis::ResultSet& b, const ResultPair& pair) {
  const analysis::ResultArray &of_a = a.arrays[pair.a], &of_b = b.arrays[pair.b];
  if (of_a.unit != of_b.unit) {
    throw UserError(fmt::format("{}: the units differ: {} in A, {} in B; analyse both with one version and the same settings",
                                full_name(of_a), of_a.unit, of_b.unit));
  }
  if (of_a.shape.size() == of_b.shape.size()) {
    const std::string remedy = same_grid_remedy(of_a.analyzer, a.meta, b.meta);
    for (std::size_t d = 0; d < of_a.shape.size(); ++d) require_same_axis(of_a, a.axis(of_a, d), b.axis(of_b, d), remedy);
  }
  if (of_a.shape != of_b.shape) {
    throw UserError(fmt::format("{}: {} in A, {} in B; analyse both with the same settings of '{}'", full_name(of_a), shape_text(of_a),
                                shape_text(of_b), of_a.analyzer));
  }
}

const char* kind_text(const std::string& source) {
  if (source == analysis::kCoarseFrames) return "imported frames, far apart in time";
  return source == "recording" ? "a recording" : source == "tracks" ? "followed beads of a simulation" : "all beads of a simulation";
}

void note_number(std::vector<std::string>& notes, const char* what, double a, double b, const char* unit) {
  if (a == 0 || b == 0 || std::abs(a - b) <= 1e-3 * std::max(std::abs(a), std::abs(b))) return;
  notes.push_back(
      fmt::format("{} is {} {} in A and {} {} in B", what, picture::significant_text(a, 4), unit, picture::significant_text(b, 4), unit));
}

nlohmann::ordered_json options_of(const analysis::ResultSet& results, const std::string& analyzer) {
  const auto& p = results.meta.provenance;
  if (!p.is_object() || !p.contains("analyzers") || !p["analyzers"].contains(analyzer)) return {};
  return p["analyzers"][analyzer];
}

}  // namespace

bool is_bookkeeping(const analysis::ResultSet& a, const analysis::ResultSet& b, const ResultPair& pair) {
  return a.arrays[pair.a].has(kBookkeeping) || b.arrays[pair.b].has(kBookkeeping);
}

std::vector<ResultPair> pair_results(const analysis::ResultSet& a, const analysis::ResultSet& b, const CompareOptions& options,
                                     std::vector<std::string>& alone) {
  require_known(options.only, "only", a, b);
  require_known(options.without, "without", a, b);
  std::vector<ResultPair> pairs;
  const bool blind = lacks_camera(a.meta, b.meta);
  const auto find = [](const analysis::ResultSet& results, const analysis::ResultArray& like) -> std::size_t {
    const auto same = [&](const analysis::ResultArray& x) { return x.analyzer == like.analyzer && x.name == like.name; };
    return std::find_if(results.arrays.begin(), results.arrays.end(), same) - results.arrays.begin();
  };
  for (std::size_t i = 0; i < a.arrays.size(); ++i) {
    if (!is_chosen(options, a.arrays[i])) continue;
    if (blind && !stands_without_camera(a.arrays[i])) {
      alone.push_back(full_name(a.arrays[i]) + ": needs the recording's camera, for which the frames are too far apart");
      continue;
    }
    const std::size_t j = find(b, a.arrays[i]);
    if (j == b.arrays.size()) {
      alone.push_back(full_name(a.arrays[i]) + ": only in A");
      continue;
    }
    const std::string longer = longer_in_one(a, b, {i, j});
    if (!longer.empty()) {
      alone.push_back(full_name(a.arrays[i]) + ": " + longer);
      continue;
    }
    pairs.push_back({i, j});
    if (!is_bookkeeping(a, b, pairs.back())) require_comparable(a, b, pairs.back());
  }
  for (const analysis::ResultArray& array : b.arrays) {
    if (is_chosen(options, array) && find(a, array) == a.arrays.size()) alone.push_back(full_name(array) + ": only in B");
  }
  if (pairs.empty() && blind) throw UserError("what was asked for needs the recording's camera: " + camera_remedy());
  if (pairs.empty()) throw UserError("the two results have nothing in common that was asked for; analyse both with the same analyzers");
  return pairs;
}

std::vector<std::string> condition_notes(const analysis::ResultSet& a, const analysis::ResultSet& b) {
  std::vector<std::string> notes;
  const AnalyzerContext &of_a = a.meta.context, &of_b = b.meta.context;
  constexpr double kRpm = 9.549296585513721;
  note_number(notes, "the turning speed", std::abs(of_a.omega) * kRpm, std::abs(of_b.omega) * kRpm, "rpm");
  note_number(notes, "the mill's radius", 1e3 * of_a.mill_radius, 1e3 * of_b.mill_radius, "mm");
  note_number(notes, "the mass of the charge", of_a.charge_mass, of_b.charge_mass, "kg");
  note_number(notes, "the mean bead radius", 1e3 * of_a.bead_radius, 1e3 * of_b.bead_radius, "mm");
  if (lacks_camera(a.meta, b.meta)) {
    notes.push_back(
        "the frames are too far apart for the recording's camera: maps of occupancy and velocity alone are compared; for the rest " +
        camera_remedy());
  } else if (a.meta.source != b.meta.source) {
    notes.push_back(
        fmt::format("A is {}, B is {}: a camera blurs and loses beads; put the simulation through it ('millscope pept synthesize') for a "
                    "fair comparison",
                    kind_text(a.meta.source), kind_text(b.meta.source)));
  }
  std::vector<std::string> seen;
  for (const analysis::ResultArray& array : a.arrays) {
    if (std::find(seen.begin(), seen.end(), array.analyzer) != seen.end()) continue;
    seen.push_back(array.analyzer);
    const auto options_a = options_of(a, array.analyzer), options_b = options_of(b, array.analyzer);
    if (!options_a.is_null() && !options_b.is_null() && options_a != options_b)
      notes.push_back(fmt::format("the settings of '{}' differ", array.analyzer));
  }
  return notes;
}

}  // namespace millscope::compare
