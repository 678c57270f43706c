// Everything that the next step depends on, as named arrays: a restored system continues bit for bit.
#include <fmt/core.h>

#include <algorithm>
#include <cstring>

#include "kernel/base/error.hpp"
#include "kernel/dem/slab.hpp"

namespace millscope::dem {
namespace {

template <class Line>
const double* doubles(const AlignedVector<Line>& lines) {
  return reinterpret_cast<const double*>(lines.data());
}

template <class Line>
void put(AlignedVector<Line>& lines, const std::vector<double>& values) {
  lines.resize(values.size() * sizeof(double) / sizeof(Line));
  if (!values.empty()) std::memcpy(static_cast<void*>(lines.data()), values.data(), values.size() * sizeof(double));
}

/// Lines of singles as doubles, and back: exact.
template <class Line>
std::vector<double> widened(const AlignedVector<Line>& lines) {
  const float* first = reinterpret_cast<const float*>(lines.data());
  return {first, first + lines.size() * sizeof(Line) / sizeof(float)};
}

template <class Line>
void put_narrowed(AlignedVector<Line>& lines, const std::vector<double>& values) {
  lines.resize(values.size() * sizeof(float) / sizeof(Line));
  std::transform(values.begin(), values.end(), reinterpret_cast<float*>(lines.data()), [](double v) { return static_cast<float>(v); });
}

/// A checkpoint is a file: whatever it says is held against what it can be before it is used as a length or an index.
void demand(bool sound) {
  if (!sound)
    throw base::UserError("the checkpoint is damaged: its numbers do not belong together; resume with the previous one, or start again");
}

/// All within [0, end).
void demand_indices(const std::vector<std::int64_t>& values, std::int64_t end) {
  demand(std::all_of(values.begin(), values.end(), [end](std::int64_t v) { return v >= 0 && v < end; }));
}

/// Lists and wall contacts of the slab of the beads [begin, end), of `beads` in all. Candidates are the geometry's own: the seal alone
/// guards them.
void demand_sound(const SlabState& slab, std::int64_t begin, std::int64_t end, std::int64_t beads) {
  for (const PairList& list : slab.lists) {
    demand(list.partner.size() == list.owner.size() && list.touching.size() == list.owner.size());
    for (std::size_t s = 0; s < list.owner.size(); ++s) {
      demand(list.owner[s] >= begin && list.owner[s] < end && list.partner[s] > list.owner[s] && list.partner[s] < beads);
      demand(list.touching[s] <= 1 && (s == 0 || list.owner[s] >= list.owner[s - 1]));
    }
    const std::int64_t contacts = list.contact_count();
    for (const std::vector<double>& h : list.history) demand(static_cast<std::int64_t>(h.size()) == contacts);
  }
  for (const WallSlab& wall : slab.walls) {
    demand(wall.first.size() == wall.bead.size() + 1 || (wall.first.empty() && wall.bead.empty()));
    for (std::size_t k = 0; k < wall.bead.size(); ++k) {
      demand(wall.bead[k] >= begin && wall.bead[k] < end && (k == 0 || wall.bead[k] > wall.bead[k - 1]));
      demand(wall.first[k] >= 0 && wall.first[k] <= wall.first[k + 1]);
    }
    demand(wall.first.empty() || wall.first.back() == static_cast<std::int64_t>(wall.candidates.size()));
    for (const std::uint32_t bead : wall.active.bead) demand(bead < wall.bead.size());
  }
}

/// Every number of a ledger in a fixed order.
template <class LedgerType, class Visit>
void each_number(LedgerType& ledger, const Visit& visit) {
  for (auto& p : ledger.pairs) {
    for (auto& d : p.dissipated) visit(d);
    visit(p.impact_energy);
    visit(p.largest_closing_speed);
    visit(p.largest_overlap);
  }
  for (auto& b : ledger.bodies) visit(b.work);
  for (auto& w : ledger.body_force_work) visit(w);
}

template <class LedgerType, class Visit>
void each_count(LedgerType& ledger, const Visit& visit) {
  for (auto& p : ledger.pairs) {
    visit(p.collisions);
    for (auto& s : p.spectrum) visit(s);
  }
}

/// Gathers an array that is kept slab by slab.
template <class T, class Slabs, class Access>
std::vector<T> joined(const Slabs& slabs, const Access& access) {
  std::vector<T> all;
  for (const auto& slab : slabs) {
    const auto& part = access(*slab);
    all.insert(all.end(), part.begin(), part.end());
  }
  return all;
}

/// Hands an array out again, `counts[k]` items to slab k.
template <class T, class Slabs, class Access>
void dealt(const std::vector<T>& all, const std::vector<std::int64_t>& counts, Slabs& slabs, const Access& access) {
  std::int64_t total = 0;
  for (const std::int64_t count : counts) {
    demand(count >= 0 && count <= static_cast<std::int64_t>(all.size()));
    total += count;
  }
  demand(counts.size() == slabs.size() && total == static_cast<std::int64_t>(all.size()));
  std::size_t at = 0;
  for (std::size_t k = 0; k < slabs.size(); ++k) {
    auto& part = access(*slabs[k]);
    const std::size_t n = static_cast<std::size_t>(counts[k]);
    part.resize(n);
    for (std::size_t i = 0; i < n; ++i) part[i] = static_cast<typename std::remove_reference_t<decltype(part)>::value_type>(all[at + i]);
    at += n;
  }
}

}  // namespace

void System::save(const DoubleSink& put_doubles, const IntegerSink& put_integers) const {
  const Particles& p = particles;
  const std::size_t n = p.position.size(), slots = static_cast<std::size_t>(layout_.history_count());
  const std::vector<std::int64_t> counters{step_,
                                           rebuilds_,
                                           rebuild_needed_ ? 1 : 0,
                                           settings_.partitions,
                                           static_cast<std::int64_t>(slots),
                                           static_cast<std::int64_t>(physics_.size())};
  put_integers("counters", counters.data(), counters.size());
  const double walls_moved[3] = {wall_margin_, wall_moved_, wall_speed_};
  put_doubles("walls_moved", walls_moved, 3);
  put_doubles("position", doubles(p.position), 4 * n);
  put_doubles("motion", doubles(p.motion), 8 * n);
  put_doubles("half", doubles(p.half), 8 * n);
  const std::vector<double> acceleration = widened(p.acceleration), reference = widened(p.reference);
  put_doubles("acceleration", acceleration.data(), acceleration.size());
  put_doubles("reference", reference.data(), reference.size());
  const std::vector<std::int64_t> ids(p.id.begin(), p.id.end()), materials(p.material.begin(), p.material.end());
  put_integers("id", ids.data(), n);
  put_integers("material", materials.data(), n);
  const auto integers = [&](const std::string& name, const auto& access) {
    const std::vector<std::int64_t> all = joined<std::int64_t>(slabs_, access);
    put_integers(name, all.data(), all.size());
  };
  const auto numbers = [&](const std::string& name, const auto& access) {
    const std::vector<double> all = joined<double>(slabs_, access);
    put_doubles(name, all.data(), all.size());
  };
  const auto sizes = [&](const std::string& name, const auto& access) {
    std::vector<std::int64_t> all;
    for (const auto& slab : slabs_) all.push_back(static_cast<std::int64_t>(access(*slab).size()));
    put_integers(name, all.data(), all.size());
  };
  for (std::size_t q = 0; q < physics_.size(); ++q) {
    const std::string at = fmt::format("pairs/{}/", q);
    sizes(
        at + "count", [q](const SlabState& s) -> const auto& { return s.lists[q].owner; });
    integers(
        at + "owner", [q](const SlabState& s) -> const auto& { return s.lists[q].owner; });
    integers(
        at + "partner", [q](const SlabState& s) -> const auto& { return s.lists[q].partner; });
    integers(
        at + "touching", [q](const SlabState& s) -> const auto& { return s.lists[q].touching; });
    std::vector<std::int64_t> contacts;
    for (const auto& slab : slabs_) contacts.push_back(slab->lists[q].contact_count());
    put_integers(at + "contacts", contacts.data(), contacts.size());
    for (std::size_t h = 0; h < slots; ++h) {
      std::vector<double> all;
      for (std::size_t k = 0; k < slabs_.size(); ++k) {
        const double* values = slabs_[k]->lists[q].history[h].data();
        all.insert(all.end(), values, values + contacts[k]);
      }
      put_doubles(fmt::format("{}contact_history_{}", at, h), all.data(), all.size());
    }
  }
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const std::string at = fmt::format("walls/{}/", b);
    sizes(
        at + "beads", [b](const SlabState& s) -> const auto& { return s.walls[b].bead; });
    integers(
        at + "bead", [b](const SlabState& s) -> const auto& { return s.walls[b].bead; });
    sizes(
        at + "offsets", [b](const SlabState& s) -> const auto& { return s.walls[b].first; });
    integers(
        at + "first", [b](const SlabState& s) -> const auto& { return s.walls[b].first; });
    sizes(
        at + "candidate_count", [b](const SlabState& s) -> const auto& { return s.walls[b].candidates; });
    integers(
        at + "candidates", [b](const SlabState& s) -> const auto& { return s.walls[b].candidates; });
    sizes(
        at + "contacts", [b](const SlabState& s) -> const auto& { return s.walls[b].active.bead; });
    integers(
        at + "contact_bead", [b](const SlabState& s) -> const auto& { return s.walls[b].active.bead; });
    integers(
        at + "contact_feature", [b](const SlabState& s) -> const auto& { return s.walls[b].active.feature; });
    std::vector<double> normals;
    for (const auto& slab : slabs_) {
      for (const auto& normal : slab->walls[b].active.normal) normals.insert(normals.end(), normal.begin(), normal.end());
    }
    put_doubles(at + "contact_normal", normals.data(), normals.size());
    for (std::size_t h = 0; h < slots; ++h) {
      numbers(
          fmt::format("{}history_{}", at, h), [ b, h ](const SlabState& s) -> const auto& { return s.walls[b].active.history[h]; });
    }
    numbers(
        at + "impact", [b](const SlabState& s) -> const auto& { return s.impact[b]; });
    numbers(
        at + "shear", [b](const SlabState& s) -> const auto& { return s.shear[b]; });
  }
  std::vector<double> book;
  std::vector<std::int64_t> counts;
  for (const auto& slab : slabs_) {
    const Ledger& ledger = slab->ledger;
    each_number(ledger, [&book](double v) { book.push_back(v); });
    each_count(ledger, [&counts](std::int64_t v) { counts.push_back(v); });
  }
  put_doubles("ledger/numbers", book.data(), book.size());
  put_integers("ledger/counts", counts.data(), counts.size());
}

