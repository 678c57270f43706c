// What every body force must hold to.
#pragma once

#include <algorithm>
#include <array>
#include <numbers>

#include "millscope/body_force.hpp"
#include "millscope/conformance/values.hpp"

namespace millscope::conformance {

/// What the checks of a body force assume: beads of the study's mill.
struct BodyForceSetting {
  double mill_radius = 0.15;      ///< m; beads are put anywhere inside, z from 0 to 0.3 m
  double speed = 3.0;             ///< largest component of a velocity, m/s
  double power_tolerance = 1e-6;  ///< relative, of the power that is booked
  std::size_t bead_count = 61;
};

/// Beads as the host hands them over, with what acts on them.
struct ForcedBeads {
  using Column = std::vector<double>;
  using Columns = std::array<Column, 3>;

  explicit ForcedBeads(std::size_t n) : count(n) {
    for (Columns* c : {&position, &velocity, &spin, &force, &moment}) {
      for (Column& axis : *c) axis.assign(n, 0.0);
    }
    for (Column* c : {&radius, &mass, &added_mass}) c->assign(n, 0.0);
  }

  void act(const Held<BodyForceTable>& body_force, double time) {
    BodyForceBatch b{};
    b.count = static_cast<std::int64_t>(count);
    b.time = time;
    b.time_step = 1e-5;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      b.position[axis] = position[axis].data();
      b.velocity[axis] = velocity[axis].data();
      b.spin[axis] = spin[axis].data();
      b.force[axis] = force[axis].data();
      b.moment[axis] = moment[axis].data();
    }
    b.radius = radius.data();
    b.mass = mass.data();
    b.added_mass = added_mass.data();
    body_force.table().evaluate(body_force.get(), &b);
    power = b.power_sum;
  }

  /// Bead i of these, with nothing acting yet.
  ForcedBeads only(std::size_t i) const {
    ForcedBeads one(1);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      one.position[axis][0] = position[axis][i];
      one.velocity[axis][0] = velocity[axis][i];
      one.spin[axis][0] = spin[axis][i];
    }
    one.radius[0] = radius[i];
    one.mass[0] = mass[i];
    return one;
  }

  std::size_t count;
  Columns position, velocity, spin, force, moment;
  Column radius, mass, added_mass;
  double power = 0;
};

/// Beads anywhere in the mill, some at rest.
inline ForcedBeads random_beads(const BodyForceSetting& setting) {
  Random numbers(23);
  ForcedBeads beads(setting.bead_count);
  for (std::size_t i = 0; i < beads.count; ++i) {
    const double r = setting.mill_radius * std::sqrt(numbers.between(0, 1)), angle = numbers.between(-std::numbers::pi, std::numbers::pi);
    beads.position[0][i] = r * std::cos(angle);
    beads.position[1][i] = r * std::sin(angle);
    beads.position[2][i] = numbers.between(0, 0.3);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      beads.velocity[axis][i] = i % 9 == 8 ? 0.0 : setting.speed * numbers.between(-1, 1);
      beads.spin[axis][i] = 50.0 * numbers.between(-1, 1);
    }
    beads.radius[i] = numbers.between(1e-3, 1e-2);
    beads.mass[i] = 2500.0 * 4.18879 * beads.radius[i] * beads.radius[i] * beads.radius[i];
  }
  return beads;
}

namespace detail {

using BodyForce = Held<BodyForceTable>;
constexpr double kTime = 0.7;  // s, any

inline bool body_force_is_finite(const BodyForce& body_force, const BodyForceSetting& setting, Violations& out) {
  double acceleration[3] = {};
  if (body_force.table().uniform(body_force.get(), kTime, acceleration) != 0 &&
      !std::all_of(acceleration, acceleration + 3, [](double a) { return std::isfinite(a); })) {
    return out.push_back({"finite", "the uniform acceleration is not finite"}), false;
  }
  ForcedBeads beads = random_beads(setting);
  beads.act(body_force, kTime);
  for (std::size_t i = 0; i < beads.count; ++i) {
    double sum = beads.added_mass[i] + beads.power;
    for (std::size_t axis = 0; axis < 3; ++axis) sum += beads.force[axis][i] + beads.moment[axis][i];
    if (std::isfinite(sum)) continue;
    return out.push_back({"finite", text_of("force, moment, added mass or power of a bead is not finite (radius %g m, mass %g kg)",
                                            beads.radius[i], beads.mass[i])}),
           false;
  }
  return true;
}

/// A bead alone gets what it gets among others; a second call gives the same; what was there before is added to.
inline void body_force_is_local(const BodyForce& body_force, const BodyForceSetting& setting, Violations& out) {
  ForcedBeads beads = random_beads(setting), again = beads, filled = beads;
  for (std::size_t i = 0; i < beads.count; ++i) {
    for (ForcedBeads::Columns* c : {&filled.force, &filled.moment}) {
      for (auto& axis : *c) axis[i] = 0.25;
    }
    filled.added_mass[i] = 0.25;
  }
  beads.act(body_force, kTime);
  again.act(body_force, kTime);
  filled.act(body_force, kTime);
  double power = 0, power_scale = 0;
  for (std::size_t i = 0; i < beads.count; ++i) {
    ForcedBeads one = beads.only(i);
    one.act(body_force, kTime);
    power += one.power;
    power_scale += std::fabs(one.power);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double force = beads.force[axis][i], moment = beads.moment[axis][i];
      if (std::fabs(force - again.force[axis][i]) + std::fabs(moment - again.moment[axis][i]) > 0.0) {
        return out.push_back({"determinism", text_of("a second call gives %g N instead of %g N", again.force[axis][i], force)});
      }
      if (std::fabs(force - one.force[axis][0]) + std::fabs(moment - one.moment[axis][0]) > 0.0) {
        return out.push_back({"bead by bead", text_of("a bead alone gets %g N, among others %g N", one.force[axis][0], force)});
      }
      const double added = filled.force[axis][i] - (0.25 + force), turned = filled.moment[axis][i] - (0.25 + moment);
      if (std::fabs(added) + std::fabs(turned) > 1e-15) {
        return out.push_back(
            {"adds", text_of("what acted before is not kept: the force is %g N instead of %g N", filled.force[axis][i], 0.25 + force)});
      }
    }
    if (!(std::fabs(filled.added_mass[i] - (0.25 + beads.added_mass[i])) <= 1e-15))
      return out.push_back({"adds", "the added mass of before is not kept"});
  }
  if (!(std::fabs(power - beads.power) <= 1e-9 * power_scale))
    out.push_back({"bead by bead", text_of("the beads' power is %g W together, %g W one by one", beads.power, power)});
}

