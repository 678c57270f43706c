#include "kernel/dem/scratch.hpp"

namespace millscope::dem {
namespace {

/// Collects pointers, single ones and groups of them, and then gives each an array of its own.
template <class T>
class Arrays {
 public:
  template <class... Pointers>
  void add(Pointers&... pointers) {
    (add_one(pointers), ...);
  }
  template <class Storage>
  void deal(Storage& storage) const {
    storage.assign(wanted_.size() * kBatchStride, T{});
    T* next = storage.data();
    for (T** pointer : wanted_) {
      *pointer = next;
      next += kBatchStride;
    }
  }

 private:
  void add_one(T*& pointer) { wanted_.push_back(&pointer); }
  template <std::size_t kCount>
  void add_one(T* (&group)[kCount]) {
    for (T*& pointer : group) wanted_.push_back(&pointer);
  }
  std::vector<T**> wanted_;
};

}  // namespace

Scratch::Scratch(int history_count) {
  PairBatch& p = pairs;
  Arrays<double> doubles;
  doubles.add(walls.pressing, walls.sliding, walls.worn, walls.lever, p.normal, p.velocity, walls.wall_velocity, p.spin_i, p.spin_j,
              p.force, p.torque_i, p.torque_j, p.moment_i, p.moment_j);
  doubles.add(p.overlap, p.radius_i, p.radius_j, p.radius, p.mass, p.arm_i, p.arm_j, p.normal_force, p.normal_stiffness, p.added_force,
              p.added_cap, p.restitution, p.friction, query_radius, found.overlap, p.power, query_position, found.normal);
  doubles.add(bodies.position, bodies.velocity, bodies.spin, bodies.radius, bodies.mass, bodies.force, bodies.moment, bodies.added_mass);
  for (int h = 0; h < history_count; ++h) doubles.add(p.history[h]);
  doubles.deal(doubles_);

  Arrays<std::uint32_t> integers;
  integers.add(p.owner, p.partner, p.source, found.feature, triangle, found.material);
  integers.deal(integers_);
  Arrays<std::int32_t> indices;
  indices.add(found.bead);
  indices.deal(signed_);
  Arrays<std::uint8_t> bytes;
  bytes.add(p.fresh, walls.first);
  bytes.deal(bytes_);
  found.capacity = kBatch;

  static_cast<ContactArrays&>(walls) = p;
  walls.bead = p.owner;
  walls.contact = p.partner;
  walls.arm = p.arm_i;
  walls.wall_power = p.arm_j;
  for (int a = 0; a < 3; ++a) {
    walls.torque[a] = p.torque_i[a];
    walls.body_torque[a] = p.torque_j[a];
  }
}

}  // namespace millscope::dem
