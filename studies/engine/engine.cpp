#include "studies/engine/engine.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "kernel/base/nearest.hpp"
#include "kernel/base/program.hpp"
#include "kernel/config/imported.hpp"
#include "kernel/output/directory.hpp"
#include "studies/engine/liggghts/obstacles.hpp"
#include "studies/engine/liggghts/play.hpp"

namespace millscope::engine {

namespace {

/// Engines that a case may name in run.engine, beside none: this program.
std::vector<std::string> names() { return {"liggghts"}; }

}  // namespace

void require_known(const config::Case& c) {
  config::refuse_imported(c);
  const std::vector<std::string> known = names();
  if (c.run.engine.empty() || std::find(known.begin(), known.end(), c.run.engine) != known.end()) return;
  c.root.at("run").at("engine").fail(
      fmt::format("'{}' is no engine that is known; {}", c.run.engine, base::suggestion(c.run.engine, known)));
}

void require_playable(const config::Case& c, const host::Registry& registry) {
  require_known(c);
  run::Assembly a = run::assemble(c, registry, {1, ""});
  if (c.run.engine.empty()) {
    run::insert_beads(a);
    run::begin(a);  // its period must hold beads and reach of forces
    return;
  }
  liggghts::installed_version();
  liggghts::require_playable(a, registry);
}

std::string version_of(const config::Case& c) {
  require_known(c);
  const std::vector<std::string> here{"studies/engine"};
  return liggghts::installed_version() + " " + base::program_parts(here).at("code");
}

run::Outcome run_case(const std::string& case_file, const host::Registry& registry, const run::RunOptions& options) {
  const config::Case c = config::read_case(case_file, options.overrides);
  require_known(c);
  return c.run.engine.empty() ? run::run_case(case_file, registry, options) : liggghts::play_case(case_file, registry, options);
}

bool is_run(const std::filesystem::path& out) { return std::filesystem::exists(out / output::kEngineFolder / output::kResolvedCase); }

std::filesystem::path restart_file(const std::filesystem::path& out) {
  return is_run(out) ? liggghts::newest_restart(out / output::kEngineFolder) : std::filesystem::path();
}

run::Outcome resume_run(const host::Registry& registry, const run::RunOptions& options) {
  return is_run(options.output) ? liggghts::resume_case(registry, options) : run::resume_run(registry, options);
}

}  // namespace millscope::engine
