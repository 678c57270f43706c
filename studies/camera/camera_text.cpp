// The estimate as a camera file.
#include <fmt/format.h>

#include <iterator>

#include "studies/camera/estimate_camera.hpp"

namespace millscope::camera {
namespace {

std::string text(const Estimated& e, double unit = 1) { return fmt::format("{:.3g} ± {:.2g}", e.value / unit, e.error / unit); }

std::string triple(const std::array<Estimated, 3>& e) {
  return fmt::format("[{:.3g}, {:.3g}, {:.3g}, mm]", 1e3 * e[0].value, 1e3 * e[1].value, 1e3 * e[2].value);
}

std::string errors(const std::array<Estimated, 3>& e) {
  return fmt::format("± {:.2g}, {:.2g}, {:.2g} mm", 1e3 * e[0].error, 1e3 * e[1].error, 1e3 * e[2].error);
}

std::string sampling_lines(const CameraEstimate& e) {
  return fmt::format(
      "  rate:    # {} /s before losses; evenness {}\n    kind: sampling\n    rate: {:.4g} Hz\n    dead_time: {:.3g} ms\n"
      "    shape: {:.3g}\n",
      text(e.sampling.rate), text(e.sampling.shape), e.sampling.rate.value, 1e3 * e.sampling.dead_time,
      e.sampling.shape.value - 1 < 2 * e.sampling.shape.error ? 1.0 : e.sampling.shape.value);
}

std::string cut_lines(const CameraLosses& loss) {
  if (!loss.found) return "  # error_cut: the rate depends neither on distance nor on speed\n";
  std::string kept;
  for (const double v : {0.0, 0.5, 1.0, 1.5, 2.0})
    kept += fmt::format(" {:.0f} % at {} m/s,", 100 * loss.kept(loss.typical_distance, v), v);
  kept.pop_back();
  return fmt::format(
      "  losses:  # at {:.0f} mm from the middle are kept{}\n"
      "           # P(kept) = Phi({} - {} /m d - {} s/m v)\n"
      "    kind: error_cut\n    cut: {:.4g} mm\n    spread: {:.4g} mm\n    per_distance: {:.4g}\n    per_speed: {:.4g} ms\n"
      "    scatter: {:.4g} mm\n",
      1e3 * loss.typical_distance, kept, text(loss.at_rest), text(loss.per_distance), text(loss.per_speed), 1e3 * loss.cut,
      1e3 * loss.spread, loss.spread_per_distance, 1e3 * loss.spread_per_speed, 1e3 * loss.scatter);
}

std::string noise_lines(const CameraNoise& n) {
  std::string out = fmt::format(
      "  noise:   # both parts together {} mm at {:.0f} mm from the middle, {} mm at {:.0f} mm; from {} stretches\n"
      "    kind: noise\n    white: {}    # {}\n",
      text(n.total_near, 1e-3), 1e3 * n.near, text(n.total_far, 1e-3), 1e3 * n.far, n.stretches, triple(n.white), errors(n.white));
  if (n.correlation_time.value > 0) {
    out += fmt::format("    correlated: {}    # {}\n    correlation_time: {:.3g} ms    # ± {:.2g} ms\n", triple(n.correlated),
                       errors(n.correlated), 1e3 * n.correlation_time.value, 1e3 * n.correlation_time.error);
  } else {
    out += "    # correlated: none is found\n";
  }
  return out + fmt::format("    growth: {:.3g}    # ± {:.2g} per m\n", n.growth.value, n.growth.error);
}

std::string gap_lines(const CameraGaps& g) {
  if (g.count == 0) return fmt::format("  # gaps: no pause beyond {:.2g} s; their rate is below {:.2g} /s\n", g.limit, g.rate.error);
  return fmt::format(
      "  gaps:    # {} pauses beyond {:.2g} s; {} /s of {} s\n    kind: gaps\n    rate: {:.3g} Hz\n    mean_length: {:.3g} s\n", g.count,
      g.limit, text(g.rate), text(g.mean_length), g.rate.value, g.mean_length.value);
}

constexpr double kTellingErrors = 3;  // standard errors of a loss with speed that is said

}  // namespace

std::string losses_text(const CameraLosses& loss, double speed) {
  if (!loss.found || loss.per_speed.value < kTellingErrors * loss.per_speed.error || !(speed > 0)) return "";
  // How many are kept at rest is not told by every recording; what speed does to it is.
  const auto of_rest = [&](double v) { return 100 * loss.kept(loss.typical_distance, v) / loss.kept(loss.typical_distance, 0); };
  return fmt::format(
      "its camera loses fast beads: of the locations that it keeps of a bead at rest it keeps {:.0f} % at the shell's {:.2g} m/s, {:.0f} % "
      "at twice that",
      of_rest(speed), speed, of_rest(2 * speed));
}

std::string camera_text(const CameraEstimate& e, const std::string& source) {
  std::string out = fmt::format(
      "# The camera of {}, estimated from {} locations in {:.0f} s of sight. Values ± standard errors.\nschema_version: 1\n"
      "observations:\n"
      "  # A recording does not tell its location window; it is about one over the rate:\n"
      "  # blur: {{kind: location_blur, window: {:.2g} ms}}\n",
      source, e.locations, e.seconds, 1e3 / e.sampling.rate.value);
  out += sampling_lines(e) + cut_lines(e.loss) + noise_lines(e.noise) + gap_lines(e.gaps);
  fmt::format_to(std::back_inserter(out),
                 "  outliers:    # share {}; how far they lie is not known\n    kind: outliers\n    fraction: {:.3g}\n", text(e.outliers),
                 e.outliers.value);
  if (e.axis) {
    const auto& [x, y] = *e.axis;
    fmt::format_to(
        std::back_inserter(out),
        "  frame:   # the mill's axis stands at ({}, {}) mm\n    kind: frame_error\n    offset_x: {:.3g} mm\n    offset_y: {:.3g} mm\n",
        text(x, 1e-3), text(y, 1e-3), 1e3 * x.value, 1e3 * y.value);
  } else {
    out += "  # frame: where the mill's axis lies in the camera's frame is not known\n";
  }
  return out;
}

}  // namespace millscope::camera
