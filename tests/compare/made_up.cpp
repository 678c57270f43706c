#include "made_up.hpp"

#include <cmath>
#include <numeric>

#include "millscope/observation_adapter.hpp"

namespace compare_test {
namespace {

using namespace millscope;
using millscope::Random;

constexpr std::size_t kDraws = 200;
constexpr double kRadius = 0.15;

/// Values of all blocks, [blocks][size], become an array with its resamples.
class Maker {
 public:
  explicit Maker(const MadeUp& recipe) : random_(recipe.seed), blocks_(recipe.blocks) {
    for (std::size_t d = 0; d < kDraws; ++d) {
      std::vector<std::size_t> drawn;
      for (std::size_t i = 0; i < blocks_; ++i) drawn.push_back(static_cast<std::size_t>(random_.uniform() * static_cast<double>(blocks_)));
      drawn_.push_back(drawn);
    }
  }

  Random& random() { return random_; }

  void add(analysis::ResultArray array, const std::vector<std::vector<double>>& blocks) {
    const double n = static_cast<double>(blocks_);
    const std::size_t size = blocks[0].size();
    array.value.assign(size, 0), array.sem.assign(size, 0);
    for (const auto& block : blocks) {
      for (std::size_t k = 0; k < size; ++k) array.value[k] += block[k] / n;
    }
    for (const auto& block : blocks) {
      for (std::size_t k = 0; k < size; ++k) array.sem[k] += std::pow(block[k] - array.value[k], 2) / (n * (n - 1));
    }
    for (double& s : array.sem) s = std::sqrt(s);
    for (std::size_t k = 0; k < size; ++k) {
      array.low.push_back(array.value[k] - 1.68 * array.sem[k]), array.high.push_back(array.value[k] + 1.7 * array.sem[k]);
    }
    array.effective_blocks.assign(size, n);
    array.flags.assign(size, blocks_ < 10 ? static_cast<std::uint8_t>(analysis::kFewBlocks) : std::uint8_t{0});
    for (const auto& drawn : drawn_) {
      for (std::size_t k = 0; k < size; ++k) {
        double sum = 0;
        for (const std::size_t i : drawn) sum += blocks[i][k];
        array.draws.push_back(static_cast<float>(sum / n - array.value[k]));
      }
    }
    results.arrays.push_back(std::move(array));
  }

  void add_exact(analysis::ResultArray array) {
    if (!array.is_axis) {
      array.sem.assign(array.size(), 0), array.low = array.high = array.value;
      array.effective_blocks.assign(array.size(), static_cast<double>(blocks_)), array.flags.assign(array.size(), 0);
      array.draws.assign(array.size() * kDraws, 0);
    }
    results.arrays.push_back(std::move(array));
  }

  analysis::ResultSet results;

