// Where the charge leaves the shell and where it comes back to it, from the polar map about the mill's axis.
//
// Departure shoulder θ_s: the angle at which the mean flow along the shell begins to turn inwards.
//
//   −v̄_r/(|Ω| r_max) ≈ A max(0, θ − θ_s + b (1 − r/r_max))      least squares over the cells of the rising stream, weight = time
//
// Beads nearer the centre of circulation turn back earlier (b ≥ 0), so all streamlines of the outer three quarters between the centre
// and the shell tell where the outermost one leaves; a single tracer that seldom comes to the shell itself is enough.
//
// Bulk toe θ_t: the angle that halves the net outward flow, Σ w v_r, into the zone next to the shell (r > 0.85 r_max) before the angle
// of the centre of circulation. Departure median and last: the same for the net inward flow after it.
#pragma once

#include <numbers>
#include <vector>

#include "analyzers/charge_features/fields.hpp"
#include "analyzers/common/centre.hpp"

#include "millscope/element.hpp"

namespace millscope::analyzers {

/// Angles in rad; NaN where the data do not say. All are NaN where less than a tenth of the stream along the shell leaves it: the charge
/// centrifuges.
struct ShellFeatures {
  double shoulder = kNaN;
  double departure_median = kNaN, departure_last = kNaN;
  double bulk_toe = kNaN, farthest_toe = kNaN;
};

namespace detail {

inline constexpr double kShellZone = 0.85;     ///< of the largest radius
inline constexpr double kStreamStart = 0.25;   ///< of the way from the centre of circulation to the shell
inline constexpr double kSteepest = 5;         ///< of A, per rad: free fall from a slowly turning shell gives about 4
inline constexpr double kLeastSupport = 1e-3;  ///< of the time of the rising stream that a departure must rest on
inline constexpr double kLatest = 170;         ///< deg; a departure that is not before this is none
inline constexpr double kLeastExchange = 0.1;  ///< of the stream along the shell that must leave it for a shoulder to exist

/// A cell of the rising stream.
struct StreamCell {
  double angle, depth;  ///< rad; 1 − r/r_max
  double time, inward;  ///< s; −v̄_r/(|Ω| r_max)
};

inline std::vector<StreamCell> rising_stream(const ChargeFields& fields, const Centre& centre) {
  const FieldShape& shape = fields.shape();
  const double from = shape.angle(centre.x, centre.y), r = std::hypot(centre.x, centre.y);
  const double inner = r + kStreamStart * (shape.reach - r), speed = shape.omega * shape.reach;
  std::vector<StreamCell> cells;
  for (std::int64_t a = shape.angles.at(from).value_or(shape.angles.count); a < shape.angles.count; ++a) {
    for (std::int64_t k = shape.rings.at(inner).value_or(shape.rings.count); k < shape.rings.count; ++k) {
      const double* cell = fields.polar(a, k);
      if (!(cell[kPolarTime] > 0) || shape.rings.centre(k) < inner) continue;
      cells.push_back({shape.angles.centre(a), 1 - shape.rings.centre(k) / shape.reach, cell[kPolarTime],
                       -cell[kOutward] / (cell[kPolarTime] * speed)});
    }
  }
  return cells;
}

struct Hinge {
  double at = kNaN, slope = 0, gain = 0;
};

/// The best place of the hinge for one b. Cells are put into fine bins of s = θ + b (1 − r/r_max); sums from the far end give every
/// candidate at once: with S_n = Σ w sⁿ and Y_n = Σ w y sⁿ beyond t, the fall of the misfit is (Y₁ − t Y₀)²/(S₂ − 2 t S₁ + t² S₀).
inline Hinge best_hinge(const std::vector<StreamCell>& cells, double b, const Bins& places) {
  struct Sums {
    double s0 = 0, s1 = 0, s2 = 0, y0 = 0, y1 = 0;
  };
  std::vector<Sums> bins(as_size(places.count));
  double all = 0;
  for (const StreamCell& cell : cells) {
    const double s = cell.angle + b * cell.depth;
    const std::optional<std::int64_t> bin = s >= places.high ? places.count - 1 : places.at(s);
    if (!bin) continue;
    Sums& sum = element(bins, *bin);
    sum.s0 += cell.time;
    sum.s1 += cell.time * s;
    sum.s2 += cell.time * s * s;
    sum.y0 += cell.time * cell.inward;
    sum.y1 += cell.time * cell.inward * s;
    all += cell.time;
  }
  Hinge best;
  Sums far;
  for (std::int64_t i = places.count - 1; i >= 0; --i) {
    const Sums& here = element(bins, i);
    far.s0 += here.s0, far.s1 += here.s1, far.s2 += here.s2, far.y0 += here.y0, far.y1 += here.y1;
    const double t = places.edge(i), square = far.s2 - t * (2 * far.s1 - t * far.s0), mixed = far.y1 - t * far.y0;
    if (!(mixed > 0 && square > 0 && far.s0 > kLeastSupport * all) || mixed > kSteepest * square) continue;
    if (mixed * mixed / square > best.gain) best = {t, mixed / square, mixed * mixed / square};
  }
  return best;
}

inline double shoulder(const ChargeFields& fields, const Centre& centre) {
  const std::vector<StreamCell> cells = rising_stream(fields, centre);
  const double from = fields.shape().angle(centre.x, centre.y), to = kLatest / kDegrees;
  if (!(to > from)) return kNaN;
  const Bins places(from, to, static_cast<std::int64_t>(std::ceil((to - from) * kDegrees * 4)));
  constexpr int kSlopes = 60;  // of b, 0 … 600° per radius
  Hinge best;
  for (int i = 0; i <= kSlopes; ++i) {
    const Hinge hinge = best_hinge(cells, 10.0 / kDegrees * i, places);
    if (hinge.gain > best.gain) best = hinge;
  }
  return best.at < places.edge(places.count - 1) ? best.at : kNaN;
}

/// What comes back to the shell's zone over what streams along it at the angle of the centre of circulation, roughly 0 … 1. Through an arc
/// of one bin the outward flow is Σ w v_r/(depth of the zone), and along the shell Σ w v_θ/(r Δθ).
inline double exchange(const ChargeFields& fields, const std::vector<double>& flow, std::int64_t from, std::int64_t turn) {
  const FieldShape& shape = fields.shape();
  double sum = 0, largest = 0, stream = 0;
  for (std::int64_t a = from; a < turn; ++a) {
    sum += element(flow, a);
    largest = std::fmax(largest, sum);
  }
  for (std::int64_t k = 0; k < shape.rings.count; ++k) {
    const double r = shape.rings.centre(k);
    if (r > kShellZone * shape.reach) stream += fields.polar(turn, k)[kAround] / (r * shape.angles.width());
  }
  return stream > 0 ? largest / ((1 - kShellZone) * shape.reach) / stream : 0;
}

/// Net flow through the zone next to the shell per angle: outward positive. m
inline std::vector<double> shell_flow(const ChargeFields& fields) {
  const FieldShape& shape = fields.shape();
  std::vector<double> flow(as_size(shape.angles.count), 0.0);
  for (std::int64_t a = 0; a < shape.angles.count; ++a) {
    for (std::int64_t k = 0; k < shape.rings.count; ++k) {
      if (shape.rings.centre(k) > kShellZone * shape.reach) element(flow, a) += fields.polar(a, k)[kOutward];
    }
  }
  return flow;
}

/// The angle at which the running sum of `flow` first has the fraction `part` of its largest value; the sum starts at bin `from` and goes
/// by `step` (±1) for `count` bins.
inline double flow_quantile(const std::vector<double>& flow, const Bins& angles, std::int64_t from, std::int64_t step, std::int64_t count,
                            double part) {
  double sum = 0, largest = 0;
  for (std::int64_t i = 0; i < count; ++i) {
    sum += element(flow, from + i * step);
    largest = std::fmax(largest, sum);
  }
  if (!(largest > 0)) return kNaN;
  double before = 0;
  for (std::int64_t i = 0; i < count; ++i) {
    const std::int64_t bin = from + i * step;
    const double after = before + element(flow, bin);
    if (after >= part * largest) {
      const double inside = (part * largest - before) / (after - before);
      return step > 0 ? angles.edge(bin) + inside * angles.width() : angles.edge(bin + 1) - inside * angles.width();
    }
    before = after;
  }
  return kNaN;
}

}  // namespace detail

inline ShellFeatures find_shell_features(const ChargeFields& fields, const Centre& centre) {
  const Bins& angles = fields.shape().angles;
  const std::int64_t turn = *angles.at(fields.shape().angle(centre.x, centre.y)), top = angles.count - 1,
                     bottom = *angles.at(-2 * std::numbers::pi / 3);
  std::vector<double> flow = detail::shell_flow(fields);
  ShellFeatures found;
  if (detail::exchange(fields, flow, bottom, turn) < detail::kLeastExchange) return found;
  found.shoulder = detail::shoulder(fields, centre);
  found.bulk_toe = detail::flow_quantile(flow, angles, bottom, 1, turn - bottom, 0.5);
  found.farthest_toe = detail::flow_quantile(flow, angles, bottom, 1, turn - bottom, 0.1);
  for (double& f : flow) f = -f;
  found.departure_median = detail::flow_quantile(flow, angles, top, -1, top - turn, 0.5);
  found.departure_last = detail::flow_quantile(flow, angles, top, -1, top - turn, 0.1);
  return found;
}

/// Radius at which the flow turns from rising (outside) to falling (inside), m, for sectors of `merge` bins of the angle; NaN where all of
/// the charge rises or all falls. It maximises the flow between it and the shell, ∫ v_θ occupancy dr.
inline std::vector<double> equilibrium_surface(const ChargeFields& fields, std::int64_t merge) {
  const FieldShape& shape = fields.shape();
  std::vector<double> surface(as_size(shape.angles.count / merge), kNaN);
  constexpr double kLeastFall = 0.02;  // of the rising flow: less is noise
  for (std::size_t sector = 0; sector < surface.size(); ++sector) {
    std::vector<double> flow(as_size(shape.rings.count), 0.0), time(flow);
    for (std::int64_t a = 0; a < merge; ++a) {
      for (std::int64_t k = 0; k < shape.rings.count; ++k) {
        const double* cell = fields.polar(static_cast<std::int64_t>(sector) * merge + a, k);
        element(flow, k) += cell[kAround];
        element(time, k) += cell[kPolarTime];
      }
    }
    double sum = 0, largest = 0;
    std::size_t at = flow.size();
    for (std::size_t k = flow.size(); k-- > 0;) {
      sum += flow[k];
      if (sum > largest) largest = sum, at = k;
    }
    if (!(largest > 0) || at == 0 || largest - sum < kLeastFall * largest) continue;
    // `at` is the innermost ring that rises. Between it and the next one inwards that was seen the mean velocity changes its sign.
    std::size_t inner = at;
    while (inner > 0 && !(time[inner - 1] > 0)) --inner;
    if (inner == 0) continue;
    --inner;
    const double rising = flow[at] / time[at], falling = flow[inner] / time[inner];
    const double outer_r = shape.rings.centre(static_cast<std::int64_t>(at)),
                 inner_r = shape.rings.centre(static_cast<std::int64_t>(inner));
    surface[sector] = outer_r - (outer_r - inner_r) * rising / (rising - falling);
  }
  return surface;
}

}  // namespace millscope::analyzers
