// The splines themselves, against what is known exactly or computed another way.
#include <catch2/catch.hpp>

#include <algorithm>
#include <random>

#include "recording/support.hpp"
#include "studies/trajectory/pieces.hpp"
#include "studies/trajectory/sample.hpp"
#include "studies/trajectory/smooth_wide.hpp"
#include "tests/skip.hpp"

using namespace millscope;
using namespace recording_test;

namespace {

recording::Run uneven(int count, const std::function<std::array<double, 3>(double)>& motion, std::uint64_t seed = 5) {
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<double> pause(0.001, 0.009);
  recording::Run run;
  double t = 0.3;
  for (int k = 0; k < count; ++k) {
    run.time.push_back(t += pause(generator));
    const auto x = motion(t);
    for (std::size_t axis = 0; axis < 3; ++axis) run.position[axis].push_back(x[axis]);
  }
  return run;
}

/// Solves A x = b by elimination with pivoting; A row-major.
std::vector<double> solve(std::vector<double> a, std::vector<double> b) {
  const std::size_t n = b.size();
  for (std::size_t column = 0; column < n; ++column) {
    std::size_t pivot = column;
    for (std::size_t row = column; row < n; ++row) {
      if (std::fabs(a[row * n + column]) > std::fabs(a[pivot * n + column])) pivot = row;
    }
    for (std::size_t k = 0; k < n; ++k) std::swap(a[column * n + k], a[pivot * n + k]);
    std::swap(b[column], b[pivot]);
    for (std::size_t row = column + 1; row < n; ++row) {
      const double factor = a[row * n + column] / a[column * n + column];
      for (std::size_t k = column; k < n; ++k) a[row * n + k] -= factor * a[column * n + k];
      b[row] -= factor * b[column];
    }
  }
  for (std::size_t row = n; row-- > 0;) {
    for (std::size_t k = row + 1; k < n; ++k) b[row] -= a[row * n + k] * b[k];
    b[row] /= a[row * n + row];
  }
  return b;
}

/// Prior covariance of the position at s and t of a motion that starts at the first knot with a vague position and velocity, and has random
/// accelerations of unit density: ∫ (s−u)₊ (t−u)₊ du and its derivatives.
double prior(double s, double t) {
  const double m = std::min(s, t), d = std::fabs(s - t);
  return m * m * m / 3 + d * m * m / 2;
}
double prior_velocity_position(double s, double t) { return s < t ? s * t - s * s / 2 : t * t / 2; }  // velocity at s

}  // namespace

TEST_CASE("a cubic spline passes through its points and is exact for straight motion") {
  const recording::Run run = uneven(40, [](double t) { return std::array{1 + 2 * t, -3 * t, 0.5}; });
  const trajectory::Points points = trajectory::points_of(run, {0, run.size()});
  trajectory::Spline spline;
  trajectory::interpolate(trajectory::average(points, 0, 0), {1e-3, 1e-3, 1e-3}, spline);
  trajectory::Piece piece = trajectory::empty_piece(run.time.front(), run.time.back(), 1e-3);
  trajectory::sample(points.time, spline, piece);
  for (std::size_t k = 0; k < piece.size(); ++k) {
    const double t = piece.start + static_cast<double>(k) * piece.step;
    REQUIRE(piece.position[0][k] == Approx(1 + 2 * t).epsilon(1e-12));
    REQUIRE(piece.velocity[1][k] == Approx(-3).epsilon(1e-10));
  }
}

TEST_CASE("a cubic spline has no second derivative at its ends and an unbroken one within") {
  const recording::Run run = uneven(30, [](double t) { return std::array{std::sin(40 * t), std::cos(40 * t), t * t}; });
  const trajectory::Points points = trajectory::points_of(run, {0, run.size()});
  trajectory::Spline s;
  trajectory::interpolate(trajectory::average(points, 0, 0), {0, 0, 0}, s);
  const auto bend = [&](std::size_t i, bool at_end, std::size_t axis) {
    const double h = points.time[i + 1] - points.time[i], mean = (s.knots[i + 1].x[axis] - s.knots[i].x[axis]) / h;
    const double c2 = (3 * mean - 2 * s.knots[i].v[axis] - s.knots[i + 1].v[axis]) / h;
    const double c3 = (s.knots[i].v[axis] + s.knots[i + 1].v[axis] - 2 * mean) / (h * h);
    return 2 * c2 + (at_end ? 6 * c3 * h : 0);
  };
  for (std::size_t axis = 0; axis < 3; ++axis) {
    CHECK(std::fabs(bend(0, false, axis)) < 1e-7);
    CHECK(std::fabs(bend(run.size() - 2, true, axis)) < 1e-7);
    for (std::size_t i = 1; i + 1 < run.size(); ++i) REQUIRE(bend(i - 1, true, axis) == Approx(bend(i, false, axis)).margin(1e-6));
  }
  for (std::size_t i = 0; i < run.size(); ++i) REQUIRE(s.knots[i].x[0] == run.position[0][i]);
}

