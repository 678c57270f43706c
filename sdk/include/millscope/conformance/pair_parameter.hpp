// What every pair parameter must hold to.
#pragma once

#include <algorithm>

#include "millscope/conformance/contacts.hpp"
#include "millscope/pair_parameter.hpp"

namespace millscope::conformance {

/// Contacts with the restitution and the friction that a pair parameter gives them; what it does not give keeps `kUntouched`.
struct ParameterPairs {
  static constexpr double kUntouched = -7.0;

  explicit ParameterPairs(Contacts contacts) : base(std::move(contacts)) {
    restitution.assign(base.slots, kUntouched);
    friction.assign(base.slots, kUntouched);
  }

  void step(const Held<PairParameterTable>& parameter, double time_step) {
    PairParameterBatch b{};
    b.count = static_cast<std::int64_t>(base.slots);
    b.time_step = time_step;
    b.overlap = base.overlap.data();
    b.radius = base.radius.data();
    b.mass = base.mass.data();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      b.normal[axis] = base.normal[axis].data();
      b.velocity[axis] = base.velocity[axis].data();
    }
    for (std::size_t h = 0; h < kMaxHistory; ++h) b.history[h] = base.history[h].data();
    b.restitution = restitution.data();
    b.friction = friction.data();
    parameter.table().evaluate(parameter.get(), &b);
  }

  Contacts base;
  Column restitution, friction;
};

namespace detail {

using PairParameter = Held<PairParameterTable>;

/// A time step that resolves Hertz's contact of the pair.
inline double parameter_step(const PairContext& pair) {
  const double young = pair.effective_young, mass = pair.smallest_mass;
  return 0.02 * 2.87 * std::pow(mass * mass / (pair.smallest_radius * young * young * pair.typical_speed), 0.2);
}

/// e within 0…1, μ from 0, both finite, in every slot (padding too: it is loaded by the law); and nothing else written.
inline bool gives_what_it_says(const ParameterPairs& pairs, std::uint64_t features, Violations& out) {
  const bool gives_restitution = (features & kGivesRestitution) != 0, gives_friction = (features & kGivesFriction) != 0;
  for (std::size_t s = 0; s < pairs.base.slots; ++s) {
    const double e = pairs.restitution[s], mu = pairs.friction[s];
    const auto untouched = [](double x) { return std::fabs(x - ParameterPairs::kUntouched) <= 0.0; };
    if (gives_restitution && !(e > 0.0 && e <= 1.0))
      return out.push_back({"range", text_of("e is %g (overlap %g m)", e, pairs.base.overlap[s])}), false;
    if (gives_friction && !(mu >= 0.0 && std::isfinite(mu)))
      return out.push_back({"range", text_of("mu is %g (overlap %g m)", mu, pairs.base.overlap[s])}), false;
    if ((!gives_restitution && !untouched(e)) || (!gives_friction && !untouched(mu)))
      return out.push_back({"only what it gives", "a column is written that its features do not name"}), false;
  }
  return true;
}

inline void parameter_range(const PairParameter& parameter, const Setting& setting, std::uint64_t features, Violations& out) {
  ParameterPairs pairs(random_contacts(setting));
  const double dt = parameter_step(setting.pair);
  for (int step = 0; step < 40; ++step) {
    pairs.step(parameter, dt);
    if (!gives_what_it_says(pairs, features, out)) return;
    for (const Column& h : pairs.base.history) {
      if (std::all_of(h.begin(), h.end(), [](double x) { return std::isfinite(x); })) continue;
      return out.push_back({"finite", text_of("a history is not finite in step %g of %g", step, 40)});
    }
    move(pairs.base, dt);
  }
}

/// At rest, barely moving and very fast: the range holds there too.
inline void parameter_limits(const PairParameter& parameter, const Setting& setting, std::uint64_t features, Violations& out) {
  for (const double factor : {0.0, 1e-12, 1e-6, 1e3}) {
    ParameterPairs pairs(random_contacts(setting));
    for (Column& v : pairs.base.velocity) std::transform(v.begin(), v.end(), v.begin(), [factor](double x) { return factor * x; });
    pairs.step(parameter, parameter_step(setting.pair));
    if (!gives_what_it_says(pairs, features, out)) return;
  }
}

/// Largest difference of what two batches give.
inline double parameter_difference(const ParameterPairs& a, const ParameterPairs& b) {
  double largest = 0;
  for (std::size_t s = 0; s < a.base.count; ++s) {
    largest = std::max({largest, std::fabs(a.restitution[s] - b.restitution[s]), std::fabs(a.friction[s] - b.friction[s])});
  }
  return largest;
}

/// The same contacts seen by the other body, and turned in space: e and μ are scalars.
inline void parameter_is_scalar(const PairParameter& parameter, const Setting& setting, Violations& out) {
  ParameterPairs a(random_contacts(setting)), exchanged = a, turned = a;
  const double dt = parameter_step(setting.pair);
  for (int step = 0; step < 10; ++step) {
    exchanged.base = turned.base = a.base;
    for (std::size_t s = 0; s < a.base.count; ++s) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        exchanged.base.normal[axis][s] *= -1.0;
        exchanged.base.velocity[axis][s] *= -1.0;
      }
      for (Columns* c : {&turned.base.normal, &turned.base.velocity}) {
        std::array<double, 3> v;
        rotate(Contacts::at(*c, s).data(), v.data());
        Contacts::put(*c, s, v);
      }
    }
    const PairParameterInfo& info = parameter.table().info;
    for (std::uint32_t h = 0; h < info.history_count; ++h) {
      for (double& x : exchanged.base.history[h]) x *= info.histories[h].sign;
    }
    const bool scalar_history =
        std::all_of(info.histories, info.histories + info.history_count, [](const History& h) { return h.sign > 0; });
    a.step(parameter, dt);
    exchanged.step(parameter, dt);
    turned.step(parameter, dt);
    const double off = parameter_difference(a, exchanged), askew = parameter_difference(a, turned);
    if (!(off <= 1e-9)) return out.push_back({"symmetry", text_of("exchanging i and j changes e or mu by %g (step %g)", off, step)});
    if (scalar_history && !(askew <= 1e-9))
      return out.push_back({"frame indifference", text_of("turning a contact changes e or mu by %g (step %g)", askew, step)});
    move(a.base, dt);
  }
}

