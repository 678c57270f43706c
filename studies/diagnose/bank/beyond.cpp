#include "studies/diagnose/bank/beyond.hpp"

#include <algorithm>
#include <cmath>

namespace millscope::diagnose {
namespace {

constexpr int kPartOfBase = 3, kPartOfEach = 2;

/// Of a question that may be changed or not.
template <class AnyQuestion>
auto& end_of(AnyQuestion& question, const End& end) {
  const auto of = [&](auto& range) -> auto& { return end.upper ? range.high : range.low; };
  if (end.candidate) return of(question.candidates[*end.candidate].range);
  const auto parameters = std::ssize(question.study.parameters);
  if (*end.coordinate < parameters) return of(question.study.parameters[*end.coordinate]);
  return of(question.nuisances[*end.coordinate - parameters]);
}

int count_of(const BankSize& bank, const End& end) {
  return end.candidate ? (bank.each + kPartOfEach - 1) / kPartOfEach : (bank.base + kPartOfBase - 1) / kPartOfBase;
}

}  // namespace

double place_of(const Question& question, const End& end) { return end_of(question, end); }

double farthest_of(const Question& question, const End& end) {
  if (end.candidate) {
    const naming::StrengthRange& farthest = question.candidates[*end.candidate].farthest;
    return end.upper ? farthest.high : farthest.low;
  }
  const Farthest& farthest = question.farthest[*end.coordinate];
  return end.upper ? farthest.high : farthest.low;
}

/// The group's own points, with what is varied here moved from its range into the strip beyond.
std::vector<BankPoint> plan_beyond(const Question& question, const End& end) {
  const double from = place_of(question, end), to = farthest_of(question, end);
  const naming::Coordinate own = end.coordinate ? question.coordinates()[*end.coordinate] : naming::Coordinate{};
  std::vector<BankPoint> points = plan_group(question, {end.candidate, {}}, count_of(question.bank, end));
  for (BankPoint& p : points) {
    if (end.candidate) {
      const Candidate& c = question.candidates[*end.candidate];
      double& strength = p.active.front().strength;
      strength = rounded_strength(c, from + std::max(std::fabs(strength), kLeastStrength) * (to - from));
    } else {
      double& value = p.theta[*end.coordinate];
      const double share = (value - own.low) / (own.high - own.low);
      value = rounded(from + (end.upper ? share : 1 - share) * (to - from));
    }
    p.group += (end.upper ? ">" : "<") + own.name;
  }
  std::erase_if(points, [&](const BankPoint& p) { return !question.study.allowed(p.theta.head(std::ssize(question.study.parameters))); });
  return points;
}

Question widened(Question question, const End& end) {
  const double to = farthest_of(question, end);
  end_of(question, end) = to;
  return question;
}

}  // namespace millscope::diagnose
