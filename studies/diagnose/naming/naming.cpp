#include "studies/diagnose/naming/naming.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "studies/diagnose/naming/pseudo_data.hpp"
#include "studies/diagnose/naming/visibility.hpp"

namespace millscope::naming {
namespace {

/// Part of the draws that are at least `value`, the value itself counted among them.
double tail(const std::vector<double>& draws, double value) {
  const auto above = std::count_if(draws.begin(), draws.end(), [&](double d) { return d >= value; });
  return static_cast<double>(1 + above) / static_cast<double>(1 + draws.size());
}

template <class Of>
std::vector<double> collect(const std::vector<PseudoData::Drawn>& drawn, Of of) {
  std::vector<double> out;
  for (const PseudoData::Drawn& d : drawn) out.push_back(of(d));
  return out;
}

/// The intervals of θ among those of all coordinates, in natural units.
std::vector<base::Interval90> of_theta(const BankData& data, const std::vector<base::Interval90>& coded) {
  std::vector<base::Interval90> out;
  for (std::size_t i = 0; i < data.theta.size(); ++i) {
    const Coordinate& c = data.theta[i];
    out.push_back({c.natural(coded[i].value), c.natural(coded[i].low), c.natural(coded[i].high)});
  }
  return out;
}

constexpr double kNothing = 0.01;  // of Q: less is no gain

/// What each later fit of a draw gains on the first one in one draw of ten; never less than one unit of Q.
std::vector<double> usual_gains(const std::vector<PseudoData::Drawn>& drawn) {
  constexpr double kPart = 0.9;
  std::vector<double> usual(drawn.front().fit.size(), 1);
  for (std::size_t j = 1; j < usual.size(); ++j) {
    auto gain = collect(drawn, [j](const auto& d) { return d.fit[0].q - d.fit[j].q; });
    usual[j] = std::max(1.0, base::quantile(gain, kPart));
  }
  return usual;
}

/// p of several statistics together (min-p; Westfall & Young 1993): how often the smallest p of a draw is as small. Large values are
/// unlikely ones. Draws and what was observed are ranked together, so that neither has a finer scale.
class Family {
 public:
  explicit Family(const std::vector<std::vector<double>>& draws) {
    for (const std::vector<double>& statistic : draws) {
      Ranked own{statistic, statistic, {}};
      std::sort(own.sorted.begin(), own.sorted.end());
      for (const double value : own.value) own.above.push_back(own.at_least(value));
      ranked_.push_back(std::move(own));
    }
  }

  /// Of one of the statistics, where all have been observed.
  double p(std::size_t statistic, const std::vector<double>& observed) const {
    const std::ptrdiff_t own = 1 + ranked_[statistic].at_least(observed[statistic]);
    const std::size_t draws = ranked_[statistic].value.size();
    std::size_t smaller = 0;
    for (std::size_t b = 0; b < draws; ++b) {
      std::ptrdiff_t least = own + 1;
      for (std::size_t k = 0; k < ranked_.size(); ++k)
        least = std::min(least, ranked_[k].above[b] + (observed[k] >= ranked_[k].value[b] ? 1 : 0));
      smaller += least <= own ? 1 : 0;
    }
    return static_cast<double>(1 + smaller) / static_cast<double>(1 + draws);
  }

 private:
  /// One statistic.
  struct Ranked {
    std::vector<double> value, sorted;
    std::vector<std::ptrdiff_t> above;  ///< draws that are at least as large, itself among them
    std::ptrdiff_t at_least(double limit) const { return sorted.end() - std::lower_bound(sorted.begin(), sorted.end(), limit); }
  };

  std::vector<Ranked> ranked_;
};

class Namer {
 public:
  Namer(const Problem& problem, const Options& options) : p_(problem), o_(options), pseudo_(problem, options) {}

  Result run() {
    out_.covariance = pseudo_.weighting().covariance;
    out_.chance = pseudo_.chance();
    against_base();
    choose_best();
    if (out_.best) {
      look_closer(*out_.best);
      compare_others();
      look_for_second();
    }
    return std::move(out_);
  }

 private:
  Index count() const { return std::ssize(p_.alternatives); }
  bool tested(Index j) const { return out_.judged[j].tested; }
  /// Too small to be seen, from its squared length in noise units.
  bool unseen(double lambda) const { return std::sqrt(lambda) < o_.noise_units; }
  void say(const std::string& line) const {
    if (o_.say) o_.say(line);
  }

