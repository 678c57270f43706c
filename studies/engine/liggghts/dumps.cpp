#include "studies/engine/liggghts/dumps.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <map>
#include <optional>

#include "kernel/base/error.hpp"
#include "kernel/config/case.hpp"
#include "kernel/output/frames.hpp"
#include "kernel/output/tracks.hpp"
#include "kernel/run/pictures.hpp"
#include "studies/engine/liggghts/script.hpp"

namespace millscope::engine::liggghts {
namespace {

namespace fs = std::filesystem;
using base::UserError;

/// The beads of one frame, by number.
struct Frame {
  std::int64_t step = 0;
  std::vector<double> position, velocity, spin, radius, mass;
  std::vector<std::uint32_t> id, material;
};

constexpr const char* kFrameColumns = "ITEM: ATOMS id type x y z vx vy vz omegax omegay omegaz radius density";

void add_bead(const TextFile& in, const run::Assembly& a, Frame& frame) {
  const std::vector<double> row = in.numbers(13);
  if (row[0] != static_cast<double>(frame.id.size() + 1))
    in.fail(fmt::format("bead {} stands where {} is expected; beads must stand in the order of their numbers, without a gap", row[0],
                        frame.id.size() + 1));
  if (!(row[1] >= 1 && row[1] <= static_cast<double>(a.materials.size()) && row[1] == std::floor(row[1])))
    in.fail(fmt::format("type {} is none of the {} of the case", row[1], a.materials.size()));
  frame.id.push_back(static_cast<std::uint32_t>(frame.id.size()));
  frame.material.push_back(static_cast<std::uint32_t>(row[1]) - 1);
  frame.position.insert(frame.position.end(), row.begin() + 2, row.begin() + 5);
  frame.velocity.insert(frame.velocity.end(), row.begin() + 5, row.begin() + 8);
  frame.spin.insert(frame.spin.end(), row.begin() + 8, row.begin() + 11);
  frame.radius.push_back(row[11]);
  frame.mass.push_back(row[12] * config::sphere_volume(2 * row[11]));
}

Frame read_frame(const fs::path& file, const run::Assembly& a) {
  TextFile in(file);
  Frame frame;
  for (int line = 1; line <= 9; ++line) {
    if (!in.next()) in.fail("the frame is cut short; let LIGGGHTS run again");
    if (line == 2) frame.step = std::llround(in.numbers(1)[0]);
    if (line == 4 && in.numbers(1)[0] != static_cast<double>(a.bead_count))
      in.fail(fmt::format("holds {} beads of {}: LIGGGHTS has lost the others; take a smaller time step", in.text(), a.bead_count));
    if (line == 9 && in.text().substr(0, in.text().find_last_not_of(" \r") + 1) != kFrameColumns)
      in.fail("the columns are others than in.liggghts asks for");
  }
  while (in.next()) add_bead(in, a, frame);
  if (frame.id.size() != a.bead_count)
    in.fail(fmt::format("the frame is cut short after {} beads of {}; let LIGGGHTS run again", frame.id.size(), a.bead_count));
  return frame;
}

/// The steps of the frames that the case asks for.
std::vector<std::int64_t> steps_of_frames(const run::Assembly& a) {
  std::vector<std::int64_t> steps;
  if (!a.c.output.frames) return steps;
  const std::int64_t zero = zero_step(a), every = frame_every(a);
  for (std::int64_t step = (zero + frames_from(a) + every - 1) / every * every; step <= zero + a.end_step; step += every)
    steps.push_back(step);
  return steps;
}

/// A row of tracks.txt: number, place.
struct TrackRow {
  std::uint32_t id = 0;
  std::array<double, 3> place{};
};

/// The next instant of tracks.txt up to a step: rows by number; the step, or nothing at the end. What a killed run left half written lies
/// beyond that step.
std::optional<std::int64_t> next_instant(TextFile& in, std::int64_t until, std::vector<TrackRow>& rows) {
  if (!in.next()) return {};
  const auto line = [&] {
    if (!in.next()) in.fail("the tracks are cut short; let LIGGGHTS run again");
  };
  line();
  const std::int64_t step = std::llround(in.numbers(1)[0]);
  if (step > until) return {};
  line(), line();
  const auto count = static_cast<std::size_t>(in.numbers(1)[0]);
  for (int skipped = 0; skipped < 5; ++skipped) line();
  rows.clear();
  for (std::size_t i = 0; i < count; ++i) {
    line();
    const std::vector<double> row = in.numbers(4);
    rows.push_back({static_cast<std::uint32_t>(row[0]) - 1, {row[1], row[2], row[3]}});
  }
  return step;
}

}  // namespace

TextFile::TextFile(const fs::path& file) : file_(file), in_(file) {
  if (!in_) throw UserError(fmt::format("{}: cannot be read; run 'liggghts -in in.liggghts' in that folder first", file.string()));
}

bool TextFile::next() {
  ++line_;
  return static_cast<bool>(std::getline(in_, text_)) && !in_.eof();
}

void TextFile::fail(const std::string& what) const { throw UserError(fmt::format("{}:{}: {}", file_.string(), line_, what)); }

std::vector<double> TextFile::numbers(std::size_t count) const {
  std::vector<double> all;
  const char *at = text_.data(), *const end = at + text_.size();
  for (;;) {
    while (at < end && (*at == ' ' || *at == '\t' || *at == '\r')) ++at;
    if (at == end) break;
    double value = 0;
    const auto [behind, error] = std::from_chars(at, end, value);
    if (error != std::errc{} || !std::isfinite(value))
      fail(fmt::format("'{}' holds what is no finite number; the run has blown up, or the file is damaged", text_.substr(0, 60)));
    all.push_back(value);
    at = behind;
  }
  if (all.size() != count)
    fail(fmt::format("holds {} numbers, {} are expected; it belongs to another case, or is damaged", all.size(), count));
  return all;
}

std::vector<DataBead> beads_in(const fs::path& file) {
  TextFile in(file);
  std::vector<DataBead> beads;
  while (in.next() && in.text() != "Atoms") {
  }
  in.next();
  while (in.next() && !in.text().empty()) {
    const std::vector<double> row = in.numbers(7);
    beads.push_back({static_cast<std::uint32_t>(row[0]) - 1, row[2], row[3]});
  }
  return beads;
}

std::size_t write_frames(const fs::path& folder, const run::Assembly& a, const fs::path& to) {
  std::optional<output::FrameWriter> writer;
  const std::vector<std::int64_t> steps = steps_of_frames(a);
  for (const std::int64_t step : steps) {
    const fs::path file = folder / fmt::format("frame_{}.txt", step);
    const Frame frame = read_frame(file, a);
    if (frame.step != step) throw UserError(fmt::format("{}:2: is of step {}; let LIGGGHTS run again", file.string(), frame.step));
    if (!writer) writer = output::FrameWriter::create(to, {frame.id, frame.radius, frame.mass, frame.material, a.materials, {}, {}});
    output::FrameView view;
    view.time = static_cast<double>(frame.step - zero_step(a)) * a.time_step;
    if (const auto body = a.wall_body_of_mill()) {
      const dem::Motion& motion = a.system->bodies[static_cast<std::size_t>(*body)].motion;
      view.wall_angle = dem::pose_at(motion, view.time).angle;
      view.angular_velocity = dem::angular_speed(motion, view.time);
    }
    view.position = frame.position;
    view.velocity = frame.velocity;
    view.spin = frame.spin;
    writer->append(view);
  }
  if (writer) writer->close();
  return steps.size();
}

void write_pictures(const fs::path& post, const run::Assembly& a, const fs::path& to) {
  run::Pictures pictures(to);
  const std::int64_t zero = zero_step(a), every = picture_every(a);
  for (std::int64_t step = zero; step <= zero + a.end_step; step += every) {
    const Frame f = read_frame(post / fmt::format("picture_{}.txt", step), a);
    pictures.add(a, static_cast<double>(step - zero) * a.time_step, (step - zero) / every,
                 {f.id, f.material, f.radius, f.position, f.velocity, f.spin});
  }
}

void write_tracks(const fs::path& folder, const run::Assembly& a, const fs::path& to) {
  std::map<std::uint32_t, DataBead> of_id;
  for (const DataBead& bead : beads_in(folder / "beads.data")) of_id[bead.id] = bead;
  std::vector<TrackRow> rows;
  std::optional<output::TrackWriter> writer;
  std::vector<std::uint32_t> ids;
  const std::int64_t every = track_every(a);
  std::int64_t last = zero_step(a) - every;
  const auto add = [&](TextFile in, std::int64_t after, std::int64_t until) {
    while (const std::optional<std::int64_t> step = next_instant(in, until, rows)) {
      if (*step <= after) continue;
      if (*step - last > every) in.fail(fmt::format("no track stands from step {} to {}; let LIGGGHTS run in one go", last, *step));
      last = *step;
      if (!writer) {
        std::vector<output::TrackInfo> infos;
        for (const TrackRow& row : rows) {
          ids.push_back(row.id);
          infos.push_back({fmt::format("bead_{}", row.id), row.id, of_id[row.id].diameter, of_id[row.id].density, "simulation"});
        }
        writer = output::TrackWriter::create(to, infos);
      }
      std::vector<double> places;
      for (std::size_t i = 0; i < rows.size(); ++i) {
        if (i >= ids.size() || rows[i].id != ids[i])
          in.fail(fmt::format("bead {} stands where another is expected; let LIGGGHTS run again", rows[i].id + 1));
        for (int axis = 0; axis < 3; ++axis)
          places.push_back(dem::wrapped(a.system->settings(), axis, rows[i].place[static_cast<std::size_t>(axis)]));
      }
      if (rows.size() != ids.size())
        in.fail(fmt::format("{} beads of {}: LIGGGHTS has lost the others; take a smaller time step", rows.size(), ids.size()));
      writer->append(static_cast<double>(*step - zero_step(a)) * a.time_step, places);
    }
  };
  for (const Session& session : sessions_of(folder / "post", "tracks")) {
    // A run that was killed while the charge settled had no tracks yet.
    if (session.until <= zero_step(a) && !fs::exists(session.file)) continue;
    add(TextFile(session.file), session.after, session.until);
  }
  if (!writer) throw UserError(fmt::format("{}: holds no track; let LIGGGHTS run again", (folder / "post" / "tracks.txt").string()));
  writer->close();
}

}  // namespace millscope::engine::liggghts
