#include <catch2/catch.hpp>

#include "analyzers_fields/analyzer.hpp"

using namespace analyzers_test;

namespace {

constexpr double kOmega = 6;

/// Index of a cell of the default grid (50 × 50 cells of 6 mm).
std::size_t cell_at(double x, double y) {
  return static_cast<std::size_t>(std::floor((y + 0.15) / 0.006)) * 50 + static_cast<std::size_t>(std::floor((x + 0.15) / 0.006));
}

}  // namespace

TEST_CASE("a rigid rotation has one angular velocity in every cell") {
  const double sense = GENERATE(1.0, -1.0);
  const auto frames =
      all_beads(turning_disc(3000, 0.14, sense * kOmega), 3000, even_times(20, 0.01), std::vector<double>(20, 0.01), sense * kOmega);
  const Outcome o = Analyzer("pept_grid", study(sense)).of(frames);
  CHECK(sum(values(o, "occupancy")) == Approx(1).epsilon(1e-12));
  CHECK(number(o, "outside_fraction") == Approx(0).margin(1e-12));
  CHECK(number(o, "bead_time") == Approx(3000 * 20 * 0.01));
  std::size_t seen = 0;
  for (std::size_t i = 0; i < 2500; ++i) {
    if (std::isnan(values(o, "speed")[i])) {
      CHECK(values(o, "occupancy")[i] == 0);
      continue;
    }
    ++seen;
    CHECK(values(o, "angular_speed")[i] == Approx(kOmega));
    CHECK(values(o, "angular_velocity")[i] == Approx(kOmega));
    const double x = -0.147 + 0.006 * static_cast<double>(i % 50), y = -0.147 + 0.006 * static_cast<double>(i / 50);
    CHECK(values(o, "velocity_x")[i] == Approx(-sense * kOmega * y).margin(kOmega * 0.003));
    CHECK(values(o, "velocity_y")[i] == Approx(sense * kOmega * x).margin(kOmega * 0.003));
    CHECK(values(o, "speed")[i] == Approx(kOmega * std::hypot(x, y)).margin(kOmega * 0.0043));
    // Across a cell the velocity varies by ω times its place: variance (6 mm ω)²/12 in x and in y, at most (3 mm ω)².
    CHECK(values(o, "granular_temperature")[i] >= -1e-12);
    CHECK(values(o, "granular_temperature")[i] <= 2 * std::pow(0.003 * kOmega, 2) / 3);
  }
  CHECK(seen > 1650);  // π 0.14²/0.006² = 1710 cells
}

TEST_CASE("cylindrical components count in the turning sense, from 6 o'clock") {
  const double sense = GENERATE(1.0, -1.0);
  // Rising side, level with the axis: x > 0 when the mill turns counter-clockwise.
  const Motion still = [=](std::int64_t, double) { return Sample{{sense * 0.1, 1e-4, 0.1}, {sense * 0.2, 0.3, 0.4}}; };
  const Outcome o = Analyzer("pept_grid", study(sense), "grid=r_theta_z cells_z=3").of(all_beads(still, 1, {0.0}, {1.0}, sense * kOmega));
  CHECK(o.at("occupancy").shape == std::vector<std::uint64_t>{3, 25, 72});
  CHECK(o.at("occupancy").axes == std::vector<std::string>{"z_edges", "r_edges", "theta_edges_deg"});
  const std::size_t cell = (1 * 25 + 16) * 72 + 36 + 18;  // z of 0.09…0.18, r of 0.096…0.102, θ of 90°…95°
  CHECK(values(o, "theta_edges_deg")[54] == Approx(90));
  CHECK(values(o, "occupancy")[cell] == 1);
  CHECK(values(o, "velocity_r")[cell] == Approx(0.2).epsilon(1e-2));
  CHECK(values(o, "velocity_theta")[cell] == Approx(0.3).epsilon(1e-2));
  CHECK(values(o, "velocity_z")[cell] == 0.4);
  CHECK(values(o, "angular_velocity")[cell] == Approx(3).epsilon(1e-2));
}

TEST_CASE("two maps alone are those among all, to the bit") {
  const auto frames = all_beads(turning_disc(300, 0.14, kOmega), 300, even_times(20, 0.01), std::vector<double>(20, 0.01), kOmega);
  const Outcome all = Analyzer("pept_grid", study()).of(frames),
                two = Analyzer("pept_grid", study(), "maps=occupancy_and_speed").of(frames);
  CHECK(values(two, "occupancy") == values(all, "occupancy"));
  const auto &a = values(all, "speed"), &b = values(two, "speed");
  CHECK(std::equal(a.begin(), a.end(), b.begin(), b.end(), [](double x, double y) { return x == y || (std::isnan(x) && std::isnan(y)); }));
  CHECK(number(two, "outside_fraction") == number(all, "outside_fraction"));
  CHECK(all.count("visits") == 1);
  CHECK(two.count("visits") == 0);
}

