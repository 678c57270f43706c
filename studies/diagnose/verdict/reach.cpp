#include "studies/diagnose/verdict/reach.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "studies/diagnose/naming/visibility.hpp"

namespace millscope::diagnose {
namespace {

constexpr double kHelpsSurely = 8;  // about what a level of 5 % asks of the best of a few
constexpr double kHelps = 4;        // of Q: less is no sign of anything

std::string name_of(const Question& question, const End& end) {
  return end.candidate ? question.candidates[*end.candidate].name : question.coordinates()[*end.coordinate].name;
}

/// What a strength stands for; what a parameter or nuisance is.
double value_at(const Question& question, const End& end, double place) {
  return end.candidate ? question.candidates[*end.candidate].value(place) : place;
}

void add_new(std::vector<End>& ends, const End& end) {
  if (std::find(ends.begin(), ends.end(), end) == ends.end()) ends.push_back(end);
}

void add_coordinates(const Question& question, const naming::FitResult& fit, std::vector<End>& ends) {
  for (Index i = 0; i < static_cast<Index>(question.case_dimensions()); ++i) {
    if (naming::at_limit(fit.coded[i], {-1, 1})) add_new(ends, {.coordinate = i, .upper = fit.coded[i] > 0});
  }
}

/// The surrogate of all that is simulated, and fits to it.
struct FirstLook {
  explicit FirstLook(const naming::Problem& p)
      : problem(p), surrogate(p.data), weighting(p.covariance, surrogate), ranges(naming::ranges_of(p)), base(fit(naming::Alternative{})) {}
  FirstLook(const FirstLook&) = delete;

  naming::FitResult fit(const naming::Alternative& a) const {
    std::vector<Index> on;
    if (a.candidate) on.push_back(*a.candidate);
    return naming::Model(problem.data, surrogate, weighting, {std::move(on), ranges, a.freed}).fit(problem.observed);
  }
  /// Alternatives that are candidates with simulations, and may matter.
  std::vector<Index> candidates() const {
    std::vector<Index> out;
    for (Index a = 0; a < std::ssize(problem.alternatives); ++a) {
      const naming::Alternative& alternative = problem.alternatives[a];
      if (alternative.candidate && !alternative.screened_out && surrogate.features().count(*alternative.candidate) > 0) out.push_back(a);
    }
    return out;
  }

  const naming::Problem& problem;
  naming::Surrogate surrogate;
  naming::Weighting weighting;
  std::vector<naming::StrengthRange> ranges;
  naming::FitResult base;
};

}  // namespace

std::vector<End> ends_reached(const Question& question, const naming::Problem& problem) {
  const FirstLook look(problem);
  std::vector<End> ends;
  add_coordinates(question, look.base, ends);
  std::vector<Index> asked = look.candidates();
  for (Index a = 0; a < std::ssize(problem.alternatives); ++a) {
    if (problem.alternatives[a].freed) asked.push_back(a);
  }
  for (const Index a : asked) {
    const std::optional<Index>& candidate = problem.alternatives[a].candidate;
    const naming::FitResult with = look.fit(problem.alternatives[a]);
    if (look.base.q - with.q < kHelps) continue;
    add_coordinates(question, with, ends);
    if (!candidate) continue;
    const double strength = with.strengths.front();
    if (naming::at_limit(strength, look.ranges[*candidate])) add_new(ends, {.candidate = candidate, .upper = strength > 0});
  }
  std::erase_if(ends, [&](const End& end) { return place_of(question, end) == farthest_of(question, end); });
  return ends;
}

AskedFor asked_for(const naming::Problem& problem, double noise_units) {
  const FirstLook look(problem);
  const auto& alternatives = problem.alternatives;
  const std::vector<Index> tested = look.candidates();
  std::vector<double> q;
  double least = look.base.q;  // of nuisances, too
  for (const naming::Alternative& a : alternatives) {
    if (a.freed) least = std::min(least, look.fit(a).q);
  }
  for (const Index a : tested) q.push_back(look.fit(alternatives[a]).q), least = std::min(least, q.back());
  if (least > look.base.q - kHelpsSurely) return {};
  std::vector<Index> seconds;
  std::copy_if(tested.begin(), tested.end(), std::back_inserter(seconds), [&](Index a) {
    return std::sqrt(naming::Visibility(problem, look.surrogate, look.weighting, {look.base.coded}, a).lambda_high()) >= noise_units;
  });
  AskedFor out;
  for (std::size_t k = 0; k < tested.size(); ++k) {
    if (q[k] > least + kHelps) continue;  // not the first by far
    out.helpful.push_back(tested[k]);
    for (const Index a : seconds) {
      const bool known = std::find(out.pairs.begin(), out.pairs.end(), std::pair(a, tested[k])) != out.pairs.end();
      if (!known && naming::together(alternatives[tested[k]], alternatives[a])) out.pairs.emplace_back(tested[k], a);
    }
  }
  return out;
}

std::string sentence_of(const Question& before, const End& end) {
  return fmt::format("{}: a fit stands at the {} end of its range, {:.4g}; simulated {} to {:.4g}, too", name_of(before, end),
                     end.upper ? "upper" : "lower", value_at(before, end, place_of(before, end)), end.upper ? "up" : "down",
                     value_at(before, end, farthest_of(before, end)));
}

std::vector<std::string> outside_ranges(const Question& asked, const naming::Problem& problem, const naming::FitResult& fit,
                                        const std::vector<naming::ActiveCandidate>& active) {
  std::vector<std::string> out;
  const std::vector<naming::Coordinate> coordinates = asked.coordinates();
  for (std::size_t i = 0; i < asked.case_dimensions(); ++i) {
    const naming::Coordinate& c = coordinates[i];
    const double value = problem.data.theta[i].natural(fit.coded[static_cast<Index>(i)]);
    if (rounded(value) < rounded(c.low) || rounded(value) > rounded(c.high))
      out.push_back(fmt::format("{} = {:.3g} lies outside its range {:.4g} … {:.4g}", c.name, value, c.low, c.high));
  }
  for (const naming::ActiveCandidate& a : active) {
    const Candidate& c = asked.candidates[a.candidate];
    if (c.on_or_off() || (a.strength <= c.range.high && a.strength >= c.range.low)) continue;
    const auto [low, high] = std::minmax({c.value(c.range.low), c.value(c.range.high)});
    out.push_back(
        fmt::format("{}: {} = {:.3g} lies outside its prior range {:.4g} … {:.4g}", c.name, c.parameter, c.value(a.strength), low, high));
  }
  return out;
}

}  // namespace millscope::diagnose
