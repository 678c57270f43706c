#include "studies/calibrate/session.hpp"

#include <algorithm>
#include <thread>

namespace millscope::calibrate {
namespace {

campaign::Options campaign_options(const Study& study, const SessionOptions& o) {
  campaign::Options c;
  c.cache = o.cache;
  c.runner = o.runner.empty() ? study.runner : o.runner;
  c.slots = o.slots;
  c.plugin_directories = o.plugin_directories;
  c.quiet = o.quiet;
  c.slurm_options = o.slurm_options;
  c.say = o.say;
  return c;
}

}  // namespace

Session::Session(const Study& study, const host::Registry& registry, SessionOptions options) : study_(study), options_(std::move(options)) {
  if (options_.cache.empty()) options_.cache = options_.output / "cache";
  check_study(study_, registry);
  std::filesystem::create_directories(options_.cache);
  observer_ = std::make_unique<Observer>(study_, registry, options_.cache / "observations", 0, options_.say);
  Machinery machinery;
  machinery.run = [campaign_setup = campaign_options(study_, options_),
                   retry = options_.retry_failed](std::span<const campaign::Simulation> simulations) {
    campaign::Options once = campaign_setup;
    once.retry_failed = retry;
    return campaign::run(simulations, once);
  };
  machinery.observe = [observer = observer_.get()](std::size_t condition, const campaign::Outcome& outcome) {
    Observation seen = observer->simulated(condition, outcome.folder, outcome.key);
    require_defined(seen);
    return seen;
  };
  for (std::size_t c = 0; c < study_.conditions.size(); ++c) machinery.recorded.push_back(observer_->recorded(c));
  machinery.slots = options_.slots > 0 ? options_.slots : static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  machinery.say = options_.say;
  evaluator_ = std::make_unique<Evaluator>(study_, std::move(machinery));
}

}  // namespace millscope::calibrate
