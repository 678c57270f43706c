// What a recording can and cannot support.
//
//   const Inspection i = inspect(read_recording("run.a"));
//   print_inspection(i) · inspection_json(i)                       // report.hpp
//
// Every figure comes from the points themselves and carries a 90 % interval, or the reason why the recording cannot say. The frame is the
// file's: y up, z along the mill's axis towards the viewer. The parts can be asked for singly: estimate_motion (mill_motion.hpp),
// measure_flight (flight.hpp), recognise_rotor (rotor.hpp), count_circulations (circulations.hpp), measure_losses (losses.hpp).
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "studies/inspect/circulations.hpp"
#include "studies/inspect/coverage.hpp"
#include "studies/inspect/flight.hpp"
#include "studies/inspect/losses.hpp"
#include "studies/inspect/mill_motion.hpp"
#include "studies/inspect/offset.hpp"
#include "studies/inspect/rotor.hpp"

namespace millscope::inspect {

enum class Support { yes, partly, no };

/// May this recording be used for …?
struct Verdict {
  std::string subject;  ///< "occupancy maps"
  Support support = Support::no;
  std::string reason;  ///< with the figures
};

struct Inspection {
  std::string file;
  std::vector<std::string> formats;  ///< how the files were read, each once
  Coverage coverage;
  std::array<Finding, 3> noise;  ///< standard deviation of a component, from point to point, m
  std::optional<Rotor> rotor;    ///< when the tracer sits on a rotor, nothing of what follows but the verdicts is filled
  MillMotion motion;
  recording::Condition stated;  ///< what recording.yaml states; not used, only its speed is held against the one found
  FreeFlight flight;
  Circulations circulations;
  Finding mean_offset;  ///< ⟨x⟩ of the tracer beside the axis, m
  Losses losses;
  Axial axial;
  std::vector<Verdict> verdicts;
};

Inspection inspect(const recording::Recording& recording);

}  // namespace millscope::inspect
