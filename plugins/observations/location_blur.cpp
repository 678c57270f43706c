// A location is made of events from a span of time, in which the bead moves on.
//
// symbol   here      meaning
// T        window_   the span, s
//
//   x'(t) = (1/T) ∫ x(t + s) ds,   s from −T/2 to T/2
//
// The path between samples is straight, and its integral exact. Near the ends of the track the window shrinks
// evenly on both sides. T = 0 leaves the track as it is. On a turning circle the radius shrinks by the factor sin(ωT/2)/(ωT/2).
#include <algorithm>
#include <array>
#include <vector>

#include "camera_view.hpp"

#include "millscope/element.hpp"

namespace millscope::observations {
namespace {

constexpr const char* kCitation = "Parker et al. 1993, Nucl. Instrum. Methods A 326, 592";

constexpr Parameter kParameters[] = {
    number_parameter("window", "s", 0.0, 0.0, 1.0, "Span of time from which the events of one location come; 0: none.", kCitation),
};

constexpr Hypothesis kHypotheses[] = {
    {"location_blur", "The camera's location window smears the path.", "x'(t) = (1/T) int x(t+s) ds", kCitation, "window", 0.0, 0.0, 0.02},
};

using Point = std::array<double, 3>;

/// The path and its integral from the first sample on, by straight lines, relative to the first point: a long track must not lose digits.
class Path {
 public:
  explicit Path(const TrackView& view) : view_(view), integral_(as_size(view.count)), per_second_(as_size(view.count)) {
    for (std::int64_t i = 1; i < view.count; ++i) {
      const double h = view.time[i] - view.time[i - 1];
      element(per_second_, i - 1) = 1.0 / h;
      for (std::size_t a = 0; a < 3; ++a) {
        const double* x = view.position[a];
        element(integral_, i)[a] = element(integral_, i - 1)[a] + h * (0.5 * (x[i] + x[i - 1]) - x[0]);
      }
    }
  }

  /// The last sample before `t` that has one behind it, sought from `i` on: a window's ends only move forward, or, shrinking, stand still.
  std::int64_t interval(std::int64_t i, double t) const {
    while (i + 2 < view_.count && view_.time[i + 1] <= t) ++i;
    return i;
  }

  /// Up to `t`, which lies in interval `i`.
  Point integral(std::int64_t i, double t) const {
    const double s = t - view_.time[i], half_share = 0.5 * s * element(per_second_, i);
    Point sum = element(integral_, i);
    for (std::size_t a = 0; a < 3; ++a) {
      const double* x = view_.position[a];
      sum[a] += s * (x[i] - x[0] + half_share * (x[i + 1] - x[i]));
    }
    return sum;
  }

 private:
  const TrackView& view_;
  std::vector<Point> integral_;
  std::vector<double> per_second_;
};

class LocationBlur {
 public:
  explicit LocationBlur(const Parameters& values) : window_(values.number("window")) {}

  Track observe(const TrackView& view, const TrackContext&) const {
    Track out = copy_of(view);
    if (window_ == 0.0 || view.count < 2) return out;
    if ((view.time[view.count - 1] - view.time[0]) / static_cast<double>(view.count - 1) > window_) {
      throw Refusal("the samples lie farther apart than the window; put location_blur before sampling, and record tracks more often");
    }
    const Path path(view);
    std::int64_t first = 0, last = 0;
    for (TrackSample& s : out) {
      const double half = std::min({0.5 * window_, s.time - view.time[0], view.time[view.count - 1] - s.time});
      if (half <= 0.0) continue;
      const double from = s.time - half, to = s.time + half;
      first = path.interval(first, from);
      last = path.interval(last, to);
      const Point before = path.integral(first, from), behind = path.integral(last, to);
      const double per_second = 1.0 / (to - from);
      for (std::size_t a = 0; a < 3; ++a) s.position[a] = view.position[a][0] + per_second * (behind[a] - before[a]);
    }
    return out;
  }

 private:
  double window_;
};

constexpr Descriptor kDescriptor = describe<LocationBlur>({
    .name = "location_blur",
    .version = "1.0",
    .doc = "Moving average of the path over the location window; before sampling.",
    .equation = "x'(t) = (1/T) int x(t+s) ds, s from -T/2 to T/2",
    .citation = kCitation,
    .parameters = kParameters,
    .hypotheses = kHypotheses,
});

}  // namespace
}  // namespace millscope::observations

MILLSCOPE_PLUGINS(&millscope::observations::kDescriptor)
