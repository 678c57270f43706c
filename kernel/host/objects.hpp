// Objects made by plugins, as C++ objects: created from values, destroyed in time, failures turned into UserError at the place that the
// user wrote. Each keeps its library loaded.
#pragma once

#include <memory>
#include <string>
#include <utility>

#include "kernel/host/registry.hpp"
#include "millscope/analyzer.hpp"
#include "millscope/body_force.hpp"
#include "millscope/contact_law.hpp"
#include "millscope/geometry.hpp"
#include "millscope/interaction.hpp"
#include "millscope/observation.hpp"
#include "millscope/pair_parameter.hpp"
#include "millscope/wear_law.hpp"

namespace millscope::host {

namespace detail {
/// Throws UserError at `where`: "contact_law 'x': the plugin's message".
[[noreturn]] void refuse(const Loaded& plugin, const Location& where, const Failure& failure);
}  // namespace detail

/// A plugin object of the kind whose table is `Table`. Movable, not copyable. `table().evaluate(self(), &batch)` is the hot call.
template <class Table>
class Object {
 public:
  Object() = default;

  /// Calls the plugin's create with `context` (PairContext, AnalyzerContext, or nothing). Throws UserError at `where`.
  template <class... Context>
  static Object create(const Loaded& plugin, const Values& values, const Location& where, const Context&... context) {
    Failure failure{};
    void* self = nullptr;
    const Table& table = plugin.table<Table>();
    if (table.create(&values, &context..., &self, &failure) != 0 || self == nullptr) detail::refuse(plugin, where, failure);
    return Object(plugin, self, where);
  }

  explicit operator bool() const { return self_ != nullptr; }
  const Table& table() const { return plugin_.table<Table>(); }
  void* self() const { return self_.get(); }
  const Loaded& plugin() const { return plugin_; }
  std::string name() const { return std::string(plugin_.name()); }
  const Location& where() const { return where_; }

  /// Throws UserError when a call of the table has failed.
  void check(Status status, const Failure& failure) const {
    if (status != 0) detail::refuse(plugin_, where_, failure);
  }

 private:
  Object(Loaded plugin, void* self, Location where)
      : plugin_(std::move(plugin)), where_(std::move(where)), self_(self, [library = plugin_.library, destroy = table().destroy](void* p) {
          if (p != nullptr) destroy(p);
        }) {}
  Loaded plugin_;
  Location where_;
  std::shared_ptr<void> self_;  ///< its deleter holds the library
};

using LawObject = Object<ContactLawTable>;
using InteractionObject = Object<InteractionTable>;
using PairParameterObject = Object<PairParameterTable>;
using WearLawObject = Object<WearLawTable>;
using BodyForceObject = Object<BodyForceTable>;
using GeometryObject = Object<GeometryTable>;
using ObservationObject = Object<ObservationTable>;
using AnalyzerObject = Object<AnalyzerTable>;

/// Whether an interaction acts before the contact law (else after it).
inline bool acts_before(const InteractionObject& interaction) { return (interaction.plugin().descriptor->features & kPreInteraction) != 0; }

}  // namespace millscope::host
