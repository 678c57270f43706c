// What many simulations give cause to doubt: each doubt once, with how many say it and the worst value.
#include "studies/campaign/doubts.hpp"

#include "tests/campaign/helpers.hpp"

namespace millscope::campaign::test {
namespace {

run::Doubt doubt(const std::string& name, const std::string& of, double value, double limit) {
  return {name, of, value, limit, "unit", name + " found", "this may change", "do that"};
}

fs::path run_with(const Folder& folder, const std::string& name, const std::vector<run::Doubt>& doubts) {
  nlohmann::ordered_json summary;
  summary["doubts"] = doubts;
  fs::create_directories(folder.path() / name);
  write(folder.path() / name / "summary.json", summary.dump());
  return folder.path() / name;
}

}  // namespace

TEST_CASE("a doubt of several simulations is told once, with the worst of them") {
  const Folder folder;
  const std::set<fs::path> runs{
      run_with(folder, "a", {doubt("overlap", "glass~steel (wall)", 0.1, 0.05), doubt("short_window", "", 1.5, 2)}),
      run_with(folder, "b", {doubt("overlap", "glass~steel (wall)", 0.3, 0.05), doubt("short_window", "", 0.5, 2)}),
      run_with(folder, "c", {doubt("overlap", "glass~glass", 0.2, 0.05), doubt("short_window", "", 1, 2)}), run_with(folder, "d", {})};
  const std::vector<SharedDoubt> shared = shared_doubts(runs);
  REQUIRE(shared.size() == 3);
  CHECK(shared[0].worst.value == 0.3);
  CHECK(shared[0].said_by == 2);
  CHECK(shared[0].simulations == 4);
  CHECK(shared[1].worst.name == "short_window");
  CHECK(shared[1].worst.value == 0.5);  // the least is the worst
  CHECK(shared[1].said_by == 3);
  CHECK(shared[2].worst.of == "glass~glass");
  CHECK(sentence_of(shared[0]) == "2 of 4 simulations, the worst: overlap found; this may change; do that");
  CHECK(sentence_of(shared[2]) == "1 of 4 simulations: overlap found; this may change; do that");
  const nlohmann::ordered_json j = doubts_json(shared);
  CHECK(j[0]["name"] == "overlap");
  CHECK(j[0]["said_by"] == 2);
  CHECK(j[2]["simulations"] == 4);
}

TEST_CASE("simulations of before there were doubts, and what is no simulation, say nothing") {
  const Folder folder;
  fs::create_directories(folder.path() / "old");
  write(folder.path() / "old/summary.json", R"({"steady": true})");
  CHECK(shared_doubts({folder.path() / "old", folder.path() / "none", {}}).empty());
  CHECK(shared_doubts({}).empty());
}

TEST_CASE("a simulation that left no folder does not take the working directory's doubts") {
  const Folder folder;
  const fs::path run = run_with(folder, "a", {doubt("overlap", "glass~glass", 0.2, 0.05)}), before = fs::current_path();
  fs::current_path(run);
  const std::size_t without = shared_doubts({fs::path()}).size(), there = shared_doubts({fs::path(".")}).size();
  fs::current_path(before);
  CHECK(without == 0);
  CHECK(there == 1);
}

}  // namespace millscope::campaign::test
