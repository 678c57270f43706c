#include "studies/campaign/tasks_file.hpp"

#include <fmt/format.h>

#include "kernel/config/existing_file.hpp"
#include "kernel/config/units.hpp"
#include "kernel/output/csv.hpp"
#include "kernel/output/file.hpp"

namespace millscope::campaign {
namespace {

using config::Node;

std::vector<std::string> settings_of(const Node& node) {
  std::vector<std::string> settings;
  if (const auto list = node.find("set")) {
    for (const Node& item : list->items()) {
      if (item.text().find('=') == std::string::npos)
        item.fail(fmt::format("'{}' is no setting; write it as path.to.key=value, e.g. time.end_s=2", item.text()));
      settings.push_back(item.text());
    }
  }
  return settings;
}

}  // namespace

std::vector<Simulation> read_tasks(const std::string& file) {
  const Node root = config::load_document(file);
  root.expect({"schema_version", "case", "set", "simulations"});
  const Node version = root.at("schema_version", "the version of the file's shape: 1");
  if (config::read_integer(version, config::any_number()) != 1) version.fail("is " + version.text() + "; this millscope reads 1");
  const auto common_case = root.find("case");
  const std::vector<std::string> common = settings_of(root);
  const Node list = root.at("simulations", "by name: {slow: {set: [mill.speed=50 %critical]}}");
  std::vector<Simulation> simulations;
  for (const std::string& label : list.keys()) {
    const Node node = list.at(label);
    node.expect({"case", "set"});
    const auto own_case = node.find("case");
    if (!own_case && !common_case) node.fail("names no case; give it one (case: FILE.yaml), or one for all at the top of the file");
    Simulation s{config::existing_file(own_case ? *own_case : *common_case), common, label};
    for (std::string& setting : settings_of(node)) s.settings.push_back(std::move(setting));
    simulations.push_back(std::move(s));
  }
  if (simulations.empty()) list.fail("is empty; name at least one simulation");
  root.finish();
  return simulations;
}

void write_table(const std::filesystem::path& file, std::span<const Simulation> simulations, std::span<const Outcome> outcomes,
                 const std::vector<bool>& known) {
  output::AtomicFile out(file);
  out.write("label,key,state,wall_s,cached,folder,message\n");
  for (std::size_t i = 0; i < simulations.size(); ++i) {
    const Outcome& o = outcomes[i];
    const char* state = !known[i] ? "open" : o.state == State::done ? "done" : "failed";
    const std::string wall = known[i] && o.state == State::done ? fmt::format("{:.3f}", o.wall_s) : "";
    out.write(fmt::format("{},{},{},{},{},{},{}\n", output::csv_cell(simulations[i].label), o.key, state, wall,
                          !known[i]  ? ""
                          : o.cached ? "yes"
                                     : "no",
                          output::csv_cell(o.folder.string()), output::csv_cell(o.message)));
  }
  out.commit();
}

}  // namespace millscope::campaign
