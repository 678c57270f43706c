// The moving charge: beads, lists, walls and the step that advances them.
//
// One step, all in a fixed number K of slabs (contiguous ranges of beads in cell order), whatever the number of threads:
//   A  each slab: the pairs owned by its beads (forces on beads of later slabs go to its halo); the walls trail a few batches behind, for
//      the beads that the pairs have passed;
//   B  each slab: adds the halos of the earlier slabs in slab order, body forces, kick–drift–predict.
// A pair's owner comes first in the order of cells, so once a slab has been through A nobody but earlier slabs reads or pushes its beads:
// where these belong to the same worker, B follows at once, while the slab is still in the cache. The arithmetic is the same either way.
// A rebuild happens when a bead has used up its own skin, which grows with its speed at the last rebuild: fast beads are few.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "kernel/base/error.hpp"
#include "kernel/dem/ledger.hpp"
#include "kernel/dem/motion.hpp"
#include "kernel/dem/particles.hpp"
#include "kernel/dem/physics.hpp"
#include "kernel/dem/wide.hpp"
#include "kernel/dem/workers.hpp"

namespace millscope::dem {

/// Pairs of one slab and one pair of materials.
struct PairList {
  std::vector<std::uint32_t> owner, partner;
  std::vector<std::uint8_t> touching;
  std::vector<std::vector<double>> history;  ///< [number][contact]: of the touching slots, in their order; may have room to spare
  std::vector<std::vector<double>> next;     ///< the same of the step that is being made
  PairListView view();
  std::int64_t contact_count() const;
  void make_room(PairListView& view);  ///< in `next` for one more batch
  void end_sweep();                    ///< `next` becomes `history`
};

/// A contact that lasts, at a wall: its history is found again by bead, feature and the nearest normal.
struct WallContacts {
  std::vector<std::uint32_t> bead;  ///< index into WallSlab::bead
  std::vector<std::uint32_t> feature;
  std::vector<std::array<double, 3>> normal;  ///< in the body's frame
  std::vector<std::vector<double>> history;   ///< [slot][contact]
  void clear();
  void resize(std::size_t n);
};

/// The beads of one slab that are near one body.
struct WallSlab {
  std::vector<std::uint32_t> bead;  ///< bead index
  std::vector<std::int64_t> first;  ///< bead.size() + 1
  std::vector<std::uint32_t> candidates;
  WallContacts active, next;  ///< of the last step and of this one
  std::size_t swept = 0;      ///< beads of `bead` that this step has been through
  std::size_t matched = 0;    ///< contacts of `active` that it has passed
};

struct Body {
  std::string name;
  const GeometryTable* table = nullptr;
  void* self = nullptr;
  Motion motion;
  std::vector<int> material_of_slot;  ///< material index of each slot of the geometry
  double greatest_distance = 0;       ///< of its surface from the axis of rotation, m
  bool per_triangle = false;          ///< keep impact and shear work per triangle
  std::uint64_t triangle_count = 0;
};

struct Settings {
  double time_step = 0;  ///< s
  int partitions = 8;    ///< K
  int threads = 1;
  PeriodicBox periodic{};
  double periodic_low[3] = {0, 0, 0};
  double skin_steps = 30;       ///< a bead's skin lasts this many steps at its present speed …
  double skin_base = 0.05;      ///< … beyond this fraction of its radius
  double skin_cap = 0.6;        ///< and no more than this fraction of the largest radius
  double low[3], high[3];       ///< a bead outside has left the domain, m
  std::string instruction_set;  ///< "" for the best
};

/// A coordinate along `axis` brought into the periodic box; as it is where the axis is not periodic.
double wrapped(const Settings& settings, int axis, double coordinate);

/// Beads one after the other, in cell order.
struct BeadRange {
  std::int64_t begin, end;
};

struct SlabState;  // scratch and results of one slab
struct Scratch;    // of one worker

/// A bead moved more than half its radius in one step: the state is of no use any more.
struct Runaway : base::UserError {
  using base::UserError::UserError;
};

class System {
 public:
  /// `physics[p]` of each pair; `pair_of[a * materials + b]` and `wall_pair_of[…]` give p or −1.
  System(Settings settings, Layout layout, std::vector<PairPhysics> physics, int material_count);
  ~System();

  Particles particles;
  std::vector<Body> bodies;
  std::vector<BodyForceReference> body_forces;

  /// After particles and bodies are in place: sorts, builds lists. `time` of the current positions.
  void start(std::int64_t step = 0);

  /// One time step. Throws base::UserError when a bead runs away or leaves the domain.
  void advance();

  /// Threads at work: at most one per slab.
  int threads() const { return workers_->count(); }
  std::int64_t step() const { return step_; }
  double time() const { return static_cast<double>(step_) * settings_.time_step; }
  const Settings& settings() const { return settings_; }
  const Layout& layout() const { return layout_; }
  const std::vector<PairPhysics>& physics() const { return physics_; }
  std::int64_t rebuilds() const { return rebuilds_; }
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
  std::array<double, 3> acceleration() const { return acceleration_; }
  /// Velocity and spin of a bead at the step, valid inside `observe`.
  void velocity_at_step(std::int64_t bead, double velocity[3], double spin[3]) const;

