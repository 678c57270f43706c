#include "studies/analysis/open_source.hpp"

#include <fmt/format.h>

#include <fstream>

#include "kernel/base/hash.hpp"
#include "kernel/config/units.hpp"
#include "kernel/output/directory.hpp"
#include "kernel/output/summary.hpp"
#include "kernel/output/track_reader.hpp"
#include "studies/analysis/frames_source.hpp"
#include "studies/analysis/mill.hpp"
#include "studies/analysis/recording_source.hpp"
#include "studies/analysis/tracks_source.hpp"
#include "studies/recording/description.hpp"

namespace millscope::analysis {
namespace {

namespace fs = std::filesystem;
using base::UserError;

OpenedSource open_frames(const SourceRequest& request, MillOfCase mill) {
  const fs::path file = request.path / "frames.h5";
  OpenedSource opened;
  opened.meta.inputs.push_back({file.string(), file_hash(file)});
  opened.source = std::make_unique<FramesSource>(output::FrameReader(file), mill.context, request.from, request.to);
  opened.meta.source = "simulation";
  return opened;
}

/// What an import has to say of its frames (docs/import.md): notes, and whether a camera can see them.
void know_import(const fs::path& run, OpenedSource& opened) {
  const nlohmann::ordered_json summary = output::read_json(run / "summary.json");
  if (!summary.is_object() || !summary.contains("engine") || !summary["engine"].contains("notes")) return;
  for (const auto& note : summary["engine"]["notes"]) opened.meta.notes.push_back(note.get<std::string>());
  if (!fs::exists(run / "tracks.h5")) opened.meta.source = kCoarseFrames;
}

OpenedSource open_simulation(const SourceRequest& request, const host::Registry& registry) {
  const fs::path case_file = request.path / output::kResolvedCase;
  if (!fs::exists(case_file)) {
    throw UserError(fmt::format("{}: holds no {}; give the directory that 'millscope run CASE.yaml -o OUT' wrote, or a recording",
                                request.path.string(), output::kResolvedCase));
  }
  MillOfCase mill = read_mill_of_case(case_file, registry);
  const bool has_frames = fs::exists(request.path / "frames.h5"), has_tracks = fs::exists(request.path / "tracks.h5");
  if (!has_frames && !has_tracks) {
    throw UserError(
        fmt::format("{}: holds neither frames.h5 nor tracks.h5; run the case with 'output: {{frames: {{}}}}' or 'output: {{tracks: {{}}}}'",
                    request.path.string()));
  }
  const bool follow = !request.tracers.empty() || !has_frames;
  const std::vector<std::string> notes = mill.notes;
  const std::string name = mill.name;
  OpenedSource opened = follow ? open_tracks(request, std::move(mill)) : open_frames(request, std::move(mill));
  if (request.tracers.empty() && follow)
    opened.meta.notes.push_back("there is no frames.h5: the beads of tracks.h5 are followed instead of looking at all");
  opened.meta.notes.insert(opened.meta.notes.end(), notes.begin(), notes.end());
  know_import(request.path, opened);
  opened.meta.name = name;
  opened.meta.case_file = fs::absolute(case_file).lexically_normal().string();
  opened.meta.inputs.push_back({case_file.string(), file_hash(case_file)});
  return opened;
}

/// frames.h5 or tracks.h5 of a run stands for its directory.
SourceRequest as_directory(SourceRequest request) {
  const fs::path name = request.path.filename();
  const fs::path directory = request.path.has_parent_path() ? request.path.parent_path() : fs::path(".");
  if ((name != "frames.h5" && name != "tracks.h5") || !fs::exists(directory / output::kResolvedCase)) return request;
  if (name == "tracks.h5" && request.tracers.empty()) request.tracers = {"all"};
  request.path = directory;
  return request;
}

config::Range short_step() {
  config::Range range = config::positive("a mill's motion is lost in longer steps: give e.g. 1 ms");
  range.high = 0.1;
  return range;
}

}  // namespace

OpenedSource open_source(const SourceRequest& asked, const host::Registry& registry) {
  const SourceRequest request = as_directory(asked);
  if (request.from && request.to && !(*request.to > *request.from)) {
    throw UserError(fmt::format("--from {:.6g} --to {:.6g}: the span is empty; give --to later than --from", *request.from, *request.to));
  }
  std::error_code ignored;
  if (!fs::exists(request.path, ignored)) {
    throw UserError(
        fmt::format("{}: there is no such file or directory; give a directory of 'millscope run', a recording.yaml or a file of locations",
                    request.path.string()));
  }
  OpenedSource opened;
  if (fs::is_directory(request.path, ignored)) {
    opened = open_simulation(request, registry);
  } else {
    if (!request.tracers.empty()) {
      throw UserError(fmt::format("--tracer: {} is a recording, whose tracers are all used; leave it out", request.path.string()));
    }
    opened = open_recording(request, registry);
  }
  opened.meta.description = opened.source->description();
  return opened;
}

trajectory::TrajectoryOptions read_trajectory_options(const config::Node& section) {
  section.expect({"kind", "step", "gap_limit", "least_points", "noise", "noise_correlation", "low", "high"});
  trajectory::TrajectoryOptions options;
  if (const auto node = section.find("kind"))
    options.kind =
        config::read_choice(*node, "smoothing|cubic") == "cubic" ? trajectory::SplineKind::cubic : trajectory::SplineKind::smoothing;
  if (const auto node = section.find("step")) options.step = config::read_number(*node, "s", short_step());
  options.gap_limit = 0;  // 0: what the recording says
  if (const auto node = section.find("gap_limit")) options.gap_limit = config::read_number(*node, "s", recording::gap_limit_range());
  if (const auto node = section.find("least_points")) {
    options.least_points = static_cast<int>(config::read_integer(*node, config::between(4, 1e6, "a cubic needs four points")));
  }
  if (const auto node = section.find("noise")) options.noise.fill(config::read_number(*node, "m", config::positive()));
  if (const auto node = section.find("noise_correlation")) {
    options.noise_correlation = config::read_number(*node, "1", config::between(0, 0.9, "from one point to the next"));
  }
  const auto low = section.find("low"), high = section.find("high");
  if (low.has_value() != high.has_value()) (low ? *low : *high).fail("stands alone; give both ends of the range along z, 'low' and 'high'");
  if (low) {
    options.low = config::read_number(*low, "m");
    options.high = config::read_number(*high, "m");
    if (!(options.high > options.low))
      high->fail(fmt::format("is not above 'low', {:.6g} m; give the range along z that is kept", options.low));
  }
  return options;
}

std::string file_hash(const fs::path& file) {
  constexpr std::uint64_t kPart = 1U << 20U, kParts = 64;
  std::error_code ignored;
  const std::uint64_t size = fs::file_size(file, ignored);
  const bool whole = size <= kPart * kParts;
  std::ifstream in(file, std::ios::binary);
  base::Hash hash;
  std::vector<char> buffer(kPart);
  if (!whole) hash.add(&size, sizeof size);
  for (std::uint64_t part = 0; part < kParts; ++part) {
    if (!whole) in.seekg(static_cast<std::streamoff>(part * ((size - kPart) / (kParts - 1))));
    in.read(buffer.data(), static_cast<std::streamsize>(kPart));
    hash.add(buffer.data(), in.gcount());
    if (!in) break;
  }
  return hash.text();
}

}  // namespace millscope::analysis