  void against_base() {
    say(fmt::format("null distribution: {} pseudo-recordings, {} candidates", o_.draws, count()));
    out_.base = pseudo_.fit({});
    std::vector<Choice> choices{{}};
    for (Index j = 0; j < count(); ++j) choices.push_back({j});
    const auto drawn = pseudo_.draw(pseudo_.truth({}, out_.base), choices, {o_.draws, 1});
    goodness_of_base(drawn);
    out_.base_theta = of_theta(p_.data, pseudo_.intervals({}, out_.base, o_.comparison_draws, 2));
    for (Index i = 0; i < out_.base.coded.size(); ++i) {
      const Coordinate& c = p_.data.theta[i];
      if (at_limit(out_.base.coded[i], {-1, 1})) out_.at_limit.push_back(c.name);
    }
    std::vector<std::vector<double>> gains;
    std::vector<double> observed;
    std::vector<Index> asked;
    for (Index j = 0; j < count(); ++j) {
      const auto gain = collect(drawn, [j](const auto& d) { return d.fit[0].q - d.fit[j + 1].q; });
      Judged judged;
      judged.fit = pseudo_.fit({j});
      judged.delta_q = out_.base.q - judged.fit.q;
      out_.judged.push_back(judged);
      visibility(j);
      if (!tested(j)) continue;
      out_.judged[j].p = tail(gain, judged.delta_q);
      gains.push_back(gain);
      observed.push_back(judged.delta_q);
      asked.push_back(j);
    }
    const Family family(gains);
    for (std::size_t k = 0; k < asked.size(); ++k) out_.judged[asked[k]].p_family = family.p(k, observed);
  }

  void visibility(Index j) {
    Judged& judged = out_.judged[j];
    const Visibility seen(p_, pseudo_.surrogate(), pseudo_.weighting(), {judged.fit.coded}, j);
    const double found = judged.fit.strengths.empty() ? judged.fit.coded[*p_.alternatives[j].freed] : judged.fit.strengths.front();
    for (const BankRow& row : p_.data.rows) {
      for (const ActiveCandidate& e : row.active) judged.runs += e.candidate == p_.alternatives[j].candidate ? 1 : 0;
    }
    const Alternative& alternative = p_.alternatives[j];
    judged.tested = !alternative.candidate || (judged.runs > 0 && !alternative.screened_out);
    judged.lambda = seen.lambda(), judged.kappa = seen.kappa(), judged.lambda_found = seen.at(found);
    if (alternative.candidate) judged.lambda_curve = seen.curve();
    judged.undetectable = alternative.screened_out || unseen(judged.lambda);
    judged.strength = without_interval(found);
    for (Index i = 0; i < judged.fit.coded.size(); ++i)
      judged.theta.push_back(without_interval(p_.data.theta[i].natural(judged.fit.coded[i])));
  }

  /// One p for whether the data look like a draw of the base: Q and the largest residual together (min-p), and of every observable within
  /// that family, so that none stands out of data that look like the base.
  void goodness_of_base(const std::vector<PseudoData::Drawn>& drawn) {
    const Index n = p_.observed.size();
    VectorXd mean = VectorXd::Zero(n), square = VectorXd::Zero(n);
    for (const auto& d : drawn) mean += d.residual, square += d.residual.cwiseAbs2();
    const auto draws = static_cast<double>(drawn.size());
    const VectorXd sd = (square / draws - (mean / draws).cwiseAbs2()).cwiseMax(1e-300).cwiseSqrt();
    const auto largest = collect(drawn, [&](const auto& d) { return d.residual.cwiseQuotient(sd).cwiseAbs().maxCoeff(); });
    const VectorXd base = pseudo_.surrogate().at(out_.base.coded), z = (p_.observed - base).cwiseQuotient(sd);
    const Family family({collect(drawn, [](const auto& d) { return d.fit[0].q; }), largest});
    const double q = out_.base.q;
    for (Index i = 0; i < n; ++i) out_.mismatch.push_back({i, base[i], z[i], family.p(1, {q, std::fabs(z[i])})});
    std::stable_sort(out_.mismatch.begin(), out_.mismatch.end(),
                     [](const Mismatch& a, const Mismatch& b) { return std::fabs(a.z) > std::fabs(b.z); });
    const Mismatch& most = out_.mismatch.front();
    out_.base_p = std::min(family.p(0, {q, std::fabs(most.z)}), most.p);
  }

  void choose_best() {
    for (Index j = 0; j < count(); ++j) {
      const Judged& judged = out_.judged[j];
      if (judged.p_family > o_.level || !judged.tested) continue;
      if (!out_.best || judged.fit.q < out_.judged[*out_.best].fit.q) out_.best = j;
    }
  }

  /// Intervals and goodness from draws under candidate j.
  void look_closer(Index j) {
    Judged& judged = out_.judged[j];
    const Truth truth = pseudo_.truth({j}, judged.fit);
    const auto stream = static_cast<std::uint64_t>(j);
    const auto strict = pseudo_.draw(truth, {{j}}, {o_.comparison_draws, 100 + stream});
    judged.goodness_p = tail(collect(strict, [](const auto& d) { return d.fit[0].q; }), judged.fit.q);
    const std::vector<base::Interval90> found = pseudo_.intervals({j}, judged.fit, o_.comparison_draws, 200 + stream);
    judged.theta = of_theta(p_.data, found);
    if (!judged.fit.strengths.empty()) judged.strength = found[p_.data.theta.size()];
  }

