// The files of a run from frames that were gathered: frames.h5, tracks.h5, series.csv; and what goes into the summary.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "kernel/run/window.hpp"
#include "studies/frames/gather.hpp"
#include "studies/frames/turning.hpp"

namespace millscope::frames {

/// Where velocities come from.
enum class Velocities { files, differences, none };

struct Written {
  Velocities velocities = Velocities::none;
  double interval = 0;     ///< s, the usual one; 0: there is one frame
  double longest = 0;      ///< s, the longest interval
  std::size_t alone = 0;   ///< times a bead is left out, since it is in neither frame beside: no difference says its velocity
  double mass = 0;         ///< kg, mean of the charge
  double count = 0;        ///< beads, mean
  std::size_t tracks = 0;  ///< beads that are followed in tracks.h5
  std::string no_tracks;   ///< why there are none
  run::Course course;      ///< from `analyze_from` on
};

struct WriteRequest {
  const MillFile& mill;
  Gather& gathered;
  Turning turning;
  double analyze_from = 0;  ///< s
  std::filesystem::path folder;
};

Written write_run(const WriteRequest& request);

/// What the import says of velocities and of the camera, a sentence each.
std::vector<std::string> notes_of(const Written& written, const Gather& gathered);

}  // namespace millscope::frames
