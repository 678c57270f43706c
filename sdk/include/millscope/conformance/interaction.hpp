// What every interaction must hold to.
#pragma once

#include <algorithm>
#include <cstring>

#include "millscope/conformance/contacts.hpp"
#include "millscope/interaction.hpp"

namespace millscope::conformance {

/// n pairs of one interaction with its results, padded as the host pads them.
struct Pairs {
  explicit Pairs(const Setting& setting, std::size_t n = 61) : base(random_contacts(setting, n)) {
    Random numbers(11);
    for (Column* c : {&radius_i, &radius_j, &added_force, &added_cap}) c->assign(base.slots, 0.0);
    for (Columns* c : {&spin_i, &spin_j, &moment_i, &moment_j}) {
      for (Column& axis : *c) axis.assign(base.slots, 0.0);
    }
    for (std::size_t s = 0; s < n; ++s) {
      radius_i[s] = setting.pair.largest_radius * numbers.between(1.5, 2.5);
      radius_j[s] = setting.pair.largest_radius * numbers.between(1.5, 2.5);
      for (Columns* c : {&spin_i, &spin_j}) {
        for (Column& axis : *c) axis[s] = 50.0 * numbers.between(-1.0, 1.0);
      }
      const double root = std::sqrt(base.radius[s] * std::max(base.overlap[s], 0.0));
      base.normal_stiffness[s] = 2.0 * setting.pair.effective_young * root;
      base.normal_force[s] = base.normal_stiffness[s] * std::max(base.overlap[s], 0.0) * 2.0 / 3.0;
    }
  }

  /// One step; the results start from zero.
  void step(const Held<InteractionTable>& interaction, double time_step, bool packed = true) {
    for (Column* c : {&added_force, &added_cap}) std::fill(c->begin(), c->end(), 0.0);
    for (Columns* c : {&moment_i, &moment_j}) {
      for (Column& axis : *c) std::fill(axis.begin(), axis.end(), 0.0);
    }
    InteractionBatch b = batch(time_step);
    (packed ? interaction.table().evaluate : interaction.table().evaluate_scalar)(interaction.get(), &b);
    elastic_sum = b.elastic_sum;
    std::copy(std::begin(b.power_sum), std::end(b.power_sum), power_sum.begin());
  }

  /// All results and histories, one after the other.
  Column results() const {
    Column all;
    for (const Column* c : {&added_force, &added_cap}) all.insert(all.end(), c->begin(), c->end());
    for (const Columns* c : {&moment_i, &moment_j}) {
      for (const Column& axis : *c) all.insert(all.end(), axis.begin(), axis.end());
    }
    for (const Column& h : base.history) all.insert(all.end(), h.begin(), h.end());
    return all;
  }

  Contacts base;
  Column radius_i, radius_j, added_force, added_cap;
  Columns spin_i, spin_j, moment_i, moment_j;
  double elastic_sum = 0;
  std::array<double, kMaxChannels> power_sum{};

 private:
  InteractionBatch batch(double time_step) {
    InteractionBatch b{};
    b.count = static_cast<std::int64_t>(base.slots);
    b.time_step = time_step;
    b.overlap = base.overlap.data();
    b.radius_i = radius_i.data();
    b.radius_j = radius_j.data();
    b.radius = base.radius.data();
    b.mass = base.mass.data();
    b.normal_force = base.normal_force.data();
    b.normal_stiffness = base.normal_stiffness.data();
    b.added_force = added_force.data();
    b.added_cap = added_cap.data();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      b.normal[axis] = base.normal[axis].data();
      b.velocity[axis] = base.velocity[axis].data();
      b.spin_i[axis] = spin_i[axis].data();
      b.spin_j[axis] = spin_j[axis].data();
      b.moment_i[axis] = moment_i[axis].data();
      b.moment_j[axis] = moment_j[axis].data();
    }
    for (std::size_t h = 0; h < kMaxHistory; ++h) b.history[h] = base.history[h].data();
    return b;
  }
};

namespace detail {

inline void compare_interaction(const Column& found, const Column& expected, const char* check, Violations& out) {
  double scale = 1e-300;
  for (const double x : expected) scale = std::max(scale, std::fabs(x));
  for (std::size_t s = 0; s < found.size(); ++s) {
    if (std::fabs(found[s] - expected[s]) <= 1e-9 * scale) continue;
    out.push_back({check, text_of("a result is %g instead of %g", found[s], expected[s])});
    return;
  }
}

inline void interaction_scalar_is_packed(const Held<InteractionTable>& law, const Setting& setting, double dt, Violations& out) {
  Pairs packed(setting), scalar(setting);
  for (int step = 0; step < 40; ++step) {
    packed.step(law, dt, true);
    scalar.step(law, dt, false);
    const Column a = packed.results(), b = scalar.results();
    if (std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) != 0) {
      out.push_back({"scalar = packed", text_of("the two differ in step %g (of %g)", step, 40)});
      return;
    }
    for (const double x : a) {
      if (std::isfinite(x)) continue;
      out.push_back({"finite", text_of("a result is %g in step %g", x, step)});
      return;
    }
    move(packed.base, dt);
    move(scalar.base, dt);
  }
}

