#include "kernel/dem/ledger.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace millscope::dem {

/// From the power of two, which leaves at most two bins to go up: a logarithm for every collision took a hundredth of the time.
int ImpactBins::bin(double energy) {
  static const std::array<double, kCount> edges = [] {
    std::array<double, kCount> all;
    for (int b = 0; b < kCount; ++b) all[b] = lower_edge(b);
    return all;
  }();
  if (!(energy >= edges[0])) return 0;
  if (energy >= edges[kCount - 1]) return kCount - 1;
  const double lowest = (std::ilogb(energy) * std::numbers::ln2 / std::numbers::ln10 - kLowest) * kPerDecade;
  int b = std::clamp(static_cast<int>(lowest), 0, kCount - 2);
  while (energy >= edges[b + 1]) ++b;
  return b;
}

double ImpactBins::lower_edge(int bin) { return std::pow(10.0, kLowest + static_cast<double>(bin) / kPerDecade); }

void Ledger::reset_instant() {
  for (PairLedger& p : pairs) {
    p.elastic = 0;
    p.contacts = 0;
  }
  for (BodyLedger& b : bodies) {
    b.force = {};
    b.torque = {};
    b.power = 0;
  }
}

void Ledger::add(const Ledger& other) {
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    PairLedger& p = pairs[i];
    const PairLedger& q = other.pairs[i];
    p.elastic += q.elastic;
    for (std::size_t c = 0; c < p.dissipated.size(); ++c) p.dissipated[c] += q.dissipated[c];
    for (std::size_t w = 0; w < p.worn.size(); ++w) p.worn[w] += q.worn[w];
    p.contacts += q.contacts;
    p.collisions += q.collisions;
    p.impact_energy += q.impact_energy;
    p.largest_closing_speed = std::max(p.largest_closing_speed, q.largest_closing_speed);
    p.largest_overlap = std::max(p.largest_overlap, q.largest_overlap);
    for (std::size_t b = 0; b < p.spectrum.size(); ++b) p.spectrum[b] += q.spectrum[b];
  }
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    BodyLedger& p = bodies[i];
    const BodyLedger& q = other.bodies[i];
    for (std::size_t a = 0; a < 3; ++a) {
      p.force[a] += q.force[a];
      p.torque[a] += q.torque[a];
    }
    p.power += q.power;
    p.work += q.work;
  }
  for (std::size_t i = 0; i < body_force_work.size(); ++i) body_force_work[i] += other.body_force_work[i];
}

}  // namespace millscope::dem
