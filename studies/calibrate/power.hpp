// Power of the recorded mill: measured by a meter, or by the place of the tracer. For the files of this room, and for diagnose.
//
// A measured power is compared with that of the whole simulated charge, scaled to the recorded mass; of a mill without a meter M g <x> Ω of
// the tracer is compared with that of the beads seen.
#pragma once

#include <filesystem>
#include <string>

#include "studies/analysis/results.hpp"
#include "studies/calibrate/observation.hpp"

namespace millscope::calibrate {

/// M g <x> Ω of the beads behind the results. `mass`: kg, of the recorded charge.
PowerFigure beads_power(const analysis::ResultSet& results, double mass, std::string how);

/// Power of the whole simulated charge over the analysed time, from the run's own summary, times `factor`. Throws base::UserError where
/// the run has not come to its end.
PowerFigure whole_charge_power(const std::filesystem::path& run, double factor);

/// A power that owes nothing to the beads that were followed: of a meter, or of a whole simulated charge. Where the power is compared, it
/// takes this value, and no correlation with what the beads show.
void set_metered_power(Observation& observation, PowerFigure power);

/// Adds what speed and power meter together may be wrong by, relative to the power: two devices, or two codes, that agree better than that
/// agree by chance. To `covariance`, one of a recording's numbers …
void add_power_error(const Observation& recorded, double relative, Eigen::MatrixXd& covariance);
/// … or to all that the recording says of its power.
void add_power_error(Observation& recorded, double relative);

}  // namespace millscope::calibrate