TEST_CASE("two cells in turn: shares by time, visits by entries") {
  const std::array<double, 3> first{0.003, 0.003, 0.1}, second{0.063, -0.057, 0.1};
  Frames frames;
  constexpr int kTurns = 12;
  double t = 0;
  for (int turn = 0; turn < kTurns; ++turn) {
    for (int i = 0; i < 3; ++i, t += 0.001) frames.add_sample(0, {first, {1, 0, 0}}, 0.001), frames.end_frame(t, kOmega);
    for (int i = 0; i < 7; ++i, t += 0.001) frames.add_sample(0, {second, {0, -2, 0}}, 0.001), frames.end_frame(t, kOmega);
  }
  const Outcome o = Analyzer("pept_grid", study()).of(frames);
  CHECK(values(o, "occupancy")[cell_at(0.003, 0.003)] == Approx(0.3));
  CHECK(values(o, "occupancy")[cell_at(0.063, -0.057)] == Approx(0.7));
  CHECK(values(o, "speed")[cell_at(0.063, -0.057)] == Approx(2));
  CHECK(values(o, "visits")[cell_at(0.003, 0.003)] == kTurns - 1);  // the first one began before the first sample
  CHECK(values(o, "visits")[cell_at(0.063, -0.057)] == kTurns);
  CHECK(sum(values(o, "visits")) == 2 * kTurns - 1);
}

TEST_CASE("a gap, another bead, or a trimmed stretch is no entry") {
  const auto at = [](double x, double z) { return Sample{{x, 0.001, z}, {0, 0, 0}}; };
  Frames gap;
  for (int i = 0; i < 6; ++i) gap.add_sample(0, at(i < 3 ? 0.001 : 0.101, 0.1), 0.01), gap.end_frame(0.01 * i, kOmega, 0, i < 3 ? 0 : 1);
  CHECK(sum(values(Analyzer("pept_grid", study()).of(gap), "visits")) == 0);

  Frames beads;
  for (int i = 0; i < 6; ++i)
    beads.add_sample(0, at(0.001, 0.1), 0.01), beads.add_sample(1, at(0.101, 0.1), 0.01), beads.end_frame(0.01 * i, kOmega);
  CHECK(sum(values(Analyzer("pept_grid", study()).of(beads), "visits")) == 0);

  // Out of the range along z and back: one entry, into the cell that it comes back to.
  Frames out;
  for (int i = 0; i < 9; ++i) out.add_sample(0, at(0.001, i < 3 || i >= 6 ? 0.1 : 0.26), 0.01), out.end_frame(0.01 * i, kOmega);
  const Outcome o = Analyzer("pept_grid", study(), "end_trim=0.05").of(out);
  CHECK(sum(values(o, "visits")) == 1);
  CHECK(number(o, "in_range_fraction") == Approx(6.0 / 9.0));
  CHECK(sum(values(o, "occupancy")) == Approx(1));
}

TEST_CASE("a bead on a circle enters each sector once a turn") {
  const double period = 2 * kPi / kOmega;
  const Motion circle = [](std::int64_t, double t) {
    const double angle = kOmega * t + 0.01;
    return Sample{{0.1 * std::cos(angle), 0.1 * std::sin(angle), 0.1}, {-0.6 * std::sin(angle), 0.6 * std::cos(angle), 0}};
  };
  const std::size_t n = 5 * 720;
  const Outcome o = Analyzer("pept_grid", study(), "grid=cylindrical")
                        .of(one_bead(circle, 0, even_times(n, period / 720), std::vector<double>(n, period / 720), kOmega));
  for (std::size_t sector = 0; sector < 72; ++sector) {
    const std::size_t cell = 16 * 72 + sector;
    CHECK(values(o, "occupancy")[cell] == Approx(1.0 / 72));
    CHECK(values(o, "visits")[cell] == 5);
    CHECK(values(o, "velocity_theta")[cell] == Approx(0.6));
    CHECK(values(o, "granular_temperature")[cell] == Approx(0).margin(1e-12));
  }
  CHECK(sum(values(o, "visits")) == 5 * 72);
}

TEST_CASE("the fluctuation is the variance, less that of the measurement") {
  Frames frames;
  for (int i = 0; i < 100; ++i) {
    frames.add_sample(0, {{0.05, 0.02, 0.1}, {1 + (i % 2 == 0 ? 0.3 : -0.3), 0.5, i % 4 < 2 ? 0.1 : -0.1}}, 0.01);
    frames.end_frame(0.01 * i, kOmega);
  }
  const std::size_t cell = cell_at(0.05, 0.02);
  CHECK(values(Analyzer("pept_grid", study()).of(frames), "granular_temperature")[cell] == Approx((0.09 + 0.01) / 3));
  frames.variance.assign(100, 0.02);
  CHECK(values(Analyzer("pept_grid", study()).of(frames), "granular_temperature")[cell] == Approx((0.09 + 0.01) / 3 - 0.02));
}

