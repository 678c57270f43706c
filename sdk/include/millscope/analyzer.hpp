// Analyzer: from frames to results, in two pure steps.
//
// `accumulate` maps one block (the frames of a time span, or one circulation of a tracer) to named arrays that add up: counts, sums,
// sums of squares. `finish` turns such a sum into results with units. The host cuts the blocks, the same for every analyzer of a run,
// and resamples them, so that all results have one joint covariance. A recording is a run with one bead: the same code serves both.
#pragma once

#include "millscope/layout.hpp"

namespace millscope {

inline constexpr int kMaxRank = 3;

/// What a block of frames may lack.
enum FrameField : std::uint64_t {
  kHasVelocity = 1,
  kHasSpin = 2,
  kHasOmega = 4,
  kHasPhase = 8,
  kHasWallWork = 16,
  kHasDissipation = 32,
  kHasAllBeads = 64,    ///< every bead of the charge is in every frame; a recording has its tracer only
  kHasLocations = 128,  ///< the measured points behind the samples
  kHasImpacts = 256,    ///< counts of collisions by energy
};

/// One block. Frame f holds the samples first[f] … first[f+1]−1. Arrays of fields that are not in `has` are nullptr.
///
/// A block of a simulation is a span of time with all beads in every frame. A block of a recording, or of a simulated bead that is
/// followed, is a span of one bead's trajectory at even times, with one sample per frame; where the camera lost the bead the frames
/// lack, and `piece` changes.
///
/// Blocks of one stretch join without loss: the first frame of a block may be the last one of the block before it, with weight 0 (its time
/// counted there). Sums over samples do not feel it; differences between neighbouring frames (work, dissipation, collisions, entries
/// into a cell) then add up to those of the whole.
struct FrameBlock {
  std::uint64_t has;  ///< bits of FrameField
  double duration;    ///< s that the block stands for: the sum of the weights of one bead's samples
  std::int64_t frame_count;
  const double* time;               ///< per frame, s
  const std::int32_t* piece;        ///< per frame: equal numbers belong to one unbroken stretch of time
  const double* omega;              ///< per frame: Ω of the shell about z, rad/s
  const double* phase;              ///< per frame: angle of the shell, rad
  const double* wall_work;          ///< per frame: work done by the walls on the charge since the run's start, J
  const double* dissipation;        ///< per frame × channel: lost since the run's start, J
  std::int64_t channel_count;       ///< of dissipation
  const char* const* channel_name;  ///< "pair.channel", e.g. "glass~liner.sliding_friction"
  const std::int64_t* first;        ///< frame_count + 1 offsets
  const double* weight;             ///< per sample: dwell time of a tracer, s, or the frame's share of the block's duration
  const std::int64_t* id;           ///< per sample: permanent id of the bead
  const double* position[3];        ///< m
  const double* velocity[3];        ///< m/s
  const double* spin[3];            ///< rad/s
  const double* radius;             ///< m
  const double* mass;               ///< kg
  /// Per sample: variance that the measurement leaves in each component (mean of the three); nullptr: exact.
  const double* position_variance;  ///< m²
  const double* velocity_variance;  ///< (m/s)²
  /// The measured points in the span of the block, before any spline; in time order for each bead.
  std::int64_t location_count;
  const double* location_time;         ///< s
  const double* location_position[3];  ///< m
  const double* location_variance;     ///< per point: of each component, m²; nullptr: exact
  const std::int64_t* location_id;
  /// Collisions that ended since the run's start: per frame × pair × bin.
  const double* impacts;
  std::int64_t impact_pair_count, impact_bin_count;
  const char* const* impact_pair;    ///< "glass~liner"
  const double* impact_energy_edge;  ///< bins + 1, J
};
template <>
struct Layout<FrameBlock> {
  using S = FrameBlock;
  static constexpr Member members[] = {MILLSCOPE_MEMBER(S, has),
                                       MILLSCOPE_MEMBER(S, duration),
                                       MILLSCOPE_MEMBER(S, frame_count),
                                       MILLSCOPE_MEMBER(S, time),
                                       MILLSCOPE_MEMBER(S, piece),
                                       MILLSCOPE_MEMBER(S, omega),
                                       MILLSCOPE_MEMBER(S, phase),
                                       MILLSCOPE_MEMBER(S, wall_work),
                                       MILLSCOPE_MEMBER(S, dissipation),
                                       MILLSCOPE_MEMBER(S, channel_count),
                                       MILLSCOPE_MEMBER(S, channel_name),
                                       MILLSCOPE_MEMBER(S, first),
                                       MILLSCOPE_MEMBER(S, weight),
                                       MILLSCOPE_MEMBER(S, id),
                                       MILLSCOPE_MEMBER(S, position),
                                       MILLSCOPE_MEMBER(S, velocity),
                                       MILLSCOPE_MEMBER(S, spin),
                                       MILLSCOPE_MEMBER(S, radius),
                                       MILLSCOPE_MEMBER(S, mass),
                                       MILLSCOPE_MEMBER(S, position_variance),
                                       MILLSCOPE_MEMBER(S, velocity_variance),
                                       MILLSCOPE_MEMBER(S, location_count),
                                       MILLSCOPE_MEMBER(S, location_time),
                                       MILLSCOPE_MEMBER(S, location_position),
                                       MILLSCOPE_MEMBER(S, location_variance),
                                       MILLSCOPE_MEMBER(S, location_id),
                                       MILLSCOPE_MEMBER(S, impacts),
                                       MILLSCOPE_MEMBER(S, impact_pair_count),
                                       MILLSCOPE_MEMBER(S, impact_bin_count),
                                       MILLSCOPE_MEMBER(S, impact_pair),
                                       MILLSCOPE_MEMBER(S, impact_energy_edge)};
};

/// What is the same for all blocks; 0 where unknown.
struct AnalyzerContext {
  double mill_radius;          ///< of the bare shell, m
  double mill_low, mill_high;  ///< range along z, m
  double omega;                ///< mean Ω about z, rad/s; its sign is the turning sense
  double gravity;              ///< m/s², along −y
  double charge_mass;          ///< of all beads, kg
  double charge_count;         ///< number of all beads
  double bead_radius;          ///< mean, m
  double bead_density;         ///< mean, kg/m³
  double start, end;           ///< span that is analysed, s
  std::int64_t largest_id;     ///< ids are 0 … largest_id
  std::uint64_t has;           ///< fields that every block carries
  std::uint32_t is_recording;  ///< 1: one tracer of a real mill
  std::uint32_t is_periodic;   ///< 1: periodic along z
  double filling;              ///< J on the bare shell's volume
  double porosity;             ///< of the bed at rest, that goes with the filling
  /// As in every block; 0 and nullptr where the blocks have none. They live as long as the analyzer.
  std::int64_t channel_count;
  const char* const* channel_name;
  std::int64_t impact_pair_count, impact_bin_count;
  const char* const* impact_pair;
  const double* impact_energy_edge;  ///< bins + 1, J
  double mill_length;                ///< inner, m; also where the end faces are not known
};
template <>
struct Layout<AnalyzerContext> {
  using S = AnalyzerContext;
  static constexpr Member members[] = {MILLSCOPE_MEMBER(S, mill_radius),
                                       MILLSCOPE_MEMBER(S, mill_low),
                                       MILLSCOPE_MEMBER(S, mill_high),
                                       MILLSCOPE_MEMBER(S, omega),
                                       MILLSCOPE_MEMBER(S, gravity),
                                       MILLSCOPE_MEMBER(S, charge_mass),
                                       MILLSCOPE_MEMBER(S, charge_count),
                                       MILLSCOPE_MEMBER(S, bead_radius),
                                       MILLSCOPE_MEMBER(S, bead_density),
                                       MILLSCOPE_MEMBER(S, start),
                                       MILLSCOPE_MEMBER(S, end),
                                       MILLSCOPE_MEMBER(S, largest_id),
                                       MILLSCOPE_MEMBER(S, has),
                                       MILLSCOPE_MEMBER(S, is_recording),
                                       MILLSCOPE_MEMBER(S, is_periodic),
                                       MILLSCOPE_MEMBER(S, filling),
                                       MILLSCOPE_MEMBER(S, porosity),
                                       MILLSCOPE_MEMBER(S, channel_count),
                                       MILLSCOPE_MEMBER(S, channel_name),
                                       MILLSCOPE_MEMBER(S, impact_pair_count),
                                       MILLSCOPE_MEMBER(S, impact_bin_count),
                                       MILLSCOPE_MEMBER(S, impact_pair),
                                       MILLSCOPE_MEMBER(S, impact_energy_edge),
                                       MILLSCOPE_MEMBER(S, mill_length)};
};

/// One additive array.
struct ArrayInfo {
  const char* name;
  const char* unit;
  std::uint32_t rank;  ///< 0: one number
  std::uint32_t reserved;
  std::uint64_t shape[kMaxRank];
};
template <>
struct Layout<ArrayInfo> {
  using S = ArrayInfo;
  static constexpr Member members[] = {MILLSCOPE_MEMBER(S, name), MILLSCOPE_MEMBER(S, unit), MILLSCOPE_MEMBER(S, rank),
                                       MILLSCOPE_MEMBER(S, reserved), MILLSCOPE_MEMBER(S, shape)};
};

/// What the host must know of a result beyond its numbers. Bits of Result::traits.
///
/// The mirror image is that of a mill which turns the other way, seen from its other end: x → −x, Ω → −Ω. A result without one of the
/// bits kOdd … kCumulative is the same in it, as powers and angles in the turning sense are.
enum ResultTrait : std::uint32_t {
  kBookkeeping = 1,   ///< how much data there are, or how sure something is: follows the length of a run; never compared
  kOdd = 2,           ///< changes its sign in the mirror image: a component along x, what carries the sign of Ω
  kFirstOdd = 4,      ///< of three components x, y, z the first does
  kAlongX = 8,        ///< edges or centres along x: reversed and negated in the mirror image, and with them the cells along this axis
  kCumulative = 16,   ///< a share below each edge; along x the mirror image has the share above it
  kShare = 32,        ///< between 0 and 1, in "%" between 0 and 100; so is its interval
  kNotNegative = 64,  ///< a count, an amount: its interval ends at 0; undefined where over 5 % of its resamples are below 0 or undefined
  /// A spread between beads, or what follows from one. Blocks that a resample holds twice would count their own noise as spread, so the
  /// error comes from leaving out one block after the other.
  kSpread = 128,
};

/// One result.
struct Result {
  const char* name;  ///< lower_case_words, unique in the analyzer
  const char* unit;
  const char* doc;
  std::uint32_t rank;
  std::uint32_t traits;  ///< bits of ResultTrait
  std::uint64_t shape[kMaxRank];
  const double* values;  ///< row-major; NaN where undefined
  /// For each dimension the name of the result of this analyzer that holds its edges (one number more than the dimension) or its
  /// centres; nullptr: a mere count. Pictures, tables and comparisons find their axes here.
  const char* axis[kMaxRank];
};
template <>
struct Layout<Result> {
  using S = Result;
  static constexpr Member members[] = {MILLSCOPE_MEMBER(S, name),   MILLSCOPE_MEMBER(S, unit),   MILLSCOPE_MEMBER(S, doc),
                                       MILLSCOPE_MEMBER(S, rank),   MILLSCOPE_MEMBER(S, traits), MILLSCOPE_MEMBER(S, shape),
                                       MILLSCOPE_MEMBER(S, values), MILLSCOPE_MEMBER(S, axis)};
};

/// Receives results; everything is copied before `add` returns.
struct ResultSink {
  void* host;
  void (*add)(void* host, const Result*);
};
template <>
struct Layout<ResultSink> {
  using S = ResultSink;
  static constexpr Member members[] = {MILLSCOPE_MEMBER(S, host), MILLSCOPE_MEMBER(S, add)};
};

struct AnalyzerTable {
  std::uint64_t needs;  ///< bits of FrameField without which it cannot work
  Status (*create)(const Values*, const AnalyzerContext*, void** self, Failure*);
  void (*destroy)(void* self);
  /// The additive arrays; owned by the plugin, valid until destroy.
  void (*arrays)(const void* self, const ArrayInfo** items, std::uint64_t* count);
  /// Adds one block to `sums` (one pointer per array). Called from many threads at once, with different sums.
  Status (*accumulate)(const void* self, const FrameBlock*, double* const* sums, Failure*);
  /// Pure: the same sums give the same results.
  Status (*finish)(const void* self, const double* const* sums, const ResultSink*, Failure*);
};
template <>
struct Layout<AnalyzerTable> {
  using S = AnalyzerTable;
  static constexpr Member members[] = {MILLSCOPE_MEMBER(S, needs),  MILLSCOPE_MEMBER(S, create),     MILLSCOPE_MEMBER(S, destroy),
                                       MILLSCOPE_MEMBER(S, arrays), MILLSCOPE_MEMBER(S, accumulate), MILLSCOPE_MEMBER(S, finish)};
};

inline constexpr std::uint64_t kAnalyzerLayout =
    layout_hash(Kind::analyzer, {kMaxRank}, KindStructs<FrameBlock, AnalyzerContext, ArrayInfo, Result, ResultSink, AnalyzerTable>{});

}  // namespace millscope
