// What a conformance check needs to make a plugin object: values from the plugin's own list, and a pair of materials.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <deque>
#include <string>
#include <string_view>
#include <vector>

#include "millscope/pair_term.hpp"
#include "millscope/parameters.hpp"
#include "millscope/random.hpp"

namespace millscope::conformance {

/// One thing that a plugin does not hold to.
struct Violation {
  std::string check;    ///< "scalar = packed", "antisymmetry", …
  std::string message;  ///< with the numbers
};

using Violations = std::vector<Violation>;

inline std::string text_of(const char* format, double a, double b) {
  char line[256];
  std::snprintf(line, sizeof line, format, a, b);
  return line;
}

/// The values of one object: every default of the plugin's list, then what the test sets. Required numbers that are not set get the
/// middle of their range.
class ValueSet {
 public:
  explicit ValueSet(const Descriptor& descriptor) : descriptor_(&descriptor) {
    for (std::uint64_t i = 0; i < descriptor.parameter_count; ++i) items_.push_back(initial(descriptor.parameters[i]));
  }

  ValueSet& set(std::string_view name, double number) {
    Value& value = find(name);
    for (double& component : value.number) component = number;
    value.given = 1;
    return *this;
  }
  ValueSet& set(std::string_view name, const char* text) {
    Value& value = find(name);
    texts_.emplace_back(text);
    value.text = texts_.back().c_str();
    value.given = 1;
    return *this;
  }
  /// "key=value key=value": numbers, or texts where no number can be read.
  ValueSet& read(const std::string& text) {
    for (std::size_t at = 0, end = 0; at < text.size(); at = end + 1) {
      end = std::min(text.find(' ', at), text.size());
      const std::size_t equal = text.find('=', at);
      const std::string key = text.substr(at, equal - at), value = text.substr(equal + 1, end - equal - 1);
      char* rest = nullptr;
      const double number = std::strtod(value.c_str(), &rest);
      *rest == '\0' && !value.empty() ? set(key, number) : set(key, value.c_str());
    }
    return *this;
  }
  bool has(std::string_view name) const {
    for (const Value& value : items_) {
      if (name == value.name) return true;
    }
    return false;
  }

  const Descriptor& descriptor() const { return *descriptor_; }
  /// Valid as long as this set.
  Values view() const { return {items_.data(), items_.size()}; }

 private:
  static Value initial(const Parameter& p) {
    Value value{p.name, p.fallback_text != nullptr ? p.fallback_text : "", {}, p.optional != 0 && std::isnan(p.fallback) ? 0U : 1U, 0};
    double number = p.fallback;
    if (std::isnan(number)) {
      const bool low = std::isfinite(p.minimum), high = std::isfinite(p.maximum);
      number = low && high ? 0.5 * (p.minimum + p.maximum) : low ? p.minimum + 1.0 : high ? p.maximum - 1.0 : 1.0;
    }
    for (double& component : value.number) component = number;
    return value;
  }
  Value& find(std::string_view name) {
    for (Value& value : items_) {
      if (name == value.name) return value;
    }
    throw Refusal("the plugin '" + std::string(descriptor_->name) + "' has no parameter '" + std::string(name) + "'");
  }

