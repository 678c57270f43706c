// results.h5: what the analyzers found, with uncertainty and the joint covariance of everything (docs/format.md).
//
//   const ResultSet r = read_results("OUT/results.h5");
//   const ResultArray* map = r.find("pept_grid", "occupancy");           // value, sem, low, high, row-major
//   const ResultArray* x = r.axis(*map, 0);                              // edges (one number more than the dimension) or centres
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "millscope/analyzer.hpp"

namespace millscope::analysis {

inline constexpr std::uint32_t kResultsSchema = 2;

/// What the resampling says of one value. Bits of ResultArray::flags.
enum ResultFlag : std::uint8_t {
  kFewBlocks = 1,       ///< fewer than 10 effective blocks: its interval cannot be relied on
  kCorrelated = 2,      ///< the blocks are correlated in this value: sem and interval are widened for it
  kOftenUndefined = 4,  ///< undefined (NaN) in more than a tenth of the resamples
  kNoUncertainty = 8,   ///< the blocks cannot tell it: sem, low and high are NaN. Too few blocks; or the same in every block where other
                        ///< elements of the array vary: a cell that was never visited, a fraction that was always 1
};

/// One result of one analyzer.
struct ResultArray {
  std::string analyzer;  ///< name of the instance
  std::string name, unit, doc;
  std::vector<std::size_t> shape;  ///< empty: one number
  /// For each dimension the name of the result of the same analyzer that holds its edges or centres; "": a mere count.
  std::vector<std::string> axes;
  bool is_axis = false;                  ///< serves another result as an axis: exact, so that all arrays below but `value` are empty
  std::vector<double> value;             ///< row-major; NaN where undefined
  std::vector<double> sem;               ///< standard error, over the resampled blocks
  std::vector<double> low, high;         ///< 90 % interval
  std::vector<double> effective_blocks;  ///< independent blocks that the uncertainty rests on
  std::vector<std::uint8_t> flags;       ///< bits of ResultFlag
  /// Resamples, draw-major [draws, size]: draw − value. Draw b of every array comes from the same resampled blocks, so any joint
  /// distribution can be read off. Widened alike for the memory of blocks, so that sums of values have theirs; `sem` is widened for each
  /// value's own. NaN where undefined. Empty for arrays with more than kMostDrawnValues values.
  std::vector<float> draws;
  std::uint32_t traits = 0;  ///< bits of ResultTrait: never compared, what its mirror image is, its range

  bool has(ResultTrait trait) const { return (traits & trait) != 0; }
  std::size_t size() const { return value.size(); }
};

inline constexpr std::size_t kMostDrawnValues = 50000;

/// One input or plugin file, for the provenance.
struct ResultFile {
  std::string file;
  std::string hash;  ///< FNV-1a of its bytes, hexadecimal
};

/// Autocorrelation of one basic observable (x, y, radius, z, speed; of the centre of mass or the tracer).
struct ObservableTime {
  std::string name;
  double time;          ///< s, integrated autocorrelation time
  double effective;     ///< independent values in the span: span / (2 time)
  bool sets_the_block;  ///< transverse: blocks are at least three of its times
  /// Independent values that its mean over the span rests on, N_eff = (σ/sem)²: σ over the span, sem from the blocks. NaN: too few blocks.
  double independent = std::numeric_limits<double>::quiet_NaN();
};

/// One block: the unit of resampling.
struct ResultBlock {
  double start, end;      ///< s
  double duration;        ///< s that it stands for
  std::uint32_t stretch;  ///< run or bead
};

/// How long a block must be, s, from how fast a charge forgets (times.hpp); and what neighbouring blocks have in common all the same.
struct BlockLengths {
  double least = 0;        ///< three autocorrelation times of x, y and radius, and of one bead two circulations
  double wished = 0;       ///< three of the speed, which a bead's loop carries on over circulations: as far as enough blocks remain
  double correlation = 0;  ///< of neighbouring blocks, mean over x, y, radius and speed
  bool operator==(const BlockLengths&) const = default;
};

/// Frames are near enough in time for a virtual camera up to here, s: on the cubic with the places and velocities of two of them an impact
/// puts a bead some 0.1 mm aside, where a camera leaves 0.5 mm (studies/calibrate/bead_paths.hpp).
inline constexpr double kCameraInterval = 0.005;

/// Source of results: imported frames that are farther apart.
inline constexpr const char* kCoarseFrames = "coarse frames";

struct ResultMeta {
  std::string source;       ///< "simulation", "tracks", "recording", or kCoarseFrames
  std::string description;  ///< file, beads, seconds
  std::string name;         ///< of the case or recording
  std::string case_file;    ///< case with the mill's geometry (to draw the shell); empty: unknown
  AnalyzerContext context{};
  std::uint64_t seed = 1;
  std::uint32_t draws = 0;
  double confidence = 0.9;
  double block_duration = 0;  ///< s, mean
  std::vector<ResultBlock> blocks;
  BlockLengths lengths;
  std::vector<ObservableTime> times;  ///< empty where the lengths were known beforehand
  std::vector<ResultFile> inputs;
  nlohmann::ordered_json runs;        ///< of a recording: name, file, format, rows and what was set aside by which rule; else null
  nlohmann::ordered_json provenance;  ///< version, command line, plugins, options of every analyzer
  std::vector<std::string> left_out;  ///< "analyzer: why" for those whose needs the data do not meet
  std::vector<std::string> notes;     ///< what a reader of the results must know, one sentence each
};

/// Which value a row of the covariance belongs to.
struct CovarianceEntry {
  std::uint32_t array;    ///< index into ResultSet::arrays
  std::uint32_t element;  ///< index into its values
};

struct ResultSet {
  ResultMeta meta;
  std::vector<ResultArray> arrays;  ///< in the order of the analyzers and of their results
  /// Of all single numbers and of rows of at most 64 values that are no axes, defined in every resample.
  std::vector<CovarianceEntry> covariance_entries;
  std::vector<double> covariance;     ///< [entries, entries], in the product of the units
  std::uint32_t covariance_rank = 0;  ///< at most blocks − 1, and draws − 1

  /// nullptr when absent.
  const ResultArray* find(const std::string& analyzer, const std::string& name) const;
  /// The axis of one dimension; nullptr: a mere count.
  const ResultArray* axis(const ResultArray& array, std::size_t dimension) const;
};

/// "pept_grid.occupancy", or "distributions.x_share[12]".
std::string entry_name(const ResultSet& results, const CovarianceEntry& entry);

/// Writes aside and renames. Throws base::UserError when the file exists (unless `overwrite`) or cannot be written.
void write_results(const std::filesystem::path& file, const ResultSet& results, bool overwrite = false);

/// Reads a results.h5, or that of an output directory. Throws base::UserError.
ResultSet read_results(const std::filesystem::path& file_or_directory);

}  // namespace millscope::analysis
