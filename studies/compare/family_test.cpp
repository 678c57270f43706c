#include "studies/compare/family_test.hpp"

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <cstdint>
#include <numeric>

#include "kernel/base/statistics.hpp"

namespace millscope::compare {
namespace {

constexpr std::size_t kForTail = 2000;  // pairs that give an element's weight

std::size_t draw_count(const std::vector<float>& draws, std::size_t elements) { return draws.size() / elements; }

/// Draws less their mean, in units of their own deviation, times `unit`: element-major, so that one element lies together. Undefined: 0.
std::vector<float> scaled(const std::vector<float>& draws, const std::vector<double>& unit) {
  const std::size_t n = unit.size(), count = draw_count(draws, n);
  std::vector<float> out(draws.size());
  for (std::size_t k = 0; k < n; ++k) {
    double sum = 0, squares = 0, defined = 0;
    for (std::size_t r = 0; r < count; ++r) {
      const auto draw = static_cast<double>(draws[r * n + k]);
      if (std::isnan(draw)) continue;
      sum += draw, squares += draw * draw, defined += 1;
    }
    const double mean = defined > 0 ? sum / defined : 0, variance = defined > 1 ? (squares - sum * mean) / (defined - 1) : 0;
    const double factor = variance > 0 ? unit[k] / std::sqrt(variance) : 0;
    for (std::size_t r = 0; r < count; ++r) {
      const float draw = draws[r * n + k];
      out[k * count + r] = std::isnan(draw) ? 0 : static_cast<float>((static_cast<double>(draw) - mean) * factor);
    }
  }
  return out;
}

/// Which draw of A goes with which of B. The shift grows by one with every round through the draws of A: no pair comes twice within as many
/// rounds as B has draws.
struct Pairing {
  std::vector<std::uint32_t> a, b;
  Pairing(std::size_t count_a, std::size_t count_b, std::size_t pairs) : a(pairs), b(pairs) {
    for (std::size_t r = 0; r < pairs; ++r) {
      a[r] = static_cast<std::uint32_t>(r % count_a);
      b[r] = static_cast<std::uint32_t>((r + 1 + r / count_a) % count_b);
    }
  }
};

/// w_k: the normal deviate at 99 % over that of the resamples, at most 1.
float tail_weight(std::vector<float> deviates) {
  constexpr float kNormal = 2.5758F;
  const float found = base::quantile_below(deviates, 0.99);
  return found > kNormal ? kNormal / found : 1;
}

/// M*_r of one observable; sets the weights of its elements.
std::vector<float> resampled_maxima(const TestedObservable& observable, std::vector<TestedElement>& elements, std::size_t pairs) {
  std::vector<double> unit_a, unit_b;
  for (const TestedElement& e : elements) unit_a.push_back(e.error_a / e.error), unit_b.push_back(e.error_b / e.error);
  const std::vector<float> a = scaled(observable.draws_a, unit_a), b = scaled(observable.draws_b, unit_b);
  const std::size_t n = elements.size(), count_a = a.size() / n, count_b = b.size() / n;
  const Pairing pairing(count_a, count_b, pairs);
  std::vector<float> maxima(pairs, 0), deviates(pairs);
  for (std::size_t k = 0; k < n; ++k) {
    const float *const draw_a = a.data() + k * count_a, *const draw_b = b.data() + k * count_b;
    for (std::size_t r = 0; r < pairs; ++r) deviates[r] = std::abs(draw_b[pairing.b[r]] - draw_a[pairing.a[r]]);
    const auto some = static_cast<std::ptrdiff_t>(std::min(pairs, kForTail));
    const float weight = tail_weight({deviates.begin(), deviates.begin() + some});
    elements[k].weight = static_cast<double>(weight);
    for (std::size_t r = 0; r < pairs; ++r) maxima[r] = std::max(maxima[r], weight * deviates[r]);
  }
  return maxima;
}

/// s_a², s_b² and ν of every element.
struct Errors {
  std::vector<double> a, b, freedom;
};

Errors own_errors(const TestedObservable& o) {
  Errors errors;
  for (std::size_t k = 0; k < o.size(); ++k) {
    errors.a.push_back(o.error_a[k] * o.error_a[k]), errors.b.push_back(o.error_b[k] * o.error_b[k]);
    errors.freedom.push_back(degrees_of_freedom(o.error_a[k], o.blocks_a[k], o.error_b[k], o.blocks_b[k]));
  }
  return errors;
}

/// φ such that s_b²/φ and s_a² have the same mean over the elements, each in units of what both say together.
double common_ratio(const TestedObservable& o, const Errors& own) {
  double ratio = 1;
  for (int round = 0; round < 50; ++round) {
    double of_a = 0, of_b = 0;
    for (std::size_t k = 0; k < o.size(); ++k) {
      const double weight_a = o.blocks_a[k] - 1, weight_b = o.blocks_b[k] - 1;
      const double both = (weight_a * own.a[k] + weight_b * own.b[k] / ratio) / (weight_a + weight_b);
      of_a += own.a[k] / both, of_b += own.b[k] / both;
    }
    if (!(of_a > 0) || !(of_b > 0)) return 0;  // one of the two is exact
    const double next = of_b / of_a;
    if (std::abs(next / ratio - 1) < 1e-9) break;
    ratio = next;
  }
  return ratio;
}

Errors judged_errors(const TestedObservable& o) {
  Errors errors = own_errors(o);
  const double ratio = o.size() < kMany ? 0 : common_ratio(o, errors);
  if (!(ratio > 0)) return errors;
  for (std::size_t k = 0; k < o.size(); ++k) {
    const double weight_a = o.blocks_a[k] - 1, weight_b = o.blocks_b[k] - 1;
    const double both = (weight_a * errors.a[k] + weight_b * errors.b[k] / ratio) / (weight_a + weight_b);
    errors.a[k] = std::max(errors.a[k], both), errors.b[k] = std::max(errors.b[k], ratio * both);
    errors.freedom[k] = weight_a + weight_b;
  }
  return errors;
}

std::vector<TestedElement> describe(const TestedObservable& o, double confidence) {
  const Errors errors = judged_errors(o);
  std::vector<TestedElement> elements(o.size());
  for (std::size_t k = 0; k < o.size(); ++k) {
    TestedElement& e = elements[k];
    e.error_a = std::sqrt(errors.a[k]), e.error_b = std::sqrt(errors.b[k]);
    e.error = std::hypot(e.error_a, e.error_b);
    const double reach = boost::math::quantile(boost::math::students_t(errors.freedom[k]), 0.5 + confidence / 2) * e.error;
    e.low = o.difference[k] - reach, e.high = o.difference[k] + reach;
    e.deviate = normal_deviate(o.difference[k] / e.error, errors.freedom[k]);
  }
  return elements;
}

/// Share of `sorted` (ascending) that is at least `value`, counting the observed one among them.
double tail(const std::vector<float>& sorted, double value) {
  const auto first = std::lower_bound(sorted.begin(), sorted.end(), value, [](float s, double v) { return static_cast<double>(s) < v; });
  return (1.0 + static_cast<double>(sorted.end() - first)) / (1.0 + static_cast<double>(sorted.size()));
}

/// min-P, step by step: the most significant observable against all, the next against those that are left, ….
class StepDown {
 public:
  StepDown(std::vector<ObservableVerdict>& verdicts, const std::vector<std::vector<float>>& maxima) : verdicts_(verdicts) {
    for (const auto& m : maxima) chance_.push_back(chance_p(m));
  }

