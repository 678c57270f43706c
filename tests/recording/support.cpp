#include "recording/support.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <cmath>
#include <fstream>
#include <numbers>
#include <random>
#include <stdexcept>

namespace recording_test {

namespace fs = std::filesystem;

fs::path Scratch::file(const std::string& name, const std::string& text) const {
  std::ofstream(path / name, std::ios::binary) << text;
  return path / name;
}

fs::path Scratch::packed(const std::string& name, const std::string& text) const {
  gzFile out = gzopen((path / name).c_str(), "wb");
  if (out == nullptr || gzwrite(out, text.data(), static_cast<unsigned>(text.size())) != static_cast<int>(text.size())) {
    throw std::runtime_error("no gzip file");
  }
  gzclose(out);
  return path / name;
}

namespace {
constexpr double kLeave = std::numbers::pi / 3;
}  // namespace

Motion::Motion() {
  const double x0 = kRadius * std::cos(kLeave), y0 = kRadius * std::sin(kLeave);
  const double vx = -kRadius * kOmega * std::sin(kLeave), vy = kRadius * kOmega * std::cos(kLeave);
  const auto at = [&](double t) { return std::array{x0 + vx * t, y0 + vy * t - kGravity * t * t / 2}; };
  const auto outside = [&](double t) { return std::hypot(at(t)[0], at(t)[1]) - kRadius; };
  double low = 0.05, high = 0.6;  // inside the circle at first, then out of it below
  for (int k = 0; k < 100; ++k) (outside((low + high) / 2) < 0 ? low : high) = (low + high) / 2;
  flight_ = low;
  landing_ = std::atan2(at(flight_)[1], at(flight_)[0]);
  while (landing_ > kLeave) landing_ -= 2 * std::numbers::pi;
  ride_ = (kLeave - landing_) / kOmega;
}

std::array<double, 6> Motion::state(double t) const {
  const double cycle = std::floor(t / period()), u = t - cycle * period();
  // Along z a drift of ±40 mm/s that changes at each impact; the signs repeat after four cycles.
  constexpr double kDrift[] = {0.04, -0.03, 0.02, -0.03};
  double z = 0;
  const auto n = static_cast<long>(cycle);
  for (long k = 0; k < n % 4; ++k) z += kDrift[k] * period();
  const double vz = kDrift[n % 4];
  z += vz * u;
  if (u < ride_) {
    const double angle = landing_ + kOmega * u;
    return {kRadius * std::cos(angle),           kRadius * std::sin(angle),          z,
            -kRadius * kOmega * std::sin(angle), kRadius * kOmega * std::cos(angle), vz};
  }
  const double f = u - ride_, vx = -kRadius * kOmega * std::sin(kLeave), vy = kRadius * kOmega * std::cos(kLeave);
  return {kRadius * std::cos(kLeave) + vx * f, kRadius * std::sin(kLeave) + vy * f - kGravity * f * f / 2, z, vx, vy - kGravity * f, vz};
}

std::array<double, 3> Motion::position(double t) const {
  const auto s = state(t);
  return {s[0], s[1], s[2]};
}
std::array<double, 3> Motion::velocity(double t) const {
  const auto s = state(t);
  return {s[3], s[4], s[5]};
}
bool Motion::flies(double t) const { return t - std::floor(t / period()) * period() > ride_; }

millscope::recording::Run see(const Motion& motion, const Camera& camera) {
  std::mt19937_64 generator(camera.seed);
  std::exponential_distribution<double> pause(camera.rate);
  std::normal_distribution<double> normal;
  millscope::recording::Run run;
  run.name = run.source = "seen";
  std::array<double, 3> noise{normal(generator), normal(generator), normal(generator)};
  double t = 0;
  while (t < camera.duration) {
    t += pause(generator);
    const double stamped = std::round(t / camera.grid) * camera.grid;
    if (!run.time.empty() && stamped <= run.time.back()) continue;
    run.time.push_back(stamped);
    const auto where = motion.position(stamped);
    for (std::size_t k = 0; k < 3; ++k) {
      noise[k] = camera.correlation * noise[k] + std::sqrt(1 - camera.correlation * camera.correlation) * normal(generator);
      run.position[k].push_back(where[k] + camera.noise * noise[k]);
    }
  }
  return run;
}

std::string ctrack_head() { return "\n\nSeparation=\n\nf(opt) :  0.500\n\n\nFixed slices:    250 events/slice,    1 locations/slice\n\n"; }

std::string ctrack_row(double time, double x, double y, double z, double u) {
  return fmt::format("{:10.1f}{:10.1f}{:10.1f}{:10.1f}{:10.1f}       0.0      0.00  125\n", time, x, y, z, u);
}

std::string circle_row(int k, const char* separator) {
  const double angle = 0.02 * k;
  return fmt::format("{:.1f}{}{:.3f}{}{:.3f}{}{:.3f}", 5.0 * k, separator, 100 * std::cos(angle), separator, 100 * std::sin(angle),
                     separator, 30 + 5 * std::sin(0.3 * angle));
}

std::string circle_rows(int count, const std::function<std::string(int, std::string)>& change) {
  std::string text;
  for (int k = 0; k < count; ++k) {
    const std::string row = circle_row(k);
    text += (change ? change(k, row) : row) + "\n";
  }
  return text;
}

}  // namespace recording_test
