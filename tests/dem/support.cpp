#include "dem/support.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <stdexcept>

#include "kernel/dem/wide.hpp"
#include "kernel/host/registry.hpp"

namespace dem_test {

std::vector<std::string> levels() {
  std::vector<std::string> found;
  for (const char* level : {"v2", "v3", "v4"}) {
    try {
      dem::wide_table(level);
      found.emplace_back(level);
    } catch (const base::UserError&) {
    }
  }
  return found;
}

const host::Registry& registry(const std::string& level) {
  static std::map<std::string, std::unique_ptr<host::Registry>> all;
  std::unique_ptr<host::Registry>& r = all[level];
  if (!r) {
    host::RegistryOptions options;
    options.directories = {std::string(MILLSCOPE_BINARY_DIR) + "/lib/millscope/plugins"};
    options.own = false;
    for (const host::InstructionSet s : {host::InstructionSet::v2, host::InstructionSet::v3, host::InstructionSet::v4}) {
      if (host::text(s) == level) options.instruction_set = s;
    }
    r = std::make_unique<host::Registry>(options);
  }
  return *r;
}

std::string Setup::text() const {
  const std::string walls = wall_pairs.empty() ? pairs : wall_pairs;
  std::string t = "schema_version: 1\nname: test\n";
  t += fmt::format("stiffness_factor: {:.17g}\n", stiffness_factor);
  t += "materials:\n"
       "  glass: {density: 2500 kg/m^3, young_modulus: 63.96 GPa, poisson_ratio: 0.23}\n"
       "  heavy: {density: 7800 kg/m^3, young_modulus: 63.96 GPa, poisson_ratio: 0.30}\n"
       "  wall: {density: 2500 kg/m^3, young_modulus: 63.96 GPa, poisson_ratio: 0.23}\n";
  t += "beads: " + beads + "\nfill: " + fill + "\n";
  t += "contact:\n  law: " + law + "\n  interactions: " + interactions + "\n  pair_parameters: " + pair_parameters + "\n  wear: " + wear +
       "\n";
  t += fmt::format(
      "pairs:\n  glass~glass: {{{0}}}\n  glass~heavy: {{{0}}}\n  heavy~heavy: {{{0}}}\n  glass~wall: {{{1}}}\n  heavy~wall: {{{1}}}\n",
      pairs, walls);
  t += "body_forces: " + body_forces + "\n";
  if (geometry != "{}") t += "geometry: " + geometry + "\n";
  if (!mill.empty()) t += "mill: " + mill + "\n";
  t += "domain: " + domain + "\ntime: " + time + "\nrun: " + run + "\n";
  return t;
}

Assembly assembled(const Setup& setup, const run::AssemblyOptions& options, const std::string& level) {
  run::AssemblyOptions o = options;
  if (o.threads == 0) o.threads = 1;
  return run::assemble(config::parse_case(setup.text(), "test.yaml"), registry(level), o);
}

void place(Assembly& a, const std::vector<Bead>& beads) {
  dem::Particles& p = a.system->particles;
  p.resize(beads.size());
  const double h = 0.5 * a.time_step;
  for (std::size_t i = 0; i < beads.size(); ++i) {
    const Bead& b = beads[i];
    const double m = bead_mass(b.radius, b.density);
    p.position[i] = {b.position[0], b.position[1], b.position[2], b.radius};
    dem::MotionLine line{};
    line.inverse_mass = 1 / m;
    line.inverse_inertia = 1 / (0.4 * m * b.radius * b.radius);
    dem::AccelerationLine acceleration{};
    for (std::size_t k = 0; k < 3; ++k) {
      line.v[k] = b.velocity[k];
      line.w[k] = b.spin[k];
      acceleration.linear[k] = static_cast<float>(a.gravity[k]);
    }
    p.motion[i] = p.half[i] = line;
    for (std::size_t k = 0; k < 3; ++k) p.half[i].v[k] -= h * a.gravity[k];
    p.force[i] = {};
    p.acceleration[i] = acceleration;
    p.id[i] = static_cast<std::uint32_t>(i);
    p.material[i] = static_cast<std::uint8_t>(b.material);
  }
  a.bead_count = beads.size();
}

void start(Assembly& a, const std::vector<Bead>& beads) {
  place(a, beads);
  a.system->start(0);
}

void start_in_contact(Assembly& a, const std::vector<Bead>& beads) {
  start(a, beads);
  a.system->advance();
  std::vector<dem::AccelerationLine> first(beads.size());
  for (std::size_t i = 0; i < beads.size(); ++i) first[a.system->particles.id[i]] = a.system->particles.acceleration[i];
  place(a, beads);
  dem::Particles& p = a.system->particles;
  for (std::size_t i = 0; i < beads.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      p.half[i].v[k] = beads[i].velocity[k] - 0.5 * a.time_step * static_cast<double>(first[i].linear[k]);
      p.half[i].w[k] = beads[i].spin[k] - 0.5 * a.time_step * static_cast<double>(first[i].angular[k]);
    }
    p.acceleration[i] = first[i];
  }
  a.system->start(0);
}

