#include "studies/new/mill.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace millscope::new_mill {
namespace {

constexpr double kGravity = 9.81;
constexpr double kMostOverlap = 0.1;
constexpr double kFrameBytes = 40, kPictureBytes = 60, kMostBytes = 1e9;  // a bead in frames.h5 and in a picture; each output altogether

/// How deep the fastest contact goes, part of the effective radius: Hertz, undamped, δ = (15 m v²/(16 E √R))^{2/5} with the effective
/// mass, modulus and radius (Johnson 1985, section 11.4). m/R³ is 4/3 π ρ at a wall and four times that between equal beads.
double overlap_of(double density, const Material& a, const Material& b, double factor, bool wall, double speed) {
  const double young = factor / ((1 - a.poisson * a.poisson) / a.young + (1 - b.poisson * b.poisson) / b.young);
  const double mass = (wall ? 1 : 4) * 4.0 / 3.0 * std::numbers::pi * density;
  return std::pow(15.0 / 16.0 * mass * speed * speed / young, 0.4);
}

double deepest(const Mill& m, double factor, double speed) {
  const double density = m.bead_material.density;
  return std::max(overlap_of(density, m.bead_material, m.bead_material, factor, false, speed),
                  overlap_of(density, m.bead_material, m.liner_material, factor, true, speed));
}

/// The smallest of 1, 2, 5, 10, … that is not below.
double round_up(double x) {
  const double decade = std::pow(10, std::floor(std::log10(x) + 1e-9));
  for (const double step : {1.0, 2.0, 5.0}) {
    if (step * decade >= x * (1 - 1e-9)) return step * decade;
  }
  return 10 * decade;
}

}  // namespace

/// Of the critical speed: slower is a slip of the pen, "0.7 %critical", more often than a mill.
constexpr double kSlowest = 0.05;

double critical_speed(double diameter, double bead) { return 42.3 / std::sqrt(diameter - bead) * 2 * std::numbers::pi / 60; }

double usual_seconds(double omega) { return 0.5 * std::ceil(2 * 4.5 * 2 * std::numbers::pi / omega); }

Choices choose(const Mill& m) {
  Choices c;
  const double volume = std::numbers::pi / 4 * m.diameter.si * m.diameter.si * m.length.si;
  c.beads = static_cast<std::uint64_t>(
      std::clamp(std::round(m.filling.si * volume * (1 - kPorosity) * 6 / (std::numbers::pi * std::pow(m.bead.si, 3))), 0.0, 1e18));
  c.fastest = std::sqrt(2 * kGravity * m.diameter.si) + m.omega * 0.5 * m.diameter.si;
  for (const double factor : {0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0}) {
    c.stiffness_factor = factor;
    c.overlap = deepest(m, factor, c.fastest);
    if (c.overlap <= kMostOverlap) break;
  }
  // Beads are put on a loose lattice: the topmost falls through half of the mill at most, and the bed comes to rest.
  c.settle = std::max(0.3, 0.05 * std::ceil(1.2 * std::sqrt(2 * m.diameter.si / kGravity) / 0.05 - 1e-9));
  c.analyze_from = std::round(0.55 * m.seconds.si * 1000) / 1000;  // of 4.5 turns the last two, which a run does not doubt
  const double turn = 2 * std::numbers::pi / m.omega, beads = static_cast<double>(c.beads);
  c.series_every = std::min(round_up(turn / 200), m.seconds.si);
  c.frames_every = round_up(std::max(turn / 200, (m.seconds.si - c.analyze_from) * beads * kFrameBytes / kMostBytes));
  c.pictures_every = round_up(std::max(turn / 50, m.seconds.si * beads * kPictureBytes / kMostBytes));
  return c;
}

std::vector<std::string> warnings(const Mill& m, const Choices& c) {
  std::vector<std::string> all;
  if (m.bead.si > 0.1 * m.diameter.si) {
    all.push_back(
        fmt::format("beads of {} are larger than a tenth of the mill ({}): a few beads are no charge, and its bulk cannot flow; "
                    "take smaller beads",
                    m.bead.text, m.diameter.text));
  }
  if (m.filling.si > 0.5) {
    all.push_back(
        fmt::format("a filling of {} is more than half of the mill: the charge turns about its own core and draws less power "
                    "the fuller it is; mills run at 20 to 45 %",
                    m.filling.text));
  }
  if (m.omega < kSlowest * m.critical_omega) {
    all.push_back(fmt::format(
        "{} is {:.2g} % of the critical speed, which no mill is and which takes {:.0f} s to simulate; mills run at 60 to 85 %critical",
        m.speed.text, 100 * m.omega / m.critical_omega, m.seconds.si));
  }
  if (m.omega >= m.critical_omega) {
    all.push_back(
        fmt::format("{} is {:.0f} % of the critical speed: the outer beads are held to the shell (centrifuging) and grind "
                    "nothing; mills run at 60 to 85 %critical",
                    m.speed.text, 100 * m.omega / m.critical_omega));
  }
  if (c.beads > 1000000) {
    all.push_back(
        fmt::format("about {:.2g} million beads take days and {:.0f} GB of memory or more; take larger beads, or a slice "
                    "(--ends periodic --length \"{}\")",
                    1e-6 * static_cast<double>(c.beads), std::ceil(1e-9 * 600 * static_cast<double>(c.beads)), millimetres(4 * m.bead.si)));
  }
  return all;
}

std::string millimetres(double metres, int digits) {
  const double mm = 1000 * metres, digit = std::pow(10, std::floor(std::log10(mm)) + 1 - digits);
  return fmt::format("{:.6g} mm", std::round(mm / digit) * digit);
}

}  // namespace millscope::new_mill
