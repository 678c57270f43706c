// What several observations share: where the camera sees best, and how fast a bead goes.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "millscope/element.hpp"
#include "millscope/observation_adapter.hpp"
#include "millscope/pack.hpp"

namespace millscope::observations {

constexpr Parameter kMiddleParameter =
    optional(vector_parameter("middle", "m", kRequired, "Where the camera sees best; default: the middle of the mill's axis."));

/// A vector whose components may not be negative; default zero.
constexpr Parameter magnitudes_parameter(const char* name, const char* unit, const char* doc, const char* citation = "") {
  return {name, unit, doc, citation, "", nullptr, 0.0, 0.0, kUnbounded, ValueType::vector, Scope::instance, 0, 0};
}

/// Distance from the rig's middle. In a slice that is periodic along z the path goes on from image to image: a bead is where its image
/// nearest to the middle is, however far it has wandered.
class Middle {
 public:
  explicit Middle(const Parameters& values) : given_(values.given("middle")) {
    if (given_) std::copy_n(values.vector("middle"), 3, middle_.begin());
  }

  double distance(const double* position, const TrackContext& context) const {
    const double along = given_ ? middle_[2] : 0.5 * (context.mill_low + context.mill_high);
    Vec<double> beside{position[0] - middle_[0], position[1] - middle_[1], position[2] - along};
    if (context.period > 0.0 && std::fabs(beside.z) > 0.5 * context.period) beside.z = std::remainder(beside.z, context.period);
    return length(beside);
  }

 private:
  bool given_;
  std::array<double, 3> middle_{};
};

/// Track as it came in.
inline Track copy_of(const TrackView& view) {
  Track track;
  track.reserve(as_size(view.count));
  for (std::int64_t i = 0; i < view.count; ++i) track.push_back(sample_at(view, i));
  return track;
}

}  // namespace millscope::observations