void System::restore(const DoubleSource& get_doubles, const IntegerSource& get_integers) {
  const std::vector<std::int64_t> counters = get_integers("counters");
  const std::size_t slots = static_cast<std::size_t>(layout_.history_count());
  if (counters.size() != 6 || counters[3] != settings_.partitions || counters[4] != static_cast<std::int64_t>(slots) ||
      counters[5] != static_cast<std::int64_t>(physics_.size())) {
    throw base::UserError(
        "the checkpoint was written with other plugins, materials or run.partitions than the case has now; put them back");
  }
  step_ = counters[0];
  Particles& p = particles;
  const std::vector<double> centres = get_doubles("position");
  demand(centres.size() % 4 == 0 && centres.size() / 4 < (std::size_t{1} << 31));
  put(p.position, centres);
  const std::size_t n = p.position.size();
  const std::int64_t beads = static_cast<std::int64_t>(n);
  p.resize(n);
  put(p.motion, get_doubles("motion"));
  put(p.half, get_doubles("half"));
  put_narrowed(p.acceleration, get_doubles("acceleration"));
  put_narrowed(p.reference, get_doubles("reference"));
  const std::vector<std::int64_t> ids = get_integers("id"), materials = get_integers("material");
  demand(p.motion.size() == n && p.half.size() == n && p.acceleration.size() == n && p.reference.size() == n && ids.size() == n &&
         materials.size() == n);
  demand_indices(materials, material_count_);
  std::vector<bool> seen(n, false);
  for (const std::int64_t id : ids) {
    demand(id >= 0 && id < beads && !seen[static_cast<std::size_t>(id)]);
    seen[static_cast<std::size_t>(id)] = true;
  }
  std::copy(ids.begin(), ids.end(), p.id.begin());
  std::transform(materials.begin(), materials.end(), p.material.begin(), [](std::int64_t m) { return static_cast<std::uint8_t>(m); });
  for (ForceLine& f : p.force) f = ForceLine{};
  prepare();
  rebuilds_ = counters[1];
  rebuild_needed_ = counters[2] != 0;
  const std::vector<double> walls_moved = get_doubles("walls_moved");
  demand(walls_moved.size() == 3);
  wall_margin_ = walls_moved[0];
  wall_moved_ = walls_moved[1];
  wall_speed_ = walls_moved[2];
  for (std::size_t q = 0; q < physics_.size(); ++q) {
    const std::string at = fmt::format("pairs/{}/", q);
    const std::vector<std::int64_t> count = get_integers(at + "count");
    dealt(
        get_integers(at + "owner"), count, slabs_, [q](SlabState & s) -> auto& { return s.lists[q].owner; });
    dealt(
        get_integers(at + "partner"), count, slabs_, [q](SlabState & s) -> auto& { return s.lists[q].partner; });
    dealt(
        get_integers(at + "touching"), count, slabs_, [q](SlabState & s) -> auto& { return s.lists[q].touching; });
    const std::vector<std::int64_t> contacts = get_integers(at + "contacts");
    for (std::size_t h = 0; h < slots; ++h) {
      dealt(
          get_doubles(fmt::format("{}contact_history_{}", at, h)), contacts, slabs_,
          [ q, h ](SlabState & s) -> auto& { return s.lists[q].history[h]; });
    }
  }
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const std::string at = fmt::format("walls/{}/", b);
    dealt(
        get_integers(at + "bead"), get_integers(at + "beads"), slabs_, [b](SlabState & s) -> auto& { return s.walls[b].bead; });
    dealt(
        get_integers(at + "first"), get_integers(at + "offsets"), slabs_, [b](SlabState & s) -> auto& { return s.walls[b].first; });
    dealt(
        get_integers(at + "candidates"), get_integers(at + "candidate_count"),
        slabs_, [b](SlabState & s) -> auto& { return s.walls[b].candidates; });
    const std::vector<std::int64_t> contacts = get_integers(at + "contacts");
    dealt(
        get_integers(at + "contact_bead"), contacts, slabs_, [b](SlabState & s) -> auto& { return s.walls[b].active.bead; });
    dealt(
        get_integers(at + "contact_feature"), contacts, slabs_, [b](SlabState & s) -> auto& { return s.walls[b].active.feature; });
    const std::vector<double> normals = get_doubles(at + "contact_normal");
    std::size_t next = 0;
    for (std::size_t k = 0; k < slabs_.size(); ++k) {
      auto& normal = slabs_[k]->walls[b].active.normal;
      demand(normals.size() >= next + 3 * static_cast<std::size_t>(contacts[k]));
      normal.resize(static_cast<std::size_t>(contacts[k]));
      for (auto& v : normal) {
        v = {normals[next], normals[next + 1], normals[next + 2]};
        next += 3;
      }
    }
    for (std::size_t h = 0; h < slots; ++h) {
      dealt(
          get_doubles(fmt::format("{}history_{}", at, h)), contacts, slabs_,
          [ b, h ](SlabState & s) -> auto& { return s.walls[b].active.history[h]; });
    }
    const std::vector<std::int64_t> triangles(slabs_.size(), static_cast<std::int64_t>(slabs_[0]->impact[b].size()));
    dealt(
        get_doubles(at + "impact"), triangles, slabs_, [b](SlabState & s) -> auto& { return s.impact[b]; });
    dealt(
        get_doubles(at + "shear"), triangles, slabs_, [b](SlabState & s) -> auto& { return s.shear[b]; });
  }
  const std::vector<double> book = get_doubles("ledger/numbers");
  const std::vector<std::int64_t> counts = get_integers("ledger/counts");
  std::size_t at = 0, at_count = 0;
  for (std::size_t k = 0; k < slabs_.size(); ++k) {
    SlabState& slab = *slabs_[k];
    each_number(slab.ledger, [&](double& v) {
      demand(at < book.size());
      v = book[at++];
    });
    each_count(slab.ledger, [&](std::int64_t& v) {
      demand(at_count < counts.size());
      v = counts[at_count++];
    });
    demand_sound(slab, slab_begin(static_cast<int>(k)), slab_begin(static_cast<int>(k) + 1), beads);
    std::int64_t last = slab_begin(static_cast<int>(k) + 1) - 1;
    const std::int64_t end = last + 1;
    for (const PairList& list : slab.lists) {
      for (const std::uint32_t j : list.partner) last = std::max<std::int64_t>(last, j);
    }
    slab.halo.assign(static_cast<std::size_t>(last + 1 - end), ForceLine{});
  }
  prepare_sweeps();
}

}  // namespace millscope::dem
