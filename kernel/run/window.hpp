// What is sampled while a run goes on, and the means over its analysis window.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "kernel/run/assembly.hpp"

namespace millscope::run {

/// One sample of the whole charge.
struct Sample {
  double time = 0;
  double translational = 0, rotational = 0, elastic = 0, potential = 0;  ///< J
  std::array<double, 3> centre{};                                        ///< m
  double wall_work = 0;                                                  ///< of all bodies since the start, J
  double torque_work = 0;                                                ///< of the turning bodies since the start, J
  double dissipated = 0;                                                 ///< all channels and drag since the start, J
  double torque = 0;                                                     ///< on the turning bodies about z at this instant, N m
  std::int64_t contacts = 0;
};

Sample take_sample(const dem::System& system, const Assembly& a);

/// Samples every `kSampleInterval` of simulated time from the start of the analysis window to the end.
inline constexpr double kSampleInterval = 1e-3;  // s

/// P = M g ⟨x⟩ Ω, W, for any direction of gravity and any axis: Ω a · (M g × (r − p)) with the turning body's axis a through p. 0: none
/// turns.
double power_of_centre(const Assembly& a, double mass, double time, const std::array<double, 3>& centre);

/// The charge over an analysis window, evenly sampled; at least 9 values each.
struct Course {
  double from = 0, until = 0;                  ///< s
  std::vector<double> torque;                  ///< power by torque, W; empty: not known, and that by centre of mass is
  std::vector<double> centre;                  ///< power by centre of mass, W; empty: not known
  std::vector<double> kinetic;                 ///< J; empty: not known
  std::array<std::vector<double>, 3> place{};  ///< of the centre of mass, m; empty: not known
};

/// window_s, steady, steadiness, power_W, com_m, kinetic_energy_J, with standard errors; what is not known is null or absent.
nlohmann::ordered_json means_of(const Course& course);

/// Means, standard errors, steadiness and energy balance over the samples of the window.
nlohmann::ordered_json window_summary(const Assembly& a, const std::vector<Sample>& samples);

/// Names and values of the columns of series.csv.
std::vector<std::string> series_columns(const Assembly& a);
std::vector<double> series_row(const Sample& s, const Assembly& a, double power);

/// Collisions per pair of materials since `before`.
nlohmann::ordered_json collision_summary(const Assembly& a, const dem::Ledger& now, const dem::Ledger& before, double seconds);

}  // namespace millscope::run