 private:
  Random random_;
  std::size_t blocks_;
  std::vector<std::vector<std::size_t>> drawn_;
};

analysis::ResultArray array_of(const char* analyzer, const char* name, const char* unit, std::vector<std::size_t> shape,
                               std::vector<std::string> axes, std::uint32_t traits = 0, const char* doc = "") {
  analysis::ResultArray array;
  array.analyzer = analyzer, array.name = name, array.unit = unit, array.doc = doc;
  array.shape = std::move(shape), array.axes = std::move(axes), array.traits = traits;
  return array;
}

void add_edges(Maker& maker, const char* analyzer, const char* name, std::size_t cells) {
  analysis::ResultArray edges = array_of(analyzer, name, "m", {cells + 1}, {}, name[0] == 'x' ? millscope::kAlongX : 0U);
  edges.is_axis = true;
  for (std::size_t i = 0; i <= cells; ++i) edges.value.push_back(kRadius * (2 * static_cast<double>(i) / static_cast<double>(cells) - 1));
  maker.add_exact(std::move(edges));
}

void add_numbers(Maker& maker, const MadeUp& recipe) {
  std::vector<std::vector<double>> power, place;
  for (std::size_t i = 0; i < recipe.blocks; ++i) {
    power.push_back({7 + recipe.power + 0.5 * maker.random().normal()});
    place.push_back({(recipe.omega < 0 ? -0.05 : 0.05) + 0.004 * maker.random().normal()});
  }
  maker.add(array_of("power", "power_gravity", "W", {}, {}), power);
  maker.add(array_of("power", "centre_of_mass_x", "m", {}, {}, millscope::kOdd), place);
  analysis::ResultArray critical = array_of("models", "critical_speed", "rad/s", {}, {});
  critical.value = {recipe.critical};
  maker.add_exact(std::move(critical));
}

void add_distribution(Maker& maker, const MadeUp& recipe) {
  add_edges(maker, "distributions", "x_edges", recipe.cells);
  std::vector<std::vector<double>> percent, cumulative;
  for (std::size_t i = 0; i < recipe.blocks; ++i) {
    std::vector<double> p;
    for (std::size_t k = 0; k < recipe.cells; ++k) p.push_back(static_cast<double>(k + 1) * maker.random().exponential());
    const double sum = std::accumulate(p.begin(), p.end(), 0.0);
    std::vector<double> c{0};
    for (double& v : p) v *= 100 / sum, c.push_back(c.back() + v);
    percent.push_back(p), cumulative.push_back(c);
  }
  maker.add(array_of("distributions", "x_percent", "%", {recipe.cells}, {"x_edges"}, millscope::kShare), percent);
  maker.add(array_of("distributions", "x_cumulative", "%", {recipe.cells + 1}, {"x_edges"}, millscope::kShare | millscope::kCumulative),
            cumulative);
}

void add_maps(Maker& maker, const MadeUp& recipe) {
  const std::size_t n = recipe.cells;
  add_edges(maker, "pept_grid", "x_edges", n);
  add_edges(maker, "pept_grid", "y_edges", n);
  std::vector<std::vector<double>> speed(recipe.blocks), velocity(recipe.blocks);
  for (std::size_t i = 0; i < recipe.blocks; ++i) {
    for (std::size_t cell = 0; cell < n * n; ++cell) {
      const std::size_t column = cell % n, row = cell / n;
      const double x = (static_cast<double>(column) + 0.5) / static_cast<double>(n) - 0.5,
                   y = (static_cast<double>(row) + 0.5) / static_cast<double>(n) - 0.5;
      const bool lower_left = x < -0.1 && y < -0.1 && x > y;  // within 0 to 45° past 6 o'clock of a clockwise mill
      speed[i].push_back(0.8 + (lower_left ? recipe.speed : 0) + 0.1 * maker.random().normal());
      velocity[i].push_back(x + 0.1 * maker.random().normal());
    }
  }
  maker.add(array_of("pept_grid", "speed", "m/s", {n, n}, {"y_edges", "x_edges"}), speed);
  maker.add(array_of("pept_grid", "velocity_x", "m/s", {n, n}, {"y_edges", "x_edges"}, millscope::kOdd), velocity);
  analysis::ResultArray kind =
      array_of("pept_grid", "kind", "1", {n, n}, {"y_edges", "x_edges"}, 0, "0 nothing, 1 en masse, 2 cascading layer.");
  for (std::size_t cell = 0; cell < n * n; ++cell) kind.value.push_back(static_cast<double>((cell + recipe.seed) % 3));
  maker.add_exact(std::move(kind));
  // How long it was watched: 1 s a block, give or take.
  std::vector<std::vector<double>> seconds(recipe.blocks);
  for (auto& block : seconds) block.push_back(static_cast<double>(recipe.blocks) * (1 + 0.1 * maker.random().normal()));
  maker.add(array_of("power", "seconds", "s", {}, {}, millscope::kBookkeeping | millscope::kNotNegative), seconds);
}

}  // namespace

analysis::ResultSet make_results(const MadeUp& recipe) {
  Maker maker(recipe);
  add_numbers(maker, recipe);
  add_distribution(maker, recipe);
  add_maps(maker, recipe);
  analysis::ResultMeta& meta = maker.results.meta;
  meta.name = "made up", meta.source = "recording", meta.description = "made up, 40 s";
  meta.context.mill_radius = kRadius, meta.context.omega = recipe.omega, meta.draws = kDraws;
  for (std::size_t i = 0; i < recipe.blocks; ++i) meta.blocks.push_back({static_cast<double>(i), static_cast<double>(i + 1), 1, 0});
  return std::move(maker.results);
}

}  // namespace compare_test
