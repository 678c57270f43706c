#include "studies/camera/noise_model.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "kernel/host/instruction_set.hpp"
#include "studies/camera/stretch_wide.hpp"

namespace millscope::camera {
namespace {

/// From a bed turning as one body to impacts, in steps of a factor of two and a half, m/s^1.5.
constexpr Rungs kLadder{0.008, 0.02, 0.05, 0.125, 0.3, 0.8, 2.0, 5.0, 12.5};
static_assert(kLadder.back() > 0, "Rungs has room for more strengths than there are");

double averaged(const Rungs& relative, const Rungs& weight) {
  return std::inner_product(relative.begin(), relative.end(), weight.begin(), 0.0);
}

/// The likeliest weights, by a fixed number of rounds of expectation and maximisation from equal ones. So the likelihood stays smooth in
/// the parameters, and rungs that the data hardly tell apart keep nearly equal weights; the logarithm of the likelihood is then 0.2 to 1.5
/// short of its maximum over the weights. To the end, the errors of short recordings could not be found.
Rungs likely_weights(const std::vector<Rungs>& relative) {
  constexpr int kRounds = 60;
  Rungs weight;
  weight.fill(1.0 / static_cast<double>(weight.size()));
  for (int round = 0; round < kRounds; ++round) {
    Rungs sum{};
    for (const Rungs& r : relative) {
      const double all = averaged(r, weight);
      for (std::size_t k = 0; k < r.size(); ++k) sum[k] += weight[k] * r[k] / all;
    }
    for (std::size_t k = 0; k < sum.size(); ++k) weight[k] = sum[k] / static_cast<double>(relative.size());
  }
  return weight;
}

}  // namespace

Steps::Steps(const Stretch& stretch, double correlation_time, double memory_time, double growth) : memory(memory_time) {
  for (std::size_t i = 0; i < stretch.time.size(); ++i) {
    dt.push_back(i > 0 ? stretch.time[i] - stretch.time[i - 1] : 0.0);
    kept.push_back(std::exp(-dt[i] / correlation_time));
    slowed.push_back(std::exp(-dt[i] / memory));
    factor.push_back(1 + growth * stretch.distance[i]);
  }
}

std::array<Rungs, 3> rung_likelihoods(const Stretch& s, const Steps& steps, const std::array<NoiseStrength, 3>& noise) {
  const double white[3] = {noise[0].white, noise[1].white, noise[2].white};
  const double correlated[3] = {noise[0].correlated, noise[1].correlated, noise[2].correlated};
  const StretchView view{s.time.data(),     s.value[0].data(),   s.value[1].data(),   s.value[2].data(), steps.dt.data(),
                         steps.kept.data(), steps.slowed.data(), steps.factor.data(), steps.memory,      s.time.size()};
  const bool is_v3 = host::machine_instruction_set() >= host::InstructionSet::v3;
  std::array<Rungs, 3> log{};
  for (std::size_t k = 0; k < kLadder.size(); ++k) {
    double found[3];
    (is_v3 ? wide_v3::stretch_likelihood : wide_v2::stretch_likelihood)(view, {white, correlated}, kLadder[k], found);
    for (std::size_t axis = 0; axis < 3; ++axis) log[axis][k] = found[axis];
  }
  return log;
}

std::vector<double> averaged_over_ladder(const std::vector<Rungs>& logs) {
  std::vector<Rungs> relative;  // likelihoods over the best rung's
  std::vector<double> best;
  for (const Rungs& log : logs) {
    best.push_back(*std::max_element(log.begin(), log.end()));
    Rungs& r = relative.emplace_back();
    for (std::size_t k = 0; k < r.size(); ++k) r[k] = std::exp(log[k] - best.back());
  }
  const Rungs weight = likely_weights(relative);
  std::vector<double> result;
  for (std::size_t i = 0; i < logs.size(); ++i) result.push_back(best[i] + std::log(averaged(relative[i], weight)));
  return result;
}

}  // namespace millscope::camera
