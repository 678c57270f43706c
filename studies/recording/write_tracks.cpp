#include <cmath>

#include "kernel/output/file.hpp"
#include "kernel/output/tracks.hpp"
#include "studies/recording/recording.hpp"

namespace millscope::recording {

void write_tracks(const Recording& recording, const std::filesystem::path& file) {
  std::vector<output::TrackInfo> tracks;
  for (const Run& run : recording.runs) {
    const TracerBead& tracer = recording.condition.tracer;
    tracks.push_back(
        {run.name, 0, tracer.diameter.value_or(0), tracer.density.value_or(0), std::filesystem::path(run.source).filename().string()});
  }
  const std::filesystem::path aside = output::reserve_temporary(file);
  std::filesystem::remove(aside);  // the name is ours now, and the writer makes its files itself
  auto writer = output::TrackWriter::create(aside, tracks);
  for (std::size_t k = 0; k < recording.runs.size(); ++k) {
    const Run& run = recording.runs[k];
    for (std::size_t i = 0; i < run.size(); ++i) {
      const std::array<double, 3> position{run.position[0][i], run.position[1][i], run.position[2][i]};
      writer.append_one(k, run.time[i], position);
    }
  }
  writer.close();
  output::publish(aside, file);
}

}  // namespace millscope::recording
