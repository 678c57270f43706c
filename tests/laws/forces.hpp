// Body forces on one bead, through their tables.
#pragma once

#include <catch2/catch.hpp>

#include "laws/plugins.hpp"
#include "millscope/body_force.hpp"

namespace laws_test {

class Force {
 public:
  explicit Force(const ValueSet& values) : table_(static_cast<const BodyForceTable*>(values.descriptor().table)) {
    Failure failure{};
    const Values view = values.view();
    if (table_->create(&view, &self_, &failure) != 0) throw Refusal(failure.message);
  }
  ~Force() { table_->destroy(self_); }
  Force(const Force&) = delete;
  Force& operator=(const Force&) = delete;

  std::array<double, 3> uniform() const {
    std::array<double, 3> a{};
    CHECK(table_->uniform(self_, 0.0, a.data()) == 1);
    return a;
  }
  /// Force on one bead of 1 g, the power taken from it, the fluid that moves with it.
  std::array<double, 5> on(std::array<double, 3> x, std::array<double, 3> v, double radius) const {
    double mass = 1e-3, force[3] = {}, moment[3] = {}, added = 0, spin = 0;
    BodyForceBatch b{};
    b.count = 1;
    b.radius = &radius, b.mass = &mass, b.added_mass = &added;
    for (std::size_t a = 0; a < 3; ++a) {
      b.position[a] = &x[a], b.velocity[a] = &v[a], b.spin[a] = &spin, b.force[a] = &force[a], b.moment[a] = &moment[a];
    }
    table_->evaluate(self_, &b);
    return {force[0], force[1], force[2], b.power_sum, added};
  }

 private:
  const BodyForceTable* table_;
  void* self_ = nullptr;
};

}  // namespace laws_test
