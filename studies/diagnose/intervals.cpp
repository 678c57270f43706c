// Where a fitted parameter may lie: wherever holding it there costs no more of Q than holding it at its truth does in nine of ten draws.
//
//   {v : min Q(t | t_i = v) − min Q(t) ≤ r_i},  r_i: 90 % quantile of min Q*(t | t_i = truth_i) − min Q*(t) over pseudo-recordings
//
// Profile likelihood with the bootstrap's quantile in place of that of chi-squared (Davison & Hinkley 1997, ch. 5.7): where a parameter
// does less and less, as friction at a wall to which beads stick already, the interval reaches as far as the data allow.
#include <algorithm>
#include <cmath>

#include "studies/analysis/parallel.hpp"
#include "studies/diagnose/pseudo_data.hpp"

namespace millscope::diagnose {
namespace {

constexpr double kInside = 0.9;
constexpr int kGrid = 32;
constexpr int kHalvings = 20;

/// Where `inside` begins on the way from a limit to what was found.
template <class Inside>
double end(double limit, double found, Inside inside) {
  const double step = (found - limit) / kGrid;
  for (int n = 0; n <= kGrid; ++n) {
    double in = n == kGrid ? found : limit + n * step;
    if (n < kGrid && !inside(in)) continue;
    if (n == 0) return limit;
    double out = in - step;
    for (int k = 0; k < kHalvings; ++k) {
      const double middle = 0.5 * (out + in);
      (inside(middle) ? in : out) = middle;
    }
    return in;
  }
  return found;
}

}  // namespace

VectorXd coordinates_of(const VectorXd& coded, const std::vector<double>& shares) {
  VectorXd t(coded.size() + static_cast<Index>(shares.size()));
  t << coded, Eigen::Map<const VectorXd>(shares.data(), static_cast<Index>(shares.size()));
  return t;
}

std::vector<Interval> PseudoData::intervals(const Choice& choice, const FitResult& fit, const Draws& how) const {
  const auto drawn = draw(truth(choice, fit), {choice}, how);
  const Model fitted = model(*surrogate_, choice);
  const VectorXd found = coordinates_of(fit.coded, fit.shares);
  std::vector<Interval> out(static_cast<std::size_t>(found.size()));
  studies::for_each_item(out.size(), studies::worker_count(options_.threads, out.size()), [&](std::size_t k, std::size_t) {
    const auto i = static_cast<Index>(k);
    double allowed = 0;  // the largest over the laws of noise
    for (std::size_t law = 0; law < laws(); ++law) {
      std::vector<double> rise;
      for (std::size_t b = law; b < drawn.size(); b += laws()) rise.push_back(drawn[b].rise[i]);
      const auto at = rise.begin() + static_cast<std::ptrdiff_t>(kInside * static_cast<double>(rise.size() - 1));
      std::nth_element(rise.begin(), at, rise.end());
      allowed = std::max(allowed, *at);
    }
    const auto inside = [&](double v) { return fitted.fit_holding(i, v, problem_.observed).q - fit.q <= allowed; };
    out[k] = {found[i], end(fitted.low(i), found[i], inside), end(fitted.high(i), found[i], inside)};
  });
  return out;
}

}  // namespace millscope::diagnose