TEST_CASE("the variances of a cubic spline are what noise does to it") {
  // The response to each single point, squared and summed, is the variance.
  recording::Run run = uneven(24, [](double) { return std::array{0.0, 0.0, 0.0}; });
  const double noise = 1e-3;
  trajectory::Spline spline;
  const trajectory::Points points = trajectory::points_of(run, {0, run.size()});
  const double interval = 0.003;  // averages some pairs and triples
  const trajectory::Averaged knots = trajectory::average(points, interval, 0);
  REQUIRE(knots.time.size() < run.size() - 3);
  trajectory::interpolate(knots, {noise, noise, noise}, spline);
  trajectory::Piece stated = trajectory::empty_piece(knots.time.front(), knots.time.back(), 1e-3);
  trajectory::sample(knots.time.data(), spline, stated);
  std::vector<double> position(stated.size()), velocity(stated.size());
  for (std::size_t i = 0; i < run.size(); ++i) {
    run.position[0].assign(run.size(), 0);
    run.position[0][i] = noise;
    trajectory::interpolate(trajectory::average(trajectory::points_of(run, {0, run.size()}), interval, 0), {0, 0, 0}, spline);
    trajectory::Piece response = trajectory::empty_piece(knots.time.front(), knots.time.back(), 1e-3);
    trajectory::sample(knots.time.data(), spline, response);
    for (std::size_t k = 0; k < stated.size(); ++k) {
      position[k] += std::pow(response.position[0][k], 2);
      velocity[k] += std::pow(response.velocity[0][k], 2);
    }
  }
  for (std::size_t k = 0; k < stated.size(); ++k) {
    REQUIRE(stated.position_variance[k] == Approx(position[k]).epsilon(2e-3));
    REQUIRE(stated.velocity_variance[k] == Approx(velocity[k]).epsilon(2e-3));
  }
}

TEST_CASE("the smoothing spline is the mean of the random motion that it says, with its variances") {
  // Against the same conditional mean and covariance by solving the full system of equations (Rasmussen and Williams 2006, ch. 2).
  std::mt19937_64 generator(11);
  std::normal_distribution<double> normal(0, 1e-3);
  recording::Run run = uneven(15, [&](double t) {
    return std::array{0.1 * std::sin(30 * t) + normal(generator), normal(generator), normal(generator)};
  });
  const double noise = 1e-3, q = 2.0, fastest = 10;
  const std::size_t n = run.size();
  const trajectory::Points points = trajectory::points_of(run, {0, n});
  trajectory::Spline spline;
  trajectory::smooth(points, {{noise, noise, noise}, {q, q, q}, std::vector<double>(n - 1, 1.0)}, spline);
  trajectory::Piece piece = trajectory::empty_piece(run.time.front(), run.time.back(), 1e-3);
  trajectory::sample(points.time, spline, piece);

  // The filter starts from the first point with a flat prior of its position: x(0) = y(0) ± noise, v(0) = 0 ± 10 m/s.
  const double t0 = run.time[0], y0 = run.position[0][0];
  std::vector<double> a((n - 1) * (n - 1)), y(n - 1);
  const auto covariance = [&](double s, double t) { return noise * noise + s * t * fastest * fastest + q * prior(s, t); };
  const auto slope = [&](double s, double t) { return t * fastest * fastest + q * prior_velocity_position(s, t); };
  for (std::size_t i = 1; i < n; ++i) {
    y[i - 1] = run.position[0][i] - y0;
    for (std::size_t j = 1; j < n; ++j) {
      a[(i - 1) * (n - 1) + j - 1] = covariance(run.time[i] - t0, run.time[j] - t0) + (i == j ? noise * noise : 0);
    }
  }
  for (std::size_t k = 0; k < piece.size(); k += 5) {
    const double t = piece.start + static_cast<double>(k) * piece.step - t0;
    std::vector<double> c(n - 1), d(n - 1);
    for (std::size_t i = 1; i < n; ++i) {
      c[i - 1] = covariance(t, run.time[i] - t0);
      d[i - 1] = slope(t, run.time[i] - t0);
    }
    const auto weights = solve(a, c), slopes = solve(a, d);
    double mean = y0, variance = covariance(t, t), velocity = 0, velocity_variance = fastest * fastest + q * t;
    for (std::size_t i = 0; i + 1 < n; ++i) {
      mean += weights[i] * y[i];
      variance -= weights[i] * c[i];
      velocity += slopes[i] * y[i];
      velocity_variance -= slopes[i] * d[i];
    }
    INFO("t = " << t);
    CHECK(piece.position[0][k] == Approx(mean).margin(1e-9));
    CHECK(piece.velocity[0][k] == Approx(velocity).margin(1e-7));
    CHECK(piece.position_variance[k] == Approx(variance).epsilon(1e-5));
    CHECK(piece.velocity_variance[k] == Approx(velocity_variance).epsilon(1e-5));
  }
}