  void adjust() {
    std::vector<std::size_t> order(verdicts_.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return verdicts_[a].p < verdicts_[b].p; });
    // From the least significant up, the smallest p that chance gives among those that are left.
    const std::size_t pairs = chance_.front().size();
    std::vector<float> smallest(pairs, 1);
    std::vector<std::vector<float>> sorted(order.size());
    for (std::size_t i = order.size(); i-- > 0;) {
      for (std::size_t r = 0; r < pairs; ++r) smallest[r] = std::min(smallest[r], chance_[order[i]][r]);
      sorted[i] = smallest;
      std::sort(sorted[i].begin(), sorted[i].end());
    }
    double floor = 0;  // adjusted p-values do not fall from one step to the next
    for (std::size_t i = 0; i < order.size(); ++i) {
      ObservableVerdict& verdict = verdicts_[order[i]];
      // Elements are held against all observables: one that was rejected may still have elements that do not differ.
      for (TestedElement& e : verdict.elements) e.adjusted_p = at_most(sorted[0], e.p);
      floor = verdict.adjusted_p = std::max(floor, at_most(sorted[i], verdict.p));
    }
  }

 private:
  static std::vector<float> chance_p(const std::vector<float>& maxima) {
    std::vector<float> sorted = maxima, p(maxima.size());
    std::sort(sorted.begin(), sorted.end());
    for (std::size_t r = 0; r < maxima.size(); ++r) {
      const auto first = std::lower_bound(sorted.begin(), sorted.end(), maxima[r]);
      p[r] = static_cast<float>(static_cast<double>(sorted.end() - first) / static_cast<double>(sorted.size()));
    }
    return p;
  }
  static double at_most(const std::vector<float>& sorted, double p) {
    // Chance p-values are multiples of 1/R, the observed one of 1/(R + 1): a little room keeps equal ranks equal.
    const double limit = p * (1 + 1e-6);
    const auto last = std::upper_bound(sorted.begin(), sorted.end(), limit, [](double v, float s) { return v < static_cast<double>(s); });
    return std::min(1.0, (1.0 + static_cast<double>(last - sorted.begin())) / (1.0 + static_cast<double>(sorted.size())));
  }