inline void interaction_beyond_reach(const Held<InteractionTable>& law, const Setting& setting, double dt, Violations& out) {
  Pairs pairs(setting);
  const double reach = law.table().reach(law.get(), setting.pair.largest_radius);
  if (!(reach >= 0.0) || !std::isfinite(reach))
    out.push_back({"reach", text_of("is %g (typical overlap %g m)", reach, typical_overlap(setting.pair))});
  for (std::size_t s = 0; s < pairs.base.count; ++s) {
    pairs.base.overlap[s] = -1.001 * reach - 1e-12;
    pairs.base.normal_force[s] = pairs.base.normal_stiffness[s] = 0.0;
  }
  pairs.step(law, dt);
  double most = std::fabs(pairs.elastic_sum);
  for (const Column* c : {&pairs.added_force, &pairs.added_cap}) {
    for (const double x : *c) most = std::max(most, std::fabs(x));
  }
  for (const Columns* c : {&pairs.moment_i, &pairs.moment_j}) {
    for (const Column& axis : *c) {
      for (const double x : axis) most = std::max(most, std::fabs(x));
    }
  }
  for (const double p : pairs.power_sum) most = std::max(most, std::fabs(p));
  if (!(most <= 0.0))
    out.push_back({"nothing beyond reach", text_of("force, moment, energy or power is %g at a gap of %g m", most, reach)});
}

/// Exchanges i and j of every pair, histories with their signs.
inline Pairs exchanged(const Pairs& pairs, const PairTermInfo& info) {
  Pairs other = pairs;
  std::swap(other.radius_i, other.radius_j);
  std::swap(other.spin_i, other.spin_j);
  for (Columns* c : {&other.base.normal, &other.base.velocity}) {
    for (Column& axis : *c) {
      for (double& x : axis) x = -x;
    }
  }
  for (std::uint32_t h = 0; h < info.history_count; ++h) {
    for (double& x : other.base.history[h]) x *= info.histories[h].sign;
  }
  return other;
}

inline void interaction_antisymmetry(const Held<InteractionTable>& law, const Setting& setting, double dt, Violations& out) {
  Pairs a(setting);
  for (int step = 0; step < 10; ++step) {
    a.step(law, dt);
    move(a.base, dt);
  }
  Pairs b = exchanged(a, law.table().info);
  a.step(law, dt);
  b.step(law, dt);
  b = exchanged(b, law.table().info);
  std::swap(b.moment_i, b.moment_j);
  compare_interaction(b.results(), a.results(), "antisymmetry", out);
}

/// Rotates every vector of the pairs; only the results of a law that starts without history can be compared.
inline void rotate_columns(Columns& columns) {
  for (std::size_t s = 0; s < columns[0].size(); ++s) {
    const auto v = Contacts::at(columns, s);
    std::array<double, 3> turned;
    rotate(v.data(), turned.data());
    Contacts::put(columns, s, turned);
  }
}

inline void interaction_frame_indifference(const Held<InteractionTable>& law, const Setting& setting, double dt, Violations& out) {
  Pairs a(setting), b(setting);
  for (Columns* c : {&b.base.normal, &b.base.velocity, &b.spin_i, &b.spin_j}) rotate_columns(*c);
  for (int step = 0; step < 10; ++step) {
    a.step(law, dt);
    b.step(law, dt);
    Pairs expected = a, found = b;
    for (Columns* c : {&expected.moment_i, &expected.moment_j}) rotate_columns(*c);
    for (std::size_t h = 0; h < kMaxHistory; ++h) expected.base.history[h] = found.base.history[h];
    const std::size_t before = out.size();
    compare_interaction(found.results(), expected.results(), "frame indifference", out);
    if (out.size() != before) return;
    move(a.base, dt);
    move(b.base, dt);
  }
}

inline void interaction_dissipation(const Held<InteractionTable>& law, const Setting& setting, double dt, Violations& out) {
  Pairs pairs(setting);
  const PairTermInfo& info = law.table().info;
  for (int step = 0; step < 60; ++step) {
    pairs.step(law, dt);
    for (std::uint32_t k = 0; k < info.channel_count; ++k) {
      if (info.channels[k].nature != ChannelNature::dissipative || pairs.power_sum[k] >= 0.0) continue;
      out.push_back({"dissipation >= 0", std::string(info.channels[k].name) + text_of(" gives %g W (step %g)", pairs.power_sum[k], step)});
      return;
    }
    move(pairs.base, dt);
  }
}

}  // namespace detail

/// Every check of an interaction with these values. Throws Refusal when the plugin refuses the values.
inline Violations check_interaction(const Descriptor& descriptor, const Values& values, const Setting& setting = {}) {
  Violations out;
  const Held<InteractionTable> law(table_of<InteractionTable>(descriptor, Kind::interaction, kInteractionLayout), values, setting.pair);
  const double young = setting.pair.effective_young, mass = setting.pair.smallest_mass;
  const double dt = 0.02 * 2.87 * std::pow(mass * mass / (setting.pair.smallest_radius * young * young * setting.pair.typical_speed), 0.2);
  detail::interaction_scalar_is_packed(law, setting, dt, out);
  detail::interaction_beyond_reach(law, setting, dt, out);
  detail::interaction_antisymmetry(law, setting, dt, out);
  detail::interaction_frame_indifference(law, setting, dt, out);
  detail::interaction_dissipation(law, setting, dt, out);
  return out;
}

}  // namespace millscope::conformance
