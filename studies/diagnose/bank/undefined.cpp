// What is compared has to be defined in every simulation, or the simulations without it would be left out by their outcome.
#include <fmt/format.h>

#include <cmath>
#include <map>

#include "studies/diagnose/bank/bank.hpp"

namespace millscope::diagnose {

std::vector<std::string> leave_out_undefined(const Question& question, Workshop& workshop, Bank& bank) {
  workshop.without.resize(workshop.recorded.size());
  std::vector<std::string> told;
  for (std::size_t k = 0; k < bank.conditions.size(); ++k) {
    std::map<std::string, int> lacking;
    int seen = 0;
    for (const auto& point : bank.seen) {
      if (!point[k]) continue;
      ++seen;
      for (Index i = 0; i < point[k]->value.size(); ++i) {
        if (!std::isfinite(point[k]->value[i])) ++lacking[point[k]->observables[i].name];
      }
    }
    const std::size_t condition = bank.conditions[k];
    for (const auto& [name, runs] : lacking) {
      workshop.without[condition].insert(name);
      told.push_back(fmt::format("'{}' of condition '{}' was compared nowhere: in {} of {} simulations no bead was seen there", name,
                                 question.study.conditions[condition].name, runs, seen));
    }
    if (lacking.empty()) continue;
    calibrate::leave_out(workshop.recorded[condition], workshop.without[condition]);
    for (auto& point : bank.seen) {
      if (point[k]) calibrate::leave_out(*point[k], workshop.without[condition]);
    }
  }
  return told;
}

}  // namespace millscope::diagnose
