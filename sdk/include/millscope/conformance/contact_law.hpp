// What every contact law must hold to. Usable without a test framework: `check_contact_law` returns what is violated.
#pragma once

#include <algorithm>
#include <cstring>

#include "millscope/conformance/contacts.hpp"
#include "millscope/conformance/impact.hpp"

namespace millscope::conformance {

namespace detail {

using Law = Held<ContactLawTable>;

inline bool same_bits(const Column& a, const Column& b, std::size_t n) { return std::memcmp(a.data(), b.data(), n * sizeof(double)) == 0; }

inline void scalar_is_packed(const Law& law, const Setting& setting, Violations& out) {
  Contacts packed = random_contacts(setting), scalar = packed;
  const double dt = fine_step(law, setting.pair, 50);
  for (int step = 0; step < 40; ++step) {
    packed.step(law, dt, true);
    scalar.step(law, dt, false);
    bool same = same_bits(packed.normal_force, scalar.normal_force, packed.count) &&
                same_bits(packed.normal_stiffness, scalar.normal_stiffness, packed.count) &&
                same_bits(packed.elastic_energy, scalar.elastic_energy, packed.count);
    for (std::size_t axis = 0; axis < 3; ++axis) same = same && same_bits(packed.force[axis], scalar.force[axis], packed.count);
    for (std::size_t h = 0; h < kMaxHistory; ++h) same = same && same_bits(packed.history[h], scalar.history[h], packed.count);
    for (std::size_t k = 0; k < kMaxChannels; ++k) same = same && same_bits(packed.power[k], scalar.power[k], packed.count);
    if (!same) {
      out.push_back({"scalar = packed", text_of("the two differ in step %g (of %g)", step, 40)});
      return;
    }
    move(packed, dt);
    move(scalar, dt);
  }
}

inline void finite_and_nothing_beyond_reach(const Law& law, const Setting& setting, Violations& out) {
  Contacts c = random_contacts(setting);
  const double reach = law.table().reach(law.get(), setting.pair.largest_radius);
  if (!(reach >= 0.0) || !std::isfinite(reach))
    out.push_back({"reach", text_of("is %g (typical overlap %g m)", reach, typical_overlap(setting.pair))});
  for (std::size_t s = 0; s < c.count; ++s) {
    c.overlap[s] = -1.001 * reach - 1e-12;
    if (reach == 0.0 && s % 2 == 0) {
      c.overlap[s] = 0.0;
      Contacts::put(c.velocity, s, {0, 0, 0});
    }
  }
  c.step(law, fine_step(law, setting.pair, 50));
  for (std::size_t s = 0; s < c.slots; ++s) {  // padding too: its energy and power are in the sums
    double most = std::fabs(c.elastic_energy[s]);
    for (const Column& f : c.force) most = std::max(most, std::isfinite(f[s]) ? std::fabs(f[s]) : HUGE_VAL);
    for (const Column& p : c.power) most = std::max(most, std::isfinite(p[s]) ? std::fabs(p[s]) : HUGE_VAL);
    if (!(most <= 0.0)) {
      out.push_back({"nothing without contact", text_of("force, energy or power is %g at overlap %g", most, c.overlap[s])});
      return;
    }
  }
}

inline double largest_force(const Contacts& c) {
  double largest = 1e-30;
  for (const Column& f : c.force) {
    for (std::size_t s = 0; s < c.count; ++s) largest = std::max(largest, std::fabs(f[s]));
  }
  return largest;
}

/// Runs the contacts and a transformed copy side by side; `map` turns a vector of the first into one of the second.
template <class Map>
void transformed(const Law& law, const Setting& setting, const char* name, Map map, Violations& out) {
  Contacts a = random_contacts(setting), b = a;
  for (std::size_t s = 0; s < a.count; ++s) {
    Contacts::put(b.normal, s, map(Contacts::at(a.normal, s)));
    Contacts::put(b.velocity, s, map(Contacts::at(a.velocity, s)));
  }
  const double dt = fine_step(law, setting.pair, 50);
  for (int step = 0; step < 20; ++step) {
    a.step(law, dt);
    b.step(law, dt);
    const double scale = largest_force(a);
    for (std::size_t s = 0; s < a.count; ++s) {
      const auto expected = map(Contacts::at(a.force, s)), found = Contacts::at(b.force, s);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        if (std::fabs(expected[axis] - found[axis]) <= 1e-9 * scale) continue;
        out.push_back({name, text_of("the force is %g N instead of %g N", found[axis], expected[axis])});
        return;
      }
    }
    move(a, dt);
    move(b, dt);
  }
}

/// Exchanging i and j with a history that is not empty: the signs of the histories must be right.
inline void history_signs(const Law& law, const Setting& setting, Violations& out) {
  Contacts a = random_contacts(setting);
  const double dt = fine_step(law, setting.pair, 50);
  for (int step = 0; step < 10; ++step) {
    a.step(law, dt);
    move(a, dt);
  }
  Contacts b = a;
  const PairTermInfo& info = law.table().info;
  for (std::size_t s = 0; s < a.count; ++s) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      b.normal[axis][s] = -a.normal[axis][s];
      b.velocity[axis][s] = -a.velocity[axis][s];
    }
    for (std::uint32_t h = 0; h < info.history_count; ++h) b.history[h][s] *= info.histories[h].sign;
  }
  a.step(law, dt);
  b.step(law, dt);
  const double scale = largest_force(a);
  for (std::size_t s = 0; s < a.count; ++s) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (std::fabs(a.force[axis][s] + b.force[axis][s]) <= 1e-9 * scale) continue;
      out.push_back(
          {"history signs", text_of("after exchanging i and j the force is %g N instead of %g N", b.force[axis][s], -a.force[axis][s])});
      return;
    }
  }
}

