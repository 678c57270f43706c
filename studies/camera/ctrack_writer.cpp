#include "studies/camera/ctrack_writer.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>

#include "kernel/config/units.hpp"

namespace millscope::camera {
namespace {

constexpr const char* kHeader = "\n\nSeparation=\n\nf(opt) :  0.500      \n\n\nFixed slices:    250 events/slice,    1 locations/slice\n\n";

/// JSON's quoting is also YAML's.
std::string quoted(const std::string& text) { return nlohmann::json(text).dump(); }

}  // namespace

std::string ctrack_text(const recording::Run& run) {
  std::string out = kHeader;
  for (std::size_t i = 0; i < run.size(); ++i) {
    const double u = run.spread.empty() ? 0.0 : run.spread[i];
    const std::int64_t events = run.events.empty() ? 0 : run.events[i];
    fmt::format_to(std::back_inserter(out), "{:12.4f} {:9.3f} {:9.3f} {:9.3f} {:9.3f}{:10.1f}{:10.2f}{:5d}\n", 1e3 * run.time[i],
                   1e3 * run.position[0][i], 1e3 * run.position[1][i], 1e3 * run.position[2][i], 1e3 * u, 0.0, 0.0, events);
  }
  return out;
}

recording::Run as_written(recording::Run run) {
  const auto round_to = [](std::vector<double>& values, double digits) {  // in ms or mm
    for (double& value : values) value = std::nearbyint(1e3 * value * digits) / digits / 1e3;
  };
  round_to(run.time, 1e4);
  for (auto& component : run.position) round_to(component, 1e3);
  run.spread.resize(run.size());
  round_to(run.spread, 1e3);
  run.events.resize(run.size());
  run.format = "ctrack";
  return run;
}

std::string recording_text(const std::vector<std::string>& files, const recording::Condition& c, const std::string& note) {
  std::string out = fmt::format("# {}\nfiles:\n", note);
  for (const std::string& file : files) out += fmt::format("  - {}\n", quoted(file));
  out += "format: ctrack\n";
  std::string condition;
  const auto number = [&condition](const char* key, const std::optional<double>& value, const char* unit) {
    if (value) condition += fmt::format("  {}: {}{}\n", key, config::number_text(*value), unit);
  };
  number("speed", c.speed, " rad/s");
  if (c.angular_velocity) condition += fmt::format("  direction: {}\n", *c.angular_velocity < 0 ? "clockwise" : "counter_clockwise");
  number("filling", c.filling, "");
  number("porosity", c.porosity, "");
  number("bead_diameter", c.bead_diameter, " m");
  number("bead_density", c.bead_density, " kg/m^3");
  if (c.tracer.diameter && c.tracer.density) {
    condition += fmt::format("  tracer: {{diameter: {} m, density: {} kg/m^3}}\n", config::number_text(*c.tracer.diameter),
                             config::number_text(*c.tracer.density));
  }
  number("mill_diameter", c.mill_diameter, " m");
  number("mill_length", c.mill_length, " m");
  if (c.slice) condition += fmt::format("  slice: [{} m, {} m]\n", config::number_text(c.slice->low), config::number_text(c.slice->high));
  if (c.power) {
    condition +=
        fmt::format("  power: {{value: {} W, sem: {} W}}\n", config::number_text(c.power->value), config::number_text(c.power->sem));
  }
  if (!c.geometry.empty()) condition += fmt::format("  geometry: {}\n", quoted(c.geometry.string()));
  return condition.empty() ? out : out + "condition:\n" + condition;
}

}  // namespace millscope::camera
