#include "studies/campaign/tasks_file.hpp"

#include "tests/campaign/helpers.hpp"

namespace millscope::campaign::test {

TEST_CASE("tasks are read in their order, common settings first") {
  const Folder folder;
  const fs::path file = folder.path() / "tasks.yaml";
  write(file,
        "schema_version: 1\ncase: case.yaml\nset: [time.end_s=1]\nsimulations:\n  slow: {set: [mill.speed=50 %critical, seed=2]}\n"
        "  other: {case: other.yaml}\n");
  CHECK_THAT(testing::refusal([&] { read_tasks(file.string()); }),
             Catch::Contains("tasks.yaml:6: 'simulations.other.case' is 'other.yaml': no such file"));
  write(folder.path() / "other.yaml", "seed: 1\n");
  const std::vector<Simulation> s = read_tasks(file.string());
  REQUIRE(s.size() == 2);
  CHECK(s[0].label == "slow");
  CHECK(s[0].case_file == folder.case_file());
  CHECK(s[0].settings == std::vector<std::string>{"time.end_s=1", "mill.speed=50 %critical", "seed=2"});
  CHECK(s[1].case_file == folder.path() / "other.yaml");
  CHECK(s[1].settings == std::vector<std::string>{"time.end_s=1"});
}

TEST_CASE("tasks that make no sense are refused with their line") {
  const Folder folder;
  const fs::path file = folder.path() / "tasks.yaml";
  const auto refused = [&](const std::string& text) {
    write(file, "schema_version: 1\n" + text);
    try {
      read_tasks(file.string());
    } catch (const base::UserError& e) {
      return std::string(e.what());
    }
    return std::string("nothing");
  };
  CHECK_THAT(refused("case: case.yaml\n"), Catch::Contains("simulations"));
  CHECK_THAT(refused("case: case.yaml\nsimulations: {}\n"), Catch::Contains("empty"));
  CHECK_THAT(refused("simulations:\n  a: {set: [seed=1]}\n"), Catch::Contains("tasks.yaml:3") && Catch::Contains("case"));
  CHECK_THAT(refused("case: case.yaml\nsimulations:\n  a: {set: [seed]}\n"),
             Catch::Contains("tasks.yaml:4") && Catch::Contains("path.to.key=value"));
  CHECK_THAT(refused("case: case.yaml\nsimulation:\n  a: {}\n"), Catch::Contains("did you mean 'simulations'"));
  CHECK_THAT(refused("case: case.yaml\nsimulations:\n  a: {sets: [seed=1]}\n"), Catch::Contains("did you mean 'set'"));
}

TEST_CASE("the table quotes what it must") {
  const Folder folder;
  const std::vector<Simulation> simulations{folder.simulation(), folder.simulation(), folder.simulation()};
  std::vector<Outcome> outcomes(3);
  outcomes[0] = {State::done, "/cache/0/run", "", true, 1.5, "0"};
  outcomes[1] = {State::failed, "/cache/1/run", "too long, \"unstable\"", false, 0, "1"};
  write_table(folder.path() / "campaign.csv", simulations, outcomes, {true, true, false});
  CHECK(base::text_of(folder.path() / "campaign.csv") ==
        "label,key,state,wall_s,cached,folder,message\n"
        "tiny,0,done,1.500,yes,/cache/0/run,\n"
        "tiny,1,failed,,no,/cache/1/run,\"too long, \"\"unstable\"\"\"\n"
        "tiny,,open,,,,\n");
}

}  // namespace millscope::campaign::test
