// report, watch: the page of everything that was found.
#include <fmt/core.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>

#include "app/commands.hpp"
#include "app/watching.hpp"
#include "kernel/output/directory.hpp"
#include "kernel/output/file.hpp"
#include "studies/report/movie.hpp"
#include "studies/report/report.hpp"
#include "studies/report/watch.hpp"

namespace millscope::app {
namespace {

namespace po = boost::program_options;
namespace fs = std::filesystem;
using base::UserError;

constexpr double kMostMovie = 500;  // MB
constexpr int kStay = 60;           // s that a page is served after the last run has ended

volatile std::sig_atomic_t stop_asked = 0;
void stop_watching(int) { stop_asked = 1; }

std::string title_of(const Options& options, const std::vector<std::string>& folders) {
  if (options.has("title")) return options.text("title");
  return output::name_of_folder(folders.front());
}

report::SectionOptions sections_from(const Options& options) {
  if (!options.has("movie-mb")) return {report::kMovieBytes};
  const double size = options.number("movie-mb");
  if (!(size > 0 && size <= kMostMovie))
    throw UserError(fmt::format("--movie-mb {}: give more than 0 and at most {} (MB)", size, kMostMovie));
  return {static_cast<std::uint64_t>(1e6 * size)};
}

void add_movie(Options& options) {
  options.add()("movie-mb", po::value<double>()->value_name("MB"),
                "room for the turning mill of each run: more frames, a bigger page (default: 6)");
}

}  // namespace

int report_page(const Arguments& arguments) {
  Options options(
      "report OUT… [-o report.html]",
      "Writes one page of what run, analyze, compare, calibrate, validate, diagnose and challenge found: the mill turning, power, maps, "
      "the verdict and its figures. One file, no network needed; mail it, open it in any browser.",
      "millscope report demo-out demo-analysis -o demo.html");
  options.positional("OUT", "folders that commands of millscope wrote, or a folder of such folders", true);
  options.add()("output,o", po::value<std::string>()->value_name("FILE.html"), "page to write (default: report.html in the first OUT)");
  options.add()("force", "replace the page");
  options.add()("title", po::value<std::string>()->value_name("TEXT"), "title of the page (default: the first folder's name)");
  add_movie(options);
  options.add()("quiet,q", "print nothing but errors");
  options.with_plugins();
  if (!options.parse(arguments)) return kDone;
  const std::vector<std::string> folders = options.list("OUT");
  if (folders.empty()) throw UserError("report: give at least one folder, e.g. millscope report demo-out");
  const fs::path file = options.has("output") ? fs::path(options.text("output")) : fs::path(folders.front()) / "report.html";
  const bool quiet = options.has("quiet");
  if (!options.has("force")) output::refuse_existing(file);
  const host::Registry registry = options.registry();
  std::vector<nlohmann::ordered_json> sections;
  for (const std::string& folder : folders) {
    for (auto& section : report::sections_of(folder, registry, sections_from(options))) sections.push_back(std::move(section));
  }
  report::write_page(file, report::document_of(title_of(options, folders), sections));
  if (quiet) return kDone;
  for (const auto& section : sections) {
    fmt::print("  {:<12} {}\n", section.at("kind").get<std::string>(), section.at("source").get<std::string>());
    for (const auto& note : section.at("notes")) fmt::print("    note: {}\n", note.get<std::string>());
  }
  fmt::print("wrote {} ({}); open it in a browser\n", file.string(), output::size_text(fs::file_size(file)));
  return kDone;
}

int watch(const Arguments& arguments) {
  Options options(
      "watch OUT",
      "Serves the report page of a folder that is still being written, to this machine alone (127.0.0.1, an address with a random token, "
      "nothing can be changed through it). It follows the run by itself and ends a minute after it, or with Ctrl-C.",
      "millscope watch demo-out");
  options.positional("OUT", "folder that 'run' or a study writes into, or a folder of such folders");
  options.add()("port", po::value<int>()->value_name("N"), "port (default: any free one)");
  options.add()("stay", "go on serving when the run has ended, until Ctrl-C");
  add_movie(options);
  options.with_plugins();
  if (!options.parse(arguments)) return kDone;
  const fs::path out = options.text("OUT");
  if (!fs::is_directory(out))
    throw UserError(fmt::format("{}: there is no such folder; give the one that the run writes into", out.string()));
  report::WatchOptions w;
  w.sections = sections_from(options);
  if (options.has("port")) {
    const int port = options.integer("port");
    if (port < 1 || port > 65535) throw UserError(fmt::format("--port {}: give 1 to 65535", port));
    w.port = static_cast<std::uint16_t>(port);
  }
  w.say = [](const std::string& address) { fmt::print("{}\n", address), std::fflush(stdout); };
  const bool stays = options.has("stay");
  int idle = 0;
  w.goes_on = [&] {
    idle = report::is_going_on(out) ? 0 : idle + 1;
    return stop_asked == 0 && (stays || idle <= kStay);
  };
  std::signal(SIGINT, stop_watching);
  std::signal(SIGTERM, stop_watching);
  report::watch(out, options.registry(), w);
  return kDone;
}

void watch_beside(const fs::path& out, const Options& options) {
  const host::Registry registry = options.registry();
  const pid_t parent = ::getpid();
  const pid_t child = ::fork();
  if (child < 0) throw UserError("--watch: the system starts no further process; run 'millscope watch' in another terminal");
  if (child > 0) return;
  // Dies with the run, however that ends; Ctrl-C in the terminal is for the run.
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  std::signal(SIGINT, SIG_IGN);
  int code = kDone;
  try {
    report::WatchOptions w;
    w.sections = {report::kMovieBytes};
    w.say = [](const std::string& address) { fmt::print(stderr, "watch it at {}\n", address); };
    w.goes_on = [parent] { return ::getppid() == parent; };
    report::watch(out, registry, w);
  } catch (const std::exception& e) {
    fmt::print(stderr, "--watch: {}; the run goes on without the page\n", e.what());
    code = kFailed;
  }
  ::_exit(code);
}

}  // namespace millscope::app
