// What every analyzer must hold to.
#pragma once

#include <algorithm>
#include <cstring>
#include <map>

#include "millscope/conformance/frames.hpp"

namespace millscope::conformance {

/// What the checks of an analyzer assume; false for what it does not promise.
struct AnalyzerSetting {
  std::size_t bead_count = 40;
  bool blocks_join = true;          ///< the sums of two blocks that follow each other are those of the whole
  bool ignores_zero_weight = true;  ///< a frame of weight 0 that belongs to no stretch changes nothing
  double tolerance = 1e-9;          ///< relative to the largest number of an array
};

/// One result of an analyzer, kept.
struct KeptResult {
  std::string unit, doc;
  std::vector<std::uint64_t> shape;
  std::vector<double> values;
  std::vector<std::string> axes;  ///< "" where none
};
using KeptResults = std::map<std::string, KeptResult>;

/// An analyzer with its sums, as the host holds it.
class AnalyzerProbe {
 public:
  using Sums = std::vector<std::vector<double>>;

  AnalyzerProbe(const AnalyzerTable& table, const Values& values, const AnalyzerContext& context) : held_(table, values, context) {
    table.arrays(held_.get(), &arrays_, &count_);
  }

  const ArrayInfo* arrays() const { return arrays_; }
  std::uint64_t array_count() const { return count_; }

  Sums zero(double value = 0.0) const {
    Sums sums;
    for (std::uint64_t i = 0; i < count_; ++i) {
      std::uint64_t size = 1;
      for (std::uint32_t axis = 0; axis < arrays_[i].rank; ++axis) size *= arrays_[i].shape[axis];
      sums.emplace_back(size, value);
    }
    return sums;
  }

  /// Adds a block. Throws Refusal with the analyzer's reason.
  void add(const FrameBlock& block, Sums& sums) const {
    std::vector<double*> pointers;
    for (std::vector<double>& array : sums) pointers.push_back(array.data());
    Failure failure{};
    if (held_.table().accumulate(held_.get(), &block, pointers.data(), &failure) != 0) throw Refusal(failure.message);
  }

  /// The results of sums. Throws Refusal with the analyzer's reason, or when a name comes twice.
  KeptResults finish(const Sums& sums) const {
    std::vector<const double*> pointers;
    for (const std::vector<double>& array : sums) pointers.push_back(array.data());
    KeptResults results;
    const ResultSink sink{&results, &AnalyzerProbe::keep};
    Failure failure{};
    if (held_.table().finish(held_.get(), pointers.data(), &sink, &failure) != 0) throw Refusal(failure.message);
    return results;
  }

 private:
  static void keep(void* host, const Result* r) {
    KeptResult kept{r->unit != nullptr ? r->unit : "", r->doc != nullptr ? r->doc : "", {r->shape, r->shape + r->rank}, {}, {}};
    std::uint64_t size = 1;
    for (std::uint32_t axis = 0; axis < r->rank; ++axis) {
      size *= r->shape[axis];
      kept.axes.emplace_back(r->axis[axis] != nullptr ? r->axis[axis] : "");
    }
    kept.values.assign(r->values, r->values + size);
    auto& results = *static_cast<KeptResults*>(host);
    if (!results.emplace(r->name, kept).second) results.emplace(std::string(r->name) + " (twice)", kept);
  }

