#include "studies/camera/estimate_camera.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kernel/base/error.hpp"
#include "studies/camera/estimate_parts.hpp"
#include "studies/inspect/mill_motion.hpp"
#include "studies/inspect/windows.hpp"

namespace millscope::camera {
namespace {

constexpr std::size_t kFewest = 200;

/// Middle of what a coordinate covers, without its outermost hundredths.
double middle_of(const recording::Recording& recording, std::size_t axis) {
  std::vector<double> all;
  for (const recording::Run& run : recording.runs) all.insert(all.end(), run.position[axis].begin(), run.position[axis].end());
  std::sort(all.begin(), all.end());
  return 0.5 * (all[all.size() / 100] + all[all.size() - 1 - all.size() / 100]);
}

/// As the user says, else from the beads that ride along the shell.
std::optional<std::array<Estimated, 2>> axis_of(const recording::Recording& recording, const EstimateOptions& options,
                                                const std::optional<recording::MillFrame>& frame) {
  if (frame) return std::array<Estimated, 2>{Estimated{frame->axis[0], 0}, Estimated{frame->axis[1], 0}};
  const inspect::MillMotion motion = options.motion != nullptr ? *options.motion : inspect::estimate_motion(recording);
  if (motion.sense == 0 || !motion.axis[0].estimate || !motion.axis[1].estimate) return std::nullopt;
  const auto with_error = [](const base::Interval90& x) { return Estimated{x.value, x.standard_error()}; };
  return std::array<Estimated, 2>{with_error(*motion.axis[0].estimate), with_error(*motion.axis[1].estimate)};
}

std::array<double, 3> middle_of(const recording::Recording& recording, const std::optional<std::array<Estimated, 2>>& axis,
                                const std::optional<recording::MillFrame>& frame) {
  const bool ends = frame && frame->high > frame->low;
  return {axis ? (*axis)[0].value : middle_of(recording, 0), axis ? (*axis)[1].value : middle_of(recording, 1),
          ends ? 0.5 * (frame->low + frame->high) : middle_of(recording, 2)};
}

/// Share that the reader has set aside as too far off.
Estimated outlier_share(const recording::Recording& recording) {
  double bad = 0, all = 0;
  for (const recording::Run& run : recording.runs) {
    bad += static_cast<double>(run.report.outliers + run.report.outside);
    all += static_cast<double>(run.report.outliers + run.report.outside + run.report.used);
  }
  return {bad / all, std::sqrt(std::max(bad, 1.0)) / all};
}

}  // namespace

double CameraLosses::kept(double distance, double speed) const {
  if (!found) return 1;
  return 0.5 * std::erfc(-(at_rest.value - per_distance.value * distance - per_speed.value * speed) / std::numbers::sqrt2);
}

CameraEstimate estimate_camera(const recording::Recording& recording, const EstimateOptions& options) {
  CameraEstimate e;
  for (const recording::Run& run : recording.runs) e.locations += run.size();
  if (e.locations < kFewest) {
    throw base::UserError(fmt::format("{}: {} locations are too few to tell the camera from; {} at least are needed",
                                      recording.file.string(), e.locations, kFewest));
  }
  const std::optional<recording::MillFrame> frame = options.frame ? options.frame : recording.frame;
  e.axis = axis_of(recording, options, frame);
  e.middle = middle_of(recording, e.axis, frame);
  const auto& slice = recording.condition.slice;
  if (slice) e.middle[2] = slice->middle();
  const camera::Middle middle{e.middle, slice ? slice->length() : 0};

  const double usual = inspect::median_interval(recording), pause = 30 * usual;
  const std::vector<camera::RateWindow> windows = camera::rate_windows(recording, middle, pause);
  camera::RateModel model = camera::estimate_rate(windows);
  camera::express_as_cut(model.loss, recording, middle, windows);
  e.loss = model.loss;
  // So long that chance would make a hundredth of such a pause in the whole recording, even at the lowest rate but a few.
  const double limit = std::max(2 * pause, std::log(100 * static_cast<double>(e.locations)) / model.lowest_rate);
  e.gaps = camera::estimate_gaps(recording, limit);
  // Locations that a coarse clock puts at one time are one row more of the file, which the reader sets aside.
  double duplicates = 0;
  for (const recording::Run& run : recording.runs) duplicates += static_cast<double>(run.report.duplicates);
  const double lost = 1 + duplicates / static_cast<double>(e.locations);
  e.sampling.rate = {lost * model.rate.value, lost * model.rate.error};
  camera::estimate_intervals(e.sampling, recording, model, pause);
  e.noise = camera::estimate_camera_noise(recording, middle, 6 * usual, options.most_stretches);
  e.outliers = outlier_share(recording);
  for (const camera::RateWindow& w : windows) e.seconds += w.seconds;
  return e;
}

}  // namespace millscope::camera
