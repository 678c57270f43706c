// What acts on the beads, as the core sees it: tables and objects of loaded plugins, one set per pair of materials.
#pragma once

#include <algorithm>
#include <cassert>
#include <string>
#include <vector>

#include "kernel/dem/batch.hpp"
#include "millscope/body_force.hpp"
#include "millscope/contact_law.hpp"
#include "millscope/geometry.hpp"
#include "millscope/interaction.hpp"
#include "millscope/pair_parameter.hpp"
#include "millscope/wear_law.hpp"

namespace millscope::dem {

struct LawReference {
  const ContactLawTable* table = nullptr;
  const void* self = nullptr;
};

struct InteractionReference {
  const InteractionTable* table = nullptr;
  const void* self = nullptr;
  bool pre = false;
  std::string name;
};

struct PairParameterReference {
  const PairParameterTable* table = nullptr;
  const void* self = nullptr;
  bool gives_restitution = false, gives_friction = false;
};

struct WearReference {
  const WearLawTable* table = nullptr;
  const void* self = nullptr;
  std::string name;
};

/// Everything that acts between two materials. `wall`: the second is a wall.
struct PairPhysics {
  int first = 0, second = 0;
  bool wall = false;
  std::string name;  ///< "glass~liner"
  LawReference law;
  std::vector<InteractionReference> interactions;
  std::vector<PairParameterReference> pair_parameters;
  std::vector<WearReference> wear;  ///< of a wall
  double reach = 0;                 ///< m

  bool has_pre() const {
    return std::any_of(interactions.begin(), interactions.end(), [](const InteractionReference& i) { return i.pre; });
  }
  bool has_post() const {
    return std::any_of(interactions.begin(), interactions.end(), [](const InteractionReference& i) { return !i.pre; });
  }
};

/// The physics of all pairs of materials that can meet. Its index in this table names a pair of materials everywhere in this room.
class PhysicsTable {
 public:
  PhysicsTable(std::vector<PairPhysics> all, int material_count);

  const std::vector<PairPhysics>& all() const { return all_; }
  const PairPhysics& operator[](int physics_index) const { return all_[physics_index]; }
  int count() const { return static_cast<int>(all_.size()); }
  int material_count() const { return material_count_; }
  /// Index of the physics of beads of two materials, in either order.
  int of_beads(int first, int second) const { return entry(of_beads_, first, second); }
  /// Index of the physics of a bead and a wall.
  int of_wall(int bead, int wall) const { return entry(of_wall_, bead, wall); }
  double reach() const { return reach_; }            ///< largest gap at which any acts, m
  double wall_reach() const { return wall_reach_; }  ///< … of those with a wall

 private:
  int entry(const std::vector<int>& table, int first, int second) const {
    const int physics_index = table[first * material_count_ + second];
    assert(physics_index >= 0);
    return physics_index;
  }

  std::vector<PairPhysics> all_;
  int material_count_;
  std::vector<int> of_beads_, of_wall_;  ///< [first · materials + second]; −1: they never meet
  double reach_ = 0, wall_reach_ = 0;
};

struct BodyForceReference {
  const BodyForceTable* table = nullptr;
  const void* self = nullptr;
  std::string name;
};

/// Names of the ledger's channels of every pair, law first; and the histories, at most kMaxHistories: 1 even, −1 odd.
struct Layout {
  std::vector<std::string> channels;
  std::vector<int> history_sign;
  int history_count() const { return static_cast<int>(history_sign.size()); }
};

}  // namespace millscope::dem
