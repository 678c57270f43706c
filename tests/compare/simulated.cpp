#include "simulated.hpp"

#include <cmath>

#include "millscope/observation_adapter.hpp"

namespace compare_test {
namespace {

using millscope::Random;
using millscope::compare::TestedObservable;

constexpr std::size_t kNumbers = 3, kBins = 30, kCells = kMapSide * kMapSide, kAll = kNumbers + 2 * kBins + kCells;
constexpr std::size_t kSizes[] = {1, 1, 1, kBins, kBins, kCells};

/// One block: all values, one after the other.
std::vector<double> make_block(Random& random, const Shift& shift) {
  std::vector<double> v(kAll);
  const double common = random.normal();
  for (std::size_t k = 0; k < kNumbers; ++k) v[k] = 0.6 * common + 0.8 * random.normal();
  v[0] += shift.scalar;
  for (std::size_t curve = 0; curve < 2; ++curve) {
    double sum = 0;
    double* const bins = v.data() + kNumbers + curve * kBins;
    for (std::size_t k = 0; k < kBins; ++k) sum += bins[k] = random.exponential() * (1.0 + 0.2 * static_cast<double>(k));
    for (std::size_t k = 0; k < kBins; ++k) bins[k] /= sum;
  }
  double* const map = v.data() + kNumbers + 2 * kBins;
  std::vector<double> rough(kCells);
  for (double& r : rough) r = random.exponential();
  for (std::size_t k = 0; k < kCells; ++k) {
    const std::size_t right = k % kMapSide + 1 < kMapSide ? k + 1 : k, above = k + kMapSide < kCells ? k + kMapSide : k;
    map[k] = rough[k] + 0.5 * rough[right] + 0.5 * rough[above];
  }
  for (const std::size_t k : {5UL, 6UL, 5 + kMapSide, 6 + kMapSide}) map[k] += 1.22 * shift.cell;
  return v;
}

struct Source {
  std::vector<double> mean, error;
  std::vector<float> draws;  // [draws, kAll], scaled to the error
};

Source resample(const std::vector<std::vector<double>>& blocks, std::size_t draws, Random& random) {
  const std::size_t n = blocks.size();
  Source s{std::vector<double>(kAll, 0), std::vector<double>(kAll, 0), std::vector<float>(draws * kAll)};
  for (const auto& block : blocks) {
    for (std::size_t k = 0; k < kAll; ++k) s.mean[k] += block[k] / static_cast<double>(n);
  }
  for (const auto& block : blocks) {
    for (std::size_t k = 0; k < kAll; ++k) s.error[k] += std::pow(block[k] - s.mean[k], 2) / static_cast<double>(n * (n - 1));
  }
  for (double& e : s.error) e = std::sqrt(e);
  const double widen = std::sqrt(static_cast<double>(n) / static_cast<double>(n - 1));
  for (std::size_t r = 0; r < draws; ++r) {
    std::vector<double> sum(kAll, 0);
    for (std::size_t i = 0; i < n; ++i) {
      const auto& block = blocks[static_cast<std::size_t>(random.uniform() * static_cast<double>(n))];
      for (std::size_t k = 0; k < kAll; ++k) sum[k] += block[k];
    }
    for (std::size_t k = 0; k < kAll; ++k)
      s.draws[r * kAll + k] = static_cast<float>(widen * (sum[k] / static_cast<double>(n) - s.mean[k]));
  }
  return s;
}

std::vector<float> columns(const std::vector<float>& draws, std::size_t first, std::size_t count) {
  std::vector<float> out;
  for (std::size_t r = 0; r < draws.size() / kAll; ++r) {
    for (std::size_t k = 0; k < count; ++k) out.push_back(draws[r * kAll + first + k]);
  }
  return out;
}

}  // namespace

std::vector<TestedObservable> simulate(const Design& design, std::uint64_t seed) {
  Random random(seed);
  std::vector<std::vector<double>> a, b;
  for (std::size_t i = 0; i < design.blocks_a; ++i) a.push_back(make_block(random, {}));
  for (std::size_t i = 0; i < design.blocks_b; ++i) b.push_back(make_block(random, design.shift));
  const Source of_a = resample(a, design.draws, random), of_b = resample(b, design.draws, random);
  std::vector<TestedObservable> all;
  std::size_t first = 0;
  for (const std::size_t size : kSizes) {
    TestedObservable o;
    for (std::size_t k = first; k < first + size; ++k) {
      o.difference.push_back(of_b.mean[k] - of_a.mean[k]);
      o.error_a.push_back(of_a.error[k]), o.error_b.push_back(of_b.error[k]);
      o.blocks_a.push_back(static_cast<double>(design.blocks_a)), o.blocks_b.push_back(static_cast<double>(design.blocks_b));
    }
    o.draws_a = columns(of_a.draws, first, size), o.draws_b = columns(of_b.draws, first, size);
    all.push_back(std::move(o));
    first += size;
  }
  return all;
}

}  // namespace compare_test
