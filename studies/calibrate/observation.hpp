// What is compared: a vector of summaries of a recording, or of a simulation seen in the same way, with its covariance.
#pragma once

#include <cmath>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace millscope::calibrate {

enum class ObservableKind {
  power,
  centre,        ///< of mass
  x,             ///< share of the time in bins of a coordinate or of the speed
  y,             ///< likewise
  speed,         ///< likewise
  occupancy,     ///< of a region of the mill
  region_speed,  ///< mean speed in a region
  term,          ///< a number of an analyzer that the study asks for
  profile,       ///< velocity at a place of a measured profile
  outline,       ///< of the bed in a picture, or the angle of its surface
  frame          ///< how the recording's camera stands, by its own beads
};
/// As `objective: {without: […]}` has it.
const char* name_of(ObservableKind kind);
/// Throws std::invalid_argument where no kind has that name.
ObservableKind kind_named(const std::string& name);

struct Observable {
  std::string name;  ///< "speed 0.3–0.45 of the shell's"
  std::string unit;  ///< SI or %
  ObservableKind kind = ObservableKind::term;
  bool operator==(const Observable&) const = default;
};

/// A distribution, percent per bin.
struct Histogram {
  std::vector<double> edges;         ///< one more than bins
  std::vector<double> percent, sem;  ///< %
  bool operator==(const Histogram&) const = default;
};

/// Power of the recorded mill, of all conditions, also where it is not compared.
struct PowerFigure {
  double value = 0, sem = 0;                           ///< W
  std::string how;                                     ///< "measured", "whole charge, scaled by mass 11.3", …
  bool known() const { return std::isfinite(value); }  ///< a figure tells none
  bool operator==(const PowerFigure&) const = default;
};

struct Observation {
  std::string of;  ///< what was looked at, for messages
  std::vector<Observable> observables;
  Eigen::VectorXd value;       ///< NaN: undefined, see require_defined
  Eigen::MatrixXd covariance;  ///< of all errors, correlations shrunk (naming/covariance.hpp), widened for few blocks
  Eigen::MatrixXd resampled;  ///< what resampling says of it, as it is; 0 where nothing is resampled: a meter's power, the frame's readings
  PowerFigure power;
  Histogram x, speed;       ///< fine bins, for Eq. 4.3 of Chagas 2015 and pictures
  double bead_seconds = 0;  ///< behind it
  double blocks = 0;        ///< independent blocks, median over the observables
  std::vector<std::string> notes;
  bool operator==(const Observation&) const = default;
  /// Something of single beads lies behind it, not only a profile.
  bool of_tracks() const { return bead_seconds > 0; }
  /// Number of the first observable of a kind; nothing where none is compared.
  std::optional<Eigen::Index> find(ObservableKind kind) const;
};

/// An error that is known from n blocks has Student's spread: variance (n − 1)/(n − 3).
double few_blocks_factor(double blocks);

/// Throws base::UserError where a value is NaN: a speed where no bead was seen.
void require_defined(const Observation& observation);

/// Takes observables out, with their part of the covariance. Names that it does not have are passed over.
void leave_out(Observation& observation, const std::set<std::string>& names);

}  // namespace millscope::calibrate
