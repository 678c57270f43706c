// Storage for batches of contacts, and the random contacts that the checks use.
#pragma once

#include <array>
#include <vector>

#include "millscope/conformance/values.hpp"
#include "millscope/contact_law.hpp"
#include "millscope/element.hpp"
#include "millscope/pack.hpp"

namespace millscope::conformance {

using Column = std::vector<double>;
using Columns = std::array<Column, 3>;

/// n contacts of one law, padded to kLanes as the host pads them.
struct Contacts {
  explicit Contacts(std::size_t n) : count(n), slots((n + kLanes - 1) / kLanes * kLanes) {
    overlap.assign(slots, -1.0);
    radius.assign(slots, 1.0);
    mass.assign(slots, 1.0);
    for (Column* c : {&restitution, &friction, &added_cap, &normal_force, &normal_stiffness, &elastic_energy}) c->assign(slots, 0.0);
    for (int axis = 0; axis < 3; ++axis) {
      for (Columns* c : {&normal, &velocity, &force}) element(*c, axis).assign(slots, 0.0);
    }
    for (Column& c : history) c.assign(slots, 0.0);
    for (Column& c : power) c.assign(slots, 0.0);
  }

  /// Evaluates one step with the packed or the scalar function.
  void step(const Held<ContactLawTable>& law, double time_step, bool packed = true) {
    ContactBatch b = batch(time_step);
    (packed ? law.table().evaluate : law.table().evaluate_scalar)(law.get(), &b);
    elastic_sum = b.elastic_sum;
  }

  /// Any of the three vectors at slot s.
  static std::array<double, 3> at(const Columns& c, std::size_t s) { return {c[0][s], c[1][s], c[2][s]}; }
  static void put(Columns& c, std::size_t s, const std::array<double, 3>& v) {
    for (std::size_t axis = 0; axis < 3; ++axis) c[axis][s] = v[axis];
  }

  std::size_t count, slots;
  Column overlap, radius, mass, restitution, friction, added_cap, normal_force, normal_stiffness, elastic_energy;
  Columns normal, velocity, force;
  std::array<Column, kMaxHistory> history;
  std::array<Column, kMaxChannels> power;
  double elastic_sum = 0;
  bool own_friction = false;  ///< true: the pair's own e and μ instead of the columns

 private:
  ContactBatch batch(double time_step) {
    ContactBatch b{};
    b.count = static_cast<std::int64_t>(slots);
    b.time_step = time_step;
    b.overlap = overlap.data();
    b.radius = radius.data();
    b.mass = mass.data();
    b.friction = own_friction ? nullptr : friction.data();
    b.added_cap = added_cap.data();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      b.normal[axis] = normal[axis].data();
      b.velocity[axis] = velocity[axis].data();
      b.force[axis] = force[axis].data();
    }
    for (std::size_t h = 0; h < kMaxHistory; ++h) b.history[h] = history[h].data();
    for (std::size_t k = 0; k < kMaxChannels; ++k) b.power[k] = power[k].data();
    b.normal_force = normal_force.data();
    b.normal_stiffness = normal_stiffness.data();
    b.elastic_energy = elastic_energy.data();
    return b;
  }
};

inline std::array<double, 3> random_unit(Random& numbers) {
  for (;;) {
    const double x = numbers.between(-1, 1), y = numbers.between(-1, 1), z = numbers.between(-1, 1);
    const double square = x * x + y * y + z * z;
    if (square > 0.01 && square < 1.0) return {x / std::sqrt(square), y / std::sqrt(square), z / std::sqrt(square)};
  }
}

/// Contacts with overlaps up to the typical one, closing, opening and sliding in all directions; every seventh is a gap.
inline Contacts random_contacts(const Setting& setting, std::size_t n = 61, std::uint64_t seed = 7) {
  Random numbers(seed);
  Contacts c(n);
  const double largest = typical_overlap(setting.pair), speed = setting.pair.typical_speed;
  for (std::size_t s = 0; s < n; ++s) {
    c.overlap[s] = s % 7 == 6 ? -largest * numbers.between(0.01, 1.0) : largest * numbers.between(0.01, 1.0);
    Contacts::put(c.normal, s, random_unit(numbers));
    for (Column& v : c.velocity) v[s] = speed * numbers.between(-1.0, 1.0);
    c.radius[s] = setting.pair.largest_radius;
    c.mass[s] = setting.pair.largest_mass;
    c.friction[s] = numbers.between(0.05, 0.8);
  }
  return c;
}

/// A time step that resolves a contact: 1/`parts` of the law's own contact time, or of Hertz's 2.87 (m²/(R E² v))^(1/5).
inline double fine_step(const Held<ContactLawTable>& law, const PairContext& pair, double parts) {
  double time = law.table().contact_time(law.get(), pair.smallest_radius, pair.smallest_mass, pair.typical_speed);
  if (!(time > 0.0)) {
    const double young = pair.effective_young;
    time = 2.87 * std::pow(pair.smallest_mass * pair.smallest_mass / (pair.smallest_radius * young * young * pair.typical_speed), 0.2);
  }
  return time / parts;
}

/// Moves each contact by its velocity: δ falls by v·n Δt.
inline void move(Contacts& c, double time_step) {
  for (std::size_t s = 0; s < c.count; ++s) {
    const auto v = Contacts::at(c.velocity, s), n = Contacts::at(c.normal, s);
    c.overlap[s] -= (v[0] * n[0] + v[1] * n[1] + v[2] * n[2]) * time_step;
  }
}

}  // namespace millscope::conformance
