#include "studies/diagnose/question/feasible.hpp"

#include <fmt/format.h>

#include "kernel/base/error.hpp"
#include "kernel/config/writer.hpp"
#include "studies/diagnose/naming/naming.hpp"

namespace millscope::diagnose {
namespace {

constexpr double kLeastShare = 0.125;  // of a step, or of a strength, that is tried

/// The farthest of `from` + 1, ½, ¼ and ⅛ `step` at which the case can be run; `from` where none can.
template <class Settings>
double farthest(const calibrate::Study& study, const host::Registry& registry, double from, double step, const Settings& settings_at) {
  for (const double share : {1.0, 0.5, 0.25, kLeastShare}) {
    const double value = from + share * step;
    try {
      resolved(study, settings_at(value), registry);
      return value;
    } catch (const base::UserError&) {  // no case has this value
    }
  }
  return from;
}

/// Why no case may have both; "" where some may. In the order in which the bank sets them.
std::string why_not_both(const Question& question, const Candidate& one, const Candidate& other, const host::Registry& registry) {
  const bool swapped = other.name < one.name;
  std::string why;
  for (const double strength : {1.0, kLeastShare}) {
    std::vector<std::string> both = settings_of(swapped ? other : one, strength);
    for (std::string& setting : settings_of(swapped ? one : other, strength)) both.push_back(std::move(setting));
    try {
      resolved(question.study, both, registry);
      return "";
    } catch (const base::UserError& e) {
      why = e.what();
    }
  }
  return why;
}

}  // namespace

std::string resolved(const calibrate::Study& study, const std::vector<std::string>& settings, const host::Registry& registry) {
  std::vector<std::string> all = study.conditions[study.with_role(calibrate::Role::fit).front()].settings;
  all.insert(all.end(), settings.begin(), settings.end());
  const config::Case c = config::read_case(study.base.string(), all);
  const std::vector<const Descriptor*> descriptors = registry.descriptors();
  config::finish(c, descriptors);
  return config::resolved_yaml(c, descriptors);
}

void find_farthest(const host::Registry& registry, Question& question) {
  constexpr double kBeyond = 0.5;  // of a parameter's range; of a nuisance's, which a belief made narrow, all
  const auto reach = [&](double low, double high, double part, const auto& settings) {
    const double step = part * (high - low);
    question.farthest.push_back(
        {farthest(question.study, registry, low, -step, settings), farthest(question.study, registry, high, step, settings)});
  };
  for (const calibrate::Parameter& p : question.study.parameters) {
    reach(p.low, p.high, kBeyond, [&](double value) {
      std::vector<std::string> out{fmt::format("{}={:.4g}", p.path, value)};
      for (const std::string& path : p.tied) out.push_back(fmt::format("{}={:.4g}", path, value));
      return out;
    });
  }
  for (std::size_t i = 0; i < question.case_dimensions() - question.study.parameters.size(); ++i) {
    const Nuisance& n = question.nuisances[i];
    reach(n.low, n.high, 1, [&](double value) { return std::vector{fmt::format("{}={:.4g}", n.path, value)}; });
  }
  for (Candidate& c : question.candidates) {
    c.prior = c.farthest = c.range;
    if (c.on_or_off()) continue;
    const auto settings = [&](double strength) { return settings_of(c, strength); };
    c.farthest.high = farthest(question.study, registry, c.range.high, c.range.high, settings);
    if (c.range.low < 0) c.farthest.low = farthest(question.study, registry, c.range.low, c.range.low, settings);
  }
}

void exclude_impossible(const host::Registry& registry, Question& question) {
  for (std::size_t i = 0; i < question.candidates.size(); ++i) {
    for (std::size_t k = i + 1; k < question.candidates.size(); ++k) {
      Candidate& one = question.candidates[i];
      const Candidate& other = question.candidates[k];
      if (naming::exclude_each_other(one, other)) continue;
      const std::string why = why_not_both(question, one, other, registry);
      if (why.empty()) continue;
      one.excludes.push_back(other.name);
      question.left_out.push_back(fmt::format("{} and {} at once: {}", one.name, other.name, why));
    }
  }
}

}  // namespace millscope::diagnose
