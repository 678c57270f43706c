// Locations that have nothing to do with the bead: chance coincidences.
//
// symbol   here        meaning
// p        fraction_   share of the locations
// D        distance_   mean distance from the true place, m
//
// With probability p a location is moved by an exponentially distributed distance of mean D, in a direction that is even over the
// sphere. p = 0 leaves the track as it is.
#include <numbers>

#include "camera_view.hpp"

namespace millscope::observations {
namespace {

constexpr Parameter kParameters[] = {
    number_parameter("fraction", "1", 0.0, 0.0, 1.0, "Share of the locations that are outliers; 0: none."),
    number_parameter("distance", "m", 1.0, 0.0, 1000.0, "Mean distance of an outlier from the bead."),
};

class Outliers {
 public:
  explicit Outliers(const Parameters& values) : fraction_(values.number("fraction")), distance_(values.number("distance")) {}

  Track observe(const TrackView& view, const TrackContext& context) const {
    Track track = copy_of(view);
    if (fraction_ == 0.0) return track;
    Random random(context.seed);
    for (TrackSample& s : track) {
      if (random.uniform() >= fraction_) continue;
      const double length = distance_ * random.exponential(), along = 2.0 * random.uniform() - 1.0,
                   angle = 2.0 * std::numbers::pi * random.uniform();
      const double across = std::sqrt(1.0 - along * along);
      s.position[0] += length * across * std::cos(angle);
      s.position[1] += length * across * std::sin(angle);
      s.position[2] += length * along;
    }
    return track;
  }

 private:
  double fraction_, distance_;
};

constexpr Descriptor kDescriptor = describe<Outliers>({
    .name = "outliers",
    .version = "1.0",
    .doc = "A share of the locations lies somewhere else, in any direction.",
    .equation = "x' = x + distance E n, E exponential with mean 1, n a random direction, with probability fraction",
    .parameters = kParameters,
});

}  // namespace
}  // namespace millscope::observations

MILLSCOPE_PLUGINS(&millscope::observations::kDescriptor)
