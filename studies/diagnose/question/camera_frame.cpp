#include "studies/diagnose/question/camera_frame.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <iterator>

#include "studies/camera/camera.hpp"
#include "studies/recording/description.hpp"

namespace millscope::diagnose {
namespace {

constexpr const char* kPlugin = "frame_error";
const std::string kPrefix = "camera.frame_error.";

}  // namespace

std::string camera_frame_parameter(const Nuisance& n) { return n.of_camera() ? n.path.substr(kPrefix.size()) : ""; }

std::string camera_frame_unit(const config::Node& node, const std::string& path, const host::Registry& registry) {
  const Descriptor& frame = *registry.find(Kind::observation, kPlugin, node.where()).descriptor;
  std::vector<std::string> names;
  for (std::uint64_t i = 0; i < frame.parameter_count; ++i) {
    if (path == kPrefix + frame.parameters[i].name) return frame.parameters[i].unit;
    names.emplace_back(frame.parameters[i].name);
  }
  node.fail(fmt::format("is nothing of the camera's frame, which alone may be doubted; write {} with one of {}", kPrefix + "NAME",
                        fmt::join(names, ", ")));
}

std::string camera_frame_text(const std::vector<std::pair<const Nuisance*, double>>& of) {
  std::string text = fmt::format("schema_version: 1\nobservations:\n  doubted_frame: {{kind: {}", kPlugin);
  for (const auto& [n, value] : of) fmt::format_to(std::back_inserter(text), ", {}: {:.4g}", camera_frame_parameter(*n), value);
  return text + "}\n";
}

void check_camera_frame(const Nuisance& n, const host::Registry& registry) {
  try {
    for (const double end : {n.low, n.high}) camera::parse_camera(camera_frame_text({{&n, end}}), "its camera", registry);
  } catch (const base::UserError& e) {
    throw base::UserError(n.where, fmt::format("nuisance '{}': {}", n.name, e.what()));
  }
}

void check_recorded_frames(const Question& question, const calibrate::Observer& observer) {
  for (const Nuisance& n : question.nuisances) {
    if (!n.of_camera()) continue;
    for (std::size_t c = 0; c < question.study.conditions.size(); ++c) {
      const calibrate::Condition& condition = question.study.conditions[c];
      if (!observer.recorded(c).of_tracks())
        throw base::UserError(n.where, fmt::format("nuisance '{}': no camera followed a bead in {}; leave the nuisance out", n.name,
                                                   condition.recording.string()));
      if (observer.turns_other_way(c))
        throw base::UserError(n.where, fmt::format("nuisance '{}' would change its sign in condition '{}': {} turns the other way than the "
                                                   "recording; give its mill.direction as recorded",
                                                   n.name, condition.name, question.study.base.string()));
      if (camera_frame_parameter(n).starts_with("offset_") && !recording::read_description(condition.recording).frame)
        throw base::UserError(n.where,
                              fmt::format("nuisance '{}': {} states no axis that could be doubted, it is found from the points; give "
                                          "'frame: {{axis: [x, y]}}' there, or leave the nuisance out",
                                          n.name, condition.recording.string()));
    }
  }
}

}  // namespace millscope::diagnose
