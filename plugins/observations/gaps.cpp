// Times in which the camera has lost the bead.
//
// symbol   here           meaning
// f        rate_          gaps that begin per second of sight, 1/s
// T        mean_length_   mean length of a gap, s
//
// Sight and gaps follow each other, both exponentially distributed with means 1/f and T; the share of the time that is lost is
// f T/(1 + f T). f = 0 leaves the track as it is.
#include "camera_view.hpp"

namespace millscope::observations {
namespace {

constexpr Parameter kParameters[] = {
    number_parameter("rate", "Hz", 0.0, 0.0, 1000.0, "Gaps that begin per second of sight; 0: none."),
    number_parameter("mean_length", "s", 0.0, 0.0, 1e5, "Mean length of a gap; lengths are exponentially distributed."),
};

class Gaps {
 public:
  explicit Gaps(const Parameters& values) : rate_(values.number("rate")), mean_length_(values.number("mean_length")) {
    if (rate_ > 0.0 && mean_length_ == 0.0) throw Refusal("gaps without length; give mean_length, e.g. 0.9 s, or rate 0");
  }

  Track observe(const TrackView& view, const TrackContext& context) const {
    Track track = copy_of(view);
    if (rate_ == 0.0 || track.empty()) return track;
    Random random(context.seed);
    const double lost = rate_ * mean_length_ / (1.0 + rate_ * mean_length_);
    bool sees = random.uniform() >= lost;  // a camera that has been running for long
    double until = track.front().time + length(sees, random);
    for (TrackSample& s : track) {
      while (until < s.time) {
        sees = !sees;
        until += length(sees, random);
      }
      s.visible = s.visible && sees;
    }
    return track;
  }

 private:
  double length(bool sees, Random& random) const { return random.exponential() * (sees ? 1.0 / rate_ : mean_length_); }

  double rate_, mean_length_;
};

constexpr Descriptor kDescriptor = describe<Gaps>({
    .name = "gaps",
    .version = "1.0",
    .doc = "Times without any location, of exponentially distributed length.",
    .equation = "lost share = rate mean_length/(1 + rate mean_length)",
    .parameters = kParameters,
});

}  // namespace
}  // namespace millscope::observations

MILLSCOPE_PLUGINS(&millscope::observations::kDescriptor)
