// A small case, made-up plugins and a way to catch messages.
#pragma once

#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "kernel/config/case.hpp"
#include "millscope/parameters.hpp"

namespace testing {

/// The message of the UserError that `body` throws; "" when it throws none.
template <class Body>
std::string message_of(Body&& body) {
  try {
    body();
  } catch (const millscope::base::UserError& e) {
    CHECK(e.exit_code() == 2);
    CHECK(std::string(e.what()).find('\n') == std::string::npos);
    return e.what();
  }
  return "";
}

/// A complete case, 20 lines.
inline const std::string kCase = R"(schema_version: 1
materials:
  glass: {density: 2500 kg/m^3, shear_modulus: 26 GPa, poisson_ratio: 0.23}
  hdpe: {density: 950, young_modulus: 0.88 GPa, poisson_ratio: 0.42, citation: "a book"}
  nylon: {density: 1100, shear_modulus: 0.76 GPa, poisson_ratio: 0.40}
groups: {liner: [hdpe, nylon]}
beads: {glass5: {material: glass, diameter: 5 mm}}
fill: {filling: 31.3 %, porosity: 0.37, vessel: {diameter: 300 mm, length: 20 mm}}
contact: {law: {kind: springs, stiffness: 1 kN/m}}
pairs:
  glass~glass: {restitution: 0.8, friction: 34 %}
  liner~glass: {restitution: 0.55}
  default: {restitution: 0.5}
body_forces: {gravity: {kind: pull}}
mill: {diameter: 300 mm, speed: 75 %critical, direction: counter_clockwise}
geometry:
  liner: {kind: tube, file: tube.stl, material: hdpe, motion: mill}
domain: {periodic: {z: [0, 20 mm]}}
time: {end_s: 4, analyze_from_s: 2.5}
output: {frames: {every_s: 10 ms}}
)";

/// kCase with the line that begins with `key` replaced.
inline std::string case_with(const std::string& key, const std::string& line) {
  const std::size_t begin = ("\n" + kCase).find("\n" + key);
  REQUIRE(begin != std::string::npos);
  std::string text = kCase;
  return text.replace(begin, text.find('\n', begin) - begin, line);
}

inline constexpr millscope::Parameter kSprings[] = {
    millscope::number_parameter("stiffness", "N/m", millscope::kRequired, 1, 1e9, "Spring constant."),
    millscope::choice_parameter("cap", "spring|sum", "spring", "What friction caps."),
    millscope::flag_parameter("allow_tension", false, "Attractive damping."),
    millscope::pair_parameter("restitution", "1", millscope::kRequired, 0.01, 1, "Ratio of normal speeds after and before."),
    millscope::pair_parameter("friction", "1", 0.3, 0, 10, "Coulomb's coefficient."),
};
inline constexpr millscope::Parameter kTube[] = {
    millscope::file_parameter("file", "Mesh file."),
    millscope::integer_parameter("repeat", 1, 1, 100, "Copies round the axis."),
    millscope::vector_parameter("shift", "m", 0, "Added to each vertex."),
    millscope::optional(millscope::number_parameter("turn", "rad", millscope::kRequired, -4, 4, "Angle.")),
    millscope::text_parameter("title", "tube", "A text."),
};
inline constexpr millscope::Parameter kPull[] = {
    millscope::number_parameter("acceleration", "m/s^2", 9.81, 0, 100, "Free fall."),
};

template <std::size_t N>
constexpr millscope::Descriptor descriptor(millscope::Kind kind, const char* name, const millscope::Parameter (&parameters)[N]) {
  millscope::Descriptor d{};
  d.kind = static_cast<std::uint32_t>(kind);
  d.name = name;
  d.doc = "";
  d.parameters = parameters;
  d.parameter_count = N;
  return d;
}
inline constexpr millscope::Descriptor kSpringsPlugin = descriptor(millscope::Kind::contact_law, "springs", kSprings);
inline constexpr millscope::Descriptor kTubePlugin = descriptor(millscope::Kind::geometry, "tube", kTube);
inline constexpr millscope::Descriptor kPullPlugin = descriptor(millscope::Kind::body_force, "pull", kPull);
inline constexpr const millscope::Descriptor* kPlugins[] = {&kSpringsPlugin, &kTubePlugin, &kPullPlugin};

/// Reads and finishes a case with the made-up plugins.
inline millscope::config::Case read_all(const std::string& text, const std::vector<std::string>& overrides = {}) {
  millscope::config::Case c = millscope::config::parse_case(text, "case.yaml", overrides);
  millscope::config::finish(c, kPlugins);
  return c;
}

inline std::string refusal(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return message_of([&] { read_all(text, overrides); });
}

}  // namespace testing
