#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kernel/config/error.hpp"
#include "studies/recording/clean.hpp"
#include "studies/recording/noise.hpp"
#include "studies/recording/recording.hpp"
#include "studies/recording/table.hpp"
#include "studies/recording/text_file.hpp"

namespace millscope::studies {
namespace {

using config::UserError;

std::string plain_name(std::filesystem::path file) {
  if (file.extension() == ".gz") file = file.stem();
  return file.stem().string();
}

std::vector<Run> read_file(const std::filesystem::path& file) {
  const std::string text = read_text_file(file);
  RunReport report;
  FirstFault fault;
  Rows rows = read_rows(text, ctrack_layout(), report, fault);
  if (rows.size() == 0) throw UserError(fmt::format("{}: holds no usable point", file.string()));
  std::vector<Run> runs = order_rows(std::move(rows), report);
  for (std::size_t part = 0; part < runs.size(); ++part) {
    runs[part].name = plain_name(file) + (part == 0 ? "" : fmt::format("_{}", part + 1));
    runs[part].source = file.string();
  }
  return runs;
}

void clean(Recording& recording) {
  const Extent extent = measure_extent(recording.runs);
  recording.gap_limit = default_gap_limit(recording.runs);
  const Travel travel = measure_travel(recording.runs, recording.gap_limit);
  for (Run& run : recording.runs) {
    drop_outside(run, extent, 2 * extent.largest());
    drop_outliers(run, travel);
    count_gaps(run, recording.gap_limit);
  }
}

}  // namespace

Recording read_recording(const std::filesystem::path& file) {
  Recording recording;
  recording.file = file;
  recording.runs = read_file(file);
  clean(recording);
  return recording;
}

}  // namespace millscope::studies
