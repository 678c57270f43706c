// From a recording, and from simulations seen as that recording was made, to observations that can be compared.
//
// Of each condition, once: the recording's camera is estimated (or given), its noise and gaps decide how every track is smoothed, and its
// own distributions decide the bins and regions that are compared. A simulation then goes the same way: paths of many beads → camera →
// .a files → the same cleaning, spline and analyzers → the same bins. Both are kept in the cache.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "studies/analysis/results.hpp"
#include "studies/calibrate/observation.hpp"
#include "studies/calibrate/recordings.hpp"
#include "studies/calibrate/study.hpp"
#include "studies/campaign/campaign.hpp"

namespace millscope::calibrate {

struct ObserverOptions {
  std::filesystem::path cache;                  ///< results are kept below it
  int threads = 0;                              ///< 0: all cores; no influence on results
  std::function<void(const std::string&)> say;  ///< one line on what is being done; may be empty
};

class Observer {
 public:
  /// Looks at the recordings of all conditions, and reads all that looking at simulations will need. Throws base::UserError.
  Observer(const Study& study, const host::Registry& registry, Recordings recordings, ObserverOptions options);
  ~Observer();

  /// What was recorded in a condition, as it was read.
  const Recorded& recording(std::size_t condition) const;
  /// Whether the study's case turns the other way than the recording, so that its results are mirrored.
  bool turns_other_way(std::size_t condition) const;
  /// What the recording of a condition shows.
  const Observation& recorded(std::size_t condition) const;
  /// What a finished run shows, with exactly the same observables; from its key in the cache the camera's chance comes too. `camera`: a
  /// camera file's text, whose links come before those of the recording's camera; may be empty. A speed where no bead was seen is NaN. May
  /// be called from several threads. Throws base::UserError.
  Observation simulated(std::size_t condition, const campaign::Outcome& run, const std::string& camera = {}) const;
  /// Results of other analyzers (as in analysis.yaml): of the recording where the run has no folder, else of a finished run seen in the
  /// same way.
  analysis::ResultSet results(std::size_t condition, const campaign::Outcome& run, const std::string& analyzers,
                              const std::string& camera = {}) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Settings that every simulation of a study gets: what the observer needs, and nothing else written.
std::vector<std::string> observed_outputs();

}  // namespace millscope::calibrate
