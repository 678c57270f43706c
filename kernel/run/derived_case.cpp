#include "kernel/run/derived_case.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "kernel/output/stl.hpp"

namespace millscope::run {
namespace {

namespace fs = std::filesystem;

constexpr double kSame = 1e-6;        // of the period
constexpr double kFrameEvery = 0.02;  // s

/// A node as a file would have it; JSON is also YAML.
config::Node node_of(const nlohmann::json& values, const fs::path& file) { return config::parse_document(values.dump(), file.string()); }

/// Whether a surface reaches from one end of the period along z to the other, and so goes on there.
bool goes_on(const Surface& surface, const config::DomainCase& domain) {
  if (!domain.periodic[2]) return false;
  double low = surface.vertices[2], high = low;
  for (std::uint64_t v = 0; v < surface.vertex_count; ++v)
    low = std::min(low, surface.vertices[3 * v + 2]), high = std::max(high, surface.vertices[3 * v + 2]);
  const double period = domain.box.high[2] - domain.box.low[2];
  return std::fabs(high - low - period) < kSame * period;
}

}  // namespace

void put_mesh_in_place(const Triangles& triangles, config::PluginInstance& plugin, const config::DomainCase& domain,
                       const fs::path& folder) {
  const fs::path file = fs::absolute(folder / (plugin.name + ".stl")).lexically_normal();
  output::write_stl(file, triangles.surface, triangles.slots);
  nlohmann::json values{{"file", file.string()}, {"unit", "m"}};
  if (goes_on(triangles.surface, domain)) values["period"] = domain.box.high[2] - domain.box.low[2];
  plugin.kind = "mesh";
  plugin.node = node_of(values, folder / "case.yaml");
}

void fill_by_count(config::Case& c, std::uint64_t beads) {
  if (!c.fill.file.empty()) return;
  c.fill.count = beads;
  c.fill.filling.reset(), c.fill.mass.reset();
}

void write_frames_for_means(config::Case& c) {
  c.output.frames.emplace();
  c.output.frames->every = kFrameEvery, c.output.frames->from = c.time.analyze_from;
  c.output.tracks.reset(), c.output.vtk.reset();
}

}  // namespace millscope::run
