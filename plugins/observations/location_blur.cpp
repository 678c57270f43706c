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

/// The path and its integral from the first sample on, by straight lines.
class Path {
 public:
  explicit Path(const TrackView& view) : view_(view) {
    for (int axis = 0; axis < 3; ++axis) {
      std::vector<double>& sum = integral_[axis];
      sum.assign(as_size(view.count), 0.0);
      const double* x = view.position[axis];
      for (std::int64_t i = 1; i < view.count; ++i) {
        const auto at = as_size(i);
        // Relative to the first point: a long track must not lose digits.
        sum[at] = sum[at - 1] + (view.time[i] - view.time[i - 1]) * (0.5 * (x[i] + x[i - 1]) - x[0]);
      }
    }
  }

  /// The last sample before `t` that has one behind it, sought from `i` on: a window's ends only move forward, or, shrinking, stand still.
  std::int64_t interval(std::int64_t i, double t) const {
    while (i + 2 < view_.count && view_.time[i + 1] <= t) ++i;
    return i;
  }

  /// Over the time from one end to the other.
  struct End {
    std::int64_t interval;  ///< in which it lies
    double since;           ///< s, since that begins
    double share;           ///< of the interval
  };
  End end_at(std::int64_t i, double t) const {
    const double since = t - view_.time[i];
    return {i, since, since / (view_.time[i + 1] - view_.time[i])};
  }
  double mean(int axis, const End& from, const End& to, double per_second) const {
    return view_.position[axis][0] + (integral(axis, to) - integral(axis, from)) * per_second;
  }

 private:
  double integral(int axis, const End& end) const {
    const double* x = view_.position[axis] + end.interval;
    return element(integral_[axis], end.interval) + end.since * (x[0] - view_.position[axis][0] + 0.5 * end.share * (x[1] - x[0]));
  }

  TrackView view_;
  std::vector<double> integral_[3];
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
      const Path::End begin = path.end_at(first, from), end = path.end_at(last, to);
      const double per_second = 1.0 / (to - from);
      for (int axis = 0; axis < 3; ++axis) s.position[axis] = path.mean(axis, begin, end, per_second);
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
