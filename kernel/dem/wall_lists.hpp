// The beads near each body, made anew at each rebuild, and the contacts that last, by bead, feature and nearest normal.
#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "kernel/dem/body.hpp"
#include "kernel/dem/cell_order.hpp"
#include "kernel/dem/rows.hpp"

namespace millscope::dem {

/// Contacts of one slab with one body: a history is found again by bead, feature and the nearest normal.
struct WallContacts {
  std::vector<std::uint32_t> bead;  ///< index into WallList::bead
  std::vector<std::uint32_t> feature;
  std::vector<Vector3> normal;               ///< in the body's frame
  std::vector<std::vector<double>> history;  ///< [number][contact]

  static constexpr std::uint32_t kUsedUp =
      std::numeric_limits<std::uint32_t>::max();  ///< feature of a contact that is not to be found again

  std::int64_t count() const { return std::ssize(bead); }
  void resize(std::int64_t n) {
    bead.resize(n);
    feature.resize(n);
    normal.resize(n);
    for (auto& h : history) h.resize(n);
  }
  /// The contact of a bead with this feature whose normal is nearest; it can be taken once. `cursor`, the first contact of this bead or of
  /// a later one, is kept from call to call: beads come in ascending order.
  std::optional<std::int64_t> take(std::int64_t& cursor, std::uint32_t of_bead, std::uint32_t of_feature, const Vector3& near) {
    while (cursor < count() && bead[cursor] < of_bead) ++cursor;
    std::optional<std::int64_t> best;
    double best_dot = -2;
    for (std::int64_t q = cursor; q < count() && bead[q] == of_bead; ++q) {
      if (feature[q] != of_feature) continue;
      const double d = dot(normal[q], near);
      if (d > best_dot) {
        best_dot = d;
        best = q;
      }
    }
    if (best) feature[*best] = kUsedUp;
    return best;
  }
};

/// The beads of one slab that are near one body.
struct WallList {
  std::vector<std::uint32_t> bead;  ///< ascending
  std::vector<std::int64_t> first;  ///< [bead]: its first candidate; one more at the end
  std::vector<std::uint32_t> candidates;
  WallContacts active, next;  ///< of the last step, and of the one that is being made
  std::int64_t swept = 0;     ///< entries of `bead` that this step has been through
  std::int64_t matched = 0;   ///< contacts of `active` that it has passed: `cursor` of `take`
};

class WallLists {
 public:
  WallLists(Common& common, const std::vector<Body>& bodies) : common_(common), bodies_(bodies) {}

  /// Empty lists for the bodies that there are.
  void clear();
  /// From here, slab by slab, `rebuild`: takes what lasts out of the old lists.
  void begin_rebuild(const CellOrder& order, double time);
  /// Asks every geometry for the features near the beads of a slab; contacts that last go with the beads. Many slabs at once.
  void rebuild(int slab, const CellOrder& order, Particles& particles);
  /// Adds to the work of each bead that is near a wall, by its new number.
  void add_work(const std::vector<std::uint32_t>& new_index, std::uint32_t near, std::vector<std::uint32_t>& work) const;
  /// After all slabs.
  void end_rebuild() { carried_.clear(); }
  /// The walls have moved on by one step. True: by more than the lists allow.
  bool move_on();

  const std::vector<Body>& bodies() const { return bodies_; }
  WallList& of(int slab, int body) { return slabs_[slab].lists[body]; }
  const WallList& of(int slab, int body) const { return slabs_[slab].lists[body]; }

  /// visit(list, contact) for all contacts of the last step with a body.
  template <class Visit>
  void each_contact(int body, const Visit& visit) const {
    for (const SlabLists& slab : slabs_) {
      for (std::int64_t c = 0; c < slab.lists[body].active.count(); ++c) visit(slab.lists[body], c);
    }
  }

  /// For visitors of the state (state_visitors.hpp), in state.cpp.
  template <class Self, class Visit>
  static void each_array(Self& self, int body, Visit& visit);
  template <class Self, class Visit>
  static void each_number(Self& self, Visit& visit);

 private:
  struct alignas(kCacheLine) SlabLists {
    std::vector<WallList> lists;  ///< [body]
  };
  struct Contact {
    std::uint32_t feature;
    Vector3 normal;
    std::int64_t history;  ///< its first number in Carried::history
  };
  /// Contacts on their way to a new list, by the beads' new numbers.
  struct Carried {
    std::vector<std::uint32_t> first;  ///< [bead]; one more at the end
    std::vector<Contact> contacts;
    std::vector<double> history;
  };
  struct Near {
    std::uint32_t bead, feature;
    bool operator<(const Near& other) const { return bead != other.bead ? bead < other.bead : feature < other.feature; }
  };
  double greatest_speed() const;
  GeometryBeads beads_of(int slab, int body, const CellOrder& order, Particles& particles) const;
  std::vector<Near> near(const Body& body, const GeometryBeads& beads) const;
  void take_contacts(int body, const std::vector<std::uint32_t>& new_index);
  void deal(int slab, int body, const std::vector<Near>& near);

  Common& common_;
  const std::vector<Body>& bodies_;
  std::vector<SlabLists> slabs_;
  std::vector<WallPose> poses_;   ///< [body]: at the rebuild
  std::vector<Carried> carried_;  ///< [body]
  double speed_ = 0;              ///< greatest of any wall, m/s
  double margin_ = 0;             ///< the walls may move this far before a rebuild, m
  double moved_ = 0;              ///< bound on their displacement since the rebuild, m
};

}  // namespace millscope::dem