  /// Under every other candidate k: how often some candidate would seem better than k by as much as the best does, each measured by what it
  /// gains by chance, lest one that gains much so hides the best. Of a candidate that does nothing here the model is the base's, and so is
  /// p.
  void compare_others() {
    const Index best = *out_.best;
    out_.kept = {best};
    for (Index k = 0; k < count(); ++k) {
      if (k == best || !tested(k)) continue;
      Judged& judged = out_.judged[k];
      std::vector<Choice> choices{{k}};
      std::size_t of_best = 0;
      for (Index j = 0; j < count(); ++j) {
        if (j == k || !tested(j)) continue;
        if (j == best) of_best = choices.size();
        choices.push_back({j});
      }
      const auto drawn = pseudo_.draw(pseudo_.truth({k}, judged.fit), choices, {o_.comparison_draws, 300 + static_cast<std::uint64_t>(k)});
      const std::vector<double> usual = usual_gains(drawn);
      const auto lead = collect(drawn, [&](const auto& d) {
        double most = 0;
        for (std::size_t j = 1; j < d.fit.size(); ++j) most = std::max(most, (d.fit[0].q - d.fit[j].q) / usual[j]);
        return most;
      });
      const bool nothing = judged.delta_q < kNothing && p_.alternatives[k].candidate;
      judged.against_best_p = nothing ? out_.judged[best].p_family : tail(lead, (judged.fit.q - out_.judged[best].fit.q) / usual[of_best]);
      look_closer(k);
      if (judged.against_best_p > o_.level) out_.kept.push_back(k);
    }
  }

  /// Forward selection: a second candidate beside the best, and the best tested again beside it.
  void look_for_second() {
    const Index first = *out_.best;
    const FitResult& alone = out_.judged[first].fit;
    std::vector<Index> others;
    std::vector<Choice> choices{{first}};
    for (Index k = 0; k < count(); ++k) {
      if (!tested(k) || !together(p_.alternatives[first], p_.alternatives[k])) continue;
      const Visibility beside(p_, pseudo_.surrogate(), pseudo_.weighting(), {alone.coded, active_of(p_.alternatives[first], alone)}, k);
      out_.judged[k].lambda_beside = beside.lambda();
      // What cannot be seen beside the first at any strength is not what is seen: a few runs make slopes by chance, which fit some rest.
      if (p_.alternatives[k].candidate && unseen(beside.lambda())) continue;
      others.push_back(k);
      choices.push_back({first, k});
    }
    if (others.empty()) return;
    const auto drawn = pseudo_.draw(pseudo_.truth({first}, alone), choices, {o_.comparison_draws, 500});
    const auto gain = collect(drawn, [](const auto& d) {
      double most = 0;
      for (std::size_t k = 1; k < d.fit.size(); ++k) most = std::max(most, d.fit[0].q - d.fit[k].q);
      return most;
    });
    std::vector<FitResult> fits;
    for (std::size_t k = 0; k < others.size(); ++k) fits.push_back(pseudo_.fit(choices[k + 1]));
    const auto nearest = std::min_element(fits.begin(), fits.end(), [](const FitResult& a, const FitResult& b) { return a.q < b.q; });
    Pair pair;
    pair.first = first, pair.second = others[nearest - fits.begin()], pair.fit = *nearest;
    pair.p = tail(gain, alone.q - pair.fit.q);
    const FitResult& second = out_.judged[pair.second].fit;
    const Choice own{pair.second}, both{first, pair.second};
    const auto reverse = pseudo_.draw(pseudo_.truth(own, second), {own, both}, {o_.comparison_draws, 600});
    pair.p_first = tail(collect(reverse, [](const auto& d) { return d.fit[0].q - d.fit[1].q; }), second.q - pair.fit.q);
    const auto under = pseudo_.draw(pseudo_.truth(both, pair.fit), {both}, {o_.comparison_draws, 700});
    pair.goodness_p = tail(collect(under, [](const auto& d) { return d.fit[0].q; }), pair.fit.q);
    out_.pairs.push_back(pair);
  }

  const Problem& p_;
  const Options& o_;
  PseudoData pseudo_;
  Result out_;
};

}  // namespace

bool together(const Alternative& one, const Alternative& other) {
  return one.name != other.name && !exclude_each_other(one, other) && !(one.freed && other.freed);
}

std::vector<StrengthRange> ranges_of(const Problem& problem) {
  std::vector<StrengthRange> ranges(problem.data.candidates);
  for (const Alternative& r : problem.alternatives) {
    if (r.candidate) ranges[*r.candidate] = r.range;
  }
  return ranges;
}

std::vector<std::string> ends_of(const Problem& problem, const VectorXd& coded, const std::vector<ActiveCandidate>& active) {
  std::vector<std::string> names;
  for (const Alternative& a : problem.alternatives) {
    const auto on = std::find_if(active.begin(), active.end(), [&](const ActiveCandidate& e) { return e.candidate == a.candidate; });
    if (on != active.end() && at_limit(on->strength, a.range)) names.push_back(a.name);
  }
  for (Index i = 0; i < coded.size(); ++i) {
    const Coordinate& c = problem.data.theta[i];
    if (c.products == Products::all && at_limit(coded[i], {-1, 1})) names.push_back(c.name);
  }
  return names;
}

Result name_candidates(const Problem& problem, const Options& options) { return Namer(problem, options).run(); }

}  // namespace millscope::naming
