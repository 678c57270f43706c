#include "studies/frames/write_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernel/base/error.hpp"
#include "kernel/base/statistics.hpp"
#include "kernel/output/frames.hpp"
#include "kernel/output/series.hpp"
#include "kernel/output/tracks.hpp"
#include "studies/analysis/results.hpp"

namespace millscope::frames {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kTracked = 48;       // beads, evenly over their numbers
constexpr double kTrackStep = 0.0005;      // s, at most: what a camera takes
constexpr std::size_t kFewestTracked = 4;  // frames
constexpr double kSlack = 1.05;            // of an interval, for uneven dumps

/// One frame with a place for every bead of the census, in its order; NaN where one is not there.
struct Dense {
  double time = 0;
  std::vector<double> position, velocity, spin;
  std::vector<char> there;
};

std::vector<double> intervals(const Spool& spool) {
  std::vector<double> steps;
  for (std::size_t f = 1; f < spool.size(); ++f) steps.push_back(spool.time(f) - spool.time(f - 1));
  return steps;
}

double mean_radius(const Census& census) {
  double sum = 0;
  for (const BeadKind& bead : census.beads()) sum += bead.radius / static_cast<double>(census.beads().size());
  return sum;
}

class Writer {
 public:
  Writer(const WriteRequest& request, Written& written) : r_(request), census_(request.gathered.census()), w_(written) {
    choose_velocities();
    open_frames();
    open_tracks();
    open_series();
  }

  void write() {
    Dense before, now = load(0), after;
    for (std::size_t f = 0; f < r_.gathered.spool().size(); ++f) {
      const bool last = f + 1 == r_.gathered.spool().size();
      if (!last) after = load(f + 1);
      if (w_.velocities == Velocities::differences) differ(f > 0 ? &before : nullptr, now, last ? nullptr : &after);
      add(now);
      if (f > 0) follow(before, now);
      before = std::move(now);
      now = std::move(after);
    }
    if (tracks_) {
      std::vector<double> places;
      for (const std::size_t b : followed_) places.insert(places.end(), &before.position[3 * b], &before.position[3 * b] + 3);
      tracks_->append(before.time, places);
      tracks_->close();
    }
    frames_->close();
    series_->close();
    const auto frames = static_cast<double>(r_.gathered.spool().size());
    w_.mass /= frames, w_.count /= frames;
  }

 private:
  void choose_velocities() {
    Gather& g = r_.gathered;
    std::vector<double> steps = intervals(g.spool());
    w_.interval = steps.empty() ? 0 : base::quantile(steps, 0.5);
    w_.longest = steps.empty() ? 0 : *std::max_element(steps.begin(), steps.end());
    if (g.has_velocity()) w_.velocities = Velocities::files;
    const bool near = g.stride() > 0 && g.stride() < mean_radius(census_);
    if (!g.has_velocity() && near) w_.velocities = Velocities::differences;
  }

  void open_frames() {
    std::vector<std::uint32_t> id, material;
    std::vector<double> radius, mass;
    std::vector<long long> types;
    std::vector<std::string> names;
    for (const BeadKind& bead : census_.beads()) types.push_back(bead.type);
    std::sort(types.begin(), types.end());
    types.erase(std::unique(types.begin(), types.end()), types.end());
    for (const long long type : types) names.push_back(material_name(type));
    for (const BeadKind& bead : census_.beads()) {
      id.push_back(bead.id);
      radius.push_back(bead.radius);
      mass.push_back(bead.mass());
      material.push_back(static_cast<std::uint32_t>(std::lower_bound(types.begin(), types.end(), bead.type) - types.begin()));
    }
    output::BeadTable table{id, radius, mass, material, names, {}, {}};
    table.beads_vary = r_.gathered.beads_vary();
    frames_ = output::FrameWriter::create(r_.folder / "frames.h5", table);
  }

  /// Why no bead can be followed; "" where some can.
  std::string why_none(std::size_t always) const {
    const double most = kSlack * analysis::kCameraInterval;
    const std::size_t frames = r_.gathered.spool().size();
    if (frames == 1) return "it has one frame";
    if (w_.interval > most) return fmt::format("its frames are {:.3g} ms apart", 1e3 * w_.interval);
    if (w_.longest > most) return fmt::format("its frames pause for {:.3g} ms, where a bead's way is not known", 1e3 * w_.longest);
    if (!r_.gathered.has_ids()) return "its beads have no numbers";
    if (w_.velocities == Velocities::none) return "it has no velocities";
    if (frames < kFewestTracked) return fmt::format("it has {} frames, and a track needs {}", frames, kFewestTracked);
    return always == 0 ? "no bead is in all of its frames" : "";
  }

