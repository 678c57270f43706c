#include "studies/compare/mirror.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

namespace millscope::studies {
namespace {

bool has_word(const std::string& name, std::string_view word) {
  for (std::size_t begin = 0; begin <= name.size();) {
    const std::size_t end = std::min(name.find('_', begin), name.size());
    if (std::string_view(name).substr(begin, end - begin) == word) return true;
    begin = end + 1;
  }
  return false;
}

bool is_along_x(const ResultArray& axis) { return has_word(axis.name, "x") && axis.unit == "m"; }

/// A length, velocity, acceleration, force.
bool is_vector_unit(const std::string& unit) { return unit == "m" || unit == "m/s" || unit == "m/s^2" || unit == "N"; }

/// Whether the description says that the sign goes with that of Omega or with x.
bool says_signed(const std::string& doc) {
  constexpr std::array<const char*, 3> phrases{"clockwise", "that of Omega", "towards +x"};
  return std::any_of(phrases.begin(), phrases.end(), [&](const char* phrase) { return doc.find(phrase) != std::string::npos; });
}

/// Where the mirrored array takes element `i` from.
std::size_t source_index(std::size_t i, const std::vector<std::size_t>& shape, const std::vector<bool>& reversed) {
  std::size_t source = 0, stride = 1;
  for (std::size_t d = shape.size(); d-- > 0;) {
    const std::size_t at = i % shape[d];
    i /= shape[d];
    source += (reversed[d] ? shape[d] - 1 - at : at) * stride;
    stride *= shape[d];
  }
  return source;
}

template <class T>
std::vector<T> permuted(const std::vector<T>& values, const std::vector<std::size_t>& from) {
  if (values.empty()) return {};
  std::vector<T> out;
  out.reserve(values.size());
  for (std::size_t row = 0; row < values.size() / from.size(); ++row) {
    for (const std::size_t i : from) out.push_back(values[row * from.size() + i]);
  }
  return out;
}

void turn_first(ResultArray& array) {
  array.value[0] = -array.value[0];
  if (array.low.empty()) return;
  const double low = array.low[0];
  array.low[0] = -array.high[0], array.high[0] = -low;
  for (std::size_t r = 0; r < array.draws.size(); r += array.size()) array.draws[r] = -array.draws[r];
}

void apply(const MirrorRule& rule, ResultArray& array) {
  std::vector<std::size_t> from(array.size());
  const std::vector<std::size_t> shape = array.shape.empty() ? std::vector<std::size_t>{1} : array.shape;
  const std::vector<bool> reversed = array.shape.empty() ? std::vector<bool>{false} : rule.reversed;
  for (std::size_t i = 0; i < from.size(); ++i) from[i] = source_index(i, shape, reversed);
  array.value = permuted(array.value, from), array.sem = permuted(array.sem, from);
  array.low = permuted(array.low, from), array.high = permuted(array.high, from);
  array.effective_blocks = permuted(array.effective_blocks, from), array.flags = permuted(array.flags, from);
  array.draws = permuted(array.draws, from);
  if (rule.first_changes_sign) turn_first(array);
  if (!rule.changes_sign && rule.complement == 0) return;
  for (std::vector<double>* values : {&array.value, &array.low, &array.high}) {
    for (double& v : *values) v = rule.complement - v;
  }
  std::swap(array.low, array.high);
  for (float& draw : array.draws) draw = -draw;
}

}  // namespace

bool MirrorRule::changes() const {
  return changes_sign || first_changes_sign || complement != 0 || std::find(reversed.begin(), reversed.end(), true) != reversed.end();
}

MirrorRule mirror_rule(const ResultSet& results, const ResultArray& array) {
  MirrorRule rule;
  if (array.is_axis) {
    rule.reversed = {is_along_x(array)};
    rule.changes_sign = is_along_x(array);
    return rule;
  }
  bool along_x = false;
  for (std::size_t d = 0; d < array.shape.size(); ++d) {
    const ResultArray* const axis = results.axis(array, d);
    rule.reversed.push_back(axis != nullptr && is_along_x(*axis));
    along_x = along_x || rule.reversed.back();
  }
  rule.changes_sign = (has_word(array.name, "x") && is_vector_unit(array.unit)) || says_signed(array.doc);
  const bool is_size = has_word(array.name, "error") || has_word(array.name, "deviation");
  rule.first_changes_sign =
      array.shape == std::vector<std::size_t>{3} && is_vector_unit(array.unit) && array.doc.ends_with("x, y, z.") && !is_size;
  if (along_x && has_word(array.name, "cumulative")) rule.complement = array.unit == "%" ? 100 : 1;
  return rule;
}

ResultSet mirrored(const ResultSet& results, std::vector<std::string>& done) {
  ResultSet out = results;
  std::string signs;
  bool grids = false, cumulative = false;
  for (ResultArray& array : out.arrays) {
    const MirrorRule rule = mirror_rule(results, array);
    if (!rule.changes()) continue;
    apply(rule, array);
    if (array.is_axis) continue;
    grids = grids || std::find(rule.reversed.begin(), rule.reversed.end(), true) != rule.reversed.end();
    cumulative = cumulative || rule.complement != 0;
    if (rule.changes_sign || rule.first_changes_sign)
      signs += fmt::format("{}{}.{}", signs.empty() ? "" : ", ", array.analyzer, array.name);
  }
  out.meta.context.omega = -out.meta.context.omega;
  if (grids) done.emplace_back("grids along x are reversed");
  if (cumulative) done.emplace_back("cumulative shares along x count from the other side");
  if (!signs.empty()) done.push_back("the sign changes in " + signs);
  return out;
}

}  // namespace millscope::studies
