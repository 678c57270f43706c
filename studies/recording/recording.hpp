// A recording: the measured points of one radioactive bead, from one or several files, with what is known of the mill.
//
//   const Recording r = read_recording("recording.yaml");     // or a bare .a, .csv, .tsv, .txt file, .gz of one, or tracks.h5
//
// Everything that is not used is counted, with the rule that set it aside (RunReport): nothing is silently dropped.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace millscope::recording {

struct TracerBead {
  std::optional<double> diameter;  ///< m
  std::optional<double> density;   ///< kg/m³
};

struct MeasuredPower {
  double value;  ///< W
  double sem;    ///< W
};

/// Where a slice that repeats lies along z, m.
struct Slice {
  double low = 0, high = 0;
  double middle() const { return 0.5 * (low + high); }
  double length() const { return high - low; }
};

/// What the user says of the mill; what is absent is unknown and is never guessed.
struct Condition {
  std::optional<double> angular_velocity;  ///< Ω about z, rad/s; the sign is the turning sense. Absent where the sense was not said
  std::optional<double> speed;             ///< |Ω|, rad/s
  std::optional<double> filling;           ///< J on the bare shell's volume
  std::optional<double> porosity;
  std::optional<double> bead_diameter;  ///< m
  std::optional<double> bead_density;   ///< kg/m³
  TracerBead tracer;
  std::optional<double> mill_diameter;  ///< of the bare shell, m
  std::optional<double> mill_length;    ///< inner, m
  /// m along z: of a simulated slice that repeats, whose beads' paths go on from image to image; a real mill is none.
  std::optional<Slice> slice;
  std::optional<MeasuredPower> power;
  std::filesystem::path geometry;  ///< case file with the mill's geometry; empty: none
};

/// How one file's rows were dealt with.
struct RunReport {
  std::uint64_t rows = 0;        ///< lines that hold data
  std::uint64_t used = 0;        ///< points in Run
  std::uint64_t unreadable = 0;  ///< too few columns, or not numbers; a cut last line among them
  std::uint64_t not_finite = 0;
  std::uint64_t lost = 0;         ///< the tracker's sign that it has no place, or its last place over again
  std::uint64_t false_times = 0;  ///< a single row more than a second away from both neighbours, which agree; a year from all
  std::uint64_t backwards = 0;    ///< rows whose time lies before that of the row above; sorted in when unique
  std::uint64_t duplicates = 0;   ///< the same time as another row: the one with the smaller spread is kept
  std::uint64_t outliers = 0;     ///< farther from the neighbours than any bead can travel
  std::uint64_t outside = 0;      ///< farther from the axis or along it than the mill can be
  double gap_time = 0;            ///< s in gaps longer than the limit
  std::uint64_t gaps = 0;
};

/// The points of one tracer run in time order, in the frame of the file: after axis swaps and signs, before any shift to the mill's axis.
struct Run {
  std::string name;                             ///< of the file, without folder and ending
  std::string source;                           ///< the file
  std::string format;                           ///< how it was read, e.g. "ctrack: t ms, x mm, y mm, z mm, error mm, n"
  std::vector<double> time;                     ///< s, strictly increasing
  std::array<std::vector<double>, 3> position;  ///< m
  std::vector<double> spread;                   ///< the tracker's own u, m; empty where the file has none. Not a standard error
  std::vector<std::int64_t> events;             ///< of each point; empty where the file has none
  RunReport report;
  std::size_t size() const { return time.size(); }
};

/// Where the mill stands in the frame of the file. `read_recording` leaves what recording.yaml gives; `inspect` estimates the rest.
struct MillFrame {
  std::array<double, 2> axis{0, 0};  ///< x, y of the mill's axis, m
  double low = 0, high = 0;          ///< inner end faces along z, m; equal: unknown
};

/// What a bead in these runs can do: one and a half times the speed of a fall across the mill, or of the 95th percentile of the measured
/// speeds and a half where that is more.
struct Travel {
  double speed = 0;  ///< m/s
  double noise = 0;  ///< m, of a component
  /// Whether it can get from point i to the later point j. The noise of two points in three components is allowed for sevenfold.
  bool possible(const Run& run, std::size_t i, std::size_t j) const;  // travel.cpp
  bool operator==(const Travel&) const = default;
};

struct Recording {
  std::filesystem::path file;
  std::vector<Run> runs;  ///< at least one, each with at least one point
  Condition condition;
  std::optional<MillFrame> frame;
  double gap_limit = 0;  ///< s: a longer pause between two points is a gap (`gap_limit:` of recording.yaml, else from the data)
  Travel travel;         ///< by which it was cleaned
};

/// Reads and cleans (docs/recordings.md says by which rules). Throws base::UserError with file:line, value, reason and remedy; a file
/// without a usable point is one, and so are units that cannot be meant.
Recording read_recording(const std::filesystem::path& file);

/// Points that no file holds, e.g. of a virtual camera, cleaned by the same rules: `given` has its file's name for messages, runs in the
/// order of their rows, condition and frame; gap_limit 0 and travel of no speed: from the data. Units, which no file states, are not
/// doubted. Throws as read_recording.
Recording clean_recording(Recording given);

/// Writes the points in the layout of tracks.h5 (docs/format.md), one track per run; whole or not at all. What that layout has no place for
/// is left: spreads, events, the condition. `read_recording` reads it back. Throws base::UserError.
void write_tracks(const Recording& recording, const std::filesystem::path& file);

}  // namespace millscope::recording
