// A study against the plugins and the base case.
#include <fmt/format.h>

#include "kernel/config/case.hpp"
#include "kernel/config/writer.hpp"
#include "studies/calibrate/study.hpp"

namespace millscope::calibrate {
namespace {

using base::UserError;

/// The case as it would be run, or the reader's own message at the place in the study.
std::string resolved(const Study& study, const std::vector<std::string>& settings, const host::Registry& registry,
                     const base::Location& where, const std::string& what) {
  try {
    const config::Case c = config::read_case(study.base.string(), settings);
    const std::vector<const Descriptor*> descriptors = registry.descriptors();
    config::finish(c, descriptors);
    return config::resolved_yaml(c, descriptors);
  } catch (const UserError& e) {
    throw UserError(where, fmt::format("{}: {}", what, e.what()));
  }
}

void check_parameter(const Study& study, std::size_t index, const host::Registry& registry) {
  const Parameter& p = study.parameters[index];
  std::vector<std::string> paths = p.tied;
  paths.insert(paths.begin(), p.path);
  const std::vector<std::string>& condition = study.conditions[study.with_role(Role::fit).front()].settings;
  for (const std::string& path : paths) {
    std::string text[2];
    for (const int end : {0, 1}) {
      std::vector<std::string> settings = condition;
      settings.push_back(fmt::format("{}={:.17g}", path, end == 0 ? p.low : p.high));
      text[end] = resolved(study, settings, registry, p.where, fmt::format("parameter '{}' at {:.6g}", path, end == 0 ? p.low : p.high));
    }
    if (text[0] == text[1]) {
      throw UserError(p.where,
                      fmt::format("parameter '{}' changes nothing in {}: the case overrides it; leave it out", path, study.base.string()));
    }
  }
}

}  // namespace

void check_study(const Study& study, const host::Registry& registry) {
  resolved(study, {}, registry, study.base_place, "base");
  for (std::size_t p = 0; p < study.parameters.size(); ++p) check_parameter(study, p, registry);
  for (const Condition& condition : study.conditions)
    resolved(study, condition.settings, registry, condition.where, fmt::format("condition '{}'", condition.name));
}

}  // namespace millscope::calibrate
