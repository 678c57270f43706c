#include "inspect/synthetic.hpp"

#include <cmath>
#include <numbers>

#include "millscope/random.hpp"

namespace millscope::test {
namespace {

using std::numbers::pi;

double normal(Random& random) {
  const double u = 1 - random.uniform(), v = random.uniform();
  return std::sqrt(-2 * std::log(u)) * std::cos(2 * pi * v);
}

struct State {
  double x = 0, y = 0, vx = 0, vy = 0;
};

/// In the frame of the axis, gravity along −y. The angle of a ride is counted from 6 o'clock in the turning sense.
class Bead {
 public:
  Bead(const SyntheticMill& mill, Random& random) : mill_(mill), random_(random), sense_(mill.angular_velocity > 0 ? 1 : -1) {
    begin_ride(-0.3);
  }

  State at(double time) {
    while (time > end_) flying_ ? land() : fly();
    const double s = time - start_;
    if (flying_) return {from_.x + from_.vx * s, from_.y + (from_.vy - 4.905 * s) * s, from_.vx, from_.vy - 9.81 * s};
    return on_circle(angle_ + speed_ * s);
  }

 private:
  State on_circle(double angle) const {
    const double v = speed_ * radius_;
    return {sense_ * radius_ * std::sin(angle), -radius_ * std::cos(angle), sense_ * v * std::cos(angle), v * std::sin(angle)};
  }

  void choose_radius() {
    const double u = random_.uniform();
    radius_ = mill_.radius * (random_.uniform() < mill_.at_shell ? 1 : 0.7 + 0.23 * u);
    speed_ = std::fabs(mill_.angular_velocity) * (1 - mill_.slip * random_.uniform()) *
             (radius_ < mill_.radius ? 0.75 + 0.25 * random_.uniform() : 1);
  }

  void begin_ride(double angle) {
    choose_radius();
    ride_from(angle);
  }

  void ride_from(double angle) {
    flying_ = false;
    angle_ = angle;
    start_ = end_;
    const double release = 1.6 + 0.6 * random_.uniform();
    end_ = start_ + std::max(0.05, (release - angle) / speed_);
  }

  void fly() {
    from_ = on_circle(angle_ + speed_ * (end_ - start_));
    flying_ = true;
    start_ = end_;
    choose_radius();  // of the ride to come
    double s = 0.05;
    for (; s < 2; s += 1e-4) {
      const double x = from_.x + from_.vx * s, y = from_.y + (from_.vy - 4.905 * s) * s;
      if (y < 0 && std::hypot(x, y) >= radius_) break;
    }
    end_ = start_ + s;
  }

  void land() {
    const double s = end_ - start_, x = from_.x + from_.vx * s, y = from_.y + (from_.vy - 4.905 * s) * s;
    ride_from(std::atan2(sense_ * x, -y));
  }

  const SyntheticMill& mill_;
  Random& random_;
  int sense_;
  bool flying_ = false;
  double start_ = 0, end_ = 0, radius_ = 0, speed_ = 0, angle_ = 0;
  State from_;
};

recording::Recording wrap(recording::Run run) {
  run.name = "synthetic";
  run.report.rows = run.report.used = run.time.size();
  recording::Recording recording;
  recording.file = "synthetic.a";
  recording.gap_limit = 0.045;
  for (std::size_t i = 1; i < run.size(); ++i) {
    if (run.time[i] - run.time[i - 1] <= recording.gap_limit) continue;
    ++run.report.gaps;
    run.report.gap_time += run.time[i] - run.time[i - 1];
  }
  recording.runs.push_back(std::move(run));
  return recording;
}

}  // namespace

recording::Recording make_recording(const SyntheticMill& mill) {
  Random random(mill.seed);
  Bead bead(mill, random);
  recording::Run run;
  const double turn = mill.gravity_degrees * pi / 180, cosine = std::cos(turn), sine = std::sin(turn);
  for (double time = 0.01; time < mill.seconds;) {
    const double step = -std::log(1 - random.uniform()) / mill.rate;
    time += std::max(step, 1e-4);
    const State s = bead.at(time);
    if (std::hypot(s.vx, s.vy) > mill.fast && random.uniform() < mill.lost_when_fast) continue;
    run.time.push_back(time);
    run.position[0].push_back(mill.axis[0] + cosine * s.x - sine * s.y + mill.noise * normal(random));
    run.position[1].push_back(mill.axis[1] + sine * s.x + cosine * s.y + mill.noise * normal(random));
    run.position[2].push_back(0.03 + 0.025 * std::sin(0.7 * time) + mill.noise * normal(random));
  }
  return wrap(std::move(run));
}

recording::Recording make_recording(const SyntheticRotor& rotor) {
  Random random(5);
  recording::Run run;
  const auto& a = rotor.axis;
  const double length = std::sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
  const std::array<double, 3> n{a[0] / length, a[1] / length, a[2] / length};
  const double flat = std::hypot(n[0], n[1]);
  const std::array<double, 3> u{-n[1] / flat, n[0] / flat, 0},
      v{n[1] * u[2] - n[2] * u[1], n[2] * u[0] - n[0] * u[2], n[0] * u[1] - n[1] * u[0]};
  double angle = 0, speed = 0, time = 0;
  for (const double next : rotor.speeds) {
    const double begin = time;
    while (time < begin + 45) {
      const double step = 1 / rotor.rate;
      time += step;
      speed += (next - speed) * std::min(1.0, step / std::max(step, begin + 5 - time));
      angle += speed * step;
      run.time.push_back(time);
      for (std::size_t k = 0; k < 3; ++k) {
        run.position[k].push_back(0.01 + rotor.radius * (std::cos(angle) * u[k] + std::sin(angle) * v[k]) + rotor.noise * normal(random));
      }
    }
  }
  return wrap(std::move(run));
}

}  // namespace millscope::test