  const Descriptor* descriptor_;
  std::vector<Value> items_;
  std::deque<std::string> texts_;
};

/// Two equal beads of one material: glass softened to G = 26 MPa unless said otherwise.
inline PairContext bead_pair(double radius = 5e-3, double young = 63.96e6, double poisson = 0.23, double density = 2500.0) {
  PairContext pair{};
  pair.first = pair.second = {"glass", density, young, poisson};
  pair.effective_young = 0.5 * young / (1.0 - poisson * poisson);
  pair.effective_shear = 0.5 * (0.5 * young / (1.0 + poisson)) / (2.0 - poisson);
  const double mass = density * 4.18879020478639098 * radius * radius * radius;
  pair.smallest_radius = pair.largest_radius = 0.5 * radius;
  pair.smallest_mass = pair.largest_mass = 0.5 * mass;
  pair.typical_speed = 1.0;
  return pair;
}

/// Largest overlap of an elastic Hertz impact at the pair's typical speed: (15 m* v² / (16 E* √R*))^(2/5).
inline double typical_overlap(const PairContext& pair) {
  const double v = pair.typical_speed;
  return std::pow(15.0 * pair.largest_mass * v * v / (16.0 * pair.effective_young * std::sqrt(pair.largest_radius)), 0.4);
}

/// What the checks assume; the defaults suit most laws.
struct Setting {
  PairContext pair = bead_pair();
  bool check_friction = true;         ///< |F_t| ≤ μ max(F_n + cap_offset, 0)
  double cap_offset = 0.0;            ///< N that the law itself adds to F_n in Coulomb's cap (adhesion)
  bool sum_is_capped = true;          ///< false: only the tangential spring is capped, not its sum with the damping
  double ledger_tolerance = 0.02;     ///< of the impact's energy, at a time step of 1/200 of the contact time
  double stiffness_tolerance = 1e-4;  ///< relative, of dF_n/dδ and dU/dδ against differences
};

/// A plugin object that is destroyed with its holder; `context` is what the kind's `create` wants besides: a PairContext, an
/// AnalyzerContext, or nothing.
template <class Table>
class Held {
 public:
  template <class... Context>
  Held(const Table& table, const Values& values, const Context&... context) : table_(&table) {
    Failure failure{};
    if (table.create(&values, &context..., &self_, &failure) != 0) throw Refusal(failure.message);
  }
  ~Held() {
    if (self_ != nullptr) table_->destroy(self_);
  }
  Held(const Held&) = delete;
  Held& operator=(const Held&) = delete;
  const void* get() const { return self_; }
  void* get() { return self_; }
  const Table& table() const { return *table_; }

 private:
  const Table* table_;
  void* self_ = nullptr;
};

/// The table of a descriptor. Throws Refusal when it is of another kind or was built against another SDK.
template <class Table>
const Table& table_of(const Descriptor& descriptor, Kind kind, std::uint64_t layout) {
  if (descriptor.kind != static_cast<std::uint32_t>(kind)) throw Refusal(std::string(descriptor.name) + " is a plugin of another kind");
  if (descriptor.layout != layout) throw Refusal(std::string(descriptor.name) + " was built against another SDK");
  return *static_cast<const Table*>(descriptor.table);
}

/// The values with one number at an end of its range, in turn for every number whose end is finite. A plugin may refuse such values, but it
/// must say why; what it accepts it must be able to compute with.
inline std::vector<std::vector<Value>> at_ends_of_ranges(const Descriptor& descriptor, const Values& values) {
  std::vector<std::vector<Value>> all;
  for (std::uint64_t i = 0; i < descriptor.parameter_count; ++i) {
    const Parameter& parameter = descriptor.parameters[i];
    if (parameter.type != ValueType::number) continue;
    for (const double end : {parameter.minimum, parameter.maximum}) {
      if (!std::isfinite(end)) continue;
      all.emplace_back(values.items, values.items + values.count);
      for (Value& value : all.back()) {
        if (std::string_view(value.name) != parameter.name) continue;
        value.number[0] = end;
        value.given = 1;
      }
    }
  }
  return all;
}

/// Makes an object of each of `at_ends_of_ranges` and hands it to `use`; a refusal without a reason is a violation.
template <class Table, class Use, class... Context>
void with_ends_of_ranges(const Descriptor& descriptor, const Table& table, const Values& values, Violations& out, const Use& use,
                         const Context&... context) {
  for (const std::vector<Value>& changed : at_ends_of_ranges(descriptor, values)) {
    try {
      const Held<Table> object(table, {changed.data(), changed.size()}, context...);
      use(object);
    } catch (const Refusal& refusal) {
      if (std::string_view(refusal.what()).empty()) out.push_back({"refusal", "values were refused without a reason"});
    }
  }
}

/// A rotation by 0.9 rad about (1, 2, 2)/3, for frame indifference.
inline void rotate(const double in[3], double out[3]) {
  constexpr double k[3] = {1.0 / 3.0, 2.0 / 3.0, 2.0 / 3.0};
  const double c = std::cos(0.9), s = std::sin(0.9), along = (1.0 - c) * (k[0] * in[0] + k[1] * in[1] + k[2] * in[2]);
  const double across[3] = {k[1] * in[2] - k[2] * in[1], k[2] * in[0] - k[0] * in[2], k[0] * in[1] - k[1] * in[0]};
  for (int axis = 0; axis < 3; ++axis) out[axis] = c * in[axis] + s * across[axis] + along * k[axis];
}

}  // namespace millscope::conformance
