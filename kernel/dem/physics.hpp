// What acts on the beads, as the core sees it: tables and objects of loaded plugins, one set per pair of materials.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "millscope/body_force.hpp"
#include "millscope/contact_law.hpp"
#include "millscope/geometry.hpp"

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

/// Everything that acts between two materials. `wall`: the second is a wall.
struct PairPhysics {
  int first = 0, second = 0;
  bool wall = false;
  std::string name;  ///< "glass~liner"
  LawReference law;
  std::vector<InteractionReference> interactions;
  std::vector<PairParameterReference> pair_parameters;
  double reach = 0;  ///< m

  bool has_pre() const {
    return std::any_of(interactions.begin(), interactions.end(), [](const InteractionReference& i) { return i.pre; });
  }
  bool has_post() const {
    return std::any_of(interactions.begin(), interactions.end(), [](const InteractionReference& i) { return !i.pre; });
  }
};

struct BodyForceReference {
  const BodyForceTable* table = nullptr;
  const void* self = nullptr;
  std::string name;
};

/// Names of the ledger's channels of every pair, law first; and where each history stands.
struct Layout {
  std::vector<std::string> channels;
  std::vector<int> history_sign;
  int history_count() const { return static_cast<int>(history_sign.size()); }
};

}  // namespace millscope::dem
