// One time step of all slabs: phase A (pairs and walls), phase B (body forces, kick–drift–predict), and the books.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <vector>

#include "kernel/dem/pair_sweep.hpp"
#include "kernel/dem/schedule.hpp"
#include "kernel/dem/wall_lists.hpp"

namespace millscope::dem {

class Step {
 public:
  Step(Common& common, Particles& particles, PairLists& pairs, WallLists& walls, const std::vector<BodyForceReference>& body_forces);

  /// After particles, bodies and body forces are in place: empty books, room to work in.
  void prepare();
  /// After each rebuild.
  void forget_wear();
  void lists_changed();
  /// Makes step number `step`. `observe` is called, where it is set, when all forces of the present positions are there, before the drift.
  IntegrateResult make(std::int64_t step, const std::function<void()>& observe);

  /// Uniform, of the body forces in the last step, m/s².
  const std::array<double, 3>& acceleration() const { return acceleration_; }
  const std::vector<SlabState>& slabs() const { return slabs_; }

  /// For visitors of the state (state_visitors.hpp), in state.cpp.
  template <class Self, class Visit>
  static void each_work(Self& self, int body, Visit& visit);
  template <class Self, class Visit>
  static void each_book(Self& self, Visit& visit);

 private:
  struct Share;
  BeadRange beads_of(int worker) const;
  bool takes_ring(BeadRange beads) const;
  Share share_of(int worker, bool observed);
  template <class Work>
  void each_share(bool observed, const Work& work);
  void make_observed(const std::function<void()>& observe);
  template <class Done>
  void push(Share& share, int slab, const Done& done);
  bool take_pushes(const Share& share);
  void finish(Share& share, std::int64_t end);
  void apply_body_forces(Share& share, int slab, BeadRange range);
  IntegrateResult integrate(const ForceWindow& force, BeadRange range);

  double time() const { return static_cast<double>(step_) * common_.settings.time_step; }

  Common& common_;
  Particles& particles_;
  PairLists& pairs_;
  WallLists& walls_;
  const std::vector<BodyForceReference>& body_forces_;
  Schedule schedule_;
  std::vector<SlabState> slabs_;
  std::vector<std::atomic<std::int64_t>> pushed_;  ///< [slab]: the last step whose phase A it has been through
  std::vector<std::unique_ptr<Scratch>> scratch_;  ///< [worker]
  std::vector<std::optional<Alike>> alike_;        ///< [physics]
  double largest_drift_ = 0;                       ///< a drift in one step that no sound run reaches, m
  bool has_general_body_force_ = false;            ///< one that differs from bead to bead

  // of this step
  std::int64_t step_ = 0;
  std::vector<WallPose> poses_;
  std::array<double, 3> acceleration_{};
};

}  // namespace millscope::dem
