// analyze: a simulation or a recording through the analyzers.
#include <fmt/core.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/commands.hpp"
#include "app/file_kinds.hpp"
#include "kernel/output/directory.hpp"
#include "kernel/output/file.hpp"
#include "kernel/output/summary.hpp"
#include "kernel/output/terminal.hpp"
#include "studies/analysis/analysis.hpp"
#include "studies/analysis/tables.hpp"
#include "studies/picture/outline.hpp"
#include "studies/picture/results_pictures.hpp"

namespace millscope::app {
namespace {

namespace po = boost::program_options;
namespace fs = std::filesystem;
using base::UserError;
constexpr std::size_t kShownNumbers = 8;  // of each analyzer

using Clock = std::chrono::steady_clock;

/// One line that is rewritten, with the time left; nothing where stderr is no terminal.
class Line {
 public:
  explicit Line(bool quiet) : shown_(!quiet && isatty(STDERR_FILENO) != 0) {}
  void update(const char* doing, double fraction) {
    const double elapsed = std::chrono::duration<double>(Clock::now() - start_).count();
    if (!shown_ || elapsed < next_) return;
    next_ = elapsed + 0.3;
    const double left = fraction > 0 ? elapsed * (1 - fraction) / fraction : 0;
    line_.draw(fmt::format("{} {:.0f} %, ETA {:.0f} s", doing, 100 * fraction, left));
  }
  void clear() { line_.clear(); }

 private:
  bool shown_;
  output::TerminalLine line_;
  double next_ = 0.5;
  Clock::time_point start_ = Clock::now();
};

std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> words;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t comma = std::min(text.find(',', at), text.size());
    if (comma > at) words.push_back(text.substr(at, comma - at));
    at = comma + 1;
  }
  return words;
}

/// Where the results go unless -o says it: beside the data they are of.
fs::path default_output(const fs::path& source) {
  fs::path plain = output::without_end_slash(source);
  if (fs::is_directory(plain)) return plain.string() + "-analysis";
  if (plain.extension() == ".gz") plain = plain.stem();
  return fs::path(plain.stem().string() + "-analysis");
}

std::optional<double> seconds(const Options& options, const char* name) {
  if (!options.has(name)) return std::nullopt;
  const double value = options.number(name);
  if (!std::isfinite(value)) throw UserError(fmt::format("--{}: give a time in s", name));
  return value;
}

/// Removes the tables and pictures of the earlier results in OUT, which these may lack: files named after an analyzer of theirs
/// (ANALYZER.….csv, .svg, .png) and numbers.csv. Anything else in OUT stays.
void remove_earlier(const fs::path& output) {
  const auto earlier = output::read_json(output / "results.json");
  if (!earlier.is_object() || !earlier.contains("provenance") || !earlier["provenance"].contains("analyzers")) return;
  std::error_code ignored;
  fs::remove(output / "tables" / "numbers.csv", ignored);
  for (const char* const folder : {"tables", "pictures"}) {
    std::vector<fs::path> ours;
    for (const auto& entry : fs::directory_iterator(output / folder, ignored)) {
      const std::string ending = entry.path().extension().string(), name = entry.path().filename().string();
      const bool written = std::string(folder) == "tables" ? ending == ".csv" : ending == ".svg" || ending == ".png";
      for (const auto& [analyzer, options] : earlier["provenance"]["analyzers"].items()) {
        if (written && name.starts_with(analyzer + ".")) ours.push_back(entry.path());
      }
    }
    for (const fs::path& file : ours) fs::remove(file, ignored);
  }
}

/// Makes OUT and refuses what is there, before the work begins.
void prepare(const fs::path& output, bool force) {
  std::error_code ignored;
  if (fs::exists(output, ignored) && !fs::is_directory(output, ignored)) {
    throw UserError(fmt::format("{}: is a file, a directory is needed; choose another -o", output.string()));
  }
  if (!force) output::refuse_existing(output / "results.h5");
  remove_earlier(output);
  fs::create_directories(output / "tables");
}

/// Draws every curve and map; what has no picture, and why the mill lacks its lifters, becomes a note of the report.
std::vector<std::string> draw(const analysis::ResultSet& results, const fs::path& output, const host::Registry& registry) {
  std::string why;
  const picture::MillOutline mill = picture::outline_of(results, registry, why);
  std::vector<std::string> notes;
  if (!why.empty()) notes.push_back("the pictures show the shell without lifters: " + why);
  const picture::DrawnPictures drawn = picture::draw_results(results, output / "pictures", mill);
  if (!drawn.left_out.empty()) {
    notes.push_back(fmt::format("{} results have no picture, {}{}", drawn.left_out.size(), drawn.left_out.front(),
                                drawn.left_out.size() > 1 ? ", …" : ""));
  }
  return notes;
}