  std::vector<ObservableVerdict>& verdicts_;
  std::vector<std::vector<float>> chance_;
};

}  // namespace

double degrees_of_freedom(double error_a, double blocks_a, double error_b, double blocks_b) {
  const double a = error_a * error_a, b = error_b * error_b;
  const double below = a * a / (blocks_a - 1) + b * b / (blocks_b - 1);
  return below > 0 ? (a + b) * (a + b) / below : blocks_a + blocks_b - 2;
}

double normal_deviate(double t, double freedom) {
  const double p = boost::math::cdf(boost::math::complement(boost::math::students_t(freedom), std::abs(t)));
  constexpr double kSmallest = 1e-300;  // 37 standard deviations
  return boost::math::quantile(boost::math::complement(boost::math::normal(), std::max(p, kSmallest)));
}

std::vector<ObservableVerdict> judge(const std::vector<TestedObservable>& observables, double confidence, std::size_t pairs) {
  std::vector<ObservableVerdict> verdicts;
  std::vector<std::vector<float>> maxima;
  for (const TestedObservable& observable : observables) {
    ObservableVerdict verdict;
    verdict.elements = describe(observable, confidence);
    maxima.push_back(resampled_maxima(observable, verdict.elements, pairs));
    std::vector<float> sorted = maxima.back();
    std::sort(sorted.begin(), sorted.end());
    for (TestedElement& e : verdict.elements) e.p = tail(sorted, e.weight * e.deviate);
    const auto strongest =
        std::max_element(verdict.elements.begin(), verdict.elements.end(),
                         [](const TestedElement& x, const TestedElement& y) { return x.weight * x.deviate < y.weight * y.deviate; });
    verdict.strongest = strongest - verdict.elements.begin();
    verdict.p = strongest->p;
    verdicts.push_back(std::move(verdict));
  }
  if (!verdicts.empty()) StepDown(verdicts, maxima).adjust();
  return verdicts;
}

}  // namespace millscope::compare
