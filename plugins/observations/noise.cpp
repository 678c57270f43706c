// Noise of locations: one part is new in each location, one lasts for a while.
//
// symbol   here           meaning
// σ_w      white_         standard deviation of the white part at the rig's middle, per axis, m
// σ_c, τ   correlated_, correlation_time_   the part that decays as e^{−Δt/τ}, m and s
// γ        growth_        relative growth of both with the distance d from the rig's middle, 1/m
//
//   x' = x + (1 + γ d)(σ_w a + σ_c c(t)),   a, c of variance 1,   ⟨c(t) c(t + Δt)⟩ = e^{−|Δt|/τ}
//
// c is an Ornstein–Uhlenbeck process, stepped exactly over the uneven intervals. All σ = 0 leaves the track as it is.
#include "camera_view.hpp"

namespace millscope::observations {
namespace {

constexpr const char* kCitation = "Uhlenbeck & Ornstein 1930, Phys. Rev. 36, 823";

constexpr Parameter kParameters[] = {
    magnitudes_parameter("white", "m", "Standard deviation of the part that is new in each location, at the rig's middle."),
    magnitudes_parameter("correlated", "m", "Standard deviation of the part that lasts for the correlation time, at the rig's middle.",
                         kCitation),
    number_parameter("correlation_time", "s", 0.0, 0.0, 1000.0, "Time in which the correlated part falls to 1/e."),
    number_parameter("growth", "1/m", 0.0, 0.0, 1000.0, "Relative growth of both parts with the distance from the rig's middle."),
    kMiddleParameter,
};

class Noise {
 public:
  explicit Noise(const Parameters& values) : middle_(values), time_(values.number("correlation_time")), growth_(values.number("growth")) {
    std::copy_n(values.vector("white"), 3, white_);
    std::copy_n(values.vector("correlated"), 3, correlated_);
    const bool correlated = std::any_of(correlated_, correlated_ + 3, [](double s) { return s > 0.0; });
    if (correlated && time_ == 0.0) throw Refusal("correlated noise without correlation_time; give its time, e.g. 8 ms, or use white");
  }

  Track observe(const TrackView& view, const TrackContext& context) const {
    Track track = copy_of(view);
    Random random(context.seed);
    double c[3] = {random.normal_by_layers(), random.normal_by_layers(), random.normal_by_layers()};
    for (std::size_t i = 0; i < track.size(); ++i) {
      TrackSample& s = track[i];
      const double kept = i > 0 && time_ > 0.0 ? std::exp((track[i - 1].time - s.time) / time_) : 0.0;
      const double fresh = std::sqrt(1.0 - kept * kept);
      const double factor = 1.0 + growth_ * middle_.distance(s.position, context);
      for (int axis = 0; axis < 3; ++axis) {
        if (i > 0) c[axis] = kept * c[axis] + fresh * random.normal_by_layers();
        s.position[axis] += factor * (white_[axis] * random.normal_by_layers() + correlated_[axis] * c[axis]);
      }
    }
    return track;
  }

 private:
  Middle middle_;
  double white_[3], correlated_[3], time_, growth_;
};

constexpr Descriptor kDescriptor = describe<Noise>({
    .name = "noise",
    .version = "1.0",
    .doc = "White and correlated noise of each location, growing with the distance from the rig's middle.",
    .equation = "x' = x + (1 + growth d)(white a + correlated c(t)), <c(t) c(t+s)> = exp(-|s|/correlation_time)",
    .citation = kCitation,
    .parameters = kParameters,
});

}  // namespace
}  // namespace millscope::observations

MILLSCOPE_PLUGINS(&millscope::observations::kDescriptor)