  /// The beads that are in every frame, where frames are near enough.
  void open_tracks() {
    std::vector<std::size_t> always;
    for (std::size_t b = 0; b < census_.beads().size(); ++b) {
      if (census_.beads()[b].frames == r_.gathered.spool().size()) always.push_back(b);
    }
    if (w_.no_tracks = why_none(always.size()); !w_.no_tracks.empty()) return;
    const std::size_t count = std::min(kTracked, always.size());
    std::vector<output::TrackInfo> infos;
    for (std::size_t i = 0; i < count; ++i) {
      followed_.push_back(always[i * always.size() / count]);
      const BeadKind& bead = census_.beads()[followed_.back()];
      infos.push_back({fmt::format("bead_{}", bead.id), bead.id, 2 * bead.radius, bead.density, "simulation"});
    }
    tracks_ = output::TrackWriter::create(r_.folder / "tracks.h5", infos);
    w_.tracks = count;
  }

  void open_series() {
    std::vector<std::string> columns{"time_s"};
    if (w_.velocities != Velocities::none) columns.emplace_back("translational_energy_J");
    if (r_.gathered.has_spin()) columns.emplace_back("rotational_energy_J");
    columns.insert(columns.end(), {"power_com_W", "com_x_m", "com_y_m"});
    if (!r_.mill.periodic) columns.emplace_back("com_z_m");
    series_ = output::SeriesWriter::create(r_.folder / "series.csv", columns);
  }

  Dense load(std::size_t frame) {
    r_.gathered.spool().read(frame, beads_);
    const std::size_t all = census_.beads().size();
    Dense d;
    d.time = beads_.time;
    d.position.assign(3 * all, kNaN), d.velocity.assign(3 * all, kNaN), d.spin.assign(3 * all, kNaN), d.there.assign(all, 0);
    for (std::size_t i = 0; i < beads_.size(); ++i) {
      const std::size_t b = census_.row(beads_.id[i]);
      d.there[b] = 1;
      const auto take = [&](const std::vector<double>& from, std::vector<double>& to) {
        if (!from.empty()) std::copy_n(&from[3 * i], 3, &to[3 * b]);
      };
      take(beads_.position, d.position), take(beads_.velocity, d.velocity), take(beads_.spin, d.spin);
    }
    return d;
  }

  double along(double way, std::size_t k) const {
    return k == 2 && r_.mill.periodic ? way - r_.mill.length * std::round(way / r_.mill.length) : way;
  }

  /// Velocity from the places in the frames to either side, or the one that there is. Exact on a parabola, where both are there.
  /// A bead in neither has none, and counts as one that is not there.
  void differ(const Dense* before, Dense& now, const Dense* after) const {
    for (std::size_t i = 0; i < now.position.size(); ++i) {
      const bool left = before != nullptr && before->there[i / 3] != 0, right = after != nullptr && after->there[i / 3] != 0;
      if (now.there[i / 3] == 0) continue;
      if (!left && !right) {
        for (std::size_t k = 0; k < 3; ++k) now.position[i + k] = now.spin[i + k] = kNaN;
        now.there[i / 3] = 0;
        ++w_.alone;
        continue;
      }
      const double back = left ? now.time - before->time : 0, on = right ? after->time - now.time : 0;
      const double from = left ? along(now.position[i] - before->position[i], i % 3) / back : 0;
      const double to = right ? along(after->position[i] - now.position[i], i % 3) / on : 0;
      now.velocity[i] = left && right ? (from * on + to * back) / (back + on) : left ? from : to;
    }
  }

