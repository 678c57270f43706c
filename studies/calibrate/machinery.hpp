// What calibrate and diagnose work with: ports to what runs simulations and looks at them, and nothing of any recording. Tests put their
// own in place.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "studies/analysis/results.hpp"
#include "studies/calibrate/observation.hpp"
#include "studies/campaign/campaign.hpp"

namespace millscope::calibrate {

struct Machinery {
  std::function<std::vector<campaign::Outcome>(std::span<const campaign::Simulation>)> run;
  /// What a finished simulation shows; NaN for what is undefined there: the speed where no bead was seen. `camera`: text of a camera file,
  /// whose links come before those of the recording's camera; may be empty. Called from several threads at once. Throws
  /// base::UserError: the simulation counts as failed.
  std::function<Observation(std::size_t condition, const campaign::Outcome&, const std::string& camera)> observe;
  /// Results of other analyzers (as in analysis.yaml), of the recording where the outcome has no folder; not set: nothing is looked at
  /// again.
  std::function<analysis::ResultSet(std::size_t condition, const campaign::Outcome&, const std::string& analyzers,
                                    const std::string& camera)>
      results;
  std::function<void(const std::string&)> progress;  ///< one line; may be empty
  int slots = 1;                                     ///< simulations at once, for the wall budget

  void say(const std::string& line) const {
    if (progress) progress(line);
  }
};

}  // namespace millscope::calibrate
