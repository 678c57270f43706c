// How often beads and walls hit each other, and how hard: impact spectra for each pair of materials. Simulations only.
//
//   E = ½ m* v_n² at first touch, J          (m*: effective mass, v_n: closing speed along the normal)
//   rate(pair, bin) = Δ(count)/Δt, 1/s       energy per time of a bin: rate × middle of the bin on a logarithmic scale
//
// The lowest and the highest bin also hold what lies outside them.
#include <cctype>
#include <vector>

#include "analyzers/common/grid.hpp"
#include "millscope/analyzer_adapter.hpp"
#include "millscope/element.hpp"

namespace millscope::analyzers {
namespace {

/// "glass~liner" → "glass_liner", as names of results are written.
std::string word(const std::string& pair) {
  std::string text;
  for (const char c : pair)
    text += std::isalnum(static_cast<unsigned char>(c)) ? static_cast<char>(std::tolower(static_cast<unsigned char>(c))) : '_';
  return text;
}

class CollisionEnergy {
 public:
  static constexpr std::uint64_t kNeeds = kHasImpacts;

  CollisionEnergy(const Parameters&, const AnalyzerContext& context)
      : bins_(context.impact_bin_count), charge_count_(context.charge_count) {
    if (bins_ <= 0 || context.impact_pair_count <= 0) {
      throw Refusal("these frames hold no counts of collisions: run the case again with this version of millscope");
    }
    for (std::int64_t p = 0; p < context.impact_pair_count; ++p) pairs_.emplace_back(context.impact_pair[p]);
    edges_.assign(context.impact_energy_edge, context.impact_energy_edge + bins_ + 1);
  }

  std::vector<ArrayInfo> arrays() const {
    return {additive("collisions", "1", {pairs_.size(), static_cast<std::uint64_t>(bins_)}), additive("time", "s")};
  }

  void accumulate(const FrameBlock& block, double* const* sums) const {
    const std::int64_t size = static_cast<std::int64_t>(pairs_.size()) * bins_;
    if (block.impact_pair_count * block.impact_bin_count != size) throw Refusal("a block counts collisions in other bins than the run");
    for (std::int64_t f = 1; f < block.frame_count; ++f) {
      if (block.piece[f] != block.piece[f - 1]) continue;
      const double *now = block.impacts + f * size, *before = now - size;
      for (std::int64_t i = 0; i < size; ++i) sums[0][i] += now[i] - before[i];
      *sums[1] += block.time[f] - block.time[f - 1];
    }
  }

  void finish(const double* const* sums, Results& results) const {
    const auto bins = as_size(bins_);
    const double time = *sums[1];
    results.add("energy_edges", "J", edges_.data(), {bins + 1},
                "Edges of the bins of impact energy; the outer bins hold what lies beyond, too.");
    std::vector<double> all(bins);
    for (std::size_t p = 0; p < pairs_.size(); ++p) {
      const double* counts = sums[0] + p * bins;
      for (std::size_t i = 0; i < bins; ++i) all[i] += counts[i];
      add_pair(results, word(pairs_[p]), pairs_[p], counts, time);
    }
    add_pair(results, "all", "all pairs", all.data(), time);
    if (charge_count_ > 0) {
      double total = 0;
      for (const double count : all) total += count;
      results.add("collisions_per_bead", "1/s", ratio(total, time) / charge_count_,
                  "Collisions of all pairs per time and bead of the charge.");
    }
  }

 private:
  void add_pair(Results& results, const std::string& name, const std::string& pair, const double* counts, double time) const {
    const auto bins = as_size(bins_);
    std::vector<double> rate(bins), power(bins);
    double total = 0, energy = 0;
    for (std::size_t i = 0; i < bins; ++i) {
      rate[i] = ratio(counts[i], time);
      power[i] = rate[i] * std::sqrt(edges_[i] * edges_[i + 1]);
      total += counts[i];
      energy += counts[i] * std::sqrt(edges_[i] * edges_[i + 1]);
    }
    results.add(("rate_" + name).c_str(), "1/s", rate.data(), {bins},
                ("Collisions of " + pair + " per time and bin of impact energy.").c_str(), {"energy_edges"});
    results.add(("energy_rate_" + name).c_str(), "W", power.data(), {bins}, ("Impact energy of " + pair + " per time and bin.").c_str(),
                {"energy_edges"});
    results.add(("collision_rate_" + name).c_str(), "1/s", ratio(total, time), ("Collisions of " + pair + " per time.").c_str());
    results.add(("impact_power_" + name).c_str(), "W", ratio(energy, time),
                ("Impact energy of " + pair + " per time, each collision counted with the middle of its bin.").c_str());
    results.add(("mean_energy_" + name).c_str(), "J", ratio(energy, total), ("Mean impact energy of " + pair + ".").c_str());
  }

  std::int64_t bins_;
  double charge_count_;
  std::vector<std::string> pairs_;
  std::vector<double> edges_;
};

constexpr Descriptor kDescriptor = describe<CollisionEnergy>({
    .name = "collision_energy",
    .version = "0.1.0",
    .doc = "Impact spectra, rates and energies of collisions for each pair of materials; simulations only.",
    .equation = "E = m* v_n^2 / 2 at first touch; rate = count/time",
});

}  // namespace
}  // namespace millscope::analyzers

MILLSCOPE_PLUGINS(&millscope::analyzers::kDescriptor)