inline void friction_is_capped(const Law& law, const Setting& setting, Violations& out) {
  Contacts c = random_contacts(setting);
  if (!setting.sum_is_capped) {
    for (Column& v : c.velocity) std::transform(v.begin(), v.end(), v.begin(), [](double x) { return 1e-6 * x; });
  }
  const double dt = fine_step(law, setting.pair, 20), scale = setting.sum_is_capped ? 1e-9 : 1e-3;
  for (int step = 0; step < 60; ++step) {
    c.step(law, dt);
    const double slack = scale * largest_force(c);
    for (std::size_t s = 0; s < c.count; ++s) {
      const auto f = Contacts::at(c.force, s), n = Contacts::at(c.normal, s);
      const double along = f[0] * n[0] + f[1] * n[1] + f[2] * n[2];
      const double across = std::sqrt(std::max(0.0, f[0] * f[0] + f[1] * f[1] + f[2] * f[2] - along * along));
      const double cap = c.friction[s] * std::max(c.normal_force[s] + setting.cap_offset, 0.0);
      if (across <= cap + slack + 1e-6 * std::fabs(along)) continue;
      out.push_back({"Coulomb's cap", text_of("|F_t| = %g N, but mu max(F_n, 0) = %g N", across, cap)});
      return;
    }
    if (step % 2 == 0) move(c, dt);
  }
}

inline void elastic_derivatives(const Law& law, const Setting& setting, Violations& out) {
  constexpr std::size_t n = 24;
  const double largest = typical_overlap(setting.pair), h = 1e-4;
  Contacts low(n), middle(n), high(n);
  for (std::size_t s = 0; s < n; ++s) {
    const double overlap = largest * (static_cast<double>(s) + 1.0) / n;
    for (Contacts* c : {&low, &middle, &high}) {
      c->overlap[s] = overlap * (c == &low ? 1.0 - h : c == &high ? 1.0 + h : 1.0);
      Contacts::put(c->normal, s, {0, 0, 1});
      c->radius[s] = setting.pair.largest_radius;
      c->mass[s] = setting.pair.largest_mass;
      c->friction[s] = 0.3;
    }
  }
  for (Contacts* c : {&low, &middle, &high}) c->step(law, fine_step(law, setting.pair, 50));
  const double scale = std::fabs(middle.normal_force[n - 1]), tolerance = setting.stiffness_tolerance;
  for (std::size_t s = 0; s < n; ++s) {
    const double width = high.overlap[s] - low.overlap[s];
    const double slope = (high.elastic_energy[s] - low.elastic_energy[s]) / width, force = middle.normal_force[s];
    if (std::fabs(slope - force) > tolerance * (std::fabs(force) + 1e-3 * scale)) {
      out.push_back({"elastic force = dU/d(overlap)", text_of("F_n = %g N, dU/d(overlap) = %g N", force, slope)});
      return;
    }
    const double stiffness = (high.normal_force[s] - low.normal_force[s]) / width;
    if (std::fabs(stiffness - middle.normal_stiffness[s]) > tolerance * std::fabs(stiffness) + 1e-6 * scale / largest) {
      out.push_back({"normal stiffness = dF_n/d(overlap)",
                     text_of("it says %g N/m, differences give %g N/m", middle.normal_stiffness[s], stiffness)});
      return;
    }
  }
}

inline void dissipation_is_positive(const Law& law, const Setting& setting, Violations& out) {
  Contacts c = random_contacts(setting);
  const PairTermInfo& info = law.table().info;
  const double dt = fine_step(law, setting.pair, 50);
  for (int step = 0; step < 60; ++step) {
    c.step(law, dt);
    const double slack = 1e-9 * largest_force(c) * setting.pair.typical_speed;
    for (std::uint32_t k = 0; k < info.channel_count; ++k) {
      if (info.channels[k].nature != ChannelNature::dissipative) continue;
      const double least = *std::min_element(c.power[k].begin(), c.power[k].end());
      if (least >= -slack) continue;
      out.push_back({"dissipation >= 0", std::string(info.channels[k].name) + text_of(" gives %g W (step %g)", least, step)});
      return;
    }
    move(c, dt);
  }
}

}  // namespace detail

/// Every check of a contact law with these values. Throws Refusal when the plugin refuses the values.
inline Violations check_contact_law(const Descriptor& descriptor, const Values& values, const Setting& setting = {}) {
  Violations out;
  const detail::Law law(table_of<ContactLawTable>(descriptor, Kind::contact_law, kContactLawLayout), values, setting.pair);
  detail::scalar_is_packed(law, setting, out);
  detail::finite_and_nothing_beyond_reach(law, setting, out);
  detail::transformed(
      law, setting, "antisymmetry",
      [](std::array<double, 3> v) {
        return std::array<double, 3>{-v[0], -v[1], -v[2]};
      },
      out);
  const auto turn = [](std::array<double, 3> v) {
    std::array<double, 3> turned;
    rotate(v.data(), turned.data());
    return turned;
  };
  detail::transformed(law, setting, "frame indifference", turn, out);
  detail::history_signs(law, setting, out);
  if (setting.check_friction) detail::friction_is_capped(law, setting, out);
  detail::elastic_derivatives(law, setting, out);
  detail::dissipation_is_positive(law, setting, out);
  check_ledger(law, setting, out);
  return out;
}

}  // namespace millscope::conformance
