// The numbers of a finished run that its doubts are judged from.
#pragma once

#include "kernel/run/assembly.hpp"
#include "kernel/run/doubts.hpp"

namespace millscope::run {

/// `summary`: what summary.json says so far.
Soundness soundness_of(const Assembly& a, const nlohmann::ordered_json& summary);

/// The same of a run that another engine made: how deep its contacts were is not known.
Soundness soundness_of_means(const Assembly& a, const nlohmann::ordered_json& summary);

/// What follows from the means alone; `speed`: of the mill, rad/s.
Soundness soundness_of_summary(const nlohmann::ordered_json& summary, double speed);

}  // namespace millscope::run
