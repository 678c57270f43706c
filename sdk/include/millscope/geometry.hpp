// Geometry: rigid surfaces that beads touch. A geometry is static in its own frame; the host moves the frame.
//
// At each neighbour-list rebuild the host asks for candidates (features near each bead); in each step it asks for the contacts of
// the beads that have candidates. The host keeps the contact histories, keyed by bead and by the `feature` that is returned.
#pragma once

#include "millscope/layout.hpp"

namespace millscope {

/// Receives candidate features of one bead.
struct CandidateSink {
  void* host;
  void (*add)(void* host, std::int64_t bead, std::uint32_t feature);
};
template <>
struct Layout<CandidateSink> {
  using S = CandidateSink;
  static constexpr Member members[] = {MILLSCOPE_MEMBER(S, host), MILLSCOPE_MEMBER(S, add)};
};

/// Beads in the geometry's own frame.
struct GeometryBeads {
  std::int64_t count;
  const double* position[3];  ///< m
  const double* radius;       ///< m
};
template <>
struct Layout<GeometryBeads> {
  using S = GeometryBeads;
  static constexpr Member members[] = {MILLSCOPE_MEMBER(S, count), MILLSCOPE_MEMBER(S, position), MILLSCOPE_MEMBER(S, radius)};
};

struct GeometryQuery {
  GeometryBeads beads;
  const std::int64_t* first;  ///< count + 1 offsets into `candidates`
  const std::uint32_t* candidates;
  double reach;  ///< also report gaps up to this, m
};
template <>
struct Layout<GeometryQuery> {
  using S = GeometryQuery;
  static constexpr Member members[] = {MILLSCOPE_MEMBER(S, beads), MILLSCOPE_MEMBER(S, first), MILLSCOPE_MEMBER(S, candidates),
                                       MILLSCOPE_MEMBER(S, reach)};
};

/// What stands for a triangle where a contact has none.
inline constexpr std::uint32_t kNoTriangle = 0xffffffffU;

/// Contacts found, at most `capacity` of them, ordered by bead.
struct GeometryContacts {
  std::int64_t capacity;
  std::int64_t count;       ///< out
  std::int32_t* bead;       ///< out: index into the query's beads
  double* overlap;          ///< out: δ, m; negative: a gap
  double* normal[3];        ///< out: unit, from the wall to the bead's centre, in the geometry's frame
  std::uint32_t* feature;   ///< out: names the smooth patch; stays the same while a bead slides over it
  std::uint32_t* triangle;  ///< out: index into the surface's triangles (for per-triangle work), or kNoTriangle; nullptr: nobody asks
  std::uint32_t* material;  ///< out: index into the geometry's material slots
};
template <>
struct Layout<GeometryContacts> {
  using S = GeometryContacts;
  static constexpr Member members[] = {MILLSCOPE_MEMBER(S, capacity), MILLSCOPE_MEMBER(S, count),   MILLSCOPE_MEMBER(S, bead),
                                       MILLSCOPE_MEMBER(S, overlap),  MILLSCOPE_MEMBER(S, normal),  MILLSCOPE_MEMBER(S, feature),
                                       MILLSCOPE_MEMBER(S, triangle), MILLSCOPE_MEMBER(S, material)};
};

/// Triangles for pictures and per-triangle work, and for export. Owned by the plugin, valid until destroy.
struct Surface {
  std::uint64_t vertex_count;
  const double* vertices;  ///< 3 per vertex, m, geometry's frame
  std::uint64_t triangle_count;
  const std::uint32_t* triangles;           ///< 3 per triangle, counter-clockwise seen from the beads' side
  const std::uint32_t* triangle_materials;  ///< material slot of each triangle
};
template <>
struct Layout<Surface> {
  using S = Surface;
  static constexpr Member members[] = {MILLSCOPE_MEMBER(S, vertex_count), MILLSCOPE_MEMBER(S, vertices),
                                       MILLSCOPE_MEMBER(S, triangle_count), MILLSCOPE_MEMBER(S, triangles),
                                       MILLSCOPE_MEMBER(S, triangle_materials)};
};

/// The space that the charge may fill: a cylinder round the axis (mills) or a box.
struct Interior {
  std::uint32_t is_cylinder;  ///< 1: radius and z-range; 0: the box low…high
  std::uint32_t is_bounded;   ///< 0: nothing known (a plane)
  double axis_point[3];
  double axis[3];
  double radius;           ///< of the bare shell, m
  double low[3], high[3];  ///< bounds in the geometry's frame; for a cylinder low[2], high[2] hold the range along the axis
};
template <>
struct Layout<Interior> {
  using S = Interior;
  static constexpr Member members[] = {MILLSCOPE_MEMBER(S, is_cylinder), MILLSCOPE_MEMBER(S, is_bounded), MILLSCOPE_MEMBER(S, axis_point),
                                       MILLSCOPE_MEMBER(S, axis),        MILLSCOPE_MEMBER(S, radius),     MILLSCOPE_MEMBER(S, low),
                                       MILLSCOPE_MEMBER(S, high)};
};

struct GeometryTable {
  Status (*create)(const Values*, void** self, Failure*);
  void (*destroy)(void* self);
  /// Names of the material slots ("shell", "lifter", …), separated by '|'. A geometry without names has the one slot "all".
  const char* (*material_slots)(const void* self);
  void (*surface)(const void* self, Surface*);
  void (*interior)(const void* self, Interior*);
  /// One text of several lines, "key: value": triangles, box, area, open edges, …
  const char* (*report)(const void* self);
  /// Called from many threads at once, each with beads of its own; `margin` is added to each radius.
  Status (*candidates)(void* self, const GeometryBeads*, double margin, const CandidateSink*, Failure*);
  /// Called from many threads at once.
  void (*contacts)(const void* self, const GeometryQuery*, GeometryContacts*);
};
template <>
struct Layout<GeometryTable> {
  using S = GeometryTable;
  static constexpr Member members[] = {MILLSCOPE_MEMBER(S, create),     MILLSCOPE_MEMBER(S, destroy),  MILLSCOPE_MEMBER(S, material_slots),
                                       MILLSCOPE_MEMBER(S, surface),    MILLSCOPE_MEMBER(S, interior), MILLSCOPE_MEMBER(S, report),
                                       MILLSCOPE_MEMBER(S, candidates), MILLSCOPE_MEMBER(S, contacts)};
};

/// A bead touches at most this many places of one geometry.
inline constexpr int kMaxWallContacts = 6;

inline constexpr std::uint64_t kGeometryLayout =
    layout_hash(Kind::geometry, {kMaxWallContacts},
                KindStructs<CandidateSink, GeometryBeads, GeometryQuery, GeometryContacts, Surface, Interior, GeometryTable>{});

}  // namespace millscope
