// The camera's frame is not the mill's: shifted, turned, stretched, and its clock goes wrong.
//
// symbol    here      meaning
// o         offset_   where the mill's origin appears, m
// R         turn_     rotation about x, then y, then z, by the angles α, β, γ (rad), right-handed
// ε         scale_    relative error of lengths: 0 for none
// κ         clock_    relative error of times: above 0 the recording lasts longer than it did
//
//   x' = (1 + ε) R x + o,   t' = (1 + κ) t
//
// All zero leaves the track as it is. Gravity in the camera's frame is turned by R, too: its angle from −y shows the tilt.
#include <array>
#include <numbers>

#include "camera_view.hpp"

namespace millscope::observations {
namespace {

constexpr Parameter kParameters[] = {
    number_parameter("offset_x", "m", 0.0, -10.0, 10.0, "Where the mill's axis appears along x."),
    number_parameter("offset_y", "m", 0.0, -10.0, 10.0, "Where the mill's axis appears along y."),
    number_parameter("offset_z", "m", 0.0, -10.0, 10.0, "Where the mill's origin appears along z."),
    number_parameter("tilt_x", "rad", 0.0, -std::numbers::pi, std::numbers::pi, "Rotation of the bead's path about x."),
    number_parameter("tilt_y", "rad", 0.0, -std::numbers::pi, std::numbers::pi, "Rotation about y."),
    number_parameter("tilt_z", "rad", 0.0, -std::numbers::pi, std::numbers::pi, "Rotation about z: the camera is not level."),
    number_parameter("scale", "1", 0.0, -0.99, 100.0, "Relative error of all lengths; 0: none."),
    number_parameter("clock", "1", 0.0, -0.99, 100.0, "Relative error of all times; above 0 everything seems slower. 0: none."),
};

constexpr Hypothesis kHypotheses[] = {
    {"axis_offset_x", "The mill's axis lies beside the camera's origin along x.", "x' = x + o_x", "", "offset_x", 0.0, -0.01, 0.01, "", 1},
    {"axis_offset_y", "The mill's axis lies beside the camera's origin along y.", "y' = y + o_y", "", "offset_y", 0.0, -0.01, 0.01, "", 1},
    {"tilt", "The camera is not level.", "x' = R(gamma) x", "", "tilt_z", 0.0, -0.1, 0.1, "", 1},
    {"scale", "The camera's scale is wrong.", "x' = (1 + e) x", "", "scale", 0.0, -0.02, 0.02, "", 1},
    {"clock", "The recording's clock is wrong.", "t' = (1 + k) t", "", "clock", 0.0, -0.02, 0.02, "", 1},
};

using Matrix = std::array<std::array<double, 3>, 3>;

/// R = R_z(γ) R_y(β) R_x(α).
Matrix rotation(double alpha, double beta, double gamma) {
  const double ca = std::cos(alpha), sa = std::sin(alpha), cb = std::cos(beta), sb = std::sin(beta), cg = std::cos(gamma),
               sg = std::sin(gamma);
  return {{{cg * cb, cg * sb * sa - sg * ca, cg * sb * ca + sg * sa},
           {sg * cb, sg * sb * sa + cg * ca, sg * sb * ca - cg * sa},
           {-sb, cb * sa, cb * ca}}};
}

class FrameError {
 public:
  explicit FrameError(const Parameters& values)
      : offset_{values.number("offset_x"), values.number("offset_y"), values.number("offset_z")},
        turn_(rotation(values.number("tilt_x"), values.number("tilt_y"), values.number("tilt_z"))),
        scale_(1.0 + values.number("scale")),
        clock_(1.0 + values.number("clock")) {}

  Track observe(const TrackView& view, const TrackContext&) const {
    Track track = copy_of(view);
    for (TrackSample& s : track) {
      s.time *= clock_;
      const double x[3] = {s.position[0], s.position[1], s.position[2]};
      for (std::size_t i = 0; i < 3; ++i) {
        s.position[i] = scale_ * (turn_[i][0] * x[0] + turn_[i][1] * x[1] + turn_[i][2] * x[2]) + offset_[i];
      }
    }
    return track;
  }

 private:
  std::array<double, 3> offset_;
  Matrix turn_;
  double scale_, clock_;
};

constexpr Descriptor kDescriptor = describe<FrameError>({
    .name = "frame_error",
    .version = "1.0",
    .doc = "The camera's frame against the mill's: offset of the axis, tilt, scale, clock.",
    .equation = "x' = (1 + scale) R(tilt) x + offset, t' = (1 + clock) t",
    .parameters = kParameters,
    .hypotheses = kHypotheses,
});

}  // namespace
}  // namespace millscope::observations

MILLSCOPE_PLUGINS(&millscope::observations::kDescriptor)
