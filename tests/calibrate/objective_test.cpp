#include "studies/calibrate/objective.hpp"

#include <Eigen/Cholesky>

#include "kernel/base/random.hpp"
#include "studies/calibrate/json.hpp"
#include "studies/calibrate/power.hpp"
#include "studies/diagnose/naming/covariance.hpp"
#include "studies/emulate/statements.hpp"
#include "tests/calibrate/made_up_mill.hpp"
#include "tests/scratch.hpp"

using namespace millscope;
using namespace millscope::calibrate;

namespace {

Observation observation(double power, std::vector<double> x, std::vector<double> speed, Eigen::VectorXd value, double variance) {
  Observation o;
  o.power = {power, 0.1, ""};
  o.x = {{}, std::move(x), {}};
  o.speed = {{}, std::move(speed), {}};
  o.value = std::move(value);
  o.covariance = variance * Eigen::MatrixXd::Identity(o.value.size(), o.value.size());
  for (Eigen::Index i = 0; i < o.value.size(); ++i) o.observables.push_back({i == 0 ? "slip.mean" : "other", "1", ObservableKind::term});
  return o;
}

}  // namespace

TEST_CASE("Eq. 4.3 by hand") {
  // |28.6 − 30.1| = 1.5 W; x: differences 1, −1, 0, 0 % → √(2/4); speed: 3, −4 % → √(25/2)
  const Observation recorded = observation(30.1, {10, 20, 30, 40}, {50, 50}, Eigen::Vector2d(2, 1), 1);
  const Observation simulated = observation(28.6, {11, 19, 30, 40}, {53, 46}, Eigen::Vector2d(3, 1), 1);
  const ChagasObjective o = chagas2015(recorded, simulated, {});
  CHECK(o.power == Approx(1.5));
  CHECK(o.x == Approx(0.70710678));
  CHECK(o.speed == Approx(3.53553391));
  CHECK(o.value() == Approx(5.74264069));
  const ChagasObjective with_term = chagas2015(recorded, simulated, {Term{"slip", "mean", 0.1, {}}});
  CHECK(with_term.terms == Approx(5));  // 50 % of 2, times 0.1
  CHECK_FALSE(testing::message_of([&] { chagas2015(recorded, observation(1, {1}, {1}, Eigen::Vector2d(0, 0), 1), {}); }).empty());
}

TEST_CASE("the misfit weighs by both covariances") {
  const Observation recorded = observation(1, {1}, {1}, Eigen::Vector2d(0, 0), 1),
                    simulated = observation(1, {1}, {1}, Eigen::Vector2d(2, 4), 3);
  CHECK(misfit(recorded, simulated) == Approx((4.0 + 16.0) / 4.0));
  Observation correlated = recorded;
  correlated.covariance << 1, 0.8, 0.8, 1;
  Observation exact = simulated;
  exact.covariance.setZero();
  // r' C⁻¹ r with C⁻¹ = [1 −.8; −.8 1]/0.36: (4 − 12.8 + 16)/0.36
  CHECK(misfit(correlated, exact) == Approx(7.2 / 0.36));
}

TEST_CASE("what is undefined stays so in its file, is refused where it has to be known, and can be left out") {
  Observation o;
  o.of = "a slow mill";
  o.observables = {
      {"power", "W", ObservableKind::power}, {"speed at the shoulder", "m/s", ObservableKind::region_speed}, {"x", "%", ObservableKind::x}};
  o.value = Eigen::Vector3d(8, std::nan(""), 12);
  o.covariance = (Eigen::Matrix3d() << 1, 0, 0.3, 0, 1e-24, 0, 0.3, 0, 4).finished();
  const testing::Folder folder;
  write_cached(folder.path / "o.json", o);
  Observation back = read_cached<Observation>(folder.path / "o.json").value();
  CHECK(std::isnan(back.value[1]));
  CHECK(back.value[2] == 12);
  CHECK_THAT(testing::refusal([&] { require_defined(back); }),
             Catch::Matchers::Contains("'speed at the shoulder' is undefined in a slow mill: no bead was seen there"));
  leave_out(back, {"speed at the shoulder", "what it does not have"});
  require_defined(back);
  REQUIRE(back.observables.size() == 2);
  CHECK(back.observables[1].name == "x");
  CHECK(back.value == Eigen::Vector2d(8, 12));
  CHECK(back.covariance == (Eigen::Matrix2d() << 1, 0.3, 0.3, 4).finished());
}

TEST_CASE("a power error widens the power alone, by a share of it") {
  Observation o;
  o.observables = {{"power", "W", ObservableKind::power}, {"x", "%", ObservableKind::x}};
  o.value = Eigen::Vector2d(8.0, 12.0);
  o.covariance = Eigen::Vector2d(0.0009, 0.25).asDiagonal();
  o.power = {8.0, 0.03, "measured"};
  add_power_error(o, 0.005);
  CHECK(o.covariance(0, 0) == Approx(0.0009 + 0.0016));
  CHECK(o.power.sem == Approx(0.05));
  CHECK(o.covariance(1, 1) == 0.25);
  CHECK(o.covariance(0, 1) == 0);
}

TEST_CASE("the misfit of errors that are known from few blocks comes by chance about as often as is said") {
  constexpr Eigen::Index n = 12;
  constexpr int kTries = 1000;
  const Eigen::MatrixXd truth = Eigen::MatrixXd::NullaryExpr(
      n, n, [](Eigen::Index i, Eigen::Index j) { return std::pow(0.8, static_cast<double>(std::abs(i - j))); });
  const Eigen::MatrixXd root = truth.llt().matrixL();
  base::RandomStream random(1, 1);
  const auto known_from = [&](int blocks) {
    const Eigen::MatrixXd seen = (root * random.normals(n * blocks).reshaped(n, blocks)).transpose();
    return Eigen::MatrixXd(few_blocks_factor(blocks) * naming::shrunk(naming::covariance_of(seen), blocks));
  };
  const auto [blocks, most] = GENERATE(table<int, double>({{8, 0.06}, {20, 0.045}, {80, 0.035}}));
  int unlikely = 0;
  for (int k = 0; k < kTries; ++k) {
    Observation recorded, simulated;
    recorded.value = root * random.normals(n), simulated.value = root * random.normals(n);
    recorded.covariance = known_from(blocks), simulated.covariance = known_from(blocks);
    unlikely += emulate::misfit_probability(misfit(recorded, simulated), n) < 0.025 ? 1 : 0;
  }
  INFO(blocks << " blocks: " << unlikely << " of " << kTries);
  CHECK(unlikely < most * kTries);
  CHECK(unlikely > 0.005 * kTries);
}
