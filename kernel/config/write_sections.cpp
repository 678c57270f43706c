// The sections without plugins as resolved YAML.
#include <cmath>
#include <map>

#include "kernel/config/writer.hpp"
#include "kernel/config/yaml_lines.hpp"

namespace millscope::config {
namespace {

void write_rotation(Lines& out, const RotationCase& r) {
  out.open("rotation");
  out.value("speed", r.follows_mill ? "mill" : number_text(r.speed));
  out.value("axis", vector_text(r.axis));
  out.value("point", vector_text(r.point));
  out.value("start_s", r.start);
  out.value("ramp_s", r.ramp);
  if (r.ripple) {
    const std::string how_often =
        r.ripple->per_turn ? "per_turn: " + number_text(*r.ripple->per_turn) : "frequency: " + number_text(r.ripple->frequency);
    out.value("ripple",
              fmt::format("{{amplitude: {}, {}, phase: {}}}", number_text(r.ripple->amplitude), how_often, number_text(r.ripple->phase)));
  }
  out.close();
}

void write_translation(Lines& out, const TranslationCase& t) {
  out.open("translation");
  out.value("velocity", vector_text(t.velocity));
  if (t.frequency > 0) {
    out.value("oscillation", fmt::format("{{amplitude: {}, frequency: {}, phase: {}}}", vector_text(t.amplitude), number_text(t.frequency),
                                         number_text(t.phase)));
  }
  out.value("start_s", t.start);
  out.close();
}

std::string tracks_text(const OutputCase::Tracks& tracks) {
  std::string ids;
  for (const std::uint64_t id : tracks.ids) ids += fmt::format("{}{}", ids.empty() ? "" : ", ", id);
  const std::string beads = ids.empty() ? fmt::format("{}", tracks.count) : "[" + ids + "]";
  return fmt::format("beads: {}, every_s: {}", beads, number_text(tracks.every));
}

}  // namespace

void write_head(Lines& out, const Case& c) {
  out.value("schema_version", kSchemaVersion);
  out.value("name", quoted(c.name));
  out.value("seed", fmt::format("{}", c.seed));
  out.value("stiffness_factor", c.stiffness_factor);
}

void write_materials(Lines& out, const Case& c) {
  out.open("materials");
  for (const MaterialCase& m : c.materials) {
    out.open(m.name);
    out.value("density", m.density);
    out.value("young_modulus", m.young);
    out.value("poisson_ratio", m.poisson);
    if (!m.citation.empty()) out.value("citation", quoted(m.citation));
    out.close();
  }
  out.close();
  std::map<std::string, std::string> members;
  for (const auto& [material, group] : c.pairs.group_of()) members[group] += (members[group].empty() ? "" : ", ") + material;
  if (members.empty()) return;
  out.open("groups");
  for (const auto& [group, list] : members) out.value(group, "[" + list + "]");
  out.close();
}

void write_beads(Lines& out, const std::vector<BeadCase>& beads) {
  out.open("beads");
  for (const BeadCase& bead : beads) {
    out.open(bead.name);
    out.value("material", bead.material);
    out.value("density", bead.density);
    std::string list;
    for (const SizeClass& s : bead.sizes) {
      list += fmt::format("{}{{diameter: {}, fraction: {}}}", list.empty() ? "" : ", ", number_text(s.diameter),
                          number_text(s.number_fraction));
    }
    out.value("sizes", "[" + list + "]");
    out.value("fractions_by", "number");
    out.value("share", bead.number_share);
    if (bead.tracer) out.value("tracer", "true");
    out.close();
  }
  out.close();
}

void write_fill(Lines& out, const FillCase& f) {
  out.open("fill");
  if (f.count) out.value("count", fmt::format("{}", *f.count));
  if (f.mass) out.value("mass", *f.mass);
  if (f.filling) out.value("filling", *f.filling);
  if (!f.file.empty()) out.value("file", quoted(f.file));
  out.value("porosity", f.porosity);
  if (f.vessel)
    out.value("vessel", fmt::format("{{diameter: {}, length: {}}}", number_text(f.vessel->diameter), number_text(f.vessel->length)));
  if (f.region) out.value("region", fmt::format("{{low: {}, high: {}}}", vector_text(f.region->low), vector_text(f.region->high)));
  out.value("settle_s", f.settle);
  out.value("shares_by", "number");
  out.close();
}

void write_mill(Lines& out, const std::optional<MillCase>& mill) {
  if (!mill) return;
  out.open("mill");
  out.value("speed", std::fabs(mill->speed));
  if (mill->diameter) out.value("diameter", *mill->diameter);
  out.value("direction", mill->direction == Direction::clockwise ? "clockwise" : "counter_clockwise");
  out.close();
}

void write_motion(Lines& out, const MotionCase& m) {
  if (!m.rotation && !m.translation) return out.value("motion", "fixed");
  out.open("motion");
  if (m.rotation) write_rotation(out, *m.rotation);
  if (m.translation) write_translation(out, *m.translation);
  out.close();
}

void write_domain(Lines& out, const DomainCase& domain) {
  static constexpr const char* axes[] = {"x", "y", "z"};
  std::string low, high, periodic;
  const auto add = [](std::string& list, const char* axis, const std::string& text) {
    list += fmt::format("{}{}: {}", list.empty() ? "" : ", ", axis, text);
  };
  for (std::size_t i = 0; i < 3; ++i) {
    const std::string from = number_text(domain.box.low[i]), to = number_text(domain.box.high[i]);
    if (domain.periodic[i]) {
      add(periodic, axes[i], fmt::format("[{}, {}]", from, to));
      continue;
    }
    if (std::isfinite(domain.box.low[i])) add(low, axes[i], from);
    if (std::isfinite(domain.box.high[i])) add(high, axes[i], to);
  }
  out.open("domain");
  out.value("periodic", "{" + periodic + "}");
  out.value("low", "{" + low + "}");
  out.value("high", "{" + high + "}");
  out.close();
}

void write_time(Lines& out, const TimeCase& time) {
  out.open("time");
  out.value("end_s", time.end);
  out.value("analyze_from_s", time.analyze_from);
  if (time.step) {
    out.value("step_s", *time.step);
  } else {
    out.value("step_fraction", time.step_fraction);
  }
  out.close();
}

void write_start(Lines& out, const std::optional<StartCase>& start) {
  if (!start) return;
  out.open("start");
  out.value("run", quoted(start->run));
  out.value("develop_s", start->develop);
  if (start->walls_ahead) out.value("walls_ahead_s", *start->walls_ahead);
  out.close();
}

void write_output(Lines& out, const OutputCase& o) {
  const auto off_or = [&out](const char* key, bool on, const std::string& text) { out.value(key, on ? "{" + text + "}" : "off"); };
  out.open("output");
  off_or("series", o.series.has_value(), o.series ? "every_s: " + number_text(o.series->every) : "");
  off_or("frames", o.frames.has_value(),
         o.frames ? fmt::format("every_s: {}, from_s: {}", number_text(o.frames->every), number_text(o.frames->from)) : "");
  off_or("tracks", o.tracks.has_value(), o.tracks ? tracks_text(*o.tracks) : "");
  off_or("vtk", o.vtk.has_value(), o.vtk ? "every_s: " + number_text(o.vtk->every) : "");
  off_or("checkpoint", o.checkpoint.has_value(), o.checkpoint ? "every_wall_s: " + number_text(o.checkpoint->every_wall) : "");
  out.close();
}

void write_run(Lines& out, const RunCase& run) {
  out.open("run");
  out.value("threads", run.threads);
  if (run.partitions > 0) out.value("partitions", run.partitions);
  out.value("skin", run.skin);
  out.value("allow_unstable", run.allow_unstable ? "true" : "false");
  if (!run.engine.empty()) out.value("engine", run.engine);
  if (!run.engine.empty()) out.value("ranks", run.ranks);
  out.close();
}

}  // namespace millscope::config
