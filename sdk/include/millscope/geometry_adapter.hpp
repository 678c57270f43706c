// Turns a plain C++ class into a geometry plugin.
//
//   struct MyWall {
//     explicit MyWall(const Parameters&);                 // throws Refusal with the remedy
//     const std::string& material_slots() const;          // "shell|lifter"
//     const std::string& report() const;                  // "key: value" lines
//     Surface surface() const;                            // pointers stay valid as long as the object
//     Interior interior() const;
//     void candidates(const GeometryBeads&, double margin, const CandidateSink&) const;   // many threads; bead by bead, features ascending
//     void touch(const WallBead&, const std::uint32_t* candidates, std::size_t count, WallContacts&) const;  // many threads
//     void prefetch(std::uint32_t candidate) const;       // optional: called some beads before touch
//     void contacts(const GeometryQuery&, GeometryContacts&) const;   // in the place of touch: all beads at once, for packs
//   };
//   constexpr Descriptor kDescriptor = describe<MyWall>({.name = "my_wall", .doc = "…", .parameters = kParameters});
#pragma once

#include <cstddef>

#include "millscope/describe.hpp"
#include "millscope/geometry.hpp"
#include "millscope/pack.hpp"
#include "millscope/parameters.hpp"

namespace millscope {

/// One bead in the geometry's frame.
struct WallBead {
  Vec<double> position;  ///< m
  double radius;         ///< m
  double reach;          ///< gaps up to this are reported too, m
};

/// One place that a bead touches; the names are those of GeometryContacts.
struct WallContact {
  double overlap;      ///< δ = radius − distance of the centre, m
  Vec<double> normal;  ///< unit, from the wall to the bead's centre
  std::uint32_t feature, triangle, material;
};

/// Receives the contacts of one bead, at most kMaxWallContacts of them; what lies beyond the reach is left out.
class WallContacts {
 public:
  explicit WallContacts(double reach) : reach_(reach) {}

  void add(const WallContact& contact) {
    if (count_ < kMaxWallContacts && contact.overlap > -reach_) items_[count_++] = contact;
  }
  int count() const { return count_; }
  const WallContact& operator[](int i) const { return items_[i]; }

 private:
  WallContact items_[kMaxWallContacts];
  int count_ = 0;
  double reach_;
};

/// Puts a contact behind those found so far; what exceeds the capacity is dropped.
inline void append_contact(const WallContact& contact, std::int64_t bead, GeometryContacts* out) {
  if (out->count >= out->capacity) return;
  const std::int64_t slot = out->count++;
  out->bead[slot] = static_cast<std::int32_t>(bead);
  out->overlap[slot] = contact.overlap;
  out->normal[0][slot] = contact.normal.x;
  out->normal[1][slot] = contact.normal.y;
  out->normal[2][slot] = contact.normal.z;
  out->feature[slot] = contact.feature;
  if (out->triangle) out->triangle[slot] = contact.triangle;
  out->material[slot] = contact.material;
}

template <class Wall>
void find_contacts_one_by_one(const Wall& wall, const GeometryQuery* query, GeometryContacts* out) {
  const GeometryBeads& beads = query->beads;
  out->count = 0;
  [[maybe_unused]] const std::int64_t total = query->first[beads.count];
  for (std::int64_t i = 0; i < beads.count; ++i) {
    const std::int64_t begin = query->first[i], end = query->first[i + 1];
    if (begin == end) continue;
    if constexpr (requires { wall.prefetch(std::uint32_t{}); }) {
      constexpr std::int64_t ahead = 16;  // candidates; about four beads
      for (std::int64_t k = begin + ahead; k < end + ahead && k < total; ++k) wall.prefetch(query->candidates[k]);
    }
    WallContacts found(query->reach);
    wall.touch({{beads.position[0][i], beads.position[1][i], beads.position[2][i]}, beads.radius[i], query->reach},
               query->candidates + begin, end - begin, found);
    for (int k = 0; k < found.count(); ++k) append_contact(found[k], i, out);
  }
}

template <class Wall>
void find_contacts(const void* self, const GeometryQuery* query, GeometryContacts* out) {
  const Wall& wall = *static_cast<const Wall*>(self);
  if constexpr (requires { wall.contacts(*query, *out); }) {
    return wall.contacts(*query, *out);
  } else {
    find_contacts_one_by_one(wall, query, out);
  }
}

template <class Wall>
constexpr GeometryTable make_geometry_table() {
  GeometryTable t{};
  t.create = [](const Values* values, void** self, Failure* failure) -> Status {
    return guarded(failure, [&] { *self = new Wall(Parameters(*values)); });
  };
  t.destroy = [](void* self) { delete static_cast<Wall*>(self); };
  t.material_slots = [](const void* self) { return static_cast<const Wall*>(self)->material_slots().c_str(); };
  t.surface = [](const void* self, Surface* out) { *out = static_cast<const Wall*>(self)->surface(); };
  t.interior = [](const void* self, Interior* out) { *out = static_cast<const Wall*>(self)->interior(); };
  t.report = [](const void* self) { return static_cast<const Wall*>(self)->report().c_str(); };
  t.candidates = [](void* self, const GeometryBeads* beads, double margin, const CandidateSink* sink, Failure* failure) -> Status {
    return guarded(failure, [&] { static_cast<Wall*>(self)->candidates(*beads, margin, *sink); });
  };
  t.contacts = &find_contacts<Wall>;
  return t;
}

/// What tells a geometry from the other kinds.
template <class C>
concept GeometryClass = requires(const C& wall) {
  wall.interior();
};

template <GeometryClass C>
struct [[gnu::visibility("hidden")]] Adapter<C> {
  static constexpr Kind kind = Kind::geometry;
  static constexpr std::uint64_t layout = kGeometryLayout;
  static constexpr std::uint64_t features = 0;
  static constexpr GeometryTable table = make_geometry_table<C>();
};

}  // namespace millscope
