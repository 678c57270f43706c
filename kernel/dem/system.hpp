// The moving charge: beads, walls, what acts between them, and the step that advances them.
//
// One step, all in a fixed number K of slabs (contiguous ranges of beads in cell order), whatever the number of threads (step.hpp):
//   A  the pairs owned by its beads; the walls trail a few batches behind, for the beads that the pairs have passed;
//   B  body forces, kick–drift–predict.
// A pair's owner comes after its partner in the order of cells, and a bead is done with A when the last owner that pushes it has been
// reached: B follows right behind, while the bead is still in the cache (schedule.hpp). A worker goes through its slabs as if they were
// one. What it pushes on beads of earlier workers goes into a log, which these add at their end, push by push. A
// rebuild of order and lists (cell_order.hpp, pair_lists.hpp, wall_lists.hpp) happens when a bead has used up its own skin, which grows
// with its speed at the last rebuild: fast beads are few.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "kernel/base/error.hpp"
#include "kernel/dem/body.hpp"
#include "kernel/dem/ledger.hpp"
#include "kernel/dem/particles.hpp"
#include "kernel/dem/physics.hpp"
#include "kernel/dem/settings.hpp"

namespace millscope::dem {

class PairLists;
class WallLists;
struct SlabState;

/// A bead moved more than half its radius in one step: the state is of no use any more.
struct Runaway : base::UserError {
  using base::UserError::UserError;
};

class System {
 public:
  System(Settings settings, Layout layout, std::vector<PairPhysics> physics, int material_count);
  ~System();
  System(const System&) = delete;
  System& operator=(const System&) = delete;

  Particles particles;
  std::vector<Body> bodies;
  std::vector<BodyForceReference> body_forces;

  /// After particles and bodies are in place: sorts, builds lists. `step`: that of the current positions.
  void start(std::int64_t step = 0);

  /// One time step. Throws base::UserError when a bead runs away or leaves the domain.
  void advance();

  /// Threads at work: at most one per slab.
  int threads() const;
  std::int64_t step() const { return step_; }
  double time() const { return static_cast<double>(step_) * settings().time_step; }
  const Settings& settings() const;
  const Layout& layout() const;
  const std::vector<PairPhysics>& physics() const;
  std::int64_t rebuilds() const { return rebuilds_; }
  const PairLists& pair_lists() const;
  const WallLists& wall_lists() const;
  std::int64_t listed_pairs() const;

  /// Contact forces for the present positions are computed by `advance` first; the instant sums of the ledger, kinetic energy and
  /// the like therefore belong to the state *before* the drift. `observe` is called at that moment when set.
  std::function<void(const System&)> observe;

  /// Sum of all slabs since the start.
  Ledger ledger() const;
  struct KineticEnergy {
    double translational = 0, rotational = 0;  ///< J
    double total() const { return translational + rotational; }
  };
  KineticEnergy kinetic_energy() const;  ///< at the step, valid inside `observe`
  std::array<double, 3> centre_of_mass() const;
  double total_mass() const;
  std::array<double, 3> acceleration() const;
  /// Velocity and spin of a bead at the step, valid inside `observe`.
  void velocity_at_step(std::int64_t bead, double velocity[3], double spin[3]) const;

  /// Impact and shear work of each triangle of a body, J since the start.
  std::vector<double> impact_work(std::size_t body) const;
  std::vector<double> shear_work(std::size_t body) const;
  /// What beads have taken away at each triangle of a body, m³ since Settings::wear_from_step.
  std::vector<double> worn_volume(std::size_t body) const;
  /// It is counted anew from here.
  void forget_wear();

  /// FNV-1a over ids, positions, velocities, spins, contact histories, time, wall angles, in id order.
  std::uint64_t state_hash() const;

  /// Everything that the next step depends on, by name, for checkpoints.
  using DoubleSink = std::function<void(const std::string&, const double*, std::size_t)>;
  using IntegerSink = std::function<void(const std::string&, const std::int64_t*, std::size_t)>;
  using DoubleSource = std::function<std::vector<double>(const std::string&)>;
  using IntegerSource = std::function<std::vector<std::int64_t>(const std::string&)>;
  void save(const DoubleSink&, const IntegerSink&) const;
  /// Restores what `save` gave (particles included); bodies and physics must be the same as then.
  void restore(const DoubleSource&, const IntegerSource&);

  std::size_t memory_bytes() const;  ///< of beads, lists and walls

 private:
  struct Parts;
  void rebuild();
  std::vector<double> triangle_sums(std::size_t body, std::vector<std::vector<double>> SlabState::*kind) const;
  std::array<std::int64_t, 6> counters() const;
  template <class Self, class SelfParts, class Visit>
  static void each_bead_array(Self& self, SelfParts& parts, Visit& visit);
  template <class Self, class SelfParts, class Visit>
  static void each_list_array(Self& self, SelfParts& parts, Visit& visit);

  std::unique_ptr<Parts> parts_;
  std::int64_t step_ = 0, rebuilds_ = 0;
  bool rebuild_needed_ = false;
};

}  // namespace millscope::dem
