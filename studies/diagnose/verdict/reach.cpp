#include "studies/diagnose/verdict/reach.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "studies/diagnose/naming/visibility.hpp"

namespace millscope::diagnose {
namespace {

constexpr double kHelpsSurely = 8;  // about what a level of 5 % asks of the best of a few
constexpr double kHelps = 4;        // of Q: less is no sign of anything

const std::string& name_of(const Question& question, const End& end) {
  return end.candidate ? question.candidates[*end.candidate].name : question.study.parameters[*end.parameter].name;
}

/// What a strength stands for; what a parameter is.
double value_at(const Question& question, const End& end, double place) {
  return end.candidate ? question.candidates[*end.candidate].value(place) : place;
}

void add_new(std::vector<End>& ends, const End& end) {
  if (std::find(ends.begin(), ends.end(), end) == ends.end()) ends.push_back(end);
}

void add_parameters(const Question& question, const naming::FitResult& fit, std::vector<End>& ends) {
  for (Index i = 0; i < std::ssize(question.study.parameters); ++i) {
    if (naming::at_limit(fit.coded[i], {-1, 1})) add_new(ends, {.parameter = i, .upper = fit.coded[i] > 0});
  }
}

}  // namespace

std::vector<End> ends_reached(const Question& question, const naming::Problem& problem) {
  const naming::Surrogate surrogate(problem.data);
  const naming::Weighting weighting(problem.covariance, surrogate);
  const std::vector<naming::StrengthRange> ranges = naming::ranges_of(problem);
  const auto fit = [&](std::vector<Index> on) {
    return naming::Model(problem.data, surrogate, weighting, {std::move(on), ranges, {}}).fit(problem.observed);
  };
  std::vector<End> ends;
  const naming::FitResult base = fit({});
  add_parameters(question, base, ends);
  for (const naming::Alternative& a : problem.alternatives) {
    if (!a.candidate || a.screened_out || surrogate.features().count(*a.candidate) == 0) continue;
    const naming::FitResult with = fit({*a.candidate});
    if (base.q - with.q < kHelps) continue;
    add_parameters(question, with, ends);
    const double strength = with.strengths.front();
    if (naming::at_limit(strength, ranges[*a.candidate])) add_new(ends, {.candidate = a.candidate, .upper = strength > 0});
  }
  std::erase_if(ends, [&](const End& end) { return place_of(question, end) == farthest_of(question, end); });
  return ends;
}

std::vector<std::pair<Index, Index>> pairs_asked_for(const naming::Problem& problem, double noise_units) {
  const naming::Surrogate surrogate(problem.data);
  const naming::Weighting weighting(problem.covariance, surrogate);
  const std::vector<naming::StrengthRange> ranges = naming::ranges_of(problem);
  const auto& alternatives = problem.alternatives;
  const auto fit = [&](std::vector<Index> on) {
    return naming::Model(problem.data, surrogate, weighting, {std::move(on), ranges, {}}).fit(problem.observed);
  };
  const naming::FitResult base = fit({});
  std::vector<Index> tested;
  for (Index a = 0; a < std::ssize(alternatives); ++a) {
    const auto& candidate = alternatives[a].candidate;
    if (candidate && !alternatives[a].screened_out && surrogate.features().count(*candidate) > 0) tested.push_back(a);
  }
  std::vector<double> q;
  for (const Index a : tested) q.push_back(fit({*alternatives[a].candidate}).q);
  const double least = q.empty() ? base.q : *std::min_element(q.begin(), q.end());
  if (least > base.q - kHelpsSurely) return {};
  const auto may_matter = [&](Index a) {
    return std::sqrt(naming::Visibility(problem, surrogate, weighting, {base.coded}, a).lambda_high()) >= noise_units;
  };
  std::vector<std::pair<Index, Index>> out;
  for (std::size_t k = 0; k < tested.size(); ++k) {
    if (q[k] > least + kHelps) continue;  // not the first by far
    for (const Index a : tested) {
      const bool known = std::find(out.begin(), out.end(), std::pair(a, tested[k])) != out.end();
      if (!known && naming::together(alternatives[tested[k]], alternatives[a]) && may_matter(a)) out.emplace_back(tested[k], a);
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
  for (std::size_t i = 0; i < asked.study.parameters.size(); ++i) {
    const calibrate::Parameter& p = asked.study.parameters[i];
    const double value = problem.data.theta[i].natural(fit.coded[static_cast<Index>(i)]);
    if (rounded(value) < rounded(p.low) || rounded(value) > rounded(p.high))
      out.push_back(fmt::format("{} = {:.3g} lies outside its range {:.4g} … {:.4g}", p.name, value, p.low, p.high));
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