void print_report(const analysis::ResultSet& results, const fs::path& output, bool all) {
  const analysis::ResultMeta& meta = results.meta;
  fmt::print("{}\n{} block{} of {:.3g} s, {} resamples; intervals hold with 90 %\n", meta.description, meta.blocks.size(),
             meta.blocks.size() == 1 ? "" : "s", meta.block_duration, meta.draws);
  // One figure for "how many": of x, which the power goes with.
  if (!meta.times.empty() && meta.times.front().independent > 0)
    fmt::print("N_eff {:.0f}: the mean x rests on so many independent values, (sigma/sem)^2 over the blocks\n",
               meta.times.front().independent);
  fmt::print("\n{}\n", analysis::number_table(results, all ? results.arrays.size() : kShownNumbers));
  for (const std::string& note : meta.notes) fmt::print("note: {}\n", note);
  for (const std::string& reason : meta.left_out) fmt::print("left out: {}\n", reason);
  fmt::print("joint covariance of {} values, rank {}\n", results.covariance_entries.size(), results.covariance_rank);
  fmt::print("results in {}: results.h5, results.json, tables/, pictures/\n", output.string());
}

}  // namespace

int analyze(const Arguments& arguments) {
  Options options(
      "analyze SIM_OUT|recording.yaml|FILE [-o OUT]",
      "Runs analyzers over a simulation or a recording. Writes results.h5 (values, uncertainty, joint covariance), results.json, tables "
      "and pictures into OUT.",
      "millscope analyze demo-out -o demo-analysis --set analyzers.pept_grid.cells_x=30");
  options.positional("SOURCE", "directory of 'millscope run', recording.yaml, or a bare file of locations");
  options.add()("output,o", po::value<std::string>()->value_name("OUT"), "directory for the results (default: SOURCE-analysis)");
  options.add()("force", "replace the results in OUT");
  options.add()("analyzers", po::value<std::string>()->value_name("a,b"), "only these; default: all whose needs the data meet");
  options.add()("settings", po::value<std::string>()->value_name("FILE.yaml"), "analyzers, their parameters, resampling and trajectory");
  options.add()("tracer", po::value<std::string>()->value_name("ID,ID"),
                "follow these beads of tracks.h5, or 'all', as a camera would, instead of looking at every bead");
  options.add()("from", po::value<double>()->value_name("s"), "leave out what is earlier");
  options.add()("to", po::value<double>()->value_name("s"), "leave out what is later");
  options.add()("threads", po::value<int>()->value_name("N"), "threads (default: all cores); no influence on results");
  options.add()("no-pictures", "draw nothing");
  options.add()("all", "print every number, not the first eight of each analyzer");
  options.add()("quiet,q", "print nothing but errors");
  options.with_overrides("replace a setting (may be repeated), e.g. --set analyzers.pept_grid.cells_x=40, --set resampling.draws=400");
  options.with_plugins();
  if (!options.parse(arguments)) return kDone;

  analysis::AnalysisRequest request;
  request.path = options.text("SOURCE");
  refuse_other_kind("RECORDING", options.text("SOURCE"));
  request.overrides = options.list("set");
  if (options.has("tracer")) request.tracers = split(options.text("tracer"));
  request.command_line = command_line;
  if (options.has("settings")) request.settings = options.text("settings");
  if (options.has("analyzers")) request.only = split(options.text("analyzers"));
  request.from = seconds(options, "from");
  request.to = seconds(options, "to");
  if (options.has("threads")) {
    request.threads = options.integer("threads");
    if (request.threads < 1 || request.threads > 1024) throw UserError(fmt::format("--threads {}: give 1 to 1024", request.threads));
  }
  const bool quiet = options.has("quiet");
  const fs::path output = options.has("output") ? fs::path(options.text("output")) : default_output(request.path);
  const bool force = options.has("force");
  if (!force) output::refuse_existing(output / "results.h5");  // before the work begins

  Line line(quiet);
  request.progress = [&line](const char* doing, double fraction) { line.update(doing, fraction); };
  const host::Registry registry = options.registry();
  analysis::ResultSet results = analysis::analyze(request, registry);
  prepare(output, force);
  if (!options.has("no-pictures")) {
    line.update("drawing", 0);
    for (std::string& note : draw(results, output, registry)) results.meta.notes.push_back(std::move(note));
  }
  analysis::write_tables(output / "tables", results);
  output::write_json(output / "results.json", analysis::summary_json(results));
  analysis::write_results(output / "results.h5", results, force);
  line.clear();
  if (!quiet) print_report(results, output, options.has("all"));
  return kDone;
}

}  // namespace millscope::app
