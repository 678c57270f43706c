// The rules for mirror images, held against every analyzer of the build: a recording and its mirror image give results that are mirror
// images.
#include "studies/analysis/mirror.hpp"

#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>

#include "host/temporary.hpp"
#include "millscope/observation_adapter.hpp"
#include "studies/analysis/analysis.hpp"
#include "studies/compare/compare.hpp"
#include "tests/plugins.hpp"

using namespace millscope;

namespace {

constexpr double kSpeed = 6.0, kRate = 200;  // rad/s, 1/s

/// A bead that rides up with the shell of a clockwise mill of 150 mm radius to an angle of its own, flies off, and slides back to begin
/// anew.
class Walk {
 public:
  explicit Walk(std::uint64_t seed) : random_(seed) {
    aim();
    place_ = start();
  }

  std::array<double, 3> next() {
    z_ = std::clamp(z_ + 0.001 * random_.normal(), 0.005, 0.055);
    if (phase_ == Phase::ride) {
      ride();
    } else if (phase_ == Phase::flight) {
      fly();
    } else {
      slide();
    }
    return {place_[0] + noise(), place_[1] + noise(), z_ + noise()};
  }

 private:
  using Vector = std::array<double, 2>;
  enum class Phase { ride, flight, slide };

  double noise() { return 3e-4 * random_.normal(); }
  void aim() {
    radius_ = 0.08 + 0.06 * random_.uniform();
    angle_ = -0.6 + 0.2 * random_.normal();
    top_ = 2.0 + 0.2 * random_.normal();
  }
  // Angles count from 6 o'clock; clockwise is towards −x there.
  Vector start() const { return {-radius_ * std::sin(angle_), -radius_ * std::cos(angle_)}; }
  void ride() {
    angle_ += kSpeed / kRate;
    place_ = start();
    velocity_ = {-kSpeed * radius_ * std::cos(angle_), kSpeed * radius_ * std::sin(angle_)};
    if (angle_ >= top_) phase_ = Phase::flight;
  }
  void fly() {
    for (std::size_t k = 0; k < 2; ++k) place_[k] += velocity_[k] / kRate;
    velocity_[1] -= 9.81 / kRate;
    if (std::hypot(place_[0], place_[1]) < 0.14 && place_[1] > -0.09) return;
    aim();
    phase_ = Phase::slide;
  }
  void slide() {
    const Vector goal = start();
    const double dx = goal[0] - place_[0], dy = goal[1] - place_[1], left = std::hypot(dx, dy), step = 0.6 / kRate;
    if (left <= step) phase_ = Phase::ride;
    const double part = left <= step ? 1 : step / left;
    place_[0] += part * dx, place_[1] += part * dy;
  }

  millscope::Random random_;
  Phase phase_ = Phase::ride;
  Vector place_{}, velocity_{};
  double angle_ = 0, top_ = 0, radius_ = 0, z_ = 0.03;
};

std::filesystem::path write_recording(const std::filesystem::path& folder, const std::string& name, double sign) {
  std::ofstream table(folder / (name + ".csv"));
  Walk walk(11);
  for (int i = 0; i < 60 * 200; ++i) {
    const auto p = walk.next();
    table << fmt::format("{:.3f},{:.6f},{:.6f},{:.6f}\n", i * 1000 / kRate, 1e3 * sign * p[0], 1e3 * p[1], 1e3 * p[2]);
  }
  std::filesystem::path file = folder / (name + ".yaml");
  std::ofstream(file) << fmt::format(
      "files: [{}.csv]\nformat: table\ncolumns: {{t: ms, x: mm, y: mm, z: mm}}\nframe: {{axis: [0, 0], ends: [0, 60 mm]}}\n"
      "condition:\n  speed: 6 rad/s\n  direction: {}\n  filling: 30 %\n  porosity: 0.4\n  bead_diameter: 5 mm\n  bead_density: 2500\n  "
      "mill_diameter: 300 mm\n"
      "  mill_length: 60 mm\n",
      name, sign > 0 ? "clockwise" : "counter_clockwise");
  return file;
}

analysis::ResultSet analyze_file(const std::filesystem::path& file) {
  analysis::AnalysisRequest request;
  request.path = file;
  request.overrides = {"resampling.draws=60"};
  return analysis::analyze(request, testing::registry());
}

bool same(double a, double b, double size) { return (std::isnan(a) && std::isnan(b)) || std::abs(a - b) <= 1e-7 * size; }

}  // namespace

TEST_CASE("the mirror image of a recording gives the mirror image of its results") {
  const host_test::Temporary folder;
  const analysis::ResultSet plain = analyze_file(write_recording(folder.path(), "plain", 1)),
                            image = analyze_file(write_recording(folder.path(), "image", -1));
  std::vector<std::string> done;
  const analysis::ResultSet back = analysis::mirrored(image, done);
  CHECK(back.meta.context.omega == Approx(plain.meta.context.omega));
  REQUIRE(back.arrays.size() == plain.arrays.size());
  std::size_t turned = 0;
  for (std::size_t i = 0; i < plain.arrays.size(); ++i) {
    const analysis::ResultArray &x = plain.arrays[i], &y = back.arrays[i];
    REQUIRE(x.name == y.name);
    double size = 1e-5;  // rounding errors about 0
    for (const double v : x.value) size = std::max(size, std::isfinite(v) ? std::abs(v) : 0);
    std::size_t wrong = 0;
    for (std::size_t k = 0; k < x.size(); ++k) wrong += same(x.value[k], y.value[k], size) ? 0 : 1;
    INFO(x.analyzer << "." << x.name << ": " << wrong << " of " << x.size());
    CHECK(wrong <= x.size() / 200);  // a point that lies on the edge between two cells may fall to either side
    turned += analysis::mirror_rule(plain, x).changes_sign ? 1 : 0;
  }
  CHECK(turned > 4);
  CHECK(compare::compare(plain, image, {}).verdict_kind == compare::Verdict::no_difference);
}

TEST_CASE("mirroring twice gives back what was there") {
  const host_test::Temporary folder;
  const analysis::ResultSet plain = analyze_file(write_recording(folder.path(), "plain", 1));
  std::vector<std::string> done;
  const analysis::ResultSet twice = analysis::mirrored(analysis::mirrored(plain, done), done);
  for (std::size_t i = 0; i < plain.arrays.size(); ++i) {
    const analysis::ResultArray &x = plain.arrays[i], &y = twice.arrays[i];
    for (std::size_t k = 0; k < x.size(); ++k) CHECK((same(x.value[k], y.value[k], std::abs(x.value[k]) + 100)));
    CHECK(x.draws.size() == y.draws.size());
  }
}
