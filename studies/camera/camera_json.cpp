// The estimate as JSON: units in the names of the keys.
#include <nlohmann/json.hpp>

#include "studies/camera/estimate_camera.hpp"

namespace millscope::camera {
namespace {

using Json = nlohmann::ordered_json;

Json json(const Estimated& e, double unit = 1) { return {{"value", e.value / unit}, {"standard_error", e.error / unit}}; }

Json json(const std::array<Estimated, 3>& e, double unit) {
  return {{"x", json(e[0], unit)}, {"y", json(e[1], unit)}, {"z", json(e[2], unit)}};
}

Json losses(const CameraLosses& l) {
  Json kept;
  for (const double speed : {0.0, 0.5, 1.0, 1.5, 2.0})
    kept.push_back({{"speed_m_per_s", speed}, {"share", l.kept(l.typical_distance, speed)}});
  return {{"found", l.found},
          {"at_rest", json(l.at_rest)},
          {"per_distance_per_m", json(l.per_distance)},
          {"per_speed_s_per_m", json(l.per_speed)},
          {"typical_distance_m", l.typical_distance},
          {"kept", kept}};
}

}  // namespace

Json camera_json(const CameraEstimate& e) {
  Json out;
  out["locations"] = e.locations;
  out["seconds"] = e.seconds;
  out["rate_per_s"] = json(e.sampling.rate);
  out["evenness"] = json(e.sampling.shape);
  out["dead_time_ms"] = 1e3 * e.sampling.dead_time;
  out["noise"] = {{"white_mm", json(e.noise.white, 1e-3)},
                  {"correlated_mm", json(e.noise.correlated, 1e-3)},
                  {"correlation_time_ms", json(e.noise.correlation_time, 1e-3)},
                  {"growth_per_m", json(e.noise.growth)},
                  {"near_m", e.noise.near},
                  {"total_near_mm", json(e.noise.total_near, 1e-3)},
                  {"far_m", e.noise.far},
                  {"total_far_mm", json(e.noise.total_far, 1e-3)}};
  out["losses"] = losses(e.loss);
  out["gaps"] = {
      {"count", e.gaps.count}, {"limit_s", e.gaps.limit}, {"rate_per_s", json(e.gaps.rate)}, {"mean_length_s", json(e.gaps.mean_length)}};
  out["outliers"] = json(e.outliers);
  if (e.axis) out["axis_mm"] = {{"x", json((*e.axis)[0], 1e-3)}, {"y", json((*e.axis)[1], 1e-3)}};
  return out;
}

}  // namespace millscope::camera
