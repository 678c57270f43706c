#include "kernel/run/warm_start.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "kernel/dem/state_visitors.hpp"
#include "kernel/output/archive.hpp"
#include "kernel/output/directory.hpp"
#include "kernel/run/bodies.hpp"
#include "kernel/run/insertion.hpp"

namespace millscope::run {
namespace {

namespace fs = std::filesystem;
using base::UserError;

/// A bead as the other run left it.
struct Left {
  std::uint32_t id;
  base::Vector3 centre;
  double radius, mass;
  base::Vector3 velocity, spin;
};

/// What the other run left.
struct Donor {
  config::Case c;
  double clock = 0;  ///< of its walls, s
  std::int64_t surfaces = 0;
  std::vector<Left> beads;
};

[[noreturn]] void refuse(const Assembly& a, const std::string& why) {
  a.c.start->node.fail(fmt::format("is '{}': {}", a.c.start->run, why));
}

/// The checkpoint of a run that has reached its end.
fs::path checkpoint_of(const Assembly& a) {
  const fs::path folder = a.c.start->run;
  std::error_code ignored;
  if (!fs::is_directory(folder, ignored)) refuse(a, "no such folder; give the one that 'millscope run CASE.yaml -o OUT' wrote");
  const fs::path checkpoint = output::checkpoint_path(folder);
  if (!fs::exists(checkpoint, ignored) || !fs::exists(folder / output::kResolvedCase, ignored))
    refuse(a, "it holds no checkpoint.h5 with its case.resolved.yaml; give a folder that 'millscope run CASE.yaml -o OUT' wrote");
  if (!fs::exists(folder / "summary.json", ignored))
    refuse(a, fmt::format("that run has not reached its end; millscope resume {}", folder.string()));
  return checkpoint;
}

std::unique_ptr<const output::ArchiveReader> opened(const Assembly& a, const fs::path& checkpoint) {
  try {
    return std::make_unique<const output::ArchiveReader>(checkpoint);
  } catch (const UserError& e) {
    refuse(a, fmt::format("its checkpoint cannot be read ({}); run it again", e.what()));
  }
}

void take_beads(const output::ArchiveReader& archive, Donor& donor) {
  const auto doubles = [&archive](const std::string& name) { return archive.read<double>("system/" + name); };
  const auto integers = [&archive](const std::string& name) { return archive.read<std::int64_t>("system/" + name); };
  const dem::StateReader::DoubleSource double_source = doubles;
  const dem::StateReader::IntegerSource integer_source = integers;
  dem::StateReader reader(double_source, integer_source);
  dem::Particles p;
  reader.whole("position", p.position);
  reader.whole("motion", p.motion);
  reader.whole("id", p.id);
  dem::demand(p.motion.size() == p.position.size() && p.id.size() == p.position.size());
  for (std::size_t i = 0; i < p.position.size(); ++i) {
    const dem::PositionLine& x = p.position[i];
    const dem::MotionLine& m = p.motion[i];
    donor.beads.push_back({p.id[i],
                           {x.centre[0], x.centre[1], x.centre[2]},
                           x.radius,
                           1 / m.inverse_mass,
                           {m.v[0], m.v[1], m.v[2]},
                           {m.w[0], m.w[1], m.w[2]}});
  }
  std::sort(donor.beads.begin(), donor.beads.end(), [](const Left& one, const Left& other) { return one.id < other.id; });
}

Donor donor_of(const Assembly& a) {
  const fs::path checkpoint = checkpoint_of(a);
  Donor donor;
  donor.c = config::read_case((checkpoint.parent_path() / output::kResolvedCase).string());
  const std::unique_ptr<const output::ArchiveReader> archive = opened(a, checkpoint);
  if (!archive->has("time_s") || !archive->has("surfaces"))
    refuse(a, "an older millscope wrote its checkpoint; run it again with this one");
  donor.clock = archive->read_value<double>("time_s") + donor.c.walls_ahead();
  donor.surfaces = archive->read_value<std::int64_t>("surfaces");
  take_beads(*archive, donor);
  return donor;
}

void check_walls(const Assembly& a, const Donor& donor) {
  if (surfaces_of(a) != donor.surfaces || donor.c.geometry.size() != a.c.geometry.size())
    refuse(a, "that mill has other walls; begin from a run of the same geometry, or without 'start'");
  for (std::size_t g = 0; g < a.c.geometry.size(); ++g) {
    const dem::Motion mine = motion_of(a.c.geometry[g].motion), other = motion_of(donor.c.geometry[g].motion);
    const std::string& name = a.c.geometry[g].plugin.name;
    if (mine.speed != other.speed)
      refuse(a, fmt::format("there '{}' turns at {:.6g} rad/s, here at {:.6g} rad/s; begin from a run of the same speed", name, other.speed,
                            mine.speed));
    if (mine != other) refuse(a, fmt::format("there '{}' moves otherwise than here; begin from a run with the same 'motion'", name));
    if (mine.velocity != base::Vector3{})
      refuse(a, fmt::format("'{}' moves away from where that run left it; begin without 'start'", name));
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const config::DomainCase &mine = a.c.domain, &other = donor.c.domain;
    const bool same = mine.periodic[axis] == other.periodic[axis] &&
                      (!mine.periodic[axis] || (mine.box.low[axis] == other.box.low[axis] && mine.box.high[axis] == other.box.high[axis]));
    if (!same) refuse(a, fmt::format("its period along {} is another one; begin from a run with the same domain.periodic", "xyz"[axis]));
  }
}

/// A size of a class, here and there, and how many of them are still wanted.
struct Wanted {
  BeadType type;
  double there_mass;
  std::uint64_t left;  ///< to be found
};

/// Beads keep their places, so that sizes must agree; densities need not.
std::vector<Wanted> kinds_of(const Assembly& a, const Donor& donor, Random& random) {
  std::vector<Wanted> kinds;
  if (donor.c.beads.size() != a.c.beads.size())
    refuse(a, fmt::format("there are {} classes of beads, here {}; begin from a run with the same classes", donor.c.beads.size(),
                          a.c.beads.size()));
  for (std::size_t b = 0; b < a.c.beads.size(); ++b) {
    const config::BeadCase &mine = a.c.beads[b], &other = donor.c.beads[b];
    if (mine.sizes.size() != other.sizes.size())
      refuse(a, fmt::format("there '{}' has {} sizes, here '{}' has {}; begin from a run with the same sizes", other.name,
                            other.sizes.size(), mine.name, mine.sizes.size()));
    for (std::size_t s = 0; s < mine.sizes.size(); ++s) {
      const double here = mine.sizes[s].diameter, there = other.sizes[s].diameter;
      if (std::fabs(here - there) > 1e-9 * here)
        refuse(a,
               fmt::format("there '{}' has beads of {:.6g} m, here '{}' has {:.6g} m in their place; begin from a run with the same sizes",
                           other.name, there, mine.name, here));
      kinds.push_back({{b, here}, other.density * config::sphere_volume(there), 0});
    }
  }
  for (const BeadType& t : draw_types(a, a.bead_count, random)) {
    const auto of = [&t](const Wanted& k) { return k.type.bead_class == t.bead_class && k.type.diameter == t.diameter; };
    ++std::find_if(kinds.begin(), kinds.end(), of)->left;
  }
  return kinds;
}

/// The kind that a bead is of there and that is still wanted here.
Wanted* wanted_kind(std::vector<Wanted>& kinds, const Left& bead) {
  constexpr double kRounding = 1e-6;
  for (Wanted& k : kinds) {
    const bool alike = std::fabs(2 * bead.radius - k.type.diameter) <= kRounding * k.type.diameter &&
                       std::fabs(bead.mass - k.there_mass) <= kRounding * k.there_mass;
    if (alike && k.left > 0) return &k;
  }
  return nullptr;
}

/// Brought into the periodic box, which a run does at its rebuilds only.
void check_places(const Assembly& a, Donor& donor) {
  const dem::Settings& s = a.system->settings();
  for (Left& bead : donor.beads) {
    for (int axis = 0; axis < 3; ++axis) {
      double& x = bead.centre[axis];
      x = dem::wrapped(s, axis, x);
      if (!(x >= s.low[axis] && x <= s.high[axis]))
        refuse(a, fmt::format("its bead {} is at {} = {:.6g} m, outside this case's domain of {:.6g} to {:.6g} m; widen 'domain'", bead.id,
                              "xyz"[axis], x, s.low[axis], s.high[axis]));
    }
  }
}

/// The beads that stay, in the order of their ids, each with its type here.
std::vector<std::pair<Left, BeadType>> staying(const Donor& donor, std::vector<Wanted>& kinds, Random& random) {
  std::vector<std::size_t> order(donor.beads.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  random.shuffle(order);
  std::vector<std::optional<BeadType>> type(order.size());
  for (const std::size_t i : order) {
    Wanted* kind = wanted_kind(kinds, donor.beads[i]);
    if (kind == nullptr) continue;
    type[i] = kind->type;
    --kind->left;
  }
  std::vector<std::pair<Left, BeadType>> stay;
  for (std::size_t i = 0; i < type.size(); ++i) {
    if (type[i]) stay.emplace_back(donor.beads[i], *type[i]);
  }
  return stay;
}

}  // namespace

base::Hash& add_surfaces(const Assembly& a, base::Hash& hash) {
  for (const GeometryUse& g : a.geometries) {
    hash.add(g.surface.vertices, 3 * g.surface.vertex_count * sizeof *g.surface.vertices);
    hash.add(g.surface.triangles, 3 * g.surface.triangle_count * sizeof *g.surface.triangles);
  }
  return hash;
}

void take_over_beads(Assembly& a) {
  Donor donor = donor_of(a);
  check_walls(a, donor);
  check_places(a, donor);
  a.c.start->walls_ahead = donor.clock - static_cast<double>(a.first_step) * a.time_step;
  for (dem::Body& body : a.system->bodies) body.motion.ahead = *a.c.start->walls_ahead;
  Random random(a.c.seed);
  std::vector<Wanted> kinds = kinds_of(a, donor, random);
  const std::vector<std::pair<Left, BeadType>> stay = staying(donor, kinds, random);
  a.system->particles.resize(a.bead_count);
  std::vector<Sphere> occupied;
  for (std::size_t i = 0; i < stay.size(); ++i) {
    put_moving(a, i, stay[i].second, stay[i].first.centre, stay[i].first.velocity, stay[i].first.spin);
    occupied.push_back({stay[i].first.centre, stay[i].first.radius});
  }
  std::vector<BeadType> lacking;
  for (const Wanted& k : kinds) lacking.insert(lacking.end(), k.left, k.type);
  if (lacking.empty()) return;
  const std::vector<base::Vector3> centres = scattered(a, region_of(a), lacking, random, occupied);
  for (std::size_t i = 0; i < lacking.size(); ++i) put_bead(a, stay.size() + i, lacking[i], centres[i]);
}

}  // namespace millscope::run
