// The tracker's own spread u of a location grows with the distance from the rig's middle and with the bead's speed; locations above a
// cut are thrown away, so fast and far beads are under-represented.
//
// symbol   here            meaning
// u        u               the tracker's spread of a location, m; no standard error
// u₀       spread_         of a bead at rest in the middle, m
// a, b     per_distance_, per_speed_   growth with distance d and speed v, m/m and s
// s        scatter_        standard deviation of u at given d and v, m
// u_max    cut_            m
//
//   u = u₀ + a d + b v + s n,   n of variance 1;   kept where u ≤ u_max, with probability Φ((u_max − u₀ − a d − b v)/s)
//
// v is the slope of a straight line through the samples within the speed window. The confidence of a location becomes 1 mm/u, at most 1;
// u_max = 0 leaves the track as it is.
#include <optional>

#include "camera_view.hpp"

#include "millscope/element.hpp"

namespace millscope::observations {
namespace {

constexpr double kSpreadOfFullConfidence = 1e-3;  // m

constexpr Parameter kParameters[] = {
    number_parameter("cut", "m", 0.0, 0.0, 10.0, "Largest spread that is kept; 0: everything is kept."),
    number_parameter("spread", "m", 0.0, 0.0, 10.0, "The tracker's spread of a bead at rest in the rig's middle."),
    number_parameter("per_distance", "1", 0.0, 0.0, 100.0, "Growth of the spread with the distance from the rig's middle, m per m."),
    number_parameter("per_speed", "s", 0.0, 0.0, 100.0, "Growth of the spread with the bead's speed, m per m/s."),
    number_parameter("scatter", "m", 0.0, 0.0, 10.0, "Standard deviation of the spread at given distance and speed."),
    number_parameter("speed_window", "s", 0.02, 0.0, 1.0, "Span of time in which the speed is taken."),
    kMiddleParameter,
};

constexpr Hypothesis kHypotheses[] = {
    {"fast_beads_lost", "The camera loses fast beads.", "u = spread + per_distance d + per_speed v + scatter n <= cut", "", "per_speed",
     0.0, 0.0, 0.05},
};

/// Of one bead, at one sample after the other.
class Speeds {
 public:
  Speeds(const TrackView& view, double window) : view_(view), half_(0.5 * window) {}

  /// Slope of a straight line through the samples within half the window of sample i, times and places as seen from it; nothing where there
  /// is no other. The window's ends only move forward.
  std::optional<double> at(std::int64_t i) {
    const double *const time = view_.time, now = time[i];
    while (now - time[low_] > half_) ++low_;
    while (high_ < view_.count && time[high_] - now <= half_) ++high_;
    const Vec<double> here = load_vector<double>(view_.position, i);
    double first = 0, second = 0;
    Vec<double> place{0, 0, 0}, moment{0, 0, 0};
    for (std::int64_t k = low_; k < high_; ++k) {
      const double t = time[k] - now;
      const Vec<double> x = load_vector<double>(view_.position, k) - here;
      first += t;
      second += t * t;
      place = place + x;
      moment = moment + t * x;
    }
    const double mean = first / static_cast<double>(high_ - low_), square = second - mean * first;
    if (!(square > 0.0)) return std::nullopt;
    return length(moment - mean * place) / square;
  }

 private:
  const TrackView& view_;
  double half_;
  std::int64_t low_ = 0, high_ = 0;
};

class ErrorCut {
 public:
  explicit ErrorCut(const Parameters& values)
      : middle_(values),
        cut_(values.number("cut")),
        spread_(values.number("spread")),
        per_distance_(values.number("per_distance")),
        per_speed_(values.number("per_speed")),
        scatter_(values.number("scatter")),
        window_(values.number("speed_window")) {}

  Track observe(const TrackView& view, const TrackContext& context) const {
    Track track = copy_of(view);
    if (cut_ == 0.0) return track;
    Random random(context.seed);
    Speeds speeds(view, window_);
    double speed = 0;  // of the location before, where this one stands alone
    for (std::int64_t i = 0; i < view.count; ++i) {
      TrackSample& s = element(track, i);
      if (per_speed_ > 0.0) speed = speeds.at(i).value_or(speed);
      const double usual = spread_ + per_distance_ * middle_.distance(s.position, context) + per_speed_ * speed;
      const double u = std::max(usual + scatter_ * random.normal_by_layers(), 0.1 * usual);
      s.visible = s.visible && u <= cut_;
      if (u > kSpreadOfFullConfidence) s.weight *= kSpreadOfFullConfidence / u;
    }
    return track;
  }

 private:
  Middle middle_;
  double cut_, spread_, per_distance_, per_speed_, scatter_, window_;
};

constexpr Descriptor kDescriptor = describe<ErrorCut>({
    .name = "error_cut",
    .version = "1.0",
    .doc = "Loses fast and far beads: a cut on the tracker's spread, which grows with distance and speed; before noise.",
    .equation = "u = spread + per_distance d + per_speed v + scatter n, kept where u <= cut",
    .parameters = kParameters,
    .hypotheses = kHypotheses,
});

}  // namespace
}  // namespace millscope::observations

MILLSCOPE_PLUGINS(&millscope::observations::kDescriptor)
