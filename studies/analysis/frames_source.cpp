#include "studies/analysis/frames_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

#include "kernel/base/error.hpp"
#include "kernel/base/statistics.hpp"
#include "studies/analysis/times.hpp"

namespace millscope::analysis {
namespace {

using base::UserError;
using output::BeadField;

constexpr std::size_t kMostChunkBytes = 256U << 20U;  // of the arrays of one chunk
constexpr std::size_t kSurveyedFrames = 400;

constexpr double kOneFrame = 1;  // s that a frame alone stands for; shares and means do not feel it

/// x0 y0 z0 x1 … → three arrays of doubles.
void spread(const float* from, std::size_t count, double* x, double* y, double* z) {
  for (std::size_t i = 0; i < count; ++i) {
    x[i] = static_cast<double>(from[3 * i]);
    y[i] = static_cast<double>(from[3 * i + 1]);
    z[i] = static_cast<double>(from[3 * i + 2]);
  }
}

bool all_unknown(const std::vector<float>& values) {
  return std::all_of(values.begin(), values.end(), [](float value) { return std::isnan(value); });
}

/// values[i] = values[there[i]]
template <class T>
void keep(const std::vector<std::size_t>& there, std::vector<T>& values) {
  for (std::size_t i = 0; i < there.size(); ++i) values[i] = values[there[i]];
}

std::vector<const char*> texts(const std::vector<std::string>& names) {
  std::vector<const char*> all;
  for (const std::string& name : names) all.push_back(name.c_str());
  return all;
}

}  // namespace

struct FramesSource::Buffers : FrameSource::Scratch {
  FrameBlock block{};
  std::vector<float> raw;                                   ///< one frame
  std::array<std::array<std::vector<double>, 3>, 3> field;  ///< position, velocity, spin; x, y, z
  std::vector<double> weight, radius, mass;
  std::vector<std::int64_t> id, first;
  std::vector<std::size_t> there;  ///< the beads that are in one frame
  std::size_t frames = 0;          ///< that there is room for
};

FramesSource::FramesSource(output::FrameReader reader, AnalyzerContext context, std::optional<double> from, std::optional<double> to)
    : reader_(std::move(reader)), context_(context) {
  select(from, to);
  weigh();
  know_beads();
  const output::FrameScalars& s = reader_.scalars();
  const std::size_t walls = s.wall_names.size();
  for (std::size_t f = 0; walls > 0 && f < s.time.size(); ++f) {
    const auto row = s.wall_work.begin() + static_cast<std::ptrdiff_t>(f * walls);
    wall_work_.push_back(std::accumulate(row, row + static_cast<std::ptrdiff_t>(walls), 0.0));
  }
  channels_ = texts(s.dissipation_names);
  pairs_ = texts(s.impact_pairs);
  context_.has = kHasOmega | kHasPhase | kHasAllBeads;
  if (knows(BeadField::velocity)) context_.has |= kHasVelocity;
  if (knows(BeadField::spin)) context_.has |= kHasSpin;
  if (!s.wall_work.empty()) context_.has |= kHasWallWork;
  if (!s.dissipation.empty()) context_.has |= kHasDissipation;
  if (!s.impacts.empty()) context_.has |= kHasImpacts;
  context_.channel_count = static_cast<std::int64_t>(channels_.size());
  context_.channel_name = channels_.data();
  context_.impact_pair_count = static_cast<std::int64_t>(pairs_.size());
  context_.impact_bin_count = s.impact_edges.empty() ? 0 : static_cast<std::int64_t>(s.impact_edges.size()) - 1;
  context_.impact_pair = pairs_.data();
  context_.impact_energy_edge = s.impact_edges.data();
  context_.start = s.time[begin_];
  context_.end = s.time[end_ - 1];
  // The mean over the time, whatever the wall did between the frames: one at the moment of the start still tells of rest.
  const double span = context_.end - context_.start;
  context_.omega = span > 0 ? (s.wall_angle[end_ - 1] - s.wall_angle[begin_]) / span : s.angular_velocity[begin_];
}

void FramesSource::select(std::optional<double> from, std::optional<double> to) {
  const std::vector<double>& time = reader_.scalars().time;
  // A frame on the very edge belongs to it, whatever the rounding of its time.
  const double slack = time.size() > 1 ? 1e-6 * (time[1] - time[0]) : 0;
  const auto place = [&](double t) { return std::lower_bound(time.begin(), time.end(), t) - time.begin(); };
  begin_ = from ? place(*from - slack) : 0;
  end_ = to ? place(*to + slack) : time.size();
  if (end_ > begin_) return;
  if (time.empty()) {
    throw UserError(fmt::format("{}: holds no frame; run the case longer, or write frames more often", reader_.path().string()));
  }
  throw UserError(fmt::format("{}: no frame lies in the span asked for; its frames go from {:.6g} s to {:.6g} s", reader_.path().string(),
                              time.front(), time.back()));
}

/// What is known of one frame is known of all.
bool FramesSource::knows(BeadField field) const {
  std::vector<float> values(3 * reader_.beads().size());
  reader_.read(field, begin_, 1, values);
  return !all_unknown(values);
}

std::vector<std::string> FramesSource::notes() const {
  std::vector<std::string> notes;
  if (end_ == begin_ + 1)
    notes.push_back("there is one frame: the charge at one moment, without any error; what needs a change in time is undefined");
  return notes;
}

/// A frame stands for the time to the middles between it and its neighbours; a pause of more than 1.5 usual intervals breaks the run.
void FramesSource::weigh() {
  const std::vector<double>& time = reader_.scalars().time;
  std::vector<double> steps;
  for (std::size_t f = begin_ + 1; f < end_; ++f) steps.push_back(time[f] - time[f - 1]);
  const double usual = steps.empty() ? kOneFrame : base::quantile(steps, 0.5);
  share_.assign(time.size(), 0.0);
  piece_.assign(time.size(), 0);
  for (std::size_t f = begin_; f < end_; ++f) {
    const bool breaks = f > begin_ && time[f] - time[f - 1] > 1.5 * usual;
    piece_[f] = f > begin_ ? piece_[f - 1] + (breaks ? 1 : 0) : 0;
    const double before = f > begin_ && !breaks ? time[f] - time[f - 1] : usual;
    const bool ends = f + 1 == end_ || time[f + 1] - time[f] > 1.5 * usual;
    const double after = ends ? usual : time[f + 1] - time[f];
    share_[f] = 0.5 * (before + after);
  }
}

void FramesSource::know_beads() {
  const output::FrameBeads& beads = reader_.beads();
  double volume = 0;
  context_.charge_mass = context_.bead_radius = 0;
  for (std::size_t i = 0; i < beads.size(); ++i) {
    context_.charge_mass += beads.mass[i];
    context_.bead_radius += beads.radius[i] / static_cast<double>(beads.size());
    volume += 4.0 / 3.0 * std::numbers::pi * beads.radius[i] * beads.radius[i] * beads.radius[i];
    context_.largest_id = std::max<std::int64_t>(context_.largest_id, beads.id[i]);
  }
  context_.charge_count = static_cast<double>(beads.size());
  context_.bead_density = context_.charge_mass / volume;
  const std::vector<double>& there = reader_.scalars().mass_there;
  if (there.empty()) return;
  double mass = 0, share = 0;
  for (std::size_t f = begin_; f < end_; ++f) mass += share_[f] * there[f], share += share_[f];
  context_.charge_count *= mass / share / context_.charge_mass;
  context_.charge_mass = mass / share;
}

void FramesSource::want(std::uint64_t fields) {
  if ((fields & kHasSpin) == 0) context_.has &= ~static_cast<std::uint64_t>(kHasSpin);
}

double FramesSource::duration() const { return std::accumulate(share_.begin(), share_.end(), 0.0); }

void FramesSource::cut(double duration, std::size_t most) {
  const std::size_t frames = end_ - begin_, bytes = 13 * sizeof(double) * reader_.beads().size();
  const double span = share_[begin_] * static_cast<double>(frames);
  double parts = static_cast<double>(std::min(most, frames));
  if (duration > 0) parts = std::min(parts, std::max(1.0, std::floor(span / duration + 1e-6)));
  // Where that makes chunks too large for memory, they are smaller.
  const double fit = std::max(1.0, static_cast<double>(kMostChunkBytes) / static_cast<double>(bytes));
  parts = std::min(static_cast<double>(frames), std::max(parts, std::ceil(static_cast<double>(frames) / fit)));
  const auto count = static_cast<std::size_t>(parts);
  chunks_.clear();
  for (std::size_t c = 0; c < count; ++c) {
    const std::size_t first = begin_ + c * frames / count, last = begin_ + (c + 1) * frames / count;
    chunks_.push_back({first, last, c > 0 && piece_[first] == piece_[first - 1]});
  }
}

std::unique_ptr<FrameSource::Scratch> FramesSource::make_scratch() const { return std::make_unique<Buffers>(); }

void FramesSource::lay_out(Buffers& b, std::size_t frames) const {
  if (frames <= b.frames) return;
  const output::FrameBeads& beads = reader_.beads();
  const std::size_t count = beads.size();
  b.raw.resize(3 * count);
  for (std::size_t k = 0; k < b.field.size(); ++k) {
    if (k == 2 && (context_.has & kHasSpin) == 0) continue;
    for (auto& axis : b.field[k]) axis.resize(frames * count);
  }
  b.weight.resize(frames * count);
  b.radius.resize(frames * count);
  b.mass.resize(frames * count);
  b.id.resize(frames * count);
  b.first.resize(frames + 1);
  know_who(b, frames);
  b.frames = frames;
}

/// Every bead in every frame.
void FramesSource::know_who(Buffers& b, std::size_t frames) const {
  const output::FrameBeads& beads = reader_.beads();
  const std::size_t count = beads.size();
  for (std::size_t f = 0; f < frames; ++f) {
    b.first[f + 1] = static_cast<std::int64_t>((f + 1) * count);
    std::copy(beads.radius.begin(), beads.radius.end(), b.radius.begin() + static_cast<std::ptrdiff_t>(f * count));
    std::copy(beads.mass.begin(), beads.mass.end(), b.mass.begin() + static_cast<std::ptrdiff_t>(f * count));
    std::copy(beads.id.begin(), beads.id.end(), b.id.begin() + static_cast<std::ptrdiff_t>(f * count));
  }
}

/// Leaves out the beads that are not there, whose places are NaN.
void FramesSource::leave_out(Buffers& b, std::size_t frames) const {
  const std::vector<double>& x = b.field[0][0];
  b.there.clear();
  for (std::size_t f = 0, i = 0; f < frames; ++f) {
    for (const std::size_t end = (f + 1) * reader_.beads().size(); i < end; ++i) {
      if (!std::isnan(x[i])) b.there.push_back(i);
    }
    b.first[f + 1] = static_cast<std::int64_t>(b.there.size());
  }
  for (auto& field : b.field) {
    if (field[0].empty()) continue;
    for (auto& axis : field) keep(b.there, axis);
  }
  keep(b.there, b.weight);
  keep(b.there, b.radius);
  keep(b.there, b.mass);
  keep(b.there, b.id);
}

void FramesSource::fill(Buffers& b, std::size_t first, std::size_t last, bool goes_on) const {
  const std::size_t count = reader_.beads().size();
  const bool vary = !reader_.scalars().mass_there.empty();
  if (vary) know_who(b, last - first);
  for (std::size_t k = 0; k < b.field.size(); ++k) {
    if (b.field[k][0].empty()) continue;
    for (std::size_t f = first; f < last; ++f) {
      const std::size_t at = (f - first) * count;
      // A frame is one chunk of the file: one call reads it whole, and it is still in the cache when it is spread.
      reader_.read(static_cast<BeadField>(k), f, 1, b.raw);
      spread(b.raw.data(), count, &b.field[k][0][at], &b.field[k][1][at], &b.field[k][2][at]);
    }
  }
  for (std::size_t f = first; f < last; ++f) {
    const auto at = b.weight.begin() + static_cast<std::ptrdiff_t>((f - first) * count);
    std::fill_n(at, count, goes_on && f == first ? 0.0 : share_[f]);
  }
  if (vary) leave_out(b, last - first);
}

const FrameBlock& FramesSource::load(std::size_t number, Scratch& scratch) const {
  Buffers& b = static_cast<Buffers&>(scratch);
  std::size_t frames = 0;
  for (const Chunk& chunk : chunks_) frames = std::max(frames, chunk.last - chunk.first + 1);
  lay_out(b, frames);
  const Chunk& chunk = chunks_.at(number);
  const std::size_t first = chunk.first - (chunk.goes_on ? 1 : 0);
  fill(b, first, chunk.last, chunk.goes_on);
  const FrameBlock& block = view(b, first, chunk.last);
  b.block.duration = 0;
  for (std::size_t f = chunk.first; f < chunk.last; ++f) b.block.duration += share_[f];
  return block;
}

std::vector<BasicSeries> FramesSource::survey() const {
  BasicSeries series;
  Buffers b;
  lay_out(b, 1);
  const std::size_t stride = (end_ - begin_ + kSurveyedFrames - 1) / kSurveyedFrames;
  for (std::size_t f = begin_; f < end_; f += stride) {
    fill(b, f, f + 1, false);
    series.append(basics_of(view(b, f, f + 1)));
  }
  for (double& weight : series.weight) weight *= static_cast<double>(end_ - begin_) / static_cast<double>(series.size());
  return {series};
}

/// Frames first … last − 1 as they lie in the buffers.
const FrameBlock& FramesSource::view(Buffers& b, std::size_t first, std::size_t last) const {
  const output::FrameScalars& s = reader_.scalars();
  FrameBlock& block = b.block;
  block = {};
  block.has = context_.has;
  block.frame_count = static_cast<std::int64_t>(last - first);
  block.time = s.time.data() + first;
  block.piece = piece_.data() + first;
  block.omega = s.angular_velocity.data() + first;
  block.phase = s.wall_angle.data() + first;
  block.wall_work = wall_work_.empty() ? nullptr : wall_work_.data() + first;
  block.channel_count = static_cast<std::int64_t>(channels_.size());
  block.channel_name = channels_.data();
  block.dissipation = s.dissipation.empty() ? nullptr : s.dissipation.data() + first * channels_.size();
  block.first = b.first.data();
  block.weight = b.weight.data();
  block.id = b.id.data();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    block.position[axis] = b.field[0][axis].data();
    block.velocity[axis] = (context_.has & kHasVelocity) != 0 ? b.field[1][axis].data() : nullptr;
    block.spin[axis] = (context_.has & kHasSpin) != 0 ? b.field[2][axis].data() : nullptr;
  }
  block.radius = b.radius.data();
  block.mass = b.mass.data();
  if (!s.impacts.empty()) {
    block.impact_pair_count = static_cast<std::int64_t>(pairs_.size());
    block.impact_bin_count = static_cast<std::int64_t>(s.impact_edges.size()) - 1;
    block.impacts = s.impacts.data() + first * pairs_.size() * (s.impact_edges.size() - 1);
    block.impact_pair = pairs_.data();
    block.impact_energy_edge = s.impact_edges.data();
  }
  return block;
}

std::string FramesSource::description() const {
  return fmt::format("{}: {} frames of {} beads, {:.6g} s to {:.6g} s", reader_.path().string(), end_ - begin_, reader_.beads().size(),
                     context_.start, context_.end);
}

}  // namespace millscope::analysis