/// What a slot gets depends on that slot alone.
inline void parameter_is_local(const PairParameter& parameter, const Setting& setting, Violations& out) {
  ParameterPairs all(random_contacts(setting));
  const double dt = parameter_step(setting.pair);
  ParameterPairs alone(Contacts(1));
  const std::size_t s = 5;
  alone.base.overlap[0] = all.base.overlap[s], alone.base.radius[0] = all.base.radius[s], alone.base.mass[0] = all.base.mass[s];
  Contacts::put(alone.base.normal, 0, Contacts::at(all.base.normal, s));
  Contacts::put(alone.base.velocity, 0, Contacts::at(all.base.velocity, s));
  all.step(parameter, dt);
  alone.step(parameter, dt);
  const double off = std::fabs(all.restitution[s] - alone.restitution[0]) + std::fabs(all.friction[s] - alone.friction[0]);
  if (!(off <= 0.0))
    out.push_back({"slot by slot", text_of("a contact alone gets another value, by %g (speed %g m/s)", off, all.base.velocity[0][s])});
}

/// What a fresh contact gets whose surfaces close at `closing` and slide at `sliding`.
inline std::array<double, 2> parameter_at(const PairParameter& parameter, const Setting& setting, double closing, double sliding) {
  ParameterPairs pairs(Contacts(1));
  pairs.base.overlap[0] = 0.1 * typical_overlap(setting.pair);
  pairs.base.radius[0] = setting.pair.largest_radius;
  pairs.base.mass[0] = setting.pair.largest_mass;
  Contacts::put(pairs.base.normal, 0, {0, 0, 1});
  Contacts::put(pairs.base.velocity, 0, {sliding, 0, -closing});
  pairs.step(parameter, parameter_step(setting.pair));
  return {pairs.restitution[0], pairs.friction[0]};
}

/// Looks for a jump along the speed: the largest step of a sweep is halved again and again; a continuous function's step shrinks with it.
inline void parameter_is_continuous(const PairParameter& parameter, const Setting& setting, Violations& out) {
  for (const bool slides : {false, true}) {
    const double typical = setting.pair.typical_speed;
    const auto at = [&](double speed) { return parameter_at(parameter, setting, slides ? 0.3 * typical : speed, slides ? speed : 0.0); };
    const auto step_of = [&](double low, double high) {
      const auto a = at(low), b = at(high);
      return std::max(std::fabs(a[0] - b[0]), std::fabs(a[1] - b[1]));
    };
    double low = 0, high = 0, largest = 0;
    for (int k = 0; k < 400; ++k) {
      const double a = typical * std::pow(10.0, -4.0 + 0.0125 * k), b = typical * std::pow(10.0, -4.0 + 0.0125 * (k + 1)),
                   step = step_of(a, b);
      if (step > largest) low = a, high = b, largest = step;
    }
    double jump = largest;
    for (int halving = 0; halving < 30 && jump > 0.0; ++halving) {
      const double middle = 0.5 * (low + high), left = step_of(low, middle), right = step_of(middle, high);
      (left > right ? high : low) = middle;
      jump = std::max(left, right);
    }
    if (jump > 1e-6 && jump > 0.1 * largest) out.push_back({"continuity", text_of("e or mu jumps by %g at a speed of %g m/s", jump, low)});
  }
}

}  // namespace detail

/// Every check of a pair parameter with these values. Throws Refusal when the plugin refuses the values.
inline Violations check_pair_parameter(const Descriptor& descriptor, const Values& values, const Setting& setting = {}) {
  Violations out;
  const auto& table = table_of<PairParameterTable>(descriptor, Kind::pair_parameter, kPairParameterLayout);
  const detail::PairParameter parameter(table, values, setting.pair);
  detail::parameter_range(parameter, setting, descriptor.features, out);
  detail::parameter_limits(parameter, setting, descriptor.features, out);
  detail::parameter_is_scalar(parameter, setting, out);
  detail::parameter_is_local(parameter, setting, out);
  detail::parameter_is_continuous(parameter, setting, out);
  with_ends_of_ranges(
      descriptor, table, values, out,
      [&](const detail::PairParameter& object) { detail::parameter_limits(object, setting, descriptor.features, out); }, setting.pair);
  return out;
}

}  // namespace millscope::conformance