namespace {

constexpr std::int64_t kManyBeads = 200000;

/// A mill that is evenly filled with many beads.
AnalyzerContext full_mill() {
  AnalyzerContext context = study();
  context.charge_count = kManyBeads;
  context.largest_id = kManyBeads - 1;
  context.bead_radius = 2e-3;
  return context;
}
double solids_of_full_mill() { return kManyBeads * 4.0 / 3.0 * kPi * 8e-9 / (kPi * 0.0225 * 0.27); }
Frames frames_of_full_mill() { return all_beads(turning_disc(kManyBeads, 0.15, 0), kManyBeads, {0.0}, {0.01}, kOmega); }

/// Share of a 15 mm cell that lies in the shell, counted on 100 × 100 points.
double share_in_shell(std::size_t cell) {
  int inside = 0;
  for (int i = 0; i < 100; ++i) {
    for (int j = 0; j < 100; ++j) {
      const double x = -0.15 + 0.015 * (static_cast<double>(cell % 20) + (i + 0.5) / 100),
                   y = -0.15 + 0.015 * (static_cast<double>(cell / 20) + (j + 0.5) / 100);
      inside += std::hypot(x, y) < 0.15;
    }
  }
  return inside * 1e-4;
}

}  // namespace

TEST_CASE("porosity from occupancy: an evenly filled mill gives its own, also where the shell cuts a cell") {
  const Outcome o = Analyzer("pept_grid", full_mill(), "cells_x=20 cells_y=20").of(frames_of_full_mill());
  std::size_t cut = 0;
  for (std::size_t i = 0; i < 400; ++i) {
    const double porosity = values(o, "porosity")[i], share = share_in_shell(i);
    if (share < 0.01) continue;
    INFO(i << " share " << share);
    cut += share < 0.99;
    CHECK(share * porosity == Approx(share * (1 - solids_of_full_mill())).margin(0.012));  // as many beads as the boundary cuts
  }
  CHECK(cut > 40);
  const Outcome polar = Analyzer("pept_grid", full_mill(), "grid=cylindrical cells_r=10 cells_theta=12").of(frames_of_full_mill());
  for (std::size_t i = 12; i < 120; ++i) CHECK(values(polar, "porosity")[i] == Approx(1 - solids_of_full_mill()).margin(0.02));
}

TEST_CASE("porosity in a part of the length") {
  // In the disc of sunflower seeds z follows r, so that a range along z is a ring: all its beads stand in 150 of 270 mm.
  const Outcome o =
      Analyzer("pept_grid", full_mill(), "grid=cylindrical cells_r=30 cells_theta=6 z_from=0.05 z_to=0.2").of(frames_of_full_mill());
  const double inner = 0.15 * std::sqrt(0.05 / 0.27), outer = 0.15 * std::sqrt(0.2 / 0.27);
  for (std::size_t ring = 0; ring < 30; ++ring) {
    const double low = 0.005 * static_cast<double>(ring), high = low + 0.005;
    for (std::size_t i = 6 * ring; i < 6 * ring + 6; ++i) {
      if (low > inner && high < outer) CHECK(values(o, "porosity")[i] == Approx(1 - solids_of_full_mill() * 0.27 / 0.15).margin(0.02));
      if (high < inner || low > outer) CHECK(std::isnan(values(o, "porosity")[i]));
    }
  }
  CHECK(number(o, "in_range_fraction") == Approx(0.15 / 0.27).epsilon(1e-4));
}

TEST_CASE("porosity is left out where the charge is unknown") {
  AnalyzerContext context = study();
  context.charge_count = context.charge_mass = 0;
  CHECK(Analyzer("pept_grid", context).of(all_beads(turning_disc(10, 0.1, 1), 10, {0.0}, {1.0}, kOmega)).count("porosity") == 0);
}

TEST_CASE("what lies outside the grid is stated") {
  const Motion beyond = [](std::int64_t id, double) { return Sample{{id == 0 ? 0.2 : 0.05, 0, 0.1}, {0, 0, 0}}; };
  const Outcome o = Analyzer("pept_grid", study()).of(all_beads(beyond, 4, {0.0}, {1.0}, kOmega));
  CHECK(number(o, "outside_fraction") == Approx(0.25));
  CHECK(sum(values(o, "occupancy")) == Approx(0.75));
}

TEST_CASE("without a known sense the signed angular velocity is left out") {
  AnalyzerContext context = study();
  context.omega = 0;
  const Outcome o = Analyzer("pept_grid", context).of(all_beads(turning_disc(10, 0.1, 1), 10, {0.0}, {1.0}, 0));
  CHECK(o.count("angular_velocity") == 0);
  CHECK(o.count("angular_speed") == 1);
}
