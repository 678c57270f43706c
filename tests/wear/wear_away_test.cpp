// A profile moves into the metal by what it has lost.
#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>

#include "studies/wear/wear_away.hpp"

using namespace millscope::wear;

namespace {

constexpr double kShell = 0.1, kLength = 0.05;

/// One pitch of ten: a shell, with a lifter of `height` between two shares of the pitch; its faces slope over `face` of the pitch.
Profile with_lifter(double height, double face, std::size_t columns = 120) {
  Profile p;
  p.pitches = 10, p.columns = columns, p.low = 0, p.high = kLength;
  for (std::size_t c = 0; c < columns; ++c) {
    const double at = static_cast<double>(c) / static_cast<double>(columns);
    const double up = std::clamp(std::min((at - 0.3) / face, (0.7 - at) / face), 0.0, 1.0);
    p.radius.push_back(kShell - height * up);
    p.material.push_back(0);
  }
  return p;
}

/// What an even loss of `depth` makes, m³ of all pitches.
std::vector<double> even(const Profile& p, const Stretches& s, double depth) {
  std::vector<double> volume = lengths_of(p, s, 0);
  for (double& v : volume) v *= depth * kLength * p.pitches;
  return volume;
}

double sum(const std::vector<double>& values) {
  double total = 0;
  for (const double v : values) total += v;
  return total;
}

}  // namespace

TEST_CASE("a smooth shell that loses evenly gets wider by the depth") {
  Profile p = with_lifter(0, 0.1);
  const Profile before = p;
  const Stretches s = stretches_of(p);
  const std::vector<double> volume = even(p, s, 1e-4);
  const double moved = wear_away(p, s, volume);
  CHECK(moved == Approx(1e-4).epsilon(2e-3));  // a wider shell has more area: 1e-4/0.2 less deep
  for (const double r : p.radius) CHECK(r - kShell == Approx(moved).epsilon(1e-3));
  CHECK(sum(volumes_between(before, p)) == Approx(sum(volume)).epsilon(1e-5));
}

TEST_CASE("what goes from the profile is what the law said, also at edges and on upright faces") {
  for (const double face : {0.1, 0.02, 0.008}) {  // of the pitch: 38, 78 and 85 degrees
    for (const double depth : {5e-5, 3e-4, 1e-3}) {
      INFO(face << " " << depth);
      Profile p = with_lifter(5e-3, face);
      const Profile before = p;
      const Stretches s = stretches_of(p);
      const std::vector<double> volume = even(p, s, depth);
      wear_away(p, s, volume);
      CHECK(sum(volumes_between(before, p)) == Approx(sum(volume)).epsilon(1e-5));
      for (std::size_t c = 0; c < p.columns; ++c) CHECK(p.at(0, c) >= before.at(0, c));
    }
  }
}

TEST_CASE("a straight top whose normal points along a direction loses what it should") {
  Profile p;
  p.pitches = 20, p.columns = 38, p.low = 0, p.high = kLength;
  for (std::size_t c = 0; c < p.columns; ++c) {  // flat lifter tops about direction 0, 20 mm high, in a shell of 300 mm
    const double turn = static_cast<double>(c) * p.step(), away = std::min(turn, p.step() * static_cast<double>(p.columns) - turn);
    p.radius.push_back(std::min(0.3, std::max(0.28 / std::cos(away), 0.28 + (away - 0.045) * 1.5)));
    p.material.push_back(0);
  }
  for (const double depth : {2e-5, 1.46e-4, 4e-4, 1e-3}) {
    INFO(depth);
    Profile worn = p;
    const Stretches s = stretches_of(worn);
    const std::vector<double> volume = even(worn, s, depth);
    wear_away(worn, s, volume);
    CHECK(sum(volumes_between(p, worn)) == Approx(sum(volume)).epsilon(1e-5));
    for (std::size_t c = 0; c < p.columns; ++c) CHECK(worn.at(0, c) - p.at(0, c) < 6 * depth);  // the sides stand at 80 degrees
  }
}

TEST_CASE("a face that alone loses goes back along its normal and stays straight") {
  Profile p = with_lifter(5e-3, 0.1, 600);
  const Profile before = p;
  const Stretches s = stretches_of(p);
  std::vector<double> volume(s.count(), 0.0);
  const std::vector<double> lengths = lengths_of(p, s, 0);
  const double depth = 2e-4;
  for (std::size_t c = 0; c < p.columns; ++c) {
    const double at = (static_cast<double>(c) + 0.5) / static_cast<double>(p.columns);
    if (at < 0.3 || at > 0.4) continue;
    for (std::size_t k = s.first[c]; k < s.first[c + 1]; ++k) volume[k] = lengths[k] * depth * kLength * p.pitches;
  }
  const double moved = wear_away(p, s, volume);
  CHECK(moved == Approx(depth).epsilon(0.05));
  const std::size_t middle = static_cast<std::size_t>(0.35 * 600);
  const double slope = (before.at(0, middle - 20) - before.at(0, middle + 20)) / (40 * p.step() * before.at(0, middle));
  CHECK(p.at(0, middle) - before.at(0, middle) == Approx(moved * std::sqrt(1 + slope * slope)).epsilon(0.02));
  CHECK(p.at(0, static_cast<std::size_t>(0.55 * 600)) == before.at(0, static_cast<std::size_t>(0.55 * 600)));
  CHECK(p.at(0, static_cast<std::size_t>(0.1 * 600)) == before.at(0, static_cast<std::size_t>(0.1 * 600)));
}

TEST_CASE("rows wear each by what it has lost") {
  Profile p = with_lifter(5e-3, 0.1);
  const Profile single = p;
  p.rows = 3;
  p.radius.clear();
  for (int row = 0; row < 3; ++row) p.radius.insert(p.radius.end(), single.radius.begin(), single.radius.end());
  const Stretches s = stretches_of(p);
  std::vector<double> volume(3 * s.count(), 0.0);
  const std::vector<double> lengths = lengths_of(p, s, 0);
  for (std::size_t k = 0; k < s.count(); ++k) volume[2 * s.count() + k] = 1e-4 * lengths[k] * p.row_length() * p.pitches;
  wear_away(p, s, volume);
  CHECK(p.at(0, 3) == single.at(0, 3));
  CHECK(p.at(1, 3) == single.at(0, 3));
  CHECK(p.at(2, 3) - single.at(0, 3) == Approx(1e-4).epsilon(0.05));
}

TEST_CASE("a lifter that loses in proportion to its height wears the same in steps half as long") {
  const auto worn = [](int steps) {
    Profile p = with_lifter(5e-3, 0.1);
    for (int step = 0; step < steps; ++step) {
      const Stretches s = stretches_of(p);
      std::vector<double> volume = lengths_of(p, s, 0);
      for (std::size_t c = 0; c < p.columns; ++c) {
        const double up = (kShell + 3e-3 - p.at(0, c)) / 5e-3;
        for (std::size_t k = s.first[c]; k < s.first[c + 1]; ++k) volume[k] *= 2e-3 / steps * std::max(up, 0.0) * kLength * p.pitches;
      }
      wear_away(p, s, volume);
    }
    return p;
  };
  const Profile coarse = worn(8), fine = worn(16);
  double furthest = 0;
  for (std::size_t c = 0; c < coarse.columns; ++c) furthest = std::max(furthest, std::fabs(coarse.at(0, c) - fine.at(0, c)));
  CHECK(furthest < 0.02 * 5e-3);
}