TEST_CASE("roughness follows the likelihood, and the evidence is its slope") {
  const recording::Run run = see(Motion(), {.duration = 3});
  const trajectory::Points points = trajectory::points_of(run, {0, run.size()});
  const double noise = 0.7e-3, q = 0.8;
  std::vector<double> factor(run.size() - 1, 1.0);
  std::vector<trajectory::Evidence> evidence;
  trajectory::weigh_evidence(points, {{noise, noise, noise}, {q, q, q}, factor}, evidence);
  double slope = 0;
  for (const trajectory::Evidence& e : evidence) slope += e.expected - e.found;
  const double step = 1e-4;
  const auto misfit_at = [&](double roughness) {
    const trajectory::Lanes each = trajectory::misfit(points, {noise, noise, noise}, {roughness, roughness, roughness});
    return each[0] + each[1] + each[2];
  };
  const double difference = (misfit_at(q * (1 + step)) - misfit_at(q * (1 - step))) / (2 * step);
  // d(−2 log L)/d log q = Σ (expected − found); the first interval, which `misfit` leaves out, makes the small difference.
  CHECK(slope == Approx(difference).epsilon(0.02).margin(0.5));
}

TEST_CASE("the smoother has the same bits with and without the wide instruction set") {
  if (!__builtin_cpu_supports("x86-64-v3")) return ::testing::skip("this machine has no x86-64-v3");
  constexpr std::size_t kPoints = 400;
  std::mt19937_64 generator(3);
  std::normal_distribution<double> normal;
  std::array<std::vector<double>, 4> data;
  for (std::size_t i = 0; i < kPoints; ++i) {
    data[0].push_back(0.005 * static_cast<double>(i) + 0.001 * std::sin(static_cast<double>(i)));
    for (std::size_t k = 1; k < 4; ++k) data[k].push_back(0.1 * std::sin(0.02 * static_cast<double>(i * k)) + 5e-4 * normal(generator));
  }
  const trajectory::PointView points{data[0].data(), data[1].data(), data[2].data(), data[3].data(), kPoints};
  const std::vector<double> noise{4e-4, 5e-4, 6e-4}, roughness{0.1, 0.4, 0.02}, factor(kPoints - 1, 1.3);
  struct alignas(32) Scratch {
    char bytes[trajectory::kFilteredBytes];
  };
  std::vector<Scratch> scratch(kPoints);
  struct Outcome {
    std::vector<double> knots, between, evidence, misfit;
    bool operator==(const Outcome&) const = default;
  };
  const auto run = [&](auto smooth, auto misfit) {
    Outcome o{std::vector<double>(kPoints * trajectory::kKnot), std::vector<double>((kPoints - 1) * trajectory::kBetween),
              std::vector<double>((kPoints - 1) * trajectory::kEvidence), std::vector<double>(3)};
    smooth(points, trajectory::Noise{noise.data(), roughness.data(), factor.data()}, scratch.data(),
           trajectory::SplineView{o.knots.data(), o.between.data(), nullptr});
    smooth(points, trajectory::Noise{noise.data(), roughness.data(), factor.data()}, scratch.data(),
           trajectory::SplineView{nullptr, nullptr, o.evidence.data()});
    misfit(points, noise.data(), roughness.data(), o.misfit.data());
    return o;
  };
  const Outcome v2 = run(trajectory::wide_v2::smooth, trajectory::wide_v2::misfit);
  CHECK(v2 == run(trajectory::wide_v3::smooth, trajectory::wide_v3::misfit));
  CHECK(std::all_of(v2.knots.begin(), v2.knots.end(), [](double x) { return std::isfinite(x); }));
}
