// compare: what differs between two results of `analyze`.
#include <fmt/core.h>

#include <algorithm>
#include <filesystem>

#include "app/commands.hpp"
#include "kernel/output/file.hpp"
#include "kernel/output/summary.hpp"
#include "studies/compare/report.hpp"
#include "studies/picture/outline.hpp"

namespace millscope::app {
namespace {

namespace po = boost::program_options;
namespace fs = std::filesystem;
using base::UserError;

constexpr std::size_t kRows = 20, kGiven = 6;

void print_sources(const compare::Comparison& c) {
  fmt::print("A: {}\nB: {}\n", c.a.meta.description, c.b.meta.description);
  for (const std::string& note : c.notes) fmt::print("note: {}\n", note);
}

void print_rest(const compare::Comparison& c) {
  for (std::size_t i = 0; i < std::min(kGiven, c.given.size()); ++i) fmt::print("given quantity that differs: {}\n", c.given[i]);
  if (c.given.size() > kGiven) fmt::print("… and {} more given quantities (comparison.json lists all)\n", c.given.size() - kGiven);
  if (c.not_judged.empty()) return;
  fmt::print("not compared: {}", c.not_judged.front());
  if (c.not_judged.size() > 1) fmt::print(" … and {} more (comparison.json lists all)", c.not_judged.size() - 1);
  fmt::print("\n");
}

/// Removes the pictures of the earlier comparison in OUT, which this one may lack; anything else stays.
void remove_earlier_pictures(const fs::path& output) {
  const auto earlier = output::read_json(output / "comparison.json");
  if (!earlier.is_object() || !earlier.contains("observables") || !earlier["observables"].is_array()) return;
  std::error_code ignored;
  for (const auto& o : earlier["observables"]) {
    if (!o.is_object() || !o.contains("name") || !o["name"].is_string()) continue;
    const std::string name = o["name"];
    if (name.find('/') != std::string::npos) continue;
    for (const char* ending : {".svg", ".png"}) fs::remove(output / "pictures" / (name + ending), ignored);
  }
}

void write_output(const compare::Comparison& c, const fs::path& output, const host::Registry& registry, bool quiet) {
  remove_earlier_pictures(output);
  compare::write_comparison(c, output);
  std::string lacking;
  const picture::MillOutline mill = picture::outline_of(c.a, registry, lacking);
  const auto pictures = compare::draw_comparison(c, output / "pictures", mill);
  if (quiet) return;
  if (!lacking.empty()) fmt::print("note: the pictures show the shell without lifters: {}\n", lacking);
  fmt::print("written to {}: comparison.json, observables.csv, elements.csv, {} pictures\n", output.string(), pictures.size());
}

double percent(const Options& options, const char* name, double standard) {
  if (!options.has(name)) return standard;
  const double value = options.number(name);
  if (!(value > 0 && value < 100)) throw UserError(fmt::format("--{} {}: give percent between 0 and 100", name, value));
  return value / 100;
}

}  // namespace

int compare(const Arguments& arguments) {
  Options options(
      "compare A B [-o OUT]",
      "Tells what differs between two results of 'analyze' (B less A), cell by cell and region by region, with one error rate for "
      "everything together. Turning senses may differ: B is then mirrored.",
      "millscope compare dry-analysis wet-analysis -o dry-wet");
  options.positional("A", "directory of 'millscope analyze', or its results.h5");
  options.positional("B", "the other one");
  options.add()("output,o", po::value<std::string>()->value_name("OUT"), "directory for tables and pictures (default: print only)");
  options.add()("force", "replace the comparison in OUT");
  options.add()("only", po::value<std::vector<std::string>>()->value_name("NAME"),
                "compare only this analyzer or ANALYZER.RESULT (may be repeated)");
  options.add()("without", po::value<std::vector<std::string>>()->value_name("NAME"),
                "leave this analyzer or ANALYZER.RESULT out (may be repeated)");
  options.add()("level", po::value<double>()->value_name("%"), "family-wise error rate (default: 5)");
  options.add()("json", "print comparison.json instead of the table");
  options.add()("quiet,q", "print the verdict only");
  options.with_plugins();
  if (!options.parse(arguments)) return kDone;
  const compare::CompareOptions choice{options.list("only"), options.list("without"), percent(options, "level", 0.05)};
  const fs::path output = options.has("output") ? fs::path(options.text("output")) : fs::path();
  if (!output.empty() && !options.has("force")) output::refuse_existing(output / "comparison.json");  // before the work begins
  const analysis::ResultSet a = analysis::read_results(options.text("A")), b = analysis::read_results(options.text("B"));
  const compare::Comparison c = compare::compare(a, b, choice);
  const bool json = options.has("json"), quiet = options.has("quiet") || json;
  if (!quiet) {
    print_sources(c);
    fmt::print("\n{}", compare::comparison_table(c, kRows));
    print_rest(c);
  }
  if (!output.empty()) write_output(c, output, options.registry(), quiet);
  if (json) {
    fmt::print("{}\n", compare::comparison_json(c).dump(2));
  } else {
    fmt::print("{}{}\n", quiet ? "" : "\n", c.verdict);
  }
  return kDone;
}

}  // namespace millscope::app