  Held<AnalyzerTable> held_;
  const ArrayInfo* arrays_ = nullptr;
  std::uint64_t count_ = 0;
};

namespace detail {

/// Frames from `begin` to `end`, one each `1/rate` s; the first weighs nothing where it belongs to the block before.
inline Frames span_of_frames(std::size_t beads, int begin, int end, bool joined) {
  constexpr double step = 2e-3;
  Frames frames(beads);
  for (int f = begin; f <= end; ++f) frames.add(step * f, joined && f == begin ? 0.0 : step);
  return frames;
}

/// Whether two sets of sums agree, relative to the largest number of each array; says where not.
inline bool agree(const AnalyzerProbe& probe, const AnalyzerProbe::Sums& a, const AnalyzerProbe::Sums& b, double tolerance,
                  const char* check, Violations& out) {
  for (std::size_t i = 0; i < a.size(); ++i) {
    double scale = 1e-300;
    for (const double x : a[i]) scale = std::max(scale, std::fabs(x));
    for (std::size_t k = 0; k < a[i].size(); ++k) {
      if (std::fabs(a[i][k] - b[i][k]) <= tolerance * scale) continue;
      return out.push_back({check, std::string("array ") + probe.arrays()[i].name + text_of(": %.12g instead of %.12g", b[i][k], a[i][k])}),
             false;
    }
  }
  return true;
}

inline bool same_results(const KeptResults& a, const KeptResults& b) {
  if (a.size() != b.size()) return false;
  for (const auto& [name, kept] : a) {
    const auto other = b.find(name);
    if (other == b.end() || other->second.values.size() != kept.values.size()) return false;
    if (std::memcmp(other->second.values.data(), kept.values.data(), kept.values.size() * sizeof(double)) != 0) return false;
  }
  return true;
}

inline bool is_lower_case_word(std::string_view name) {
  const auto fits = [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_'; };
  return !name.empty() && name.front() >= 'a' && name.front() <= 'z' && std::all_of(name.begin(), name.end(), fits);
}

inline void arrays_are_described(const AnalyzerProbe& probe, Violations& out) {
  if (probe.array_count() == 0) out.push_back({"arrays", "there is no additive array"});
  for (std::uint64_t i = 0; i < probe.array_count(); ++i) {
    const ArrayInfo& a = probe.arrays()[i];
    const std::string name = a.name != nullptr ? a.name : "";
    if (!is_lower_case_word(name)) out.push_back({"names", "array '" + name + "' is not named in lower_case_words"});
    if (a.unit == nullptr || *a.unit == '\0') out.push_back({"units", "array '" + name + "' has no unit; write \"1\" for none"});
    if (a.rank > kMaxRank) out.push_back({"shapes", "array '" + name + "' has too many dimensions"});
  }
}

inline void results_are_described(const KeptResults& results, Violations& out) {
  if (results.empty()) out.push_back({"results", "there is no result"});
  for (const auto& [name, r] : results) {
    if (!is_lower_case_word(name)) out.push_back({"names", "result '" + name + "' is not one name in lower_case_words"});
    if (r.unit.empty()) out.push_back({"units", "result '" + name + "' has no unit; write \"1\" for none"});
    if (r.doc.empty()) out.push_back({"docs", "result '" + name + "' has no sentence"});
    for (std::size_t axis = 0; axis < r.axes.size(); ++axis) {
      if (r.axes[axis].empty()) continue;
      const auto found = results.find(r.axes[axis]);
      const std::uint64_t cells = r.shape[axis], given = found == results.end() ? 0 : found->second.values.size();
      if (given != cells && given != cells + 1) {
        out.push_back({"axes", "result '" + name + "': axis '" + r.axes[axis] + "'" +
                                   text_of(" has %g numbers for %g cells", static_cast<double>(given), static_cast<double>(cells))});
      }
    }
  }
}

/// A block adds to what is there, whatever that is, and whatever came before.
inline void blocks_add(const AnalyzerProbe& probe, const AnalyzerSetting& setting, std::uint64_t has, Violations& out) {
  Frames early = span_of_frames(setting.bead_count, 0, 150, false), late = span_of_frames(setting.bead_count, 200, 300, false);
  const FrameBlock first = early.block(has), second = late.block(has);
  AnalyzerProbe::Sums a = probe.zero(), b = probe.zero(), both = probe.zero(), expected = probe.zero(), again = probe.zero();
  probe.add(first, a);
  probe.add(second, b);
  probe.add(first, both);
  probe.add(second, both);
  probe.add(first, again);
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t k = 0; k < a[i].size(); ++k) expected[i][k] = a[i][k] + b[i][k];
    if (std::memcmp(a[i].data(), again[i].data(), a[i].size() * sizeof(double)) == 0) continue;
    return out.push_back({"no memory", std::string("array ") + probe.arrays()[i].name + ": a block that comes again gives other sums"});
  }
  agree(probe, expected, both, setting.tolerance, "additivity", out);
}

/// Two halves of a stretch, the joint frame with weight 0 in the second.
inline void halves_join(const AnalyzerProbe& probe, const AnalyzerSetting& setting, std::uint64_t has, Violations& out) {
  Frames whole = span_of_frames(setting.bead_count, 0, 300, false);
  Frames left = span_of_frames(setting.bead_count, 0, 150, false), right = span_of_frames(setting.bead_count, 150, 300, true);
  AnalyzerProbe::Sums expected = probe.zero(), found = probe.zero();
  probe.add(whole.block(has), expected);
  probe.add(left.block(has), found);
  probe.add(right.block(has), found);
  agree(probe, expected, found, setting.tolerance, "blocks join", out);
}

inline void zero_weight_counts_for_nothing(const AnalyzerProbe& probe, const AnalyzerSetting& setting, std::uint64_t has, Violations& out) {
  Frames plain(setting.bead_count), longer(setting.bead_count);
  longer.add(-0.5, 0.0, 1);
  for (int f = 0; f <= 150; ++f) {
    plain.add(2e-3 * f, 2e-3);
    longer.add(2e-3 * f, 2e-3);
  }
  AnalyzerProbe::Sums expected = probe.zero(), found = probe.zero();
  probe.add(plain.block(has), expected);
  probe.add(longer.block(has), found);
  agree(probe, expected, found, setting.tolerance, "zero weight", out);
}

/// The same sums give the same results, and stay what they are; sums of nothing give NaN, not a crash.
inline void finish_is_pure(const AnalyzerProbe& probe, const AnalyzerProbe::Sums& sums, Violations& out) {
  const AnalyzerProbe::Sums kept = sums;
  const KeptResults first = probe.finish(sums);
  try {
    probe.finish(probe.zero());
  } catch (const Refusal& refusal) {
    if (std::string_view(refusal.what()).empty()) out.push_back({"refusal", "sums of nothing are refused without a reason"});
  }
  if (!same_results(first, probe.finish(sums))) out.push_back({"finish is pure", "the same sums give other results the second time"});
  for (std::size_t i = 0; i < sums.size(); ++i) {
    if (std::memcmp(sums[i].data(), kept[i].data(), kept[i].size() * sizeof(double)) == 0) continue;
    out.push_back({"finish is pure", std::string("finish changes the array ") + probe.arrays()[i].name});
  }
}

/// With no field beyond those that it needs it works, or refuses and says why.
inline void least_is_enough(const AnalyzerTable& table, const Values& values, const AnalyzerSetting& setting, Violations& out) {
  AnalyzerContext context = known_mill(setting.bead_count);
  context.has = table.needs;
  try {
    const AnalyzerProbe probe(table, values, context);
    AnalyzerProbe::Sums sums = probe.zero();
    Frames frames = span_of_frames(setting.bead_count, 0, 150, false);
    probe.add(frames.block(table.needs), sums);
    results_are_described(probe.finish(sums), out);
  } catch (const Refusal& refusal) {
    if (std::string_view(refusal.what()).empty())
      out.push_back({"refusal", "a block with the fields that it needs is refused without a reason"});
  }
}

}  // namespace detail

/// Every check of an analyzer with these values. Throws Refusal when the plugin refuses the values or a usual block.
inline Violations check_analyzer(const Descriptor& descriptor, const Values& values, const AnalyzerSetting& setting = {}) {
  Violations out;
  const auto& table = table_of<AnalyzerTable>(descriptor, Kind::analyzer, kAnalyzerLayout);
  const AnalyzerProbe probe(table, values, known_mill(setting.bead_count));
  constexpr std::uint64_t has = Frames::kAll;
  AnalyzerProbe::Sums sums = probe.zero();
  Frames frames = detail::span_of_frames(setting.bead_count, 0, 300, false);
  probe.add(frames.block(has), sums);
  detail::arrays_are_described(probe, out);
  detail::results_are_described(probe.finish(sums), out);
  detail::finish_is_pure(probe, sums, out);
  detail::blocks_add(probe, setting, has, out);
  if (setting.blocks_join) detail::halves_join(probe, setting, has, out);
  if (setting.ignores_zero_weight) detail::zero_weight_counts_for_nothing(probe, setting, has, out);
  detail::least_is_enough(table, values, setting, out);
  return out;
}

}  // namespace millscope::conformance
