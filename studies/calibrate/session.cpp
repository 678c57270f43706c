#include "studies/calibrate/session.hpp"

#include <algorithm>
#include <thread>

namespace millscope::calibrate {

campaign::Options campaign_of(const SessionOptions& o) {
  campaign::Options c;
  c.cache = o.cache;
  if (!o.runner.empty()) c.runner = o.runner;
  c.slots = o.slots;
  c.plugin_directories = o.plugin_directories;
  c.quiet = o.quiet;
  c.retry_failed = o.retry_failed;
  c.slurm_options = o.slurm_options;
  c.say = o.say;
  return c;
}

Session::Session(const Study& study, const host::Registry& registry, SessionOptions options) : study_(study), options_(std::move(options)) {
  if (options_.cache.empty()) options_.cache = options_.output / "cache";
  if (options_.runner.empty()) options_.runner = study_.runner;
  check_study(study_, registry);
  Recordings recordings = read_recordings(study_);
  check_recordings(study_, recordings, registry);
  std::filesystem::create_directories(options_.cache);
  observer_ = std::make_unique<Observer>(study_, registry, std::move(recordings),
                                         ObserverOptions{options_.cache / "observations", 0, options_.say});
  // A study asks many times; what other programs left is said at the first.
  machinery_.run = [how = campaign_of(options_)](std::span<const campaign::Simulation> simulations) mutable {
    campaign::Options once = how;
    how.say_of_other_programs = false;
    return campaign::run(simulations, once);
  };
  machinery_.observe = [observer = observer_.get()](std::size_t condition, const campaign::Outcome& outcome, const std::string& camera) {
    return observer->simulated(condition, outcome, camera);
  };
  machinery_.results = [observer = observer_.get()](std::size_t condition, const campaign::Outcome& outcome, const std::string& analyzers,
                                                    const std::string& camera) {
    return observer->results(condition, outcome, analyzers, camera);
  };
  machinery_.progress = options_.say;
  machinery_.slots = options_.slots > 0 ? options_.slots : static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  evaluator_ = std::make_unique<Evaluator>(study_, machinery_, recorded());
}

std::vector<Observation> Session::recorded() const {
  std::vector<Observation> all;
  for (std::size_t c = 0; c < study_.conditions.size(); ++c) all.push_back(observer_->recorded(c));
  return all;
}

}  // namespace millscope::calibrate