/// Where the same acceleration acts on all, `evaluate` gives m a, or nothing.
inline void uniform_is_evaluated(const BodyForce& body_force, const BodyForceSetting& setting, Violations& out) {
  double acceleration[3] = {};
  if (body_force.table().uniform(body_force.get(), kTime, acceleration) == 0) return;
  ForcedBeads beads = random_beads(setting);
  beads.act(body_force, kTime);
  double largest = 0;
  for (const auto& axis : beads.force) {
    for (const double f : axis) largest = std::max(largest, std::fabs(f));
  }
  for (std::size_t i = 0; i < beads.count && largest > 0.0; ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double expected = beads.mass[i] * acceleration[axis];
      if (std::fabs(beads.force[axis][i] - expected) <= 1e-12 * largest) continue;
      return out.push_back(
          {"uniform", text_of("evaluate gives %g N, mass times the uniform acceleration is %g N", beads.force[axis][i], expected)});
    }
  }
}

/// Added mass of one bead, carried along its path by a time.
inline double added_mass_after(const BodyForce& body_force, const ForcedBeads& bead, double time) {
  ForcedBeads moved = bead.only(0);
  for (std::size_t axis = 0; axis < 3; ++axis) moved.position[axis][0] += moved.velocity[axis][0] * time;
  moved.act(body_force, kTime + time);
  return moved.added_mass[0];
}

/// Power taken from a bead: −F·v − M·ω − ½ v² dm_a/dt, the last what a bead leaves with the fluid that it sets in motion or lets go.
inline void power_is_booked(const BodyForce& body_force, const BodyForceSetting& setting, Violations& out) {
  double acceleration[3] = {};
  if (body_force.table().uniform(body_force.get(), kTime, acceleration) != 0) return;  // the host knows its potential
  const ForcedBeads beads = random_beads(setting);
  constexpr double brief = 1e-6;  // s: no bead moves more than a few micrometres
  for (std::size_t i = 0; i < beads.count; ++i) {
    ForcedBeads one = beads.only(i);
    one.act(body_force, kTime);
    const double before = added_mass_after(body_force, one, -brief), after = added_mass_after(body_force, one, brief);
    const double kink = std::fabs(before + after - 2.0 * one.added_mass[0]);
    double taken = 0, scale = 0, square = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double work = one.force[axis][0] * one.velocity[axis][0], turning = one.moment[axis][0] * one.spin[axis][0];
      taken -= work + turning;
      scale += std::fabs(work) + std::fabs(turning);
      square += one.velocity[axis][0] * one.velocity[axis][0];
    }
    taken -= 0.25 * square * (after - before) / brief;
    scale += 0.25 * square * std::fabs(after - before) / brief;
    const double slack = setting.power_tolerance * scale + square * (kink + 1e-14 * one.added_mass[0]) / brief;
    if (std::fabs(one.power - taken) <= slack) continue;
    return out.push_back({"power", text_of("it books %g W, its force takes %g W from the bead", one.power, taken)});
  }
}

}  // namespace detail

/// Every check of a body force with these values. Throws Refusal when the plugin refuses the values.
inline Violations check_body_force(const Descriptor& descriptor, const Values& values, const BodyForceSetting& setting = {}) {
  Violations out;
  const auto& table = table_of<BodyForceTable>(descriptor, Kind::body_force, kBodyForceLayout);
  const detail::BodyForce body_force(table, values);
  detail::body_force_is_finite(body_force, setting, out);
  detail::body_force_is_local(body_force, setting, out);
  detail::uniform_is_evaluated(body_force, setting, out);
  detail::power_is_booked(body_force, setting, out);
  with_ends_of_ranges(descriptor, table, values, out,
                      [&](const detail::BodyForce& object) { detail::body_force_is_finite(object, setting, out); });
  return out;
}

}  // namespace millscope::conformance
