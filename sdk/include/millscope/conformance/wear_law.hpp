// What every wear law must hold to.
#pragma once

#include "millscope/conformance/contacts.hpp"
#include "millscope/wear_law.hpp"

namespace millscope::conformance {

/// Beads at a wall as the host hands them over, with what they take away.
struct RubbingBeads {
  explicit RubbingBeads(std::size_t n) : count(n), first(n, 0) {
    for (Column* c : {&radius, &mass, &pressing, &sliding, &volume}) c->assign(n, 0.0);
    for (Columns* c : {&normal, &velocity}) {
      for (Column& axis : *c) axis.assign(n, 0.0);
    }
  }

  void act(const Held<WearLawTable>& law, double time_step) {
    WearBatch b{};
    b.count = static_cast<std::int64_t>(count);
    b.time_step = time_step;
    b.first = first.data();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      b.normal[axis] = normal[axis].data();
      b.velocity[axis] = velocity[axis].data();
    }
    b.radius = radius.data();
    b.mass = mass.data();
    b.pressing = pressing.data();
    b.sliding = sliding.data();
    b.volume = volume.data();
    law.table().evaluate(law.get(), &b);
  }

  /// Bead i of these alone.
  RubbingBeads only(std::size_t i) const {
    RubbingBeads one(1);
    one.first[0] = first[i];
    one.radius[0] = radius[i], one.mass[0] = mass[i], one.pressing[0] = pressing[i], one.sliding[0] = sliding[i];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      one.normal[axis][0] = normal[axis][i];
      one.velocity[axis][0] = velocity[axis][i];
    }
    return one;
  }

  std::size_t count;
  std::vector<std::uint8_t> first;
  Column radius, mass, pressing, sliding, volume;
  Columns normal, velocity;
};

namespace detail {

using WearLaw = Held<WearLawTable>;

/// Some strike, some slide, some rest.
inline RubbingBeads random_rubbing(const Setting& setting) {
  RubbingBeads beads(61);
  Random numbers(20261126);
  const double weight = 9.81 * setting.pair.largest_mass;
  for (std::size_t i = 0; i < beads.count; ++i) {
    beads.first[i] = i % 3 == 0 ? 1 : 0;
    beads.radius[i] = setting.pair.largest_radius;
    beads.mass[i] = setting.pair.largest_mass;
    beads.pressing[i] = i % 7 == 0 ? 0.0 : numbers.between(0, 20) * weight;
    beads.sliding[i] = i % 5 == 0 ? 0.0 : numbers.between(0, setting.pair.typical_speed);
    Contacts::put(beads.normal, i, random_unit(numbers));
    std::array<double, 3> v = random_unit(numbers);
    for (double& component : v) component *= numbers.between(0, 2) * setting.pair.typical_speed;
    Contacts::put(beads.velocity, i, v);
  }
  return beads;
}

inline void wear_is_no_gain(const WearLaw& law, const Setting& setting, Violations& out) {
  RubbingBeads beads = random_rubbing(setting);
  beads.act(law, 1e-5);
  for (std::size_t i = 0; i < beads.count; ++i) {
    if (!(beads.volume[i] >= 0.0 && std::isfinite(beads.volume[i])))
      return out.push_back({"range", text_of("takes %g m3 (pressing %g N)", beads.volume[i], beads.pressing[i])});
  }
}

/// A bead that neither slides, presses nor closes takes nothing.
inline void wear_needs_a_cause(const WearLaw& law, const Setting& setting, Violations& out) {
  RubbingBeads beads = random_rubbing(setting);
  for (Column& axis : beads.velocity) axis.assign(beads.count, 0.0);
  beads.pressing.assign(beads.count, 0.0);
  beads.sliding.assign(beads.count, 0.0);
  beads.act(law, 1e-5);
  for (const double volume : beads.volume) {
    if (!(std::fabs(volume) <= 0.0)) return out.push_back({"a cause", text_of("a bead at rest takes %g m3 (%g beads)", volume, 61)});
  }
}

/// Turned in space it takes the same; and what it takes hangs on no other bead.
inline void wear_is_local(const WearLaw& law, const Setting& setting, Violations& out) {
  RubbingBeads beads = random_rubbing(setting), turned = beads;
  for (std::size_t i = 0; i < beads.count; ++i) {
    for (Columns* c : {&turned.normal, &turned.velocity}) {
      std::array<double, 3> v;
      rotate(Contacts::at(*c, i).data(), v.data());
      Contacts::put(*c, i, v);
    }
  }
  beads.act(law, 1e-5);
  turned.act(law, 1e-5);
  double largest = 0;
  for (const double volume : beads.volume) largest = std::max(largest, volume);
  for (std::size_t i = 0; i < beads.count; ++i) {
    RubbingBeads alone = beads.only(i);
    alone.act(law, 1e-5);
    const double off = std::fabs(turned.volume[i] - beads.volume[i]), apart = std::fabs(alone.volume[0] - beads.volume[i]);
    if (!(apart <= 0.0)) return out.push_back({"bead by bead", text_of("alone it takes %g of %g m3 more", apart, beads.volume[i])});
    if (!(off <= 1e-9 * largest))
      return out.push_back({"frame indifference", text_of("turned in space it takes %g of %g m3 more", off, beads.volume[i])});
  }
}

}  // namespace detail

/// Every check of a wear law with these values. Throws Refusal when the plugin refuses the values.
inline Violations check_wear_law(const Descriptor& descriptor, const Values& values, const Setting& setting = {}) {
  Violations out;
  const auto& table = table_of<WearLawTable>(descriptor, Kind::wear_law, kWearLawLayout);
  const detail::WearLaw law(table, values, setting.pair);
  detail::wear_is_no_gain(law, setting, out);
  detail::wear_needs_a_cause(law, setting, out);
  detail::wear_is_local(law, setting, out);
  with_ends_of_ranges(
      descriptor, table, values, out, [&](const detail::WearLaw& object) { detail::wear_is_no_gain(object, setting, out); }, setting.pair);
  return out;
}

}  // namespace millscope::conformance
