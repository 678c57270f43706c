#include "studies/inspect/inspect.hpp"

#include <algorithm>

#include "studies/inspect/verdict.hpp"

namespace millscope::inspect {

Inspection inspect(const recording::Recording& recording) {
  Inspection result;
  result.file = recording.file.string();
  result.stated = recording.condition;
  for (const recording::Run& run : recording.runs) {
    if (std::find(result.formats.begin(), result.formats.end(), run.format) == result.formats.end()) result.formats.push_back(run.format);
  }
  result.coverage = measure_coverage(recording);
  result.noise = measure_noise(recording);
  result.axial = measure_axial(recording);
  result.rotor = recognise_rotor(recording);
  if (!result.rotor) {
    result.motion = estimate_motion(recording);
    result.flight = measure_flight(recording);
    const auto& noise = result.noise[1].estimate;
    result.circulations = count_circulations(recording, noise ? noise->value : 0, result.motion.angular_velocity());
    const auto& time = result.circulations.time.estimate;
    result.mean_offset = mean_offset(recording, result.motion, time ? time->value : 0);
  }
  result.losses = measure_losses(recording, result.circulations);
  result.verdicts = judge(recording, result);
  return result;
}

}  // namespace millscope::inspect
