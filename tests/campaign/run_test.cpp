// Campaigns through the library: what is computed, what is not, and how many at once.
#include <sys/stat.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/campaign/helpers.hpp"

namespace millscope::campaign::test {
namespace {

/// Files with their times of change and sizes.
std::map<std::string, std::pair<fs::file_time_type, std::uintmax_t>> state_of(const fs::path& folder) {
  std::map<std::string, std::pair<fs::file_time_type, std::uintmax_t>> state;
  for (const auto& f : fs::recursive_directory_iterator(folder)) {
    if (f.is_regular_file() && f.path().filename() != ".guard") state[f.path().string()] = {f.last_write_time(), f.file_size()};
  }
  return state;
}

/// A program that notes when simulations begin and end, and lasts long enough for two to meet.
fs::path noting_program(const Folder& folder, const fs::path& notes) {
  fs::path script = folder.path() / "noting.sh";
  write(script, "#!/bin/sh\necho begin >> '" + notes.string() + "'\nsleep 0.3\n'" + folder.options().program.string() +
                    "' \"$@\"\ncode=$?\necho end >> '" + notes.string() + "'\nexit $code\n");
  ::chmod(script.c_str(), 0755);
  return script;
}

int most_at_once(const fs::path& notes) {
  std::istringstream in(base::text_of(notes));
  int now = 0, most = 0;
  for (std::string word; in >> word;) {
    now += word == "begin" ? 1 : -1;
    most = std::max(most, now);
  }
  return most;
}

std::vector<Simulation> three(const Folder& folder) {
  return {folder.simulation({"seed=1"}), folder.simulation({"seed=2"}), folder.simulation({"seed=3"})};
}

}  // namespace

TEST_CASE("what has been computed is not computed again") {
  const Folder folder;
  Options options = folder.options();
  std::vector<Simulation> simulations = three(folder);
  simulations.push_back(simulations[1]);  // the same twice
  std::vector<std::size_t> told;
  options.finished = [&](std::size_t index, const Outcome& o) {
    told.push_back(index);
    CHECK(o.state == State::done);
  };
  const std::vector<Outcome> first = run(simulations, options);
  std::sort(told.begin(), told.end());
  CHECK(told == std::vector<std::size_t>{0, 1, 2, 3});
  CHECK(first[1].folder == first[3].folder);
  CHECK((!first[1].cached && first[3].cached));
  for (const Outcome& o : first) {
    CHECK(o.wall_s > 0);
    CHECK(fs::exists(o.folder / "summary.json"));
    CHECK(o.key == o.folder.parent_path().filename());
    CHECK_FALSE(fs::exists(o.folder.parent_path() / "lock"));
  }
  const auto before = state_of(options.cache);
  options.program = "/bin/false";  // nothing is to be started
  const std::vector<Outcome> second = run(simulations, options);
  for (const Outcome& o : second) CHECK((o.state == State::done && o.cached));
  CHECK(state_of(options.cache) == before);
}

TEST_CASE("a simulation that fails is recorded, and tried again only when asked") {
  const Folder folder;
  Options options = folder.options();
  const std::vector<Simulation> simulations{folder.simulation({"time.step_s=0.002", "run.allow_unstable=true"}),  // runs away
                                            folder.simulation({"time.step_fraction=0.9"}),                        // is refused
                                            folder.simulation({"time.end=2"}),                                    // cannot be read
                                            folder.simulation()};
  const std::vector<Outcome> first = run(simulations, options);
  CHECK((first[0].state == State::failed && !first[0].cached));
  CHECK_THAT(first[0].message, Catch::Contains("moved more than half its radius"));
  CHECK_THAT(first[1].message, Catch::Contains("Rayleigh time"));
  CHECK_THAT(first[2].message, Catch::Contains("did you mean"));
  CHECK(first[2].folder.empty());
  CHECK(first[3].state == State::done);
  const auto attempts = [&] {
    return nlohmann::json::parse(base::text_of(first[0].folder.parent_path() / "task.json"))["attempts"].get<int>();
  };
  CHECK(attempts() == 1);
  const std::vector<Outcome> second = run(simulations, options);
  CHECK((second[0].cached && second[0].message == first[0].message && attempts() == 1));
  options.retry_failed = true;
  const std::vector<Outcome> third = run(simulations, options);
  CHECK((!third[0].cached && third[0].message == first[0].message && attempts() == 2));
}

TEST_CASE("a program that crashes or says nothing is recorded, one that cannot be started ends the campaign") {
  const Folder folder;
  Options options = folder.options();
  const fs::path script = folder.path() / "crash.sh";
  write(script, "#!/bin/sh\necho last words >&2\nkill -SEGV $$\n");
  ::chmod(script.c_str(), 0755);
  options.program = script;
  const std::vector<Simulation> one{folder.simulation()};
  CHECK_THAT(run(one, options)[0].message, Catch::Contains("crashed") && Catch::Contains("last words"));
  write(script, "#!/bin/sh\nexit 9\n");
  options.retry_failed = true;
  CHECK_THAT(run(one, options)[0].message, Catch::Contains("code 9"));
  options.program = folder.path() / "nowhere";
  CHECK_THROWS_WITH(run(one, options), Catch::Contains("cannot be started"));
  options = folder.options();
  options.retry_failed = true;
  CHECK(run(one, options)[0].state == State::done);  // the failure to start was not held against it
}

TEST_CASE("memory and slots limit how many run at once") {
  const Folder folder;
  const fs::path notes = folder.path() / "notes";
  Options options = folder.options();
  options.program = noting_program(folder, notes);
  options.slots = 3;
  SECTION("room for all") {
    run(three(folder), options);
    CHECK(most_at_once(notes) == 3);
  }
  SECTION("room for two") {
    options.memory_bytes = 100'000'000;  // one is predicted at 42 MB
    run(three(folder), options);
    CHECK(most_at_once(notes) == 2);
  }
  SECTION("less room than one needs: one at a time") {
    options.memory_bytes = 1;
    for (const Outcome& o : run(three(folder), options)) CHECK(o.state == State::done);
    CHECK(most_at_once(notes) == 1);
  }
  SECTION("one slot") {
    options.slots = 1;
    run(three(folder), options);
    CHECK(most_at_once(notes) == 1);
  }
}

TEST_CASE("options that make no sense are refused") {
  const Folder folder;
  Options options = folder.options();
  options.runner = "cloud";
  CHECK_THROWS_WITH(run(three(folder), options), Catch::Contains("local or slurm"));
  options = folder.options();
  options.slots = -1;
  CHECK_THROWS_WITH(run(three(folder), options), Catch::Contains("slots"));
  options = folder.options();
  options.cache.clear();
  CHECK_THROWS_WITH(run(three(folder), options), Catch::Contains("cache"));
  options = folder.options();
  write(options.cache, "a file");
  CHECK_THROWS_AS(run(three(folder), options), base::UserError);
}

}  // namespace millscope::campaign::test
