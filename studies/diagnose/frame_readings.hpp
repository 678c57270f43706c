// What a recording tells of its camera's frame without any simulation: beads that ride along the shell show where the mill's axis stands
// and how fast it turns, beads in free flight which way is down. Each reading is one observable more of its condition; a simulation has
// there what the frame of its own camera was.
#pragma once

#include <string>
#include <vector>

#include "studies/calibrate/observation.hpp"
#include "studies/diagnose/question.hpp"
#include "studies/recording/recording.hpp"

namespace millscope::diagnose {

struct FrameReading {
  std::size_t nuisance = 0;  ///< of the question
  calibrate::Observable observable;
  double per_unit = 1;        ///< of the observable, for one natural unit of the nuisance
  double value = 0, sem = 0;  ///< of the nuisance, natural units
};

/// Of the nuisances offset_x, offset_y, clock (from rides) and tilt_z (from flights), as far as the recording tells them.
std::vector<FrameReading> read_frame(const Question& question, const studies::Recording& recording);

/// What the recording itself shows.
void add_readings(const std::vector<FrameReading>& readings, calibrate::Observation& recorded);
/// What a simulation at θ (natural units) shows.
void add_readings(const Question& question, const std::vector<FrameReading>& readings, const VectorXd& theta,
                  calibrate::Observation& simulated);

/// "axis_x -0.2 mm (-1.3 … 0.9)", with 90 % intervals; "" without readings.
std::string text_of(const std::vector<FrameReading>& readings);

}  // namespace millscope::diagnose
