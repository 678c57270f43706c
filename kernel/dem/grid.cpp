// List rebuild, first half: wrap, check, sort the beads by cell, carry the histories of touching pairs over to the new order.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>

#include "kernel/dem/slab.hpp"

namespace millscope::dem {
namespace {

double speed(const MotionLine& m) { return std::sqrt(m.v[0] * m.v[0] + m.v[1] * m.v[1] + m.v[2] * m.v[2]); }

/// The skin is cut by what rounding to single precision may hide of a displacement.
ReferenceLine reference_of(const PositionLine& x, double skin) {
  const double hidden = 2e-7 * (std::abs(x.centre[0]) + std::abs(x.centre[1]) + std::abs(x.centre[2])),
               allowed = std::max(0.0, skin - hidden);
  const auto single = [](double v) { return static_cast<float>(v); };
  return {{single(x.centre[0]), single(x.centre[1]), single(x.centre[2])}, single(allowed * allowed)};
}

}  // namespace

/// Wraps periodic coordinates, checks that all beads are where they may be, and gives each its skin.
void System::sort_beads() {
  Particles& p = particles;
  const std::int64_t n = p.count();
  double largest_reach = 0, largest_radius = 0, law_reach = 0;
  for (const PairPhysics& pair : physics_) law_reach = std::max(law_reach, pair.reach);
  for (const PositionLine& x : p.position) largest_radius = std::max(largest_radius, x.radius);
  reaches_.resize(static_cast<std::size_t>(n));
  struct Extent {
    double low[3] = {1e300, 1e300, 1e300}, high[3] = {-1e300, -1e300, -1e300}, reach = 0;
    std::int64_t lost = -1;
  };
  std::vector<Extent> extents(static_cast<std::size_t>(settings_.partitions));
  workers_->run(settings_.partitions, [&](int slab, int) {
    Extent& e = extents[static_cast<std::size_t>(slab)];
    for (std::int64_t i = slab_begin(slab); i < slab_begin(slab + 1); ++i) {
      const std::size_t k = static_cast<std::size_t>(i);
      PositionLine& x = p.position[k];
      double* c = x.centre;
      for (int a = 0; a < 3; ++a) {
        c[a] = wrapped(settings_, a, c[a]);
        if (!(c[a] >= settings_.low[a] && c[a] <= settings_.high[a])) e.lost = i;
        e.low[a] = std::min(e.low[a], c[a]);
        e.high[a] = std::max(e.high[a], c[a]);
      }
      const double skin = std::min(settings_.skin_cap * largest_radius,
                                   settings_.skin_base * x.radius + settings_.skin_steps * settings_.time_step * speed(p.motion[k]));
      reaches_[k] = {{c[0], c[1], c[2]}, x.radius + skin + 0.5 * law_reach};
      p.reference[k] = reference_of(x, skin);
      e.reach = std::max(e.reach, reaches_[k].radius);
    }
  });
  double low[3] = {1e300, 1e300, 1e300}, high[3] = {-1e300, -1e300, -1e300};
  for (const Extent& e : extents) {
    if (e.lost >= 0) throw base::UserError(complaint(e.lost, "has left the domain"));
    largest_reach = std::max(largest_reach, e.reach);
    for (int a = 0; a < 3; ++a) {
      low[a] = std::min(low[a], e.low[a]);
      high[a] = std::max(high[a], e.high[a]);
    }
  }
  // The grid: cells no smaller than the largest interaction distance, at most about four cells a bead.
  double edge = 2 * largest_reach * (1 + 1e-9);
  for (;;) {
    double total = 1;
    for (int a = 0; a < 3; ++a) {
      const double length = settings_.periodic.length[a];
      grid_.low[a] = length > 0 ? settings_.periodic_low[a] : low[a];
      const double extent = length > 0 ? length : high[a] - low[a];
      const int cells = std::max(1, static_cast<int>(std::floor(extent / edge)) + (length > 0 ? 0 : 1));
      grid_.cells[a] = cells;
      grid_.inverse_edge[a] = length > 0 ? cells / length : 1.0 / edge;
      total *= cells;
    }
    if (total <= 4.0 * static_cast<double>(n) + 1000) break;
    edge *= 1.26;
  }
  // Slowest along the longest axis that is not periodic (slabs), fastest along the next, so that rows of cells are long.
  std::vector<int> order{0, 1, 2};
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    const bool pa = settings_.periodic.length[a] > 0, pb = settings_.periodic.length[b] > 0;
    if (pa != pb) return pb;
    return settings_.high[a] - settings_.low[a] > settings_.high[b] - settings_.low[b];
  });
  grid_.axis[0] = order[0];
  grid_.axis[2] = order[1];
  grid_.axis[1] = order[2];
  const auto cell_of = [this](const PositionLine& x) {
    std::uint32_t cell = 0;
    for (const int a : grid_.axis) {
      const int c = std::clamp(static_cast<int>((x.centre[a] - grid_.low[a]) * grid_.inverse_edge[a]), 0, grid_.cells[a] - 1);
      cell = cell * static_cast<std::uint32_t>(grid_.cells[a]) + static_cast<std::uint32_t>(c);
    }
    return cell;
  };
  const std::size_t cell_count =
      static_cast<std::size_t>(grid_.cells[0]) * static_cast<std::size_t>(grid_.cells[1]) * static_cast<std::size_t>(grid_.cells[2]);
  grid_.start.assign(cell_count + 1, 0);
  new_index_.resize(static_cast<std::size_t>(n));
  workers_->run(settings_.partitions, [&](int slab, int) {
    for (std::size_t i = static_cast<std::size_t>(slab_begin(slab)); i < static_cast<std::size_t>(slab_begin(slab + 1)); ++i) {
      new_index_[i] = cell_of(reaches_[i]);
    }
  });
  for (const std::uint32_t cell : new_index_) ++grid_.start[cell + 1];
  std::partial_sum(grid_.start.begin(), grid_.start.end(), grid_.start.begin());
  std::vector<std::uint32_t> next(grid_.start.begin(), grid_.start.end() - 1);
  for (std::uint32_t& index : new_index_) index = next[index]++;
}

