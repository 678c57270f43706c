// The energy book: what each slab has added up since the start, reduced in slab order.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace millscope::dem {

/// Impact energies ½ m* v_n² at first touch, J: `kPerDecade` bins a decade from 10^kLowest up; first and last bins take what lies outside.
struct ImpactBins {
  static constexpr int kPerDecade = 4, kLowest = -12, kHighest = 2;
  static constexpr int kCount = (kHighest - kLowest) * kPerDecade;
  static int bin(double energy);
  static double lower_edge(int bin);
};

/// Of one pair of materials.
struct PairLedger {
  double elastic = 0;                ///< J, at this instant
  std::vector<double> dissipated;    ///< J since the start, per channel
  std::vector<double> worn;          ///< m³ of the wall since Settings::wear_from_step, per wear law
  std::int64_t contacts = 0;         ///< at this instant
  std::int64_t collisions = 0;       ///< first touches since the start
  double impact_energy = 0;          ///< Σ ½ m* v_n² of them, J
  double largest_closing_speed = 0;  ///< m/s since the start
  double largest_overlap = 0;        ///< as a fraction of R*, since the start
  std::array<std::int64_t, ImpactBins::kCount> spectrum{};
};

/// Of one wall body.
struct BodyLedger {
  std::array<double, 3> force{};   ///< on the body at this instant, N
  std::array<double, 3> torque{};  ///< on the body about its centre at this instant, N m
  double power = 0;                ///< that the body gives to the charge at this instant, W
  double work = 0;                 ///< since the start, J
};

struct Ledger {
  std::vector<PairLedger> pairs;
  std::vector<BodyLedger> bodies;
  std::vector<double> body_force_work;  ///< J taken from the beads by each non-uniform body force

  void reset_instant();
  void add(const Ledger& other);
};

}  // namespace millscope::dem
