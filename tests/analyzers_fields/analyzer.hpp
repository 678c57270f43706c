// An analyzer of the build, opened directly, with its sums and its results by name.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "analyzers_fields/frames.hpp"
#include "millscope/analyzer_adapter.hpp"
#include "millscope/conformance/open.hpp"

namespace analyzers_test {

struct Found {
  std::string unit, doc;
  std::vector<std::uint64_t> shape;
  std::vector<double> values;
  std::vector<std::string> axes;  ///< "" where none
};

using Outcome = std::map<std::string, Found>;
using Sums = std::vector<std::vector<double>>;

/// The study's mill: 300 mm × 270 mm, 5 mm beads of glass, J = 31.3 %, porosity 0.37, 75 % of critical.
inline AnalyzerContext study(double sense = 1) {
  AnalyzerContext c{};
  c.mill_radius = 0.15;
  c.mill_low = 0;
  c.mill_high = 0.27;
  c.omega = sense * 0.75 * 42.3 / std::sqrt(0.295) * kPi / 30;
  c.gravity = 9.81;
  c.bead_radius = 2.5e-3;
  c.bead_density = 2500;
  c.filling = 0.313;
  c.porosity = 0.37;
  c.charge_mass = 0.63 * 0.313 * kPi * 0.15 * 0.15 * 0.27 * 2500;
  c.charge_count = c.charge_mass / (2500 * 4.0 / 3.0 * kPi * std::pow(2.5e-3, 3));
  c.end = 10;
  c.largest_id = 100000;
  c.has = kHasVelocity | kHasOmega | kHasPhase | kHasWallWork | kHasDissipation | kHasAllBeads;
  return c;
}

class Analyzer {
 public:
  Analyzer(const std::string& name, const AnalyzerContext& context, const std::string& options = "") {
    const std::string directory = std::string(MILLSCOPE_BINARY_DIR) + "/lib/millscope/plugins";
    const Descriptor& d = conformance::open_plugin(conformance::best_build(directory, name), name);
    conformance::ValueSet values(d);
    values.read(options);
    table_ = static_cast<const AnalyzerTable*>(d.table);
    Failure failure{};
    const Values view = values.view();
    if (table_->create(&view, &context, &self_, &failure) != 0) throw Refusal(failure.message);
    table_->arrays(self_, &arrays_, &count_);
  }
  ~Analyzer() { table_->destroy(self_); }
  Analyzer(const Analyzer&) = delete;
  Analyzer& operator=(const Analyzer&) = delete;

  Sums zero() const {
    Sums sums;
    for (std::uint64_t i = 0; i < count_; ++i) sums.emplace_back(size_of(arrays_[i]), 0.0);
    return sums;
  }
  void add(const FrameBlock& block, Sums& sums) const {
    std::vector<double*> pointers;
    for (auto& array : sums) pointers.push_back(array.data());
    Failure failure{};
    if (table_->accumulate(self_, &block, pointers.data(), &failure) != 0) throw Refusal(failure.message);
  }
  Outcome finish(const Sums& sums) const {
    std::vector<const double*> pointers;
    for (const auto& array : sums) pointers.push_back(array.data());
    Outcome outcome;
    const ResultSink sink{&outcome, &Analyzer::keep};
    Failure failure{};
    if (table_->finish(self_, pointers.data(), &sink, &failure) != 0) throw Refusal(failure.message);
    return outcome;
  }
  Outcome of(const FrameBlock& block) const {
    Sums sums = zero();
    add(block, sums);
    return finish(sums);
  }
  Outcome of(const Frames& frames) const { return of(frames.block()); }

 private:
  static void keep(void* host, const Result* r) {
    Found found{r->unit, r->doc, {r->shape, r->shape + r->rank}, {}, {}};
    std::uint64_t size = 1;
    for (std::uint32_t i = 0; i < r->rank; ++i) {
      size *= r->shape[i];
      found.axes.emplace_back(r->axis[i] != nullptr ? r->axis[i] : "");
    }
    found.values.assign(r->values, r->values + size);
    auto& outcome = *static_cast<Outcome*>(host);
    if (!outcome.emplace(r->name, found).second) throw Refusal(std::string("two results are called ") + r->name);
  }

  const AnalyzerTable* table_ = nullptr;
  void* self_ = nullptr;
  const ArrayInfo* arrays_ = nullptr;
  std::uint64_t count_ = 0;
};

inline double number(const Outcome& outcome, const std::string& name) {
  const auto found = outcome.find(name);
  if (found == outcome.end()) throw Refusal("no result is called " + name);
  return found->second.values.at(0);
}
inline const std::vector<double>& values(const Outcome& outcome, const std::string& name) {
  const auto found = outcome.find(name);
  if (found == outcome.end()) throw Refusal("no result is called " + name);
  return found->second.values;
}
inline double sum(const std::vector<double>& all) {
  double total = 0;
  for (const double v : all) total += v;
  return total;
}

/// Largest difference of two outcomes over all results, relative to the largest number of each (or 1e-6, as fractions of zero are
/// rounding); infinite when names, shapes or NaN differ.
inline double difference(const Outcome& a, const Outcome& b) {
  double largest = a.size() == b.size() ? 0 : INFINITY;
  for (const auto& [name, found] : a) {
    const auto other = b.find(name);
    if (other == b.end() || other->second.shape != found.shape) return INFINITY;
    double scale = 1e-3, off = 0;
    for (std::size_t i = 0; i < found.values.size(); ++i) {
      const double p = found.values[i], q = other->second.values[i];
      if (std::isnan(p) != std::isnan(q)) return INFINITY;
      if (std::isnan(p)) continue;
      scale = std::max({scale, std::fabs(p), std::fabs(q)});
      off = std::max(off, std::fabs(p - q));
    }
    largest = std::max(largest, off / scale);
  }
  return largest;
}

}  // namespace analyzers_test
