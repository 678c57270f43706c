// Uneven sampling: a location is found when enough gamma pairs have come in.
//
// symbol   here        meaning
// f        rate_       mean number of locations per second, 1/s
// t_d      dead_time_  shortest time between two locations, s
// k        shape_      evenness: 1 for Poisson arrivals, N where each location is made of N independent events
//
//   t_{i+1} − t_i = t_d + (1/f − t_d) G_k / k,   G_k gamma-distributed with shape k
//
// The standard deviation of the intervals is (1/f − t_d)/√k. Positions between the samples of the track lie on straight lines; where
// the track itself pauses for longer than five of its usual steps, there is nothing to locate. f = 0 leaves the track as it is.
#include <algorithm>
#include <vector>

#include "camera_view.hpp"

namespace millscope::observations {
namespace {

constexpr const char* kCitation = "Parker et al. 1993, Nucl. Instrum. Methods A 326, 592";

constexpr Parameter kParameters[] = {
    number_parameter("rate", "Hz", 0.0, 0.0, 1e5, "Mean number of locations per second before losses; 0: the track's own samples.",
                     kCitation),
    number_parameter("dead_time", "s", 0.0, 0.0, 1.0, "Shortest time between two locations."),
    number_parameter("shape", "1", 1.0, 1.0, 1e6, "Evenness of the intervals: 1 as random as can be, larger: more even."),
};

/// Gamma-distributed with mean 1 (Marsaglia & Tsang 2000); shape ≥ 1.
double gamma_of_mean_one(double shape, Random& random) {
  if (shape == 1.0) return random.exponential();
  const double d = shape - 1.0 / 3.0, c = 1.0 / std::sqrt(9.0 * d);
  for (;;) {
    const double x = random.normal(), root = 1.0 + c * x, v = root * root * root;
    if (root > 0.0 && std::log(1.0 - random.uniform()) < 0.5 * x * x + d * (1.0 - v + std::log(v))) return d * v / shape;
  }
}

/// The median of at most 200 steps, spread over the track.
double usual_step(const TrackView& view) {
  constexpr std::int64_t kSome = 200;
  std::vector<double> steps;
  for (std::int64_t i = 1; i < view.count; i += view.count / kSome + 1) steps.push_back(view.time[i] - view.time[i - 1]);
  std::nth_element(steps.begin(), steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2), steps.end());
  return steps[steps.size() / 2];
}

/// The path at time t between two samples.
TrackSample between(const TrackSample& a, const TrackSample& b, double t) {
  const double share = (t - a.time) / (b.time - a.time);
  TrackSample s{t, {}, std::min(a.weight, b.weight), a.visible && b.visible};
  for (int axis = 0; axis < 3; ++axis) s.position[axis] = a.position[axis] + share * (b.position[axis] - a.position[axis]);
  return s;
}

class Sampling {
 public:
  explicit Sampling(const Parameters& values)
      : rate_(values.number("rate")), dead_time_(values.number("dead_time")), shape_(values.number("shape")) {
    if (rate_ * dead_time_ >= 1.0) throw Refusal("rate times dead_time is 1 or more: so many locations do not fit; lower one of them");
  }

  Track observe(const TrackView& view, const TrackContext& context) const {
    if (rate_ == 0.0 || view.count < 2) return copy_of(view);
    Track out;
    Random random(context.seed);
    const double longest = 5.0 * usual_step(view), end = view.time[view.count - 1];
    std::int64_t i = 0;
    for (double t = start(view.time[0], random); t <= end; t += interval(random)) {
      while (i + 2 < view.count && view.time[i + 1] < t) ++i;
      if (view.time[i + 1] - view.time[i] <= longest) out.push_back(between(sample_at(view, i), sample_at(view, i + 1), t));
    }
    return out;
  }

 private:
  double interval(Random& random) const { return dead_time_ + (1.0 / rate_ - dead_time_) * gamma_of_mean_one(shape_, random); }

  /// The first location at or after `t0` of a camera that has been running for long.
  double start(double t0, Random& random) const {
    if (shape_ == 1.0 && dead_time_ == 0.0) return t0 + interval(random);  // Poisson arrivals remember nothing
    double t = t0 - 100.0 / rate_;
    while (t < t0) t += interval(random);
    return t;
  }

  double rate_, dead_time_, shape_;
};

constexpr Descriptor kDescriptor = describe<Sampling>({
    .name = "sampling",
    .version = "1.0",
    .doc = "Locations at uneven times: a mean rate, a dead time and the evenness of the intervals.",
    .equation = "t_{i+1} - t_i = dead_time + (1/rate - dead_time) G_k/k, G_k gamma-distributed with shape k",
    .citation = kCitation,
    .parameters = kParameters,
});

}  // namespace
}  // namespace millscope::observations

MILLSCOPE_PLUGINS(&millscope::observations::kDescriptor)
