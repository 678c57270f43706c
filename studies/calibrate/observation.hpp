// What is compared: a vector of summaries of a recording, or of a simulation seen in the same way, with its covariance.
#pragma once

#include <cmath>
#include <set>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <nlohmann/json.hpp>

namespace millscope::calibrate {

struct Observable {
  std::string name;   ///< "speed 0.3–0.45 of the shell's"
  std::string unit;   ///< SI or %
  std::string group;  ///< power, centre, x, y, speed, occupancy, region_speed, term, frame NAME
};

/// A distribution, percent per bin.
struct Histogram {
  std::vector<double> edges;         ///< one more than bins
  std::vector<double> percent, sem;  ///< %
};

struct PowerFigure {
  double value = 0, sem = 0;                           ///< W of the recorded mill
  std::string how;                                     ///< "measured", "whole charge, scaled by mass 11.3", …
  bool known() const { return std::isfinite(value); }  ///< a velocity profile tells none
};

struct Observation {
  std::string of;  ///< what was looked at, for messages
  std::vector<Observable> observables;
  Eigen::VectorXd value;  ///< NaN: undefined, see require_defined
  Eigen::MatrixXd covariance;
  PowerFigure power;
  Histogram x, speed;       ///< fine bins, for Eq. 4.3 of Chagas 2015 and pictures
  double bead_seconds = 0;  ///< behind it
  double blocks = 0;        ///< independent blocks, median over the observables
  std::vector<std::string> notes;
  /// Something of single beads lies behind it, not only a profile.
  bool of_tracks() const { return bead_seconds > 0; }
};

/// Throws base::UserError where a value is NaN: a speed where no bead was seen.
void require_defined(const Observation& observation);

/// Takes observables out, with their part of the covariance. Names that it does not have are passed over.
void leave_out(Observation& observation, const std::set<std::string>& names);

nlohmann::ordered_json to_json(const Observation& observation);
Observation observation_from(const nlohmann::ordered_json& json);

/// Adds what speed and power meter together may be wrong by, relative to the power, to the uncertainty of a recording's power: two devices,
/// or two codes, that agree better than that agree by chance.
void add_power_error(Observation& recorded, double relative);

}  // namespace millscope::calibrate
