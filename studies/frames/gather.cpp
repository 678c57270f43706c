#include "studies/frames/gather.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kernel/base/error.hpp"

namespace millscope::frames {
namespace {

using base::UserError;
using base::Vector3;

constexpr double kLargestId = 4294967295.0;  // of frames.h5
constexpr double kSameRadius = 1e-3, kSameMass = 3 * kSameRadius;

constexpr const char* kNames[] = {"number", "type",   "x",      "y",      "z",    "velocity x", "velocity y", "velocity z",
                                  "spin x", "spin y", "spin z", "radius", "mass", "density",    "time"};

void require_finite(const Frame& frame) {
  for (std::size_t q = 0; q < kQuantities; ++q) {
    const std::vector<double>& values = frame.value[q];
    const auto bad = std::find_if(values.begin(), values.end(), [](double v) { return !std::isfinite(v); });
    if (bad == values.end()) continue;
    const auto i = static_cast<std::size_t>(bad - values.begin());
    const std::string bead = frame.has(kId) ? fmt::format("bead {}", frame.value[kId][i]) : "a bead";
    throw UserError(fmt::format("{}: {} of {} is {}; the simulation has blown up, or the file is damaged: leave this frame out of 'files'",
                                frame.place(i), kNames[q], bead, *bad));
  }
}

/// All three components, or none.
bool has_vector(const Frame& frame, Quantity first) {
  const int there = int{frame.has(first)} + int{frame.has(first + 1)} + int{frame.has(first + 2)};
  if (there == 1 || there == 2) {
    const char* what = first == kVelocityX ? "velocity" : "spin";
    throw UserError(
        fmt::format("{}: only {} of the three components of the {} are there; write all three, or none", frame.place(0), there, what));
  }
  return there == 3;
}

Vector3 vector_at(const Frame& frame, Quantity first, std::size_t i) {
  return {frame.value[first][i], frame.value[first + 1][i], frame.value[first + 2][i]};
}

void append(std::vector<double>& to, const Vector3& v) { to.insert(to.end(), v.begin(), v.end()); }

}  // namespace

void Gather::read() {
  const auto stream = read_frames(
      mill_.files, {.length = mill_.length_unit, .speed = mill_.velocity_unit, .spin = mill_.spin_unit.value_or(1), .types = types_});
  Frame frame;
  Beads beads;
  while (stream->next(frame)) {
    for (const std::string& name : frame.passed_over) {
      if (std::find(passed_over_.begin(), passed_over_.end(), name) == passed_over_.end()) passed_over_.push_back(name);
    }
    if (frame.count == 0) {
      ++read_, ++empty_;
      continue;
    }
    take_time(frame, beads);
    ++read_;
    spin_without_unit_ = spin_without_unit_ || frame.spin_without_unit;
    require_finite(frame);
    take_ids(frame, beads);
    take_kinds(frame);
    take_motion(frame, beads);
    walls_.look(beads, radius_, frame.place(0));
    if (has_velocity() || has_ids()) motion_.look(beads, radius_, walls_);
    least_ = spool_.size() == 0 ? beads.size() : std::min(least_, beads.size());
    most_ = std::max(most_, beads.size());
    spool_.add(beads);
  }
  if (spool_.size() == 0) throw UserError(fmt::format("{}: the files hold no bead in any of {} frames; check 'files'", mill_.file, read_));
  if (time_unknown_ && spool_.size() > 1)
    mill_.root.fail(
        "says no times, and the files say none; add 'time: {interval: 0.01 s}', between frames, or 'time: {step: 1e-6 s}' where their "
        "names "
        "or dumps number the program's steps");
  walls_.judge();
  if (!has_ids() && beads_vary())
    throw UserError(
        fmt::format("{}: frames hold {} to {} beads that have no numbers, so that none can be followed; write the id of the beads, or name "
                    "frames of equal number",
                    mill_.file, least_, most_));
  motion_.judge(has_ids());
  census_.sort();
}

void Gather::take_time(Frame& frame, Beads& beads) {
  const bool stated = mill_.time_step || mill_.interval;
  if (frame.time && stated && !frame.time_of_picture) {
    throw UserError(fmt::format("{}: the file says the time itself ({:.6g} s); leave 'step' and 'interval' out of 'time' in {}",
                                frame.place(0), *frame.time, mill_.file));
  }
  time_overruled_ = time_overruled_ || (frame.time && stated);
  if (frame.time && !stated) {
    beads.time = *frame.time;
  } else if (mill_.interval) {
    beads.time = static_cast<double>(read_) * *mill_.interval;
  } else if (mill_.time_step) {
    if (!frame.step)
      throw UserError(fmt::format(
          "{}: neither the file nor its name numbers the program's steps, but 'time.step' in {} needs that; give 'time: {{interval: …}}'",
          frame.place(0), mill_.file));
    beads.time = static_cast<double>(*frame.step) * *mill_.time_step;
  } else {
    time_unknown_ = true;
    beads.time = static_cast<double>(read_);
  }
  if (beads.time < 0)
    throw UserError(
        fmt::format("{}: the time is {:.6g} s; times count from the start of the simulation, at 0", frame.place(0), beads.time));
  require_rising(frame, beads.time);
}

void Gather::require_rising(const Frame& frame, double time) const {
  if (spool_.size() == 0) return;
  const double before = spool_.time(spool_.size() - 1);
  if (time > before) return;
  throw UserError(
      fmt::format("{}: the time of this frame is {:.9g} s, that of the one before {:.9g} s; times must rise: is a frame there twice, or "
                  "does a second run begin here? Name files of one run",
                  frame.place(0), time, before));
}

void Gather::require_same(const Frame& frame, std::optional<bool>& first, bool now, const char* what) const {
  if (!first) first = now;
  if (*first == now) return;
  throw UserError(fmt::format("{}: this frame says {} {}, others before it {}; name files that say the same", frame.place(0),
                              now ? "a" : "no", what, now ? "none" : "one"));
}

void Gather::take_ids(const Frame& frame, Beads& beads) {
  require_same(frame, has_ids_, frame.has(kId), "number of the beads");
  beads.id.resize(frame.count);
  rows_.resize(frame.count);
  for (std::size_t i = 0; i < frame.count; ++i) {
    const double id = frame.has(kId) ? frame.value[kId][i] : static_cast<double>(i);
    if (!(id >= 0 && id <= kLargestId && id == std::floor(id)))
      throw UserError(fmt::format("{}: {} is no number of a bead; whole numbers from 0 to {:.0f} are", frame.place(i), id, kLargestId));
    beads.id[i] = static_cast<std::uint32_t>(id);
    bool known = false;
    rows_[i] = census_.row(beads.id[i], known);
    BeadKind& kind = census_[rows_[i]];
    if (known && kind.last_frame == read_)
      throw UserError(
          fmt::format("{}: bead {} stands in this frame a second time; each bead stands once: name files of one run, and write one row for "
                      "a bead, not for its contacts or spheres",
                      frame.place(i), id));
    kind.last_frame = read_;
    ++kind.frames;
  }
}

void Gather::take_motion(const Frame& frame, Beads& beads) {
  require_same(frame, has_velocity_, has_vector(frame, kVelocityX), "velocity");
  require_same(frame, has_spin_, has_vector(frame, kSpinX), "spin");
  beads.position.clear(), beads.velocity.clear(), beads.spin.clear();
  for (std::size_t i = 0; i < frame.count; ++i) {
    Vector3 place = mill_.placement.place(vector_at(frame, kX, i));
    if (mill_.periodic) place[2] -= mill_.length * std::floor(place[2] / mill_.length);
    append(beads.position, place);
    if (has_velocity()) append(beads.velocity, mill_.placement.turned(vector_at(frame, kVelocityX, i)));
    if (has_spin()) append(beads.spin, mill_.placement.turned(vector_at(frame, kSpinX, i)));
  }
}

double Gather::radius_of(const Frame& frame, std::size_t i, long long type) const {
  if (frame.has(kRadius)) {
    if (mill_.diameter_of_beads.node)
      mill_.diameter_of_beads.node->fail(
          fmt::format("is stated, but {} says the radius of each bead; leave one of them out", frame.file.string()));
    const double radius = frame.value[kRadius][i];
    if (!(radius > 0)) throw UserError(fmt::format("{}: the radius is {}; a bead has one above 0", frame.place(i), radius));
    return radius;
  }
  if (const auto diameter = mill_.diameter_of_beads.value(type, types_->word(type))) return 0.5 * *diameter;
  throw UserError(fmt::format("{}: no column says how large the beads are; write the radius, or add 'beads: {{diameter: 5 mm}}' to {}",
                              frame.place(i), mill_.file));
}

double Gather::density_of(const Frame& frame, std::size_t i, long long type, double radius) const {
  const bool said = frame.has(kDensity) || frame.has(kMass);
  if (said && mill_.density.node)
    mill_.density.node->fail(fmt::format("is stated, but {} says the {} of each bead; leave one of them out", frame.file.string(),
                                         frame.has(kDensity) ? "density" : "mass"));
  if (!said) {
    if (const auto density = mill_.density.value(type, types_->word(type))) return *density;
    throw UserError(fmt::format(
        "{}: no column says how heavy the beads are; write their mass or density, or add 'beads: {{density: 2500 kg/m^3}}' to {}",
        frame.place(i), mill_.file));
  }
  const double density =
      frame.has(kDensity) ? frame.value[kDensity][i] : frame.value[kMass][i] / (4.0 / 3.0 * std::numbers::pi * std::pow(radius, 3));
  if (!(density >= 25 && density <= 25000))
    throw UserError(fmt::format("{}: the density is {:.4g} kg/m^3, which no bead has; are its {} and its radius in SI units?",
                                frame.place(i), density, frame.has(kDensity) ? "density" : "mass"));
  return density;
}

void Gather::take_kinds(const Frame& frame) {
  radius_.resize(frame.count);
  for (std::size_t i = 0; i < frame.count; ++i) {
    BeadKind& kind = census_[rows_[i]];
    const auto type = frame.has(kType) ? std::llround(frame.value[kType][i]) : 0LL;
    const double radius = radius_[i] = radius_of(frame, i, type);
    if (kind.frames == 1) {
      kind.type = type;
      kind.radius = radius;
      kind.density = density_of(frame, i, type, radius);
    } else {
      watch_change(frame, i, kind, radius);
    }
  }
}

void Gather::watch_change(const Frame& frame, std::size_t i, BeadKind& kind, double radius) {
  const BeadKind before = kind;
  kind.radius = radius;
  if (frame.has(kMass) || frame.has(kDensity)) kind.density = density_of(frame, i, kind.type, radius);
  const bool radius_changes = std::fabs(radius - before.radius) > kSameRadius * before.radius;
  const bool mass_changes = std::fabs(kind.mass() - before.mass()) > kSameMass * before.mass();
  if (radius_changes && !has_ids())
    throw UserError(
        fmt::format("{}: the radius is {:.6g} m, and that of the bead in this place in the frame before {:.6g} m: the order of the beads "
                    "changes, and they have no numbers; write their id",
                    frame.place(i), radius, before.radius));
  changed_ += radius_changes ? 1 : 0, changed_mass_ += mass_changes ? 1 : 0;
  if (!radius_changes && !mass_changes) kind = before;
}

std::vector<std::string> Gather::notes() const {
  std::vector<std::string> notes;
  if (empty_ > 0) notes.push_back(fmt::format("{} of {} frames hold no bead and are left out", empty_, read_));
  if (beads_vary())
    notes.push_back(
        fmt::format("the number of beads changes, from {} to {} in a frame; {} different ones in all: each counts where it is there",
                    least_, most_, census_.beads().size()));
  if (!has_ids() && spool_.size() > 1)
    notes.emplace_back(
        "the beads have no numbers: their order is taken to be the same in every frame, and what follows a bead (visits, circulation, "
        "ergodicity) rests on that");
  if (changed_ > 0) notes.push_back(fmt::format("the radius of a bead changes {} times; the last one counts, for all frames", changed_));
  if (changed_mass_ > 0)
    notes.push_back(fmt::format("the mass of a bead changes {} times; the last one counts, for all frames", changed_mass_));
  if (walls_.outside() > 0)
    notes.push_back(fmt::format(
        "up to {} beads in a frame have their centres outside the mill that is stated; they are kept, and maps tell them as outside",
        walls_.outside()));
  if (time_overruled_) notes.emplace_back("the files say times (TimeValue of VTK, or a .pvd); 'time' of mill.yaml goes before them");
  if (spin_without_unit_ && !mill_.spin_unit)
    notes.emplace_back("the table names no unit of the spin: it is taken for rad/s; state 'spin_unit' where it is deg/s or rpm");
  for (std::size_t t = 0; t < types_->words().size(); ++t)
    notes.push_back(fmt::format("type '{}' is {} in the run", types_->words()[t], material_name(static_cast<long long>(t) + 1)));
  if (time_unknown_) notes.emplace_back("the file says no time: it is taken for 0");
  if (!passed_over_.empty()) notes.push_back(fmt::format("passed over: {}", fmt::join(passed_over_, ", ")));
  return notes;
}

}  // namespace millscope::frames
