#include "studies/analysis/mirror.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace millscope::analysis {
namespace {

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
    rule.reversed = {array.has(kAlongX)};
    rule.changes_sign = array.has(kAlongX);
    return rule;
  }
  bool along_x = false;
  for (std::size_t d = 0; d < array.shape.size(); ++d) {
    const ResultArray* const axis = results.axis(array, d);
    rule.reversed.push_back(axis != nullptr && axis->has(kAlongX));
    along_x = along_x || rule.reversed.back();
  }
  rule.changes_sign = array.has(kOdd);
  rule.first_changes_sign = array.has(kFirstOdd) && !array.value.empty();
  if (along_x && array.has(kCumulative)) rule.complement = array.unit == "%" ? 100 : 1;
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

}  // namespace millscope::analysis