  /// Impact and shear work of each triangle of a body, J since the start.
  std::vector<double> impact_work(std::size_t body) const;
  std::vector<double> shear_work(std::size_t body) const;

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
  /// Time and shape of the state: step, rebuilds, whether one is due; partitions, histories per contact, pairs of materials.
  std::array<std::int64_t, 6> counters() const;
  template <class Self, class Visit>
  static void each_bead_array(Self& self, Visit& visit);
  template <class Self, class Visit>
  static void each_list_array(Self& self, Visit& visit);
  template <class Self, class Visit>
  static void each_pair_array(Self& self, Visit& visit);
  template <class Self, class Visit>
  static void each_wall_array(Self& self, Visit& visit);
  void prepare();
  void rebuild();
  template <class Values>
  void permute(Values& values);
  void sort_beads();
  void extract_pair_history();
  void build_pairs(int slab);
  void extract_wall_history();
  void build_walls();
  struct PairSweep;
  void contacts(int slab, int worker, bool finish_too);
  PairSweep begin_pairs(int slab, int worker, std::size_t physics);
  void look_ahead(PairSweep& sweep, std::int64_t first) const;
  void pair_batch(PairSweep& sweep, std::int64_t first, std::int64_t last);
  void size_ring(int slab);
  struct WallChunk {
    int slab, worker;
    std::size_t body;
    std::int64_t begin, count;  ///< of WallSlab::bead
    std::size_t base;           ///< its first contact in WallSlab::next
    std::uint64_t present;      ///< bit p mod 64: it may have contacts of physics p
  };
  void begin_walls(int slab);
  void walls(int slab, int worker, std::int64_t end);
  void find_wall_contacts(WallChunk& chunk);
  std::int64_t gather_wall_batch(const WallChunk& chunk, std::size_t physics);
  void scatter_wall_batch(const WallChunk& chunk, std::size_t physics, std::int64_t count);
  void end_walls(int slab);
  BeadRange beads_of(int slab) const { return {slab_begin(slab), slab_begin(slab + 1)}; }
  void integrate(int slab, BeadRange range);
  void apply_body_forces(int slab, int worker, BeadRange range);
  void finish(int slab, int worker, BeadRange range);  ///< phase B
  void prepare_sweeps();
  bool follows_at_once(int slab, int worker) const {
    return first_reference_[static_cast<std::size_t>(slab)] >= workers_->first(worker, settings_.partitions);
  }
  void add_halos(int slab, BeadRange range);
  std::string complaint(std::int64_t bead, const char* what) const;
  int pair_index(int a, int b, bool wall) const;
  std::int64_t slab_begin(int slab) const { return slab * particles.count() / settings_.partitions; }

  Settings settings_;
  Layout layout_;
  std::vector<PairPhysics> physics_;
  int material_count_;
  std::vector<int> pair_of_, wall_pair_of_;
  const WideTable* wide_;
  std::unique_ptr<Workers> workers_;
  std::vector<std::unique_ptr<SlabState>> slabs_;
  std::vector<std::unique_ptr<Scratch>> scratch_;
  std::vector<Pose> poses_;
  std::array<double, 3> acceleration_{};
  std::int64_t step_ = 0, rebuilds_ = 0;
  bool rebuild_needed_ = false;
  double wall_reach_ = 0;    ///< gap up to which the physics of any wall acts, m
  double wall_margin_ = 0;   ///< the walls may move this far before a rebuild, m
  double wall_speed_ = 0;    ///< greatest speed of any wall, m/s
  double wall_moved_ = 0;    ///< bound on its displacement since the rebuild, m
  double largest_step_ = 0;  ///< displacement in one step that no sound run reaches, m
  bool has_general_body_force_ = false;
  std::size_t last_list_ = 0;                 ///< the last pair of materials of beads in `physics_`
  int list_count_ = 0;                        ///< how many there are
  std::vector<int> first_reference_;          ///< per slab: the earliest slab with a pair that reaches into it
  std::vector<std::uint8_t> normal_channel_;  ///< per channel: its work counts as impact, not shear

  /// All beads of a pair of materials alike: then radius and mass need no gathering.
  struct Equality {
    bool equal = false;
    double radius = 0, mass = 0;
    std::array<std::shared_ptr<AlignedVector<double>>, 3> arrays{};  ///< R*, m*, R, one batch long
  };
  std::vector<Equality> equality_;

  // the cell grid of the last rebuild
  struct Grid {
    double low[3];
    double inverse_edge[3];
    int cells[3];
    int axis[3];  ///< axis[0] is the slowest in the order of cells
    std::vector<std::uint32_t> start;
  } grid_;
  AlignedVector<PositionLine> reaches_;  ///< centre; `radius`: radius + skin + half the largest law reach
  std::vector<std::uint32_t> new_index_;
  std::vector<std::uint32_t> carried_start_;
  std::vector<std::uint32_t> carried_partner_;
  std::vector<double> carried_history_;
};

}  // namespace millscope::dem
