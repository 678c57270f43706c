// What a recording tells of its camera's frame without any simulation: beads that ride along the shell show where the mill's axis stands
// and how fast it turns, beads in free flight which way is down. Each reading is one observable more of its condition; a simulation has
// there what the frame of its own camera was.
#pragma once

#include <string>
#include <vector>

#include "studies/calibrate/recordings.hpp"
#include "studies/diagnose/question/question.hpp"

namespace millscope::diagnose {

struct FrameReading {
  std::size_t nuisance = 0;  ///< of the question
  calibrate::Observable observable;
  double per_unit = 1;        ///< of the observable, for one natural unit of the nuisance
  double value = 0, sem = 0;  ///< of the nuisance, natural units
};

/// What the study's case says of a mill whose recording is read.
struct ExpectedMill {
  double path_radius = 0;  ///< of a bead along the shell, m; 0: not known
  double bead_radius = 0;  ///< m
  bool upright = true;     ///< gravity points along −y, whatever is varied
};
ExpectedMill expected_mill(const Question& question, std::size_t condition, const host::Registry& registry);

/// Of the nuisances offset_x, offset_y, clock (from rides) and tilt_z (from flights), as far as the recording tells them: rides on
/// another circle than the shell's tell nothing, nor do flights where the case's own gravity leans, nor circles that a tilt_x or tilt_y
/// makes ellipses. Beads that all slip along the shell look like a slow clock.
std::vector<FrameReading> read_frame(const Question& question, const ExpectedMill& mill, const calibrate::Recorded& recorded);

/// What is wrong in all recordings alike (loose rides, supported flights) does not average out: each error grows by √ of the number of
/// conditions that read the same.
void share_errors(std::vector<std::vector<FrameReading>>& of_conditions);

/// What the recording itself shows.
void add_readings(const std::vector<FrameReading>& readings, calibrate::Observation& recorded);
/// What a simulation at θ (natural units) shows.
void add_readings(const Question& question, const std::vector<FrameReading>& readings, const VectorXd& theta,
                  calibrate::Observation& simulated);

/// "axis_x -0.2 mm (-1.3 … 0.9)", with 90 % intervals; "" without readings.
std::string text_of(const std::vector<FrameReading>& readings);

}  // namespace millscope::diagnose
