#include "studies/crosscheck/agreement.hpp"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cassert>
#include <cmath>
#include <numeric>
#include <span>

#include "kernel/base/statistics.hpp"

namespace millscope::crosscheck {
namespace {

Mean mean_of(std::span<const double> values) {
  const auto n = static_cast<double>(values.size());
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
  double squares = 0;
  for (const double v : values) squares += (v - mean) * (v - mean);
  return {mean, std::sqrt(squares / (n - 1) / n)};
}

double p_of(const Mean& difference, std::size_t seeds) {
  if (!(difference.error > 0)) return difference.value == 0 ? 1 : 0;
  const boost::math::students_t law(static_cast<double>(seeds - 1));
  return 2 * boost::math::cdf(boost::math::complement(law, std::fabs(difference.value) / difference.error));
}

/// Errors to either side of a difference that hold it in 95 of 100 cases; at least 2.
double reach_of(std::size_t seeds) {
  return std::max(2.0, boost::math::quantile(boost::math::students_t(static_cast<double>(seeds - 1)), 0.975));
}

std::optional<double> limit_of(const Compared& c, const Limits& limits) {
  if (c.name == kPowerByTorque || c.name == kPowerByCentre) return limits.power * std::fabs(c.ours.value);
  if (c.name == kCentre[0] || c.name == kCentre[1]) return limits.centre;
  if (c.name == kTranslation) return limits.translation * c.ours.value;
  return {};
}

void judge(Compared& c, const Limits& limits, std::size_t seeds) {
  c.limit = limit_of(c, limits);
  if (!c.limit) return;
  const double size = std::fabs(c.difference.value), error = c.difference.error, reach = reach_of(seeds) * error;
  c.judgement = size + reach <= *c.limit ? Judgement::agree : size - reach > *c.limit ? Judgement::differ : Judgement::unresolved;
  c.seeds_needed = static_cast<double>(seeds) * std::pow(reach / (size - *c.limit), 2);
}

void adjust(std::vector<Compared>& all) {
  std::vector<double> p;
  for (const Compared& c : all) p.push_back(c.p);
  p = base::holm(p);
  for (std::size_t k = 0; k < all.size(); ++k) all[k].adjusted_p = p[k];
}

}  // namespace

const char* text(Judgement judgement) {
  switch (judgement) {
    case Judgement::agree:
      return "agree";
    case Judgement::differ:
      return "differ";
    case Judgement::unresolved:
      return "not resolved";
    case Judgement::none:
      break;
  }
  return "";
}

std::vector<Compared> agreement(const std::vector<std::vector<Quantity>>& ours, const std::vector<std::vector<Quantity>>& theirs,
                                const Limits& limits) {
  const std::size_t seeds = ours.size();
  assert(seeds >= 2 && theirs.size() == seeds);
  std::vector<Compared> all;
  for (std::size_t q = 0; q < ours[0].size(); ++q) {
    std::vector<double> a, b, d;
    for (std::size_t s = 0; s < seeds; ++s) {
      assert(ours[s][q].name == ours[0][q].name && theirs[s][q].name == ours[0][q].name);
      a.push_back(ours[s][q].value), b.push_back(theirs[s][q].value), d.push_back(b.back() - a.back());
    }
    Compared c{ours[0][q].name, ours[0][q].unit, mean_of(a), mean_of(b), mean_of(d)};
    c.p = p_of(c.difference, seeds);
    judge(c, limits, seeds);
    all.push_back(c);
  }
  adjust(all);
  return all;
}

}  // namespace millscope::crosscheck
