#include "studies/diagnose/verdict/judge.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "kernel/base/random.hpp"
#include "studies/diagnose/naming/covariance.hpp"

namespace millscope::diagnose {
namespace {

constexpr int kDraws = 4000;
constexpr double kErrors = 2;  // from the strongest rival, within which another may be the strongest

double misfit(const VectorXd& r, const Eigen::LLT<MatrixXd>& c) { return r.dot(c.solve(r)) / static_cast<double>(r.size()); }

}  // namespace

Reliance reliance(const VectorXd& difference, const MatrixXd& covariance, const std::vector<MatrixXd>& left_out) {
  const VectorXd direction = covariance.llt().solve(difference);
  const double length = std::sqrt(difference.dot(direction));
  double square = 0;
  for (const MatrixXd& runs : left_out) {
    if (runs.rows() == 0) return {length, std::numeric_limits<double>::infinity()};
    square = std::max(square, (runs * direction).squaredNorm() / static_cast<double>(runs.rows()));
  }
  return {length, length > 0 ? std::sqrt(square) / length : 0};
}

std::size_t strongest(const std::vector<base::Interval90>& improvements) {
  const auto smaller = [](const base::Interval90& a, const base::Interval90& b) { return a.value < b.value; };
  return std::min_element(improvements.begin(), improvements.end(), smaller) - improvements.begin();
}

std::vector<std::size_t> near_strongest(const std::vector<base::Interval90>& improvements) {
  std::vector<std::size_t> out;
  for (std::size_t k = 0; k < improvements.size(); ++k) {
    const base::Interval90 &one = improvements[k], &least = improvements[strongest(improvements)];
    if (one.value - least.value <= kErrors * std::hypot(one.standard_error(), least.standard_error())) out.push_back(k);
  }
  return out;
}

Judge Judge::of(const naming::Problem& held, const std::vector<MatrixXd>& left_out, const std::vector<Prediction>& predictions) {
  Judge judge;
  for (Index i = 0; i < held.observed.size(); ++i) {
    if (std::all_of(predictions.begin(), predictions.end(),
                    [i](const Prediction& p) { return !p.failure.empty() || std::isfinite(p.value[i]); }))
      judge.kept.push_back(i);
  }
  judge.observed = held.observed(judge.kept), judge.recording = held.covariance(judge.kept, judge.kept);
  std::vector<naming::CommonSize> sizes = held.sizes;
  for (naming::CommonSize& size : sizes) {
    std::vector<Index> places;
    for (Index k = 0; k < std::ssize(judge.kept); ++k) {
      if (std::find(size.observables.begin(), size.observables.end(), judge.kept[k]) != size.observables.end()) places.push_back(k);
    }
    size.observables = std::move(places);
  }
  judge.noise = naming::Noise(judge.recording, std::move(sizes));
  for (const MatrixXd& runs : left_out) judge.left_out.push_back(runs.rows() == 0 ? runs : MatrixXd(runs(Eigen::all, judge.kept)));
  return judge;
}

Prediction Judge::part(const Prediction& p) const {
  Prediction out = p;
  out.value = VectorXd(p.value(kept)), out.covariance = MatrixXd(p.covariance(kept, kept));
  return out;
}

Score Judge::score(Prediction prediction) const {
  Score s;
  const Prediction own = part(prediction);
  const MatrixXd covariance = recording + own.covariance;
  s.misfit = misfit(observed - own.value, Eigen::LLT<MatrixXd>(covariance));
  s.reliance = reliance(observed - own.value, covariance, left_out);
  s.power_percent = 100 * (prediction.power - power) / power;
  s.prediction = std::move(prediction);
  return s;
}

void Judge::compare(const Score& corrected, Score& rival, std::uint64_t seed) const {
  const Prediction one = part(corrected.prediction), other = part(rival.prediction);
  const MatrixXd covariance = recording + 0.5 * (one.covariance + other.covariance);
  const Eigen::LLT<MatrixXd> c(covariance);
  rival.reliance = reliance(one.value - other.value, covariance, left_out);
  base::Interval90& found = rival.improvement;
  found.value = misfit(observed - other.value, c) - misfit(observed - one.value, c);
  const MatrixXd first = naming::factor(one.covariance), second = naming::factor(other.covariance);
  base::RandomStream random(seed, 9);
  std::vector<double> draws;
  for (int b = 0; b < kDraws; ++b) {
    const VectorXd y = observed + noise.draw(random);
    draws.push_back(misfit(y - other.value - second * random.normals(y.size()), c) -
                    misfit(y - one.value - first * random.normals(y.size()), c));
  }
  std::sort(draws.begin(), draws.end());
  found.low = draws[kDraws / 20], found.high = draws[kDraws - 1 - kDraws / 20];
}

double Judge::goodness(const Prediction& whole, std::uint64_t seed) const {
  const Prediction p = part(whole);
  const Eigen::LLT<MatrixXd> c(recording + p.covariance);
  const double seen = misfit(observed - p.value, c);
  const MatrixXd own = naming::factor(p.covariance);
  base::RandomStream random(seed, 10);
  int above = 0;
  for (int b = 0; b < kDraws; ++b) above += misfit(noise.draw(random) + own * random.normals(observed.size()), c) >= seen ? 1 : 0;
  return (1.0 + above) / (1.0 + kDraws);
}

}  // namespace millscope::diagnose
