// Everything together: study → recordings → campaign → method → files.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "studies/calibrate/methods.hpp"
#include "studies/calibrate/observe.hpp"
#include "studies/calibrate/validate.hpp"

namespace millscope::calibrate {

struct SessionOptions {
  std::filesystem::path output;
  std::filesystem::path cache;  ///< empty: OUTPUT/cache
  std::string runner;           ///< empty: the study's
  int slots = 0;                ///< simulations at once; 0: as many as cores
  std::vector<std::filesystem::path> plugin_directories;
  std::vector<std::string> slurm_options;
  bool quiet = false;
  bool retry_failed = false;
  std::function<void(const std::string&)> say;  ///< one line of progress; may be empty
};

/// How its simulations run; the cache as given, the runner that of a campaign where none is.
campaign::Options campaign_of(const SessionOptions& options);

/// The study's recordings and campaign, ready for an Evaluator.
class Session {
 public:
  /// Checks the study and looks at its recordings. Throws base::UserError.
  Session(const Study& study, const host::Registry& registry, SessionOptions options);
  Evaluator& evaluator() { return *evaluator_; }
  const Observer& observer() const { return *observer_; }
  const Machinery& machinery() const { return machinery_; }
  /// What the recordings show, as the data say.
  std::vector<Observation> recorded() const;

 private:
  const Study& study_;
  SessionOptions options_;
  std::unique_ptr<Observer> observer_;
  Machinery machinery_;
  std::unique_ptr<Evaluator> evaluator_;
};

}  // namespace millscope::calibrate
