// The small tools: parabolas, weights, intervals, turning points.
#include <catch2/catch.hpp>
#include <cmath>

#include "inspect/synthetic.hpp"
#include "studies/inspect/circulations.hpp"
#include "studies/inspect/coverage.hpp"
#include "studies/inspect/resample.hpp"
#include "studies/inspect/windows.hpp"

using namespace millscope;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

recording::Run sampled(double (*x)(double), double step, std::size_t count) {
  recording::Run run;
  for (std::size_t i = 0; i < count; ++i) {
    const double t = 100 + step * static_cast<double>(i);
    run.time.push_back(t);
    run.position[0].push_back(x(t - 100));
    run.position[1].push_back(2 * x(t - 100));
    run.position[2].push_back(1);
  }
  return run;
}

}  // namespace

TEST_CASE("a parabola is found exactly, and its growing form agrees with the fit") {
  const recording::Run run = sampled([](double t) { return 0.3 + 2 * t - 4.905 * t * t; }, 0.004, 60);
  const inspect::Parabola p = inspect::fit_parabola(run, 0, run.size());
  CHECK_THAT(p.acceleration[0], WithinAbs(-9.81, 1e-8));
  CHECK_THAT(p.velocity[0], WithinAbs(2 - 9.81 * (p.middle - 100), 1e-9));
  CHECK_THAT(p.acceleration[2], WithinAbs(0, 1e-8));
  const recording::Run wave = sampled([](double t) { return 0.1 * std::sin(30 * t); }, 0.004, 60);
  inspect::GrowingParabola growing(wave.time[0]);
  for (std::size_t i = 0; i < wave.size(); ++i) growing.add(wave, i);
  const inspect::Parabola fit = inspect::fit_parabola(wave, 0, wave.size());
  CHECK_THAT(std::sqrt(growing.variance()[0]), WithinRel(fit.scatter[0], 1e-6));
}

TEST_CASE("dwell times add up to the covered time") {
  recording::Recording recording = make_recording(test::SyntheticMill{});
  recording.gap_limit = 0.02;
  double sum = 0;
  for (const double d : inspect::dwell_times(recording.runs[0], recording.gap_limit)) sum += d;
  CHECK_THAT(sum, WithinRel(inspect::measure_coverage(recording).covered, 1e-12));
  CHECK(sum < 59);
}

TEST_CASE("resampling finds the standard error of a mean") {
  std::vector<double> values;
  for (int i = 0; i < 400; ++i) values.push_back(i % 2 ? 1 : -1);
  const auto deviation = inspect::bootstrap_deviation(values.size(), 400, [&](const std::vector<double>& times) {
    double sum = 0;
    for (std::size_t i = 0; i < values.size(); ++i) sum += times[i] * values[i];
    return std::vector<double>{sum / 400, 1.0};
  });
  CHECK_THAT(deviation[0], WithinRel(0.05, 0.1));
  CHECK(deviation[1] == 0);
  const millscope::base::Interval90 e = inspect::interval(1, 0.05, 1e6);
  CHECK_THAT(e.high - e.value, WithinRel(0.05 * 1.6449, 1e-3));
  CHECK_THAT(inspect::interval(1, 0, 5, 0.3).high, WithinRel(1.3, 1e-12));
}

TEST_CASE("a proportion has an interval even when nothing was missed") {
  const millscope::base::Interval90 none = inspect::proportion(0, 50);
  CHECK(none.value == 0);
  CHECK(none.low == 0);
  CHECK(none.high > 0.02);
  CHECK(none.high < 0.08);
}

TEST_CASE("turning points need their height and break at pauses") {
  recording::Recording recording;
  recording.gap_limit = 1;
  recording.runs.push_back(sampled([](double t) { return 0.05 * std::sin(10 * t) + 0.0005 * std::sin(300 * t); }, 0.01, 1000));
  const double turns = 10 * 9.99 / (2 * 3.14159265358979);
  const auto extremes = inspect::find_extremes(recording, 0.02, 0.3);
  CHECK_THAT(static_cast<double>(extremes.size()), WithinAbs(2 * turns, 2));
  for (std::size_t i = 1; i < extremes.size(); ++i) CHECK(extremes[i].top != extremes[i - 1].top);
  CHECK(inspect::find_extremes(recording, 0.5, 0.3).empty());
  for (std::size_t i = 500; i < 1000; ++i) recording.runs[0].time[i] += 5;
  std::size_t chains = 0;
  for (const inspect::Extreme& e : inspect::find_extremes(recording, 0.02, 0.3)) chains += !e.continues;
  CHECK(chains == 2);
}

TEST_CASE("coverage and axial extent of a made recording") {
  const recording::Recording recording = make_recording(test::SyntheticMill{});
  const inspect::Coverage c = inspect::measure_coverage(recording);
  CHECK_THAT(c.rate, WithinRel(220, 0.05));
  CHECK(c.report.gaps == recording.runs[0].report.gaps);
  const inspect::Axial a = inspect::measure_axial(recording);
  CHECK(a.low > -0.003);
  CHECK(a.high < 0.063);
  double sum = 0;
  for (const double share : a.share) sum += share;
  CHECK_THAT(sum, WithinAbs(1, 1e-9));
}
