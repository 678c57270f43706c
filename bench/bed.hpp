// A developed bed as a small text file: what both codes start from. Contact histories are left out; a warm-up builds them again.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "kernel/run/assembly.hpp"

namespace millscope::bench {

struct Bed {
  struct Bead {
    std::array<double, 3> position, velocity, spin;  ///< m, m/s, rad/s
  };
  double time = 0;       ///< s
  double time_step = 0;  ///< s
  double angle = 0;      ///< of the liner, rad
  double omega = 0;      ///< of the liner about z, rad/s
  double radius = 0;     ///< m, of every bead
  double density = 0;    ///< kg/m³
  double period = 0;     ///< along z, m; 0: between end faces
  std::vector<Bead> beads;
};

/// Throws UserError for a file that is missing or cut short.
Bed read_bed(const std::string& file);
void write_bed(const Bed& bed, const std::string& file);
/// The same beads as a data file of LIGGGHTS (atom style granular, spheres, type 1 of 2).
void write_liggghts(const Bed& bed, const std::string& file);

/// The present state of a system of equal beads. Throws UserError when they are not equal.
Bed bed_of(const run::Assembly& a);
/// Puts the beads of `bed` into the system at their time; to be stepped next.
void start_from(run::Assembly& a, const Bed& bed);

/// `copies` of a periodic bed side by side along z.
Bed replicated(const Bed& bed, int copies);
/// Without the beads that the end faces at `low` and `high` would touch; no longer periodic.
Bed between_ends(const Bed& bed, double low, double high);

}  // namespace millscope::bench
