#include "studies/inspect/verdict.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "kernel/base/statistics.hpp"
#include "studies/inspect/windows.hpp"

namespace millscope::inspect {
namespace {

// Power is M g ⟨x⟩ Ω: what the recording adds is the uncertainty of ⟨x⟩.
Verdict judge_power(const Inspection& i) {
  Verdict v{"power (M g <x> Omega)", Support::no, i.mean_offset.note};
  if (!i.mean_offset.estimate) return v;
  const double mean = std::fabs(i.mean_offset.estimate->value);
  const double all = 0.5 * (i.mean_offset.estimate->high - i.mean_offset.estimate->low) / mean;
  const double of_axis = 0.5 * (i.motion.axis[0].estimate->high - i.motion.axis[0].estimate->low) / mean;
  const double of_length = std::sqrt(std::max(0.0, all * all - of_axis * of_axis)),
               needed = i.coverage.covered * of_length * of_length / (0.05 * 0.05);
  v.support = all < 0.05 ? Support::yes : all < 0.15 ? Support::partly : Support::no;
  v.reason = fmt::format("<x> is known within {:.1f} % (90 %): {:.1f} % from the recording's length, {:.1f} % from the axis", all * 100,
                         of_length * 100, of_axis * 100);
  if (all >= 0.05 && of_length > of_axis) v.reason += fmt::format("; 5 % takes about {:.0f} s covered", needed);
  return v;
}

// Part of the covered time spent in cells with ten visits or more; visits are half a circulation apart.
double well_visited(const recording::Recording& recording, const std::array<double, 2>& axis, double cell, double apart) {
  struct Cell {
    double time = 0, last = -1e300;
    int visits = 0;
  };
  std::map<std::pair<long, long>, Cell> cells;
  double all = 0;
  for (const recording::Run& run : recording.runs) {
    const std::vector<double> dwell = dwell_times(run, recording.gap_limit);
    for (auto& [place, c] : cells) c.last = -1e300;
    for (std::size_t i = 0; i < run.size(); ++i) {
      Cell& c = cells[{std::lround((run.position[0][i] - axis[0]) / cell), std::lround((run.position[1][i] - axis[1]) / cell)}];
      c.visits += run.time[i] - c.last > apart;
      c.last = run.time[i];
      c.time += dwell[i];
      all += dwell[i];
    }
  }
  double good = 0;
  for (const auto& [place, c] : cells) good += c.visits >= 10 ? c.time : 0;
  return all > 0 ? good / all : 0;
}

Verdict judge_maps(const recording::Recording& recording, const Inspection& i) {
  Verdict v{"occupancy maps", Support::no, "the axis, the shell's radius or the circulations are not known"};
  if (!i.circulations.time.estimate || !i.motion.path_radius.estimate) return v;
  const double diameter = 2 * i.motion.path_radius.estimate->value, noise = i.motion.radial_scatter > 0 ? i.motion.radial_scatter
                                                                            : i.noise[0].estimate       ? i.noise[0].estimate->value
                                                                                                        : 0;
  const auto at = [&](double across) {
    return well_visited(recording, i.motion.centre(), diameter / across, 0.5 * i.circulations.time.estimate->value);
  };
  const double fine = at(50);
  v.support = fine > 0.8 && noise < diameter / 100 ? Support::yes : fine > 0.4 ? Support::partly : Support::no;
  v.reason = fmt::format("with 50 x 50 cells of {:.1f} mm {:.0f} % of the time is in cells of ten visits or more", diameter / 50 * 1e3,
                         fine * 100);
  if (fine <= 0.8) {
    for (const double across : {40., 30., 25., 20., 15., 10.}) {
      const double part = at(across);
      if (part <= 0.8) continue;
      v.reason += fmt::format("; with cells of {:.0f} mm {:.0f} %", diameter / across * 1e3, part * 100);
      return v;
    }
    v.reason += "; not even 80 % with a tenth of the diameter";
  }
  if (noise >= diameter / 100) v.reason += fmt::format("; noise of {:.1f} mm blurs them", noise * 1e3);
  return v;
}

// A parabola over a quarter of a radian of the mill's turn.
Verdict judge_velocity(const recording::Recording& recording, const Inspection& i) {
  Verdict v{"velocity", Support::no, "the mill's speed or the noise is not known"};
  if (!i.motion.speed.estimate || !i.noise[0].estimate) return v;
  const double speed = i.motion.speed.estimate->value, length = std::clamp(0.25 / speed, 0.02, 0.3);
  std::vector<std::pair<double, double>> errors;
  for (const Parabola& p : local_parabolas(unbroken_stretches(recording), length, 5)) errors.emplace_back(p.velocity_per_noise, 1.0);
  if (errors.size() < 20) {
    v.reason = fmt::format("fewer than five points within {:.0f} ms nearly everywhere", length * 1e3);
    return v;
  }
  const double error = base::weighted_quantile(errors, 0.5) * 0.5 * (i.noise[0].estimate->value + i.noise[1].estimate->value);
  const double rim = speed * i.motion.path_radius.estimate->value;
  v.support = error < 0.1 * rim ? Support::yes : error < 0.3 * rim ? Support::partly : Support::no;
  v.reason = fmt::format("standard error of about {:.3f} m/s over {:.0f} ms, {:.1f} % of the shell's {:.2f} m/s", error, length * 1e3,
                         error / rim * 100, rim);
  return v;
}

Verdict judge_motion(const Inspection& i) {
  Verdict v{"axis, speed and radius of the mill", Support::no, i.motion.speed.note};
  if (i.motion.sense == 0) return v;
  const bool whole = i.motion.speed.estimate && i.motion.speed.bound == Bound::both && i.motion.path_radius.bound == Bound::both;
  v.support = whole ? Support::yes : Support::partly;
  v.reason = whole ? fmt::format("{} rides along the shell, {:.1f} s", i.motion.rides, i.motion.ride_time)
                   : i.motion.path_radius.note + "; give the speed in recording.yaml, or record longer";
  return v;
}

Verdict judge_flight(const Inspection& i) {
  constexpr double kForDrag = 300;
  Verdict v{"free flight", Support::no, i.flight.angle_degrees.note};
  if (!i.flight.angle_degrees.estimate) return v;
  v.support = i.flight.flights >= kForDrag ? Support::yes : Support::partly;
  v.reason = fmt::format("{:.0f} flights: enough for the vertical direction; air drag takes about {:.0f}", i.flight.flights, kForDrag);
  return v;
}

Verdict judge_axial(const Inspection& i) {
  Verdict v{"profiles along the axis", i.axial.traverses >= 20 ? Support::yes : i.axial.traverses >= 5 ? Support::partly : Support::no, ""};
  const auto [least, most] = std::minmax_element(i.axial.share.begin(), i.axial.share.end());
  v.reason = fmt::format("{} traverses from one third to the opposite one; tenths of the length hold {:.0f} to {:.0f} % of the time",
                         i.axial.traverses, *least * 100, *most * 100);
  return v;
}

Verdict judge_fast(const Inspection& i) {
  Verdict v{"fast beads", Support::no, i.losses.lost.note};
  if (i.losses.ranges.empty()) return v;
  const SpeedRange& top = i.losses.ranges.back();
  v.support = top.lost.value < 0.15 ? Support::yes : top.lost.value < 0.6 ? Support::partly : Support::no;
  v.reason =
      top.lost.low > 0
          ? fmt::format("above {:.2f} m/s {:.0f} % of the locations are lost: weigh by time, not by count", top.low, top.lost.value * 100)
          : fmt::format("above {:.2f} m/s no loss is seen in {:.1f} s; whole flights may lie in gaps", top.low, top.time);
  return v;
}

Verdict judge_calibration(const Inspection& i) {
  Verdict v{"calibration on a rotor", Support::yes, ""};
  v.reason = fmt::format("circular motion of constant radius, {} plateaus of speed; not a tumbling charge", i.rotor->plateaus.size());
  if (i.rotor->plateaus.empty()) v.support = Support::partly;
  return v;
}

}  // namespace

std::vector<Verdict> judge(const recording::Recording& recording, const Inspection& inspection) {
  if (inspection.rotor) return {judge_calibration(inspection), judge_fast(inspection)};
  return {judge_motion(inspection),
          judge_maps(recording, inspection),
          judge_velocity(recording, inspection),
          judge_power(inspection),
          judge_fast(inspection),
          judge_flight(inspection),
          judge_axial(inspection)};
}

}  // namespace millscope::inspect