void advance(Assembly& a, std::int64_t steps) {
  for (std::int64_t s = 0; s < steps; ++s) a.system->advance();
}

std::size_t index_of(const Assembly& a, std::uint32_t id) {
  const auto& ids = a.system->particles.id;
  return static_cast<std::size_t>(std::find(ids.begin(), ids.end(), id) - ids.begin());
}

Vector position(const Assembly& a, std::uint32_t id) {
  const dem::PositionLine& x = a.system->particles.position[index_of(a, id)];
  return {x.centre[0], x.centre[1], x.centre[2]};
}

Vector velocity(const Assembly& a, std::uint32_t id) {
  const dem::MotionLine& m = a.system->particles.half[index_of(a, id)];
  return {m.v[0], m.v[1], m.v[2]};
}

Vector spin(const Assembly& a, std::uint32_t id) {
  const dem::MotionLine& m = a.system->particles.half[index_of(a, id)];
  return {m.w[0], m.w[1], m.w[2]};
}

double mass(const Assembly& a, std::uint32_t id) { return 1 / a.system->particles.half[index_of(a, id)].inverse_mass; }
double inertia(const Assembly& a, std::uint32_t id) { return 1 / a.system->particles.half[index_of(a, id)].inverse_inertia; }

Energy observed(Assembly& a) {
  Energy e;
  a.system->observe = [&](const dem::System& s) {
    e.kinetic = s.kinetic_energy().total();
    const Vector c = s.centre_of_mass();
    for (std::size_t k = 0; k < 3; ++k) e.potential -= s.total_mass() * a.gravity[k] * c[k];
    const dem::Ledger ledger = s.ledger();
    for (const dem::PairLedger& p : ledger.pairs) {
      e.elastic += p.elastic;
      for (const double d : p.dissipated) e.dissipated += d;
    }
    for (const double w : ledger.body_force_work) e.dissipated += w;
    for (const dem::BodyLedger& b : ledger.bodies) e.wall_work += b.work;
  };
  a.system->advance();
  a.system->observe = nullptr;
  return e;
}

Saved saved(const Assembly& a) {
  Saved s;
  a.system->save([&s](const std::string& name, const double* v, std::size_t n) { s.doubles[name].assign(v, v + n); },
                 [&s](const std::string& name, const std::int64_t* v, std::size_t n) { s.integers[name].assign(v, v + n); });
  return s;
}

void restore(Assembly& a, const Saved& s) {
  a.system->restore([&s](const std::string& name) { return s.doubles.at(name); },
                    [&s](const std::string& name) { return s.integers.at(name); });
}

double length(const Vector& v) { return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }
Vector minus(const Vector& a, const Vector& b) { return plus(a, -1, b); }
Vector plus(const Vector& a, double factor, const Vector& b) { return {a[0] + factor * b[0], a[1] + factor * b[1], a[2] + factor * b[2]}; }
Vector cross(const Vector& a, const Vector& b) { return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]}; }

double effective_young(double stiffness_factor) { return 63.96e9 * stiffness_factor / (2 * (1 - 0.23 * 0.23)); }
double bead_mass(double radius, double density) { return 4.0 / 3.0 * std::numbers::pi * radius * radius * radius * density; }

Book shaken_box(Setup s) {
  s.fill = "{count: 200, settle_s: 0.05}";
  s.geometry =
      "{box: {kind: box, low: [0, 0, 0], high: [30 mm, 60 mm, 30 mm], material: wall, "
      "motion: {translation: {oscillation: {amplitude: [0, 4 mm, 2 mm], frequency: 20 Hz}}}}}";
  s.domain = "{}";
  s.run = "{partitions: 4}";
  Assembly a = assembled(s);
  run::insert_beads(a);
  run::begin(a);
  advance(a, -a.first_step + std::llround(0.15 / a.time_step));
  const Energy first = observed(a);
  advance(a, std::llround(0.4 / a.time_step));
  const Energy last = observed(a);
  return {last.wall_work - first.wall_work, last.dissipated - first.dissipated, last.stored() - first.stored()};
}

double resting_overlap(double stiffness_factor, double slope) {
  const double weight = bead_mass() * kGravity * std::cos(slope);
  return std::pow(0.75 * weight / (effective_young(stiffness_factor) * std::sqrt(kRadius)), 2.0 / 3.0);
}

}  // namespace dem_test
