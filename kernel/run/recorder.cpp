#include "kernel/run/recorder.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "kernel/run/wear.hpp"
#include "millscope/random.hpp"

namespace millscope::run {
namespace {

[[noreturn]] void refuse_tracks(const Assembly& a, const std::string& message) {
  a.c.root.at("output").at("tracks").at("beads").fail(message);
}

/// Ids of the beads that may be followed, in their order.
std::vector<std::uint32_t> followable(const Assembly& a) {
  const dem::Particles& p = a.system->particles;
  std::vector<std::uint32_t> ids;
  for (std::size_t i = 0; i < a.bead_count; ++i) {
    if (a.c.may_be_followed(p.position[i].radius, 1.0 / p.motion[i].inverse_mass)) ids.push_back(p.id[i]);
  }
  std::sort(ids.begin(), ids.end());
  return ids;
}

/// How many may be followed at least, whatever the filling makes of fractions of a bead.
std::uint64_t least_followable(const Assembly& a) {
  if (!a.c.has_tracers()) return a.bead_count;
  std::uint64_t count = 0;
  for (const config::BeadCase& bead : a.c.beads) {
    for (const config::SizeClass& size : bead.sizes) {
      if (a.c.may_be_followed(0.5 * size.diameter, bead.density * config::sphere_volume(size.diameter)))
        count += static_cast<std::uint64_t>(static_cast<double>(a.bead_count) * bead.number_share * size.number_fraction);
    }
  }
  return count;
}

void wrap(const dem::Settings& s, double* x) {
  for (int a = 0; a < 3; ++a) x[a] = dem::wrapped(s, a, x[a]);
}

}  // namespace

std::vector<std::uint32_t> tracked_beads(const Assembly& a) {
  const config::OutputCase::Tracks& t = *a.c.output.tracks;
  std::vector<std::uint32_t> ids;
  for (const std::uint64_t id : t.ids) ids.push_back(static_cast<std::uint32_t>(id));
  if (!ids.empty()) return ids;
  Random random(a.c.seed ^ 0x747261636b73ULL);  // another stream than the filling's
  std::vector<std::uint32_t> all = followable(a);
  if (t.count > all.size())
    throw base::UserError(
        fmt::format("output.tracks.count is {}, but {} beads may be followed; follow fewer, or add tracers", t.count, all.size()));
  for (std::size_t k = 0; k < t.count; ++k) {
    std::swap(all[k], all[k + random.below(all.size() - k)]);
    ids.push_back(all[k]);
  }
  std::sort(ids.begin(), ids.end());
  return ids;
}

void Recorder::check(const Assembly& a) {
  if (!a.c.output.tracks) return;
  const config::OutputCase::Tracks& t = *a.c.output.tracks;
  if (t.count > a.bead_count)
    refuse_tracks(a, fmt::format("asks for {} beads, but there are only {}; give at most that many", t.count, a.bead_count));
  if (t.ids.empty() && t.count > least_followable(a)) {
    refuse_tracks(a,
                  fmt::format("asks for {} beads, but there are only {} like those of the classes with 'tracer: true'; give at most that "
                              "many, or these classes a larger share",
                              t.count, least_followable(a)));
  }
  for (const std::uint64_t id : t.ids) {
    if (id >= a.bead_count)
      refuse_tracks(a, fmt::format("names bead {}, but ids run from 0 to {}; choose one of these", id, a.bead_count - 1));
  }
  const std::set<std::uint64_t> different(t.ids.begin(), t.ids.end());
  if (different.size() < t.ids.size()) refuse_tracks(a, "names a bead twice; name each once");
}

Recorder::Recorder(const Assembly& a, std::filesystem::path directory, std::optional<double> resume_time)
    : a_(a), directory_(std::move(directory)), sample_steps_(steps_of(kSampleInterval, a.time_step)) {
  take_beads();
  if (a.c.output.series) open_series(resume_time);
  if (a.c.output.frames) open_frames(resume_time);
  if (a.c.output.tracks) open_tracks(resume_time);
  if (a.c.output.vtk) {
    picture_steps_ = steps_of(a.c.output.vtk->every, a.time_step);
    pictures_.emplace(directory_ / "vtk", resume_time);
  }
}

void Recorder::take_beads() {
  const std::size_t n = a_.bead_count;
  const dem::Particles& p = a_.system->particles;
  ids_.resize(n);
  materials_.resize(n);
  radius_.resize(n);
  mass_.resize(n);
  position_.resize(3 * n);
  velocity_.resize(3 * n);
  spin_.resize(3 * n);
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t k = p.id[i];
    ids_[k] = p.id[i];
    materials_[k] = p.material[i];
    radius_[k] = p.position[i].radius;
    mass_[k] = 1.0 / p.motion[i].inverse_mass;
  }
}

