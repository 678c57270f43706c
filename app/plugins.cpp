// describe, plugins, schema, plugin new.
#include <fmt/core.h>

#include "app/commands.hpp"
#include "kernel/base/nearest.hpp"
#include "kernel/config/document.hpp"
#include "kernel/config/writer.hpp"
#include "kernel/host/describe.hpp"
#include "kernel/host/scaffold.hpp"

namespace millscope::app {

namespace po = boost::program_options;

int describe(const Arguments& arguments) {
  Options options("describe PLUGIN",
                  "Shows what a plugin does: equation, citation, parameters with unit, default and range, ledger channels, hypotheses.",
                  "millscope describe hertz_mindlin");
  options.positional("PLUGIN", "name of a plugin");
  options.add()("json", "print JSON");
  options.with_plugins();
  if (!options.parse(arguments)) return kDone;
  const host::Registry registry = options.registry();
  nlohmann::json all = nlohmann::json::array();
  for (const host::Loaded* plugin : registry.find_any(options.text("PLUGIN"))) {
    if (options.has("json")) {
      all.push_back(host::describe_json(*plugin->descriptor));
    } else {
      fmt::print("{}", host::describe(*plugin->descriptor));
    }
  }
  if (options.has("json")) fmt::print("{}\n", (all.size() == 1 ? all[0] : all).dump(2));
  return kDone;
}

int plugins(const Arguments& arguments) {
  Options options("plugins", "Lists the plugins that would be loaded, and from where.", "millscope plugins");
  options.with_plugins();
  if (!options.parse(arguments)) return kDone;
  fmt::print("{}", host::list_plugins(options.registry()));
  return kDone;
}

int schema(const Arguments& arguments) {
  Options options(
      "schema",
      "Prints the JSON Schema of case files, with the parameters of all loaded plugins, for editors that complete and check YAML.",
      "millscope schema > millscope.schema.json");
  options.with_plugins();
  if (!options.parse(arguments)) return kDone;
  const host::Registry registry = options.registry();
  fmt::print("{}\n", config::case_schema(registry.descriptors()).dump(2));
  return kDone;
}

int plugin(const Arguments& arguments) {
  Options options("plugin new KIND NAME",
                  "Writes a plugin project of its own (CMake, source, test, README) that builds against the installed SDK.",
                  "millscope plugin new contact_law my_law");
  options.positional("ACTION", "new");
  options.positional("KIND", "contact_law, interaction, pair_parameter, body_force, geometry, observation, analyzer, wear_law");
  options.positional("NAME", "lower_case_words");
  options.choices("ACTION", {"new"});
  std::vector<std::string> kinds;
  for (const Kind k : host::all_kinds()) kinds.push_back(host::text(k));
  options.choices("KIND", kinds);
  options.add()("directory", po::value<std::string>()->value_name("DIR")->default_value("."), "where to put it");
  if (!options.parse(arguments)) return kDone;
  if (options.text("ACTION") != "new") throw base::UserError(fmt::format("plugin {}: the only action is 'new'", options.text("ACTION")));
  const std::string word = options.text("KIND");
  const std::optional<Kind> kind = host::parse_kind(word);
  if (!kind) {
    std::vector<std::string> known;
    for (const Kind k : host::all_kinds()) known.push_back(host::text(k));
    throw base::UserError(fmt::format("'{}' is no kind of plugin; {}", word, base::suggestion(word, known)));
  }
  const std::string path = host::scaffold(*kind, options.text("NAME"), options.text("directory"));
  fmt::print("wrote {0}\nbuild and test it:\n  cmake -B {0}/build {0} && cmake --build {0}/build && ctest --test-dir {0}/build\n", path);
  return kDone;
}

}  // namespace millscope::app