/// Collects the histories of touching pairs by their owner in the new order; an exchanged owner flips the signs.
void System::extract_pair_history() {
  const std::size_t n = particles.position.size();
  const std::size_t slots = static_cast<std::size_t>(layout_.history_count());
  carried_start_.assign(n + 1, 0);
  const auto each = [this](const auto& visit) {
    for (const auto& slab : slabs_) {
      for (PairList& list : slab->lists) {
        std::size_t contact = 0;
        for (std::size_t s = 0; s < list.touching.size(); ++s) {
          if (list.touching[s]) visit(list, contact++, new_index_[list.owner[s]], new_index_[list.partner[s]]);
        }
      }
    }
  };
  each([this](const PairList&, std::size_t, std::uint32_t i, std::uint32_t j) { ++carried_start_[std::min(i, j) + 1]; });
  std::partial_sum(carried_start_.begin(), carried_start_.end(), carried_start_.begin());
  carried_partner_.resize(carried_start_[n]);
  carried_history_.resize(carried_start_[n] * slots);
  std::vector<std::uint32_t> next(carried_start_.begin(), carried_start_.end() - 1);
  each([&](const PairList& list, std::size_t contact, std::uint32_t i, std::uint32_t j) {
    const std::size_t at = next[std::min(i, j)]++;
    carried_partner_[at] = std::max(i, j);
    for (std::size_t h = 0; h < slots; ++h) {
      carried_history_[at * slots + h] = (i < j ? 1.0 : layout_.history_sign[h]) * list.history[h][contact];
    }
  });
}