void Recorder::open_series(std::optional<double> resume_time) {
  series_steps_ = steps_of(a_.c.output.series->every, a_.time_step);
  const std::vector<std::string> columns = series_columns(a_);
  const auto path = directory_ / "series.csv";
  series_ = resume_time ? output::SeriesWriter::resume(path, columns, *resume_time) : output::SeriesWriter::create(path, columns);
}

void Recorder::open_frames(std::optional<double> resume_time) {
  const config::OutputCase::Frames& frames = *a_.c.output.frames;
  frame_steps_ = steps_of(frames.every, a_.time_step);
  frame_from_ = std::llround(std::min(frames.from / a_.time_step, kMostSteps));
  const auto path = directory_ / "frames.h5";
  if (resume_time) {
    frames_ = output::FrameWriter::resume(path, a_.bead_count, *resume_time);
    return;
  }
  output::BeadTable table{ids_, radius_, mass_, materials_, a_.materials, {}, {}};
  for (const dem::Body& b : a_.system->bodies) table.wall_names.push_back(b.name);
  for (const dem::PairPhysics& pair : a_.system->physics()) {
    for (const std::string& channel : a_.system->layout().channels) table.dissipation_names.push_back(pair.name + ":" + channel);
    table.impact_pairs.push_back(pair.name);
  }
  for (int b = 0; b <= dem::ImpactBins::kCount; ++b) table.impact_edges.push_back(dem::ImpactBins::lower_edge(b));
  frames_ = output::FrameWriter::create(path, table);
}

void Recorder::open_tracks(std::optional<double> resume_time) {
  track_steps_ = steps_of(a_.c.output.tracks->every, a_.time_step);
  track_ids_ = tracked_beads(a_);
  std::vector<output::TrackInfo> infos;
  for (const std::uint32_t id : track_ids_) {
    const double volume = 4.0 / 3.0 * std::numbers::pi * radius_[id] * radius_[id] * radius_[id];
    infos.push_back({fmt::format("bead_{}", id), id, 2 * radius_[id], mass_[id] / volume, "simulation"});
  }
  const auto path = directory_ / "tracks.h5";
  tracks_ = resume_time ? output::TrackWriter::resume(path, infos, *resume_time) : output::TrackWriter::create(path, infos);
}

bool Recorder::wants(std::int64_t step) const {
  if (step < 0) return false;
  return (step >= a_.analyze_step && step % sample_steps_ == 0) || (series_steps_ > 0 && step % series_steps_ == 0) ||
         (frame_steps_ > 0 && step >= frame_from_ && step % frame_steps_ == 0) || (track_steps_ > 0 && step % track_steps_ == 0) ||
         (picture_steps_ > 0 && step % picture_steps_ == 0);
}

