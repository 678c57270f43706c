// The parametric mill and the bare cylinder: an exact outline in x–y, straight along z, and flat ends.
#pragma once

#include <memory>

#include "geometry/shapes/mill_surface.hpp"
#include "millscope/geometry_adapter.hpp"

namespace millscope::geometry {

class Mill {
 public:
  static MillShape mill_shape(const Parameters&);
  static MillShape cylinder_shape(const Parameters&);

  /// `facet`: longest chord of the triangles, m; `rows`: cuts along z.
  Mill(const char* kind, const MillShape& shape, double facet, int rows);
  Mill(Mill&&) = delete;  // the surface refers to the profile

  const std::string& material_slots() const { return slot_names_; }
  const std::string& report() const { return report_; }
  Surface surface() const { return surface_->view(); }
  Interior interior() const;
  void candidates(const GeometryBeads& beads, double margin, const CandidateSink& sink) const;
  void contacts(const GeometryQuery& query, GeometryContacts& out) const { contacts_by<Pack>(query, out); }
  /// R = double, one bead at a time: the same bits.
  template <class R>
  void contacts_by(const GeometryQuery& query, GeometryContacts& out) const;

 private:
  /// Beads beside the pieces that they are near, some at a time: gathered, calculated side by side, and what touches is kept.
  struct Neighbours {
    static constexpr int kMost = 8 * kLanes;
    int count = 0;
    std::int64_t bead[kMost];
    std::uint32_t candidate[kMost];
    double u[kMost], v[kMost], radius[kMost];
    double overlap[kMost], normal_u[kMost], normal_v[kMost], piece[kMost];
  };
  // Candidates: the bays, then the lifters, then the ends.
  std::uint32_t bay_count() const { return static_cast<std::uint32_t>(profile_.bays()); }
  std::uint32_t low_end() const { return bay_count() + static_cast<std::uint32_t>(profile_.shape().lifters); }
  bool is_bay(std::uint32_t candidate) const { return candidate < bay_count(); }

  void add(Neighbours& n, const GeometryQuery& query, std::int64_t bead, std::uint32_t candidate) const;
  template <class R>
  void calculate(Neighbours& n) const;
  static void pad(Neighbours& n);
  void keep(const Neighbours& n, const GeometryQuery& query, GeometryContacts& out) const;
  void keep_end(const Neighbours& n, int at, const GeometryQuery& query, GeometryContacts& out) const;
  void keep_outline(const Neighbours& n, int at, const GeometryQuery& query, GeometryContacts& out) const;

  MillProfile profile_;
  MillSlots slots_;
  std::string slot_names_, report_;
  std::unique_ptr<MillSurface> surface_;
};

/// What the plugin tables are made of.
struct MillPlugin : Mill {
  explicit MillPlugin(const Parameters& p) : Mill("mill", mill_shape(p), p.number("facet"), static_cast<int>(p.integer("axial_cuts"))) {}
};
struct CylinderPlugin : Mill {
  explicit CylinderPlugin(const Parameters& p)
      : Mill("cylinder", cylinder_shape(p), p.number("facet"), static_cast<int>(p.integer("axial_cuts"))) {}
};

template <class R>
void Mill::contacts_by(const GeometryQuery& query, GeometryContacts& out) const {
  out.count = 0;
  Neighbours n;
  const auto flush = [&] {
    calculate<R>(n);
    keep(n, query, out);
    n.count = 0;
  };
  for (std::int64_t i = 0; i < query.beads.count; ++i) {
    for (std::int64_t c = query.first[i]; c < query.first[i + 1]; ++c) {
      if (n.count == Neighbours::kMost) flush();
      add(n, query, i, query.candidates[c]);
    }
  }
  flush();
}

template <class R>
void Mill::calculate(Neighbours& n) const {
  const auto put = [&n](int k, const ProfileContact<R>& c) {
    store(n.overlap + k, c.overlap);
    store(n.normal_u + k, c.normal_u);
    store(n.normal_v + k, c.normal_v);
    store(n.piece + k, c.piece);
  };
  pad(n);
  const std::uint32_t ends = low_end();
  for (int k = 0; k < n.count; k += kWidthOf<R>) {
    bool bays = false, lifters = false;
    double lifter[kWidthOf<R>];
    for (int lane = 0; lane < kWidthOf<R>; ++lane) {
      const bool is_lifter = !is_bay(n.candidate[k + lane]) && n.candidate[k + lane] < ends;
      lifter[lane] = is_lifter ? 1.0 : 0.0;
      lifters = lifters || is_lifter;
      bays = bays || !is_lifter;
    }
    const R u = load<R>(n.u + k), v = load<R>(n.v + k), radius = load<R>(n.radius + k);
    if (!lifters) {
      put(k, profile_.touch_shell(u, v, radius));
    } else if (!bays) {
      put(k, profile_.touch_lifter(u, v, radius));
    } else {
      const ProfileContact<R> a = profile_.touch_lifter(u, v, radius), b = profile_.touch_shell(u, v, radius);
      const auto is_lifter = load<R>(lifter) > R(0.0);
      put(k, {select(is_lifter, a.overlap, b.overlap), select(is_lifter, a.normal_u, b.normal_u), select(is_lifter, a.normal_v, b.normal_v),
              select(is_lifter, a.piece, b.piece)});
    }
  }
}

}  // namespace millscope::geometry
