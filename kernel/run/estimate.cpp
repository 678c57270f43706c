#include "kernel/run/estimate.hpp"

#include <algorithm>
#include <chrono>

#include "kernel/output/frames.hpp"
#include "kernel/run/progress.hpp"
#include "kernel/run/recorder.hpp"
#include "kernel/run/simulation.hpp"

namespace millscope::run {

std::uint64_t disk_estimate(const Assembly& a) {
  const config::OutputCase& o = a.c.output;
  double bytes = 4e6 + 2.0 * static_cast<double>(a.bead_count) * 500;  // two checkpoints
  const double end = a.c.time.end;
  if (o.frames) bytes += (end - o.frames->from) / o.frames->every * static_cast<double>(output::frame_bytes(a.bead_count));
  if (o.tracks) bytes += end / o.tracks->every * 32.0 * static_cast<double>(o.tracks->count);
  if (o.series) bytes += end / o.series->every * 280;
  if (o.vtk) {
    double triangles = 0;
    for (const GeometryUse& g : a.geometries) triangles += static_cast<double>(g.surface.triangle_count);
    bytes += end / o.vtk->every * (static_cast<double>(a.bead_count) * 72 + triangles * 60);
  }
  return static_cast<std::uint64_t>(std::min(bytes, 1e18));
}

Estimate estimate(const std::string& case_file, const host::Registry& registry, const RunOptions& options) {
  Assembly a = assemble(config::read_case(case_file, options.overrides), registry, {options.threads, options.instruction_set});
  Recorder::check(a);
  insert_beads(a);
  begin(a);
  Estimate e;
  e.beads = a.bead_count;
  e.time_step = a.time_step;
  e.rayleigh_fraction = a.time_step / a.rayleigh_time;
  e.contact_steps = a.hertz_contact_time / a.time_step;
  e.steps = a.end_step - a.first_step;
  e.partitions = a.system->settings().partitions;
  // A trial of this very case: half a second of stepping, the first rebuilds left out. A settling bed is as dense as a developed one.
  const auto warm = std::chrono::steady_clock::now();
  while (seconds_since(warm) < 0.2) a.system->advance();
  const auto start = std::chrono::steady_clock::now();
  std::int64_t steps = 0;
  for (; seconds_since(start) < 0.6; ++steps) a.system->advance();
  const double rate = static_cast<double>(steps) / seconds_since(start);
  e.particle_steps_per_s = rate * static_cast<double>(a.bead_count);
  e.wall_seconds = static_cast<double>(e.steps) / rate;
  e.memory_bytes = a.system->memory_bytes() + (40U << 20);
  e.disk_bytes = disk_estimate(a);
  return e;
}

}  // namespace millscope::run