void Recorder::observe(const dem::System& system) {
  const std::int64_t step = system.step();
  const bool sampled = step >= a_.analyze_step && step % sample_steps_ == 0, row = series_steps_ > 0 && step % series_steps_ == 0;
  if (sampled || row) {
    const Sample s = take_sample(system, a_);
    if (sampled) {
      if (!window_start_) window_start_ = system.ledger();
      samples_.push_back(s);
    }
    if (row) write_series(s);
  }
  const bool frame = frame_steps_ > 0 && step >= frame_from_ && step % frame_steps_ == 0;
  const bool picture = picture_steps_ > 0 && step % picture_steps_ == 0;
  if (frame || picture) gather(system);
  if (frame) write_frame(system);
  if (picture)
    pictures_->add(a_, system.time(), system.step() / picture_steps_, {ids_, materials_, radius_, position_, velocity_, spin_}, &system);
  if (track_steps_ > 0 && step % track_steps_ == 0) write_tracks(system);
}

/// Power over the interval since the last row would depend on where a resumed run began: the present power of the walls does not.
void Recorder::write_series(const Sample& s) {
  const dem::Ledger ledger = a_.system->ledger();
  double power = 0;
  for (std::size_t b = 0; b < ledger.bodies.size(); ++b) {
    if (a_.system->bodies[b].motion.speed != 0) power += ledger.bodies[b].power;
  }
  series_->append(series_row(s, a_, power));
}

void Recorder::gather(const dem::System& system) {
  const dem::Particles& p = system.particles;
  for (std::size_t i = 0; i < p.position.size(); ++i) {
    const std::size_t k = 3 * static_cast<std::size_t>(p.id[i]);
    std::copy_n(p.position[i].centre, 3, &position_[k]);
    wrap(system.settings(), &position_[k]);
    system.velocity_at_step(static_cast<std::int64_t>(i), &velocity_[k], &spin_[k]);
  }
}

void Recorder::write_frame(const dem::System& system) {
  const dem::Ledger ledger = system.ledger();
  std::vector<double> work, dissipation;
  std::vector<std::uint64_t> impacts;
  for (const dem::BodyLedger& b : ledger.bodies) work.push_back(b.work);
  for (const dem::PairLedger& p : ledger.pairs) {
    dissipation.insert(dissipation.end(), p.dissipated.begin(), p.dissipated.end());
    for (const std::int64_t count : p.spectrum) impacts.push_back(static_cast<std::uint64_t>(count));
  }
  output::FrameView view;
  view.time = system.time();
  if (const std::optional<int> body = a_.wall_body_of_mill()) {
    const dem::Motion& motion = system.bodies[*body].motion;
    view.wall_angle = dem::pose_at(motion, view.time).angle;
    view.angular_velocity = dem::angular_speed(motion, view.time);
  }
  view.wall_work = work;
  view.dissipation = dissipation;
  view.impacts = impacts;
  view.position = position_;
  view.velocity = velocity_;
  view.spin = spin_;
  frames_->append(view);
}

void Recorder::write_tracks(const dem::System& system) {
  const dem::Particles& p = system.particles;
  if (indexed_rebuild_ != system.rebuilds()) {
    index_of_id_.resize(p.id.size());
    for (std::size_t i = 0; i < p.id.size(); ++i) index_of_id_[p.id[i]] = static_cast<std::uint32_t>(i);
    indexed_rebuild_ = system.rebuilds();
  }
  std::vector<double> position;
  for (const std::uint32_t id : track_ids_) {
    const dem::PositionLine& x = p.position[index_of_id_[id]];
    double c[3] = {x.centre[0], x.centre[1], x.centre[2]};
    wrap(system.settings(), c);
    position.insert(position.end(), c, c + 3);
  }
  tracks_->append(system.time(), position);
}

void Recorder::flush() {
  if (series_) series_->flush();
  if (frames_) frames_->flush();
  if (tracks_) tracks_->flush();
  if (!a_.c.contact.wear.empty()) write_wear(a_, directory_ / kWearFile);
}

void Recorder::close() {
  if (series_) series_->close();
  if (frames_) frames_->close();
  if (tracks_) tracks_->close();
}

}  // namespace millscope::run
