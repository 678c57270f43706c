// What is compared has to be defined in every simulation, or the simulations without it would be left out by their outcome.
#include <fmt/format.h>

#include <cmath>
#include <map>

#include "studies/diagnose/bank/bank.hpp"

namespace millscope::diagnose {

Undefined undefined_in(const Question& question, const Bank& bank) {
  Undefined undefined;
  undefined.names.resize(question.study.conditions.size());
  for (std::size_t k = 0; k < bank.conditions.size(); ++k) {
    std::map<std::string, int> lacking;
    int seen = 0;
    for (const auto& point : bank.seen) {
      if (!point[k]) continue;
      ++seen;
      auto value = point[k]->value.begin();
      for (const calibrate::Observable& o : point[k]->observables) {
        if (!std::isfinite(*value++)) ++lacking[o.name];
      }
    }
    const std::size_t condition = bank.conditions[k];
    for (const auto& [name, runs] : lacking) {
      undefined.names[condition].insert(name);
      undefined.notes.push_back(fmt::format("'{}' of condition '{}' was compared nowhere: in {} of {} simulations no bead was seen there",
                                            name, question.study.conditions[condition].name, runs, seen));
    }
  }
  return undefined;
}

Evidence leave_out(Evidence evidence, const Undefined& undefined) {
  evidence.without.resize(evidence.recorded.size());
  for (std::size_t c = 0; c < evidence.recorded.size(); ++c) {
    if (undefined.names[c].empty()) continue;
    evidence.without[c].insert(undefined.names[c].begin(), undefined.names[c].end());
    calibrate::leave_out(evidence.recorded[c], undefined.names[c]);
  }
  return evidence;
}

Bank leave_out(Bank bank, const Undefined& undefined) {
  for (auto& point : bank.seen) {
    for (std::size_t k = 0; k < bank.conditions.size(); ++k) {
      const std::set<std::string>& names = undefined.names[bank.conditions[k]];
      if (point[k] && !names.empty()) calibrate::leave_out(*point[k], names);
    }
  }
  return bank;
}

}  // namespace millscope::diagnose
