// Sections of study.yaml; for the files of this room.
#pragma once

#include <string>
#include <vector>

#include "studies/calibrate/study.hpp"

namespace millscope::calibrate {

std::vector<Condition> read_conditions(const config::Node& section);
std::vector<Parameter> read_parameters(const config::Node& section);
ObjectiveChoice read_objective(const config::Node& node);
DesignChoice read_design(const config::Node& section);
Budget read_budget(const config::Node& section);
Observing read_observing(const config::Node& section);

/// "a < 0.5 * b", "a >= 0.1": names or paths of parameters. Throws base::UserError at the node.
Constraint read_constraint(const config::Node& node, const std::vector<Parameter>& parameters);

/// The index of the parameter of that name or path; nothing where there is none.
std::optional<Eigen::Index> find_parameter(const std::vector<Parameter>& parameters, const std::string& name);

}  // namespace millscope::calibrate
