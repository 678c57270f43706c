#include "studies/emulate/statements.hpp"

#include <fmt/format.h>

#include <boost/math/special_functions/gamma.hpp>
#include <cmath>

namespace millscope::emulate {
namespace {

using Eigen::Index;

constexpr double kWell = 1.0 / 3, kHardly = 2.0 / 3;
constexpr double kStrong = 0.8;     // correlation from which two parameters are said to conceal each other
constexpr double kUnlikely = 0.01;  // of a misfit

Determined verdict(double width_ratio) {
  if (width_ratio < kWell) return Determined::well;
  return width_ratio > kHardly ? Determined::hardly : Determined::weakly;
}

/// The parameter that moves most with this one; itself when there is no other.
Index closest(const Eigen::MatrixXd& correlation, Index parameter) {
  Index other = parameter;
  double most = 0;
  for (Index k = 0; k < correlation.cols(); ++k) {
    if (k == parameter || std::abs(correlation(parameter, k)) <= most) continue;
    most = std::abs(correlation(parameter, k));
    other = k;
  }
  return other;
}

std::string sentence(const Posterior& posterior, const Box& box, Index k) {
  const Marginal& m = posterior.marginal[k];
  const char* const word = m.determined == Determined::well     ? "determined"
                           : m.determined == Determined::weakly ? "weakly determined"
                                                                : "hardly determined";
  std::string text = fmt::format("{}: {} by the data: {:.3g} to {:.3g} (90 %), {:.0f} % of its width before them", box.name_of(k), word,
                                 m.low90, m.high90, 100 * m.width_ratio);
  const Index other = closest(posterior.correlation, k);
  if (m.determined != Determined::well && m.conditional_ratio < 0.5 * m.width_ratio) {
    text += fmt::format("; {:.0f} % if the others were known: what it does, {} can do (correlation {:.2f})", 100 * m.conditional_ratio,
                        box.name_of(other), posterior.correlation(k, other));
  }
  if (m.at_edge && m.determined != Determined::hardly) text += "; the best value lies at the end of its range: widen it";
  return text;
}

/// Of the observables' number, what is left when the determined parameters have been fitted.
double freedom(const Posterior& posterior, Index observables) {
  double left = static_cast<double>(observables);
  for (const Marginal& m : posterior.marginal) left -= std::max(0.0, 1 - m.width_ratio * m.width_ratio);
  return left;
}

}  // namespace

double misfit_probability(double misfit, double freedom) { return boost::math::gamma_q(0.5 * freedom, 0.5 * misfit); }

void add_statements(Posterior& posterior, const Box& box, Index observables) {
  const Index p = box.size();
  for (Index k = 0; k < p; ++k) {
    Marginal& m = posterior.marginal[k];
    m.determined = verdict(m.width_ratio);
    m.statement = sentence(posterior, box, k);
  }
  const double left = freedom(posterior, observables);
  posterior.misfit_probability = left >= 0.5 ? misfit_probability(posterior.misfit, left) : 1;
  const auto say = [&](std::string text) { posterior.statements.push_back(std::move(text)); };
  if (left < 0.5) {
    say(fmt::format("{} observables for as many determined parameters: that they agree proves nothing", observables));
  } else if (posterior.misfit_probability < kUnlikely) {
    say(
        fmt::format("no parameters fit: the best leave a misfit of {:.3g} where {:.3g} would be usual (p = {:.1g}); the intervals hold "
                    "only for a simulation "
                    "that can tell the truth",
                    posterior.misfit, left, posterior.misfit_probability));
  } else {
    say(fmt::format("the best parameters fit: misfit {:.3g} where {:.3g} is usual (p = {:.2g})", posterior.misfit, left,
                    posterior.misfit_probability));
  }
  for (Index j = 0; j < p; ++j) {
    for (Index k = j + 1; k < p; ++k) {
      if (std::abs(posterior.correlation(j, k)) < kStrong) continue;
      say(fmt::format("{} and {} conceal each other: correlation {:.2f}", box.name_of(j), box.name_of(k), posterior.correlation(j, k)));
    }
  }
  if (!posterior.converged) say("the chains have not agreed: take the intervals as rough, or allow more draws");
}

}  // namespace millscope::emulate
