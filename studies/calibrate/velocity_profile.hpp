// A measured velocity profile in the place of a recording: where no track was kept, but the velocity against depth was published.
//
//   # drum.yaml
//   profile:
//     file: points.csv                              # a line of names, then numbers
//     position: {column: y, unit: mm}               # from the mill's axis along the bed's normal, below 0 in the bed
//     velocity: {column: v, unit: m/s}              # along the free surface, above 0 with the shell beneath the bed
//     position_error: 1 mm                          # standard errors of each point by itself
//     velocity_error: 0.01 m/s
//     origin_error: 1 mm                            # of all positions together: where the axis lies in the figure; default: 0
//     from: -110 mm                                 # what is used of it; default: all
//     to: -40 mm
//     z: [0 mm, 360 mm]                             # part of the mill's length that the profile is of; default: all
//   condition: {speed: 11.6 rpm, mill_diameter: 240 mm}
//
// Simulations are compared by the analyzer `bed_profile` over all their beads, without a camera.
#pragma once

#include <optional>
#include <vector>

#include "studies/calibrate/figure.hpp"

namespace millscope::calibrate {

/// Points by position, SI. Neighbouring ones are taken together, as at most twelve values.
struct VelocityProfile : Figure {
  std::vector<double> position, velocity;
  double position_error = 0, velocity_error = 0, origin_error = 0;
  std::optional<double> z_low, z_high;

  /// The section `profile` of a recording.yaml. Throws base::UserError with file:line.
  static VelocityProfile read(const config::Node& section);
  const char* what() const override { return "a velocity profile"; }
  void measure(const FigureOf& of, RecordedCondition& r) const override;
};

}  // namespace millscope::calibrate
