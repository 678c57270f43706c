// Simulations that begin where another one ended: what stands in the key, who waits for whom, what becomes of them where one fails.
#include <sys/stat.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "studies/campaign/cache.hpp"
#include "studies/campaign/identity.hpp"
#include "tests/campaign/helpers.hpp"

namespace millscope::campaign::test {
namespace {

constexpr double kDevelop = 0.02;  // s, before the analysis, which begins at 0.025 s

Simulation after(const Folder& folder, const Simulation& donor, std::vector<std::string> settings, double develop = kDevelop) {
  Simulation s = folder.simulation(std::move(settings));
  s.donor = std::make_shared<const Simulation>(donor);
  s.develop_s = develop;
  return s;
}

nlohmann::json summary(const Outcome& o) { return nlohmann::json::parse(base::text_of(o.folder / "summary.json")); }

/// Folder of the run from whose end this one began; empty: from none.
fs::path began_at(const Outcome& o) {
  const nlohmann::json s = summary(o);
  return s.contains("start") ? fs::path(s["start"]["run"].get<std::string>()) : fs::path();
}

const std::vector<std::string> kRunsAway{"time.step_s=0.002", "run.allow_unstable=true", "seed=9"};
const std::vector<std::string> kUnreadable{"time.end=2"};

/// A program that notes the entries that it is started with.
fs::path noting_program(const Folder& folder, const fs::path& notes) {
  fs::path script = folder.path() / "noting.sh";
  write(script, "#!/bin/sh\nbasename \"$2\" >> '" + notes.string() + "'\nexec '" + folder.options().program.string() + "' \"$@\"\n");
  ::chmod(script.c_str(), 0755);
  return script;
}

}  // namespace

TEST_CASE("the donor's key and the time after it stand in the key, its path does not") {
  const Folder folder, elsewhere;
  const Options options = folder.options();
  const Simulation donor = folder.simulation({"seed=2"});
  const std::string cold = key(folder.simulation({"seed=3"}), options), warm = key(after(folder, donor, {"seed=3"}), options);
  CHECK(warm != cold);
  CHECK(key(after(folder, donor, {"seed=3"}), options) == warm);
  CHECK(key(after(folder, donor, {"seed=3"}, 0.01), options) != warm);
  CHECK(key(after(folder, donor, {"seed=4"}), options) != warm);
  CHECK(key(after(folder, folder.simulation({"seed=5"}), {"seed=3"}), options) != warm);
  CHECK(key(after(folder, after(folder, folder.simulation(), {"seed=2"}), {"seed=3"}), options) != warm);  // another donor of the donor
  CHECK(key(after(elsewhere, elsewhere.simulation({"seed=2"}), {"seed=3"}), elsewhere.options()) == warm);
  Simulation named = donor;
  named.label = "another";
  CHECK(key(after(folder, named, {"seed=3"}), options) == warm);
}

TEST_CASE("a donor that cannot be read is passed over") {
  const Folder folder;
  const Options options = folder.options();
  const Simulation good = folder.simulation({"seed=2"});
  CHECK(key(after(folder, after(folder, good, kUnreadable), {"seed=3"}), options) == key(after(folder, good, {"seed=3"}), options));
  CHECK(key(after(folder, folder.simulation(kUnreadable), {"seed=3"}), options) == key(folder.simulation({"seed=3"}), options));
}

TEST_CASE("a case with a start of its own goes by the content of the run that it names") {
  const Folder folder;
  const Options options = folder.options();
  const Outcome one = run(std::vector{folder.simulation()}, options)[0];
  fs::copy(one.folder, folder.path() / "copy", fs::copy_options::recursive);
  const auto from = [&](const fs::path& run) { return folder.simulation({"start.run=" + run.string(), "start.develop_s=0.02"}); };
  CHECK(key(from(one.folder), options) == key(from(folder.path() / "copy"), options));
  const Outcome other = run(std::vector{folder.simulation({"seed=2"})}, options)[0];
  CHECK(key(from(other.folder), options) != key(from(one.folder), options));
  CHECK_THROWS_WITH(key(from(folder.path() / "nowhere"), options), Catch::Contains("cannot be read"));
  Simulation both = from(one.folder);
  both.donor = std::make_shared<const Simulation>(folder.simulation());
  both.develop_s = kDevelop;
  CHECK_THROWS_WITH(key(both, options), Catch::Contains("leave 'start' out"));
  CHECK_THROWS_WITH(key(after(folder, folder.simulation(), {}, 0.03), options), Catch::Contains("0.03 s before"));
}

TEST_CASE("a simulation waits for its donor, which is run though nobody asked for it") {
  const Folder folder;
  Options options = folder.options();
  const fs::path notes = folder.path() / "notes";
  options.program = noting_program(folder, notes);
  options.slots = 3;
  const Simulation first = folder.simulation({"seed=2"}), second = after(folder, first, {"seed=3"}),
                   third = after(folder, second, {"seed=4"});
  const std::vector<Simulation> asked{third, first};
  const std::vector<Outcome> outcomes = run(asked, options);
  REQUIRE(outcomes.size() == 2);
  CHECK(outcomes[0].state == State::done);
  CHECK(outcomes[1].state == State::done);
  CHECK(base::text_of(notes) == key(first, options) + "\n" + key(second, options) + "\n" + key(third, options) + "\n");
  CHECK(fs::equivalent(began_at(outcomes[0]), options.cache / key(second, options) / "run"));
  CHECK(began_at(outcomes[1]).empty());
  CHECK_THAT(base::text_of(outcomes[0].folder.parent_path() / "case.yaml"), Catch::Contains("../" + key(second, options) + "/run"));
  options.program = "/bin/false";  // nothing is to be started
  for (const Outcome& o : run(asked, options)) CHECK((o.state == State::done && o.cached));
}

TEST_CASE("where the donor fails its own donor takes its place, and where none is left the simulation begins at rest") {
  const Folder folder;
  Options options = folder.options();
  const Simulation good = folder.simulation({"seed=2"}), bad = after(folder, good, kRunsAway), rootless = folder.simulation(kRunsAway);
  const std::vector<Simulation> asked{bad, after(folder, bad, {"seed=3"}), after(folder, rootless, {"seed=3"})};
  const std::vector<Outcome> outcomes = run(asked, options);
  CHECK(outcomes[0].state == State::failed);
  REQUIRE(outcomes[1].state == State::done);
  CHECK(fs::equivalent(began_at(outcomes[1]), options.cache / key(good, options) / "run"));
  CHECK(outcomes[1].key == key(asked[1], options));
  REQUIRE(outcomes[2].state == State::done);
  CHECK(began_at(outcomes[2]).empty());
  CHECK(outcomes[2].key != key(folder.simulation({"seed=3"}), options));
  const Outcome cold = run(std::vector{folder.simulation({"seed=3"})}, options)[0];
  CHECK(summary(outcomes[2])["state_hash"] == summary(cold)["state_hash"]);
}

TEST_CASE("an entry says anew from where it begins") {
  const Folder folder;
  const fs::path cache = folder.options().cache;
  const Entry entry(cache, "one");
  fs::create_directories(entry.folder());
  write(entry.case_file(), "name: x\n");
  entry.begin_from("two", 0.5);
  CHECK(base::text_of(entry.case_file()) == "name: x\nstart: {run: ../two/run, develop_s: 0.5}\n");
  entry.begin_from("three", 0.5);
  CHECK(base::text_of(entry.case_file()) == "name: x\nstart: {run: ../three/run, develop_s: 0.5}\n");
  entry.begin_from("", 0.5);
  CHECK(base::text_of(entry.case_file()) == "name: x\n");
}

}  // namespace millscope::campaign::test
