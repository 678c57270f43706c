// How long one look at a finished simulation takes: virtual camera, cleaning, splines, analyzers, summaries.
//   millscope_look_bench configs/story/study.yaml --set conditions.speed75.recording=r75.yaml --run RUN --looks 10
// Each look is with another chance of the camera, so that none is found in a cache. `bench/look.sh` makes the recording and the run.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <boost/program_options.hpp>
#include <filesystem>
#include <fstream>
#include <iostream>

#include "bench/program.hpp"
#include "kernel/base/error.hpp"
#include "studies/calibrate/observe.hpp"

namespace millscope::bench {
namespace {

namespace fs = std::filesystem;
namespace po = boost::program_options;

/// Every number of an observation to its last bit, so that two programs can be compared: `cmp`.
void write_values(std::ostream& out, const std::string& look, const calibrate::Observation& o) {
  for (Eigen::Index i = 0; i < o.value.size(); ++i) {
    out << fmt::format("{} {} {:.17g}", look, o.observables[static_cast<std::size_t>(i)].name, o.value[i]);
    for (Eigen::Index j = 0; j <= i; ++j) out << fmt::format(" {:.17g}", o.covariance(i, j));
    out << "\n";
  }
  for (Eigen::Index i = 0; i < o.resampled.rows(); ++i) {
    out << fmt::format("{} resampled", look);
    for (Eigen::Index j = 0; j <= i; ++j) out << fmt::format(" {:.17g}", o.resampled(i, j));
    out << "\n";
  }
  out << fmt::format("{} power {:.17g} {:.17g} blocks {:.17g} bead-seconds {:.17g}\n", look, o.power.value, o.power.sem, o.blocks,
                     o.bead_seconds);
  for (const calibrate::Histogram* h : {&o.x, &o.speed}) {
    for (std::size_t b = 0; b < h->percent.size(); ++b) out << fmt::format("{} bin {:.17g} {:.17g}\n", look, h->percent[b], h->sem[b]);
  }
}

/// A folder that is gone at the end.
struct Scratch {
  fs::path path = fs::temp_directory_path() / fmt::format("millscope-look-bench-{}", ::getpid());
  ~Scratch() { fs::remove_all(path); }
};

int measure(const po::variables_map& options) {
  const host::Registry registry;
  const auto settings = options.count("set") > 0 ? options["set"].as<std::vector<std::string>>() : std::vector<std::string>();
  const calibrate::Study study = calibrate::read_study(options["study"].as<std::string>(), settings, calibrate::kDiagnoseSections);
  const Scratch scratch;
  const calibrate::Observer observer(study, registry, calibrate::read_recordings(study), {scratch.path, options["threads"].as<int>(), {}});
  const int looks = options["looks"].as<int>();
  std::ofstream values;
  if (options.count("values") > 0) values.open(options["values"].as<std::string>());
  std::vector<double> cost;
  if (values.is_open()) write_values(values, "recorded", observer.recorded(0));
  for (int k = 0; k < looks; ++k) {
    campaign::Outcome run;
    run.state = campaign::State::done;
    run.folder = options["run"].as<std::string>();
    run.key = fmt::format("look{}-", k);
    const double before = cpu_seconds();
    const calibrate::Observation seen = observer.simulated(0, run);
    cost.push_back(cpu_seconds() - before);
    if (values.is_open()) write_values(values, std::to_string(k), seen);
  }
  std::sort(cost.begin(), cost.end());
  fmt::print("a look: {:.4f} s of processor time, median of {} (least {:.4f}, most {:.4f})\n", cost[cost.size() / 2], looks, cost.front(),
             cost.back());
  return 0;
}

int run(int count, char** words) {
  po::options_description options("Options");
  options.add_options()("help", "show this page")("study", po::value<std::string>()->required(),
                                                  "study.yaml; its first condition is looked at")(
      "set", po::value<std::vector<std::string>>()->composing(), "path=value, laid on the study")(
      "run", po::value<std::string>()->required(), "a finished run of that condition, with frames")(
      "looks", po::value<int>()->default_value(10), "looks")("threads", po::value<int>()->default_value(1), "threads")(
      "values", po::value<std::string>(), "file that gets every number that was seen");
  po::positional_options_description first;
  first.add("study", 1);
  po::variables_map values;
  po::store(po::command_line_parser(count, words).options(options).positional(first).run(), values);
  if (values.count("help") > 0) {
    std::cout << options;
    return 0;
  }
  po::notify(values);
  if (values["looks"].as<int>() < 1) throw base::UserError("--looks must be 1 or more");
  return measure(values);
}

}  // namespace
}  // namespace millscope::bench

int main(int count, char** words) { return millscope::bench::run_as("millscope_look_bench", count, words, millscope::bench::run); }