  void add(const Dense& d) {
    double mass = 0, count = 0, translation = 0, rotation = 0, centre[3] = {};
    for (std::size_t b = 0; b < d.there.size(); ++b) {
      if (d.there[b] == 0) continue;
      const BeadKind& bead = census_.beads()[b];
      const double m = bead.mass();
      mass += m, count += 1;
      for (std::size_t k = 0; k < 3; ++k) {
        centre[k] += m * d.position[3 * b + k];
        translation += 0.5 * m * d.velocity[3 * b + k] * d.velocity[3 * b + k];
        rotation += 0.2 * m * bead.radius * bead.radius * d.spin[3 * b + k] * d.spin[3 * b + k];
      }
    }
    if (count == 0)
      throw base::UserError(fmt::format(
          "{}: none of the beads at {:.6g} s is in a frame beside it, so that no difference of places says a velocity; leave that frame "
          "out, or let the program write velocities",
          r_.mill.file, d.time));
    for (double& c : centre) c /= mass;
    output::FrameView view;
    view.time = d.time;
    view.wall_angle = r_.turning.angle_at(d.time), view.angular_velocity = r_.turning.speed_at(d.time);
    view.position = d.position, view.velocity = d.velocity, view.spin = d.spin, view.mass = mass;
    frames_->append(view);
    const double power = mass * r_.mill.gravity * centre[0] * view.angular_velocity;
    std::vector<double> row{d.time};
    if (w_.velocities != Velocities::none) row.push_back(translation);
    if (r_.gathered.has_spin()) row.push_back(rotation);
    row.insert(row.end(), {power, centre[0], centre[1]});
    if (!r_.mill.periodic) row.push_back(centre[2]);
    series_->append(row);
    w_.mass += mass, w_.count += count;
    if (d.time < r_.analyze_from) return;
    run::Course& c = w_.course;
    if (c.centre.empty()) c.from = d.time;
    c.until = d.time;
    c.centre.push_back(power);
    if (w_.velocities != Velocities::none && r_.gathered.has_spin()) c.kinetic.push_back(translation + rotation);
    for (std::size_t k = 0; k < (r_.mill.periodic ? 2U : 3U); ++k) c.place[k].push_back(centre[k]);
  }

  /// The cubic with places and velocities of both frames, in even parts of at most kTrackStep, without its end.
  void follow(const Dense& from, const Dense& to) {
    if (!tracks_) return;
    const double h = to.time - from.time;
    const int parts = std::max(1, static_cast<int>(std::ceil(h / kTrackStep - 0.01)));
    for (int p = 0; p < parts; ++p) {
      const double s = static_cast<double>(p) / parts;
      std::vector<double> places;
      for (const std::size_t b : followed_) {
        for (std::size_t k = 0; k < 3; ++k) {
          const std::size_t i = 3 * b + k;
          const double way = along(to.position[i] - from.position[i], k), begin = h * from.velocity[i], end = h * to.velocity[i];
          double x = from.position[i] + s * (begin + s * (3 * way - 2 * begin - end + s * (begin + end - 2 * way)));
          if (k == 2 && r_.mill.periodic) x -= r_.mill.length * std::floor(x / r_.mill.length);
          places.push_back(x);
        }
      }
      tracks_->append(from.time + s * h, places);
    }
  }

  const WriteRequest& r_;
  const Census& census_;
  Written& w_;
  Beads beads_;
  std::optional<output::FrameWriter> frames_;
  std::optional<output::TrackWriter> tracks_;
  std::optional<output::SeriesWriter> series_;
  std::vector<std::size_t> followed_;
};

}  // namespace

Written write_run(const WriteRequest& request) {
  Written written;
  Writer(request, written).write();
  return written;
}

std::vector<std::string> notes_of(const Written& w, const Gather& gathered) {
  std::vector<std::string> notes;
  const double radius = mean_radius(gathered.census());
  if (w.velocities == Velocities::differences)
    notes.push_back(fmt::format(
        "the files hold no velocities: they are differences of places {:.3g} ms apart, so that impacts are smoothed over {:.3g} ms",
        1e3 * w.interval, 2e3 * w.interval));
  if (w.velocities == Velocities::none) {
    const std::string why = w.interval == 0       ? "and one frame has no differences"
                            : !gathered.has_ids() ? "and beads without numbers cannot be followed"
                                                  : fmt::format(
                                                        "and in the {:.3g} ms between frames a bead in a hundred goes farther than {:.3g} "
                                                        "mm, more than its radius of {:.3g} mm; every {:.2g} ms would do",
                                                        1e3 * w.interval, 1e3 * gathered.stride(), 1e3 * radius,
                                                        1e3 * w.interval * radius / std::max(gathered.stride(), 1e-300));
    notes.push_back(fmt::format(
        "the files hold no velocities, {}: maps of velocity and all that needs them is left out; let the program write velocities", why));
  }
  if (w.alone > 0)
    notes.push_back(fmt::format(
        "{} times a bead is in one frame, and in neither beside it: it is left out there, since no difference says its velocity", w.alone));
  if (w.tracks == 0)
    notes.push_back(fmt::format("no virtual camera can be laid over this run ({}): it needs numbered beads with velocities every {:.3g} ms",
                                w.no_tracks, 1e3 * analysis::kCameraInterval));
  return notes;
}

}  // namespace millscope::frames
