// Where a fitted parameter may lie: wherever holding it there costs no more of Q than holding it at its truth does in nine of ten draws.
//
//   {v : min Q(t | t_i = v) − min Q(t) ≤ r_i},  r_i: 90 % quantile of min Q*(t | t_i = truth_i) − min Q*(t) over pseudo-recordings
//
// Profile likelihood with the bootstrap's quantile in place of that of chi-squared (Davison & Hinkley 1997, ch. 5): where a parameter
// does less and less, as friction at a wall to which beads stick already, the interval reaches as far as the data allow.
#include <algorithm>
#include <cmath>

#include "kernel/base/parallel.hpp"
#include "kernel/base/statistics.hpp"
#include "studies/diagnose/naming/pseudo_data.hpp"

namespace millscope::naming {
namespace {

constexpr double kInside = 0.9;
constexpr int kGrid = 32;
constexpr int kHalvings = 20;
constexpr std::size_t kFree = 20;  // draws for a quantile of their own

/// Where `inside` begins on the way from a limit to what was found, which is inside.
template <class Inside>
double edge(double limit, double found, Inside inside) {
  const double step = (found - limit) / kGrid;
  int n = 0;
  while (n < kGrid && !inside(limit + n * step)) ++n;
  if (n == 0) return limit;
  double in = limit + n * step, out = in - step;
  for (int k = 0; k < kHalvings; ++k) {
    const double middle = 0.5 * (out + in);
    (inside(middle) ? in : out) = middle;
  }
  return in;
}

}  // namespace

VectorXd coordinates_of(const VectorXd& coded, const std::vector<double>& strengths) {
  VectorXd t(coded.size() + std::ssize(strengths));
  t << coded, Eigen::Map<const VectorXd>(strengths.data(), std::ssize(strengths));
  return t;
}

/// r_i. Where the fit stands at a limit half of the draws end there as well and rise by nothing, so that a truth a little inside would be
/// missed: the quantile of the draws that end elsewhere counts where it is larger.
double PseudoData::allowed(const std::vector<Drawn>& drawn, const Model& fitted, Index i) const {
  std::vector<double> all, free;
  for (const Drawn& d : drawn) {
    const double found = coordinates_of(d.fit[0].coded, d.fit[0].strengths)[i];
    all.push_back(d.rise[i]);
    if (found > fitted.low(i) && found < fitted.high(i)) free.push_back(d.rise[i]);
  }
  const double out = all.empty() ? 0 : base::quantile_of_next(all, kInside);
  return free.size() >= kFree ? std::max(out, base::quantile_of_next(free, kInside)) : out;
}

std::vector<base::Interval90> PseudoData::intervals(const Choice& choice, const FitResult& fit, int draws, std::uint64_t stream) const {
  const auto drawn = draw(truth(choice, fit), {choice}, {draws, stream, true});
  const Model fitted = model(*surrogate_, choice);
  const VectorXd found = coordinates_of(fit.coded, fit.strengths);
  std::vector<base::Interval90> out(found.size());
  base::for_each_item(out.size(), base::worker_count(options_.threads, out.size()), [&](std::size_t k, std::size_t) {
    const Index i = k;
    const double most = fit.q + allowed(drawn, fitted, i);
    const auto inside = [&](double v) { return fitted.fit_holding(i, v, problem_.observed).q <= most; };
    out[k] = {found[i], edge(fitted.low(i), found[i], inside), edge(fitted.high(i), found[i], inside)};
  });
  return out;
}

}  // namespace millscope::naming
