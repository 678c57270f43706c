// Steps a case from a developed bed, the energy ledger on and nothing written, and says what a particle-step costs.
#include <fmt/format.h>
#include <malloc.h>

#include <boost/program_options.hpp>
#include <fstream>
#include <iostream>

#include "bench/bed.hpp"
#include "bench/program.hpp"
#include "kernel/config/case.hpp"

namespace millscope::bench {
namespace {

namespace po = boost::program_options;
using base::UserError;

/// From now on `peak_bytes` counts anew.
void forget_peak() {
  malloc_trim(0);
  std::ofstream("/proc/self/clear_refs") << "5";
}

std::size_t peak_bytes() {
  std::ifstream in("/proc/self/status");
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with("VmHWM:")) return 1024 * std::stoull(line.substr(6));
  }
  return 0;
}

po::options_description description() {
  po::options_description d("millscope_bench CASE.yaml [options]");
  auto add = d.add_options();
  add("help,h", "explain");
  add("case", po::value<std::string>(), "the case");
  add("set", po::value<std::vector<std::string>>()->composing()->default_value({}, ""), "path.to.key=value");
  add("plugin-dir", po::value<std::vector<std::string>>()->composing()->default_value({}, ""), "directory of plugins");
  add("threads", po::value<int>()->default_value(1), "threads");
  add("instruction-set", po::value<std::string>()->default_value(""), "v2, v3, v4; default: the best of the machine");
  add("load", po::value<std::string>(), "start from this bed instead of filling and settling");
  add("replicate-z", po::value<int>()->default_value(1), "that many copies of the bed along z; what end faces would touch is left out");
  add("until", po::value<double>(), "run to this time first, s");
  add("save", po::value<std::string>(), "write the bed then");
  add("liggghts", po::value<std::string>(), "write it as a LIGGGHTS data file too");
  add("warm-up", po::value<int>()->default_value(500), "steps before the clock starts");
  add("steps", po::value<int>()->default_value(0), "steps to time");
  return d;
}

Bed loaded(const run::Assembly& a, const std::string& file, int copies) {
  const Bed bed = replicated(read_bed(file), copies);
  const double period = a.system->settings().periodic.length[2];
  if (period > 0) {
    if (std::abs(bed.period - period) > 1e-9) throw UserError(fmt::format("the bed is {} m long, the case {} m", bed.period, period));
    return bed;
  }
  if (!(bed.period > 0)) return bed;
  const Interior& inside = a.geometries.at(0).interior;
  if (!inside.is_bounded) throw UserError("the case is neither periodic along z nor closed by its first geometry");
  return between_ends(bed, inside.low[2], inside.high[2]);
}

void time_steps(run::Assembly& a, int warm_up, int steps) {
  dem::System& s = *a.system;
  for (int k = 0; k < warm_up; ++k) s.advance();
  const std::int64_t rebuilds = s.rebuilds();
  const double cpu = cpu_seconds(), wall = wall_seconds();
  for (int k = 0; k < steps; ++k) s.advance();
  const double cpu_used = cpu_seconds() - cpu, wall_used = wall_seconds() - wall;
  const double beads = static_cast<double>(a.bead_count), particle_steps = beads * steps;
  std::int64_t contacts = 0;
  for (const dem::PairLedger& p : s.ledger().pairs) contacts += p.contacts;
  fmt::print(
      "{{\"beads\": {}, \"steps\": {}, \"threads\": {}, \"cpu_s\": {:.6f}, \"wall_s\": {:.6f}, \"ns_per_particle_step\": {:.3f}, "
      "\"M_particle_steps_per_cpu_s\": {:.4f}, \"M_particle_steps_per_wall_s\": {:.4f}, \"steps_per_rebuild\": {:.2f}, "
      "\"contacts_per_bead\": {:.4f}, "
      "\"listed_pairs_per_bead\": {:.3f}, \"system_bytes_per_bead\": {:.1f}, \"peak_bytes\": {}, \"simulated_s\": {:.6f}, \"state_hash\": "
      "\"{:016x}\"}}\n",
      a.bead_count, steps, s.settings().threads, cpu_used, wall_used, 1e9 * cpu_used / particle_steps, 1e-6 * particle_steps / cpu_used,
      1e-6 * particle_steps / wall_used, steps / static_cast<double>(std::max<std::int64_t>(1, s.rebuilds() - rebuilds)),
      static_cast<double>(contacts) / beads, static_cast<double>(s.listed_pairs()) / beads, static_cast<double>(s.memory_bytes()) / beads,
      peak_bytes(), s.time(), s.state_hash());
}

int time_case(const po::variables_map& options) {
  host::RegistryOptions where;
  where.directories = options["plugin-dir"].as<std::vector<std::string>>();
  const host::Registry registry(where);
  const config::Case c = config::read_case(options["case"].as<std::string>(), options["set"].as<std::vector<std::string>>());
  run::Assembly a = run::assemble(c, registry, {options["threads"].as<int>(), options["instruction-set"].as<std::string>()});
  if (options.count("load")) {
    start_from(a, loaded(a, options["load"].as<std::string>(), options["replicate-z"].as<int>()));
  } else {
    run::insert_beads(a);
    run::begin(a);
  }
  if (options.count("until")) {
    while (a.system->time() < options["until"].as<double>()) a.system->advance();
  }
  if (options.count("save")) write_bed(bed_of(a), options["save"].as<std::string>());
  if (options.count("liggghts")) write_liggghts(bed_of(a), options["liggghts"].as<std::string>());
  forget_peak();
  if (options["steps"].as<int>() > 0) time_steps(a, options["warm-up"].as<int>(), options["steps"].as<int>());
  return 0;
}

int run(int count, char** words) {
  po::variables_map options;
  const po::options_description all = description();
  po::positional_options_description position;
  position.add("case", 1);
  store(po::command_line_parser(count, words).options(all).positional(position).run(), options);
  notify(options);
  if (options.count("help") || !options.count("case")) {
    std::cout << all;
    return options.count("help") ? 0 : 2;
  }
  return time_case(options);
}

}  // namespace
}  // namespace millscope::bench

int main(int count, char** words) { return millscope::bench::run_as("millscope_bench", count, words, millscope::bench::run); }