/// Lists all pairs (i in this slab, j > i) whose reaches overlap.
void System::build_pairs(int slab) {
  SlabState& state = *slabs_[static_cast<std::size_t>(slab)];
  const std::size_t slots = static_cast<std::size_t>(layout_.history_count());
  for (PairList& list : state.lists) {
    list.owner.clear();
    list.partner.clear();
    list.touching.clear();
    for (auto& h : list.history) h.clear();
  }
  std::vector<std::uint32_t> found;
  std::vector<std::pair<std::size_t, std::uint32_t>> kept;  // slot and entry of a carried history
  std::int64_t last_partner = -1;
  const std::int64_t begin = slab_begin(slab), end = slab_begin(slab + 1);
  const int n0 = grid_.cells[grid_.axis[0]], n1 = grid_.cells[grid_.axis[1]], n2 = grid_.cells[grid_.axis[2]];
  const bool p0 = settings_.periodic.length[grid_.axis[0]] > 0, p1 = settings_.periodic.length[grid_.axis[1]] > 0,
             p2 = settings_.periodic.length[grid_.axis[2]] > 0;
  // Distinct neighbours of a coordinate, ascending.
  const auto around = [](int c, int count, bool periodic, int(&out)[3]) {
    int m = 0;
    if (periodic && c == count - 1 && count > 2) out[m++] = 0;
    if (c > 0) out[m++] = c - 1;
    out[m++] = c;
    if (c + 1 < count) out[m++] = c + 1;
    if (periodic && c == 0 && count > 2) out[m++] = count - 1;
    return m;
  };
  std::int64_t cell = std::upper_bound(grid_.start.begin(), grid_.start.end(), static_cast<std::uint32_t>(begin)) - grid_.start.begin() - 1;
  for (std::int64_t i = begin; i < end;) {
    while (static_cast<std::int64_t>(grid_.start[static_cast<std::size_t>(cell) + 1]) <= i) ++cell;
    const std::int64_t cell_end = std::min<std::int64_t>(end, grid_.start[static_cast<std::size_t>(cell) + 1]);
    int k0[3], k1[3], k2[3];
    const int m0 = around(static_cast<int>(cell / (n1 * n2)), n0, p0, k0);
    const int m1 = around(static_cast<int>(cell / n2 % n1), n1, p1, k1);
    const int m2 = around(static_cast<int>(cell % n2), n2, p2, k2);
    // Ranges of beads to look at: rows of neighbouring cells, joined where they follow one another.
    std::int64_t ranges[27][2];
    int range_count = 0;
    for (int a = 0; a < m0; ++a) {
      for (int b = 0; b < m1; ++b) {
        for (int c = 0; c < m2; ++c) {
          const std::size_t k = static_cast<std::size_t>((k0[a] * n1 + k1[b]) * n2 + k2[c]);
          const std::int64_t from = grid_.start[k], to = grid_.start[k + 1];
          if (to <= i || from == to) continue;
          if (range_count > 0 && ranges[range_count - 1][1] == from) {
            ranges[range_count - 1][1] = to;
          } else {
            ranges[range_count][0] = from;
            ranges[range_count++][1] = to;
          }
        }
      }
    }
    for (; i < cell_end; ++i) {
      std::size_t count = 0;
      for (int r = 0; r < range_count; ++r) {
        const std::int64_t from = std::max(ranges[r][0], i + 1), to = ranges[r][1];
        if (from >= to) continue;
        if (found.size() < count + static_cast<std::size_t>(to - from) + 8)
          found.resize(2 * (count + static_cast<std::size_t>(to - from)) + 64);
        count += static_cast<std::size_t>(wide_->near(reaches_.data(), settings_.periodic, i, from, to, found.data() + count));
      }
      if (count == 0) continue;
      const std::uint8_t material = particles.material[static_cast<std::size_t>(i)];
      const std::uint32_t owner = static_cast<std::uint32_t>(i);
      const auto append = [&](PairList& list, std::size_t first, std::size_t last) {
        const std::size_t base = list.partner.size(), total = base + last - first;
        list.partner.insert(list.partner.end(), found.begin() + static_cast<std::ptrdiff_t>(first),
                            found.begin() + static_cast<std::ptrdiff_t>(last));
        list.owner.insert(list.owner.end(), last - first, owner);
        list.touching.resize(total, 0);
        kept.clear();
        for (std::uint32_t e = carried_start_[owner]; e < carried_start_[owner + 1]; ++e) {
          const auto at = std::find(list.partner.begin() + static_cast<std::ptrdiff_t>(base), list.partner.end(), carried_partner_[e]);
          if (at == list.partner.end()) continue;
          const std::size_t s = static_cast<std::size_t>(at - list.partner.begin());
          list.touching[s] = 1;
          kept.emplace_back(s, e);
        }
        std::sort(kept.begin(), kept.end());
        for (const auto& [s, e] : kept) {
          for (std::size_t h = 0; h < slots; ++h) list.history[h].push_back(carried_history_[e * slots + h]);
        }
      };
      if (material_count_ == 1) {
        append(state.lists[static_cast<std::size_t>(pair_of_[0])], 0, count);
      } else {
        for (std::size_t f = 0; f < count; ++f) {
          append(state.lists[static_cast<std::size_t>(pair_index(material, particles.material[found[f]], false))], f, f + 1);
        }
      }
      last_partner =
          std::max<std::int64_t>(last_partner, *std::max_element(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(count)));
    }
  }
  state.halo.assign(static_cast<std::size_t>(std::max<std::int64_t>(0, last_partner + 1 - end)), ForceLine{});
}

/// Brings values into the new order. Between steps the forces are zero and their lines are free: the largest of all serve as the other
/// half.
template <class Values>
void System::permute(Values& values) {
  using Item = typename Values::value_type;
  static_assert(sizeof(Item) <= sizeof(ForceLine));
  unsigned char* const there = reinterpret_cast<unsigned char*>(particles.force.data());
  workers_->run(settings_.partitions, [&](int slab, int) {
    const BeadRange beads = beads_of(slab);
    for (std::size_t i = static_cast<std::size_t>(beads.begin); i < static_cast<std::size_t>(beads.end); ++i) {
      std::memcpy(there + new_index_[i] * sizeof(Item), &values[i], sizeof(Item));
    }
  });
  workers_->run(settings_.partitions, [&](int slab, int) {
    const std::size_t begin = static_cast<std::size_t>(slab_begin(slab)), end = static_cast<std::size_t>(slab_begin(slab + 1));
    std::memcpy(static_cast<void*>(values.data() + begin), there + begin * sizeof(Item), (end - begin) * sizeof(Item));
  });
}

void System::rebuild() {
  sort_beads();
  extract_pair_history();
  extract_wall_history();
  Particles& p = particles;
  permute(p.acceleration);
  permute(p.motion);
  permute(p.half);
  permute(p.position);
  permute(p.reference);
  permute(reaches_);
  permute(p.id);
  permute(p.material);
  workers_->run(settings_.partitions, [this](int slab, int) { build_pairs(slab); });
  prepare_sweeps();
  build_walls();
  workers_->run(settings_.partitions, [&p, this](int slab, int) {
    std::fill(p.force.begin() + slab_begin(slab), p.force.begin() + slab_begin(slab + 1), ForceLine{});
  });
  ++rebuilds_;
  rebuild_needed_ = false;
}

}  // namespace millscope::dem
