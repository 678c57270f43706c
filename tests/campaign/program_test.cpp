// A law that changes is computed anew by all that used it and by nothing else; its comments, its formatting and its folder leave the cache.
#include <cstdlib>
#include <functional>
#include <nlohmann/json.hpp>

#include "kernel/base/text.hpp"
#include "studies/campaign/identity.hpp"
#include "tests/campaign/helpers.hpp"

namespace millscope::campaign::test {
namespace {

using Catch::Matchers::Contains;

void replace(std::string& text, const std::string& old, const std::string& with) {
  REQUIRE(text.find(old) != std::string::npos);
  text = replaced(std::move(text), old, with);
}

/// The linear spring under another name, as a third party would have it: edited, built in a folder of its own.
fs::path build_law(const Folder& folder, const std::string& name, const std::function<void(std::string&)>& edit) {
  const fs::path place = folder.path() / name, sources = MILLSCOPE_SOURCE_DIR;
  fs::create_directories(place);
  std::string text = base::text_of(sources / "plugins/contact_laws/linear_spring_dashpot.cpp");
  replace(text, "\"linear_spring_dashpot\"", "\"own_spring\"");
  edit(text);
  write(place / "own_spring.cpp", text);
  const std::string command = std::string(MILLSCOPE_CXX) +
                              " -std=c++20 -O1 -DNDEBUG -fPIC -shared -fvisibility=hidden -ffp-contract=off -Wno-psabi -I '" +
                              (sources / "sdk/include").string() + "' -I '" + (sources / "plugins/contact_laws").string() + "' -o '" +
                              (place / "libown_spring.so").string() + "' '" + (place / "own_spring.cpp").string() + "' && chmod go-w '" +
                              place.string() + "' '" + (place / "libown_spring.so").string() + "'";
  REQUIRE(std::system(command.c_str()) == 0);
  return place;
}

void leave(std::string&) {}

/// Comments, blank lines and spaces.
void reformat(std::string& text) {
  replace(text, "#include \"options.hpp\"", "/* a comment\n   of two lines */\n\n#include   \"options.hpp\"  // and another");
  replace(text, "const R overlap = maximum(c.overlap, zero);", "const R overlap =\n\n        maximum(c.overlap,   zero);  // the overlap");
}

void stiffen(std::string& text) {
  replace(text, "const R overlap = maximum(c.overlap, zero);", "const R overlap = R(1.001) * maximum(c.overlap, zero);");
}

const std::vector<std::string> kOwnLaw{"contact.law.kind=own_spring", "pairs.default.contact_time=0.001"};

struct Session {
  Options options;
  std::vector<std::string> said;
  explicit Session(const Folder& folder) : options(folder.options()) {
    options.say = [this](const std::string& line) { said.push_back(line); };
  }
  std::vector<Outcome> run(const std::vector<Simulation>& simulations, const fs::path& plugins) {
    said.clear();
    options.plugin_directories = {plugins};
    return campaign::run(simulations, options);
  }
};

std::string state_hash(const Outcome& o) {
  return nlohmann::json::parse(base::text_of(o.folder / "summary.json"))["state_hash"].get<std::string>();
}

}  // namespace

TEST_CASE("a changed law is computed anew by what used it alone, changed comments by nothing") {
  const Folder folder;
  const fs::path first = build_law(folder, "first", leave);
  const std::vector<Simulation> simulations{folder.simulation(kOwnLaw), folder.simulation()};
  Session session(folder);
  const std::vector<Outcome> computed = session.run(simulations, first);
  REQUIRE(computed[0].state == State::done);
  CHECK((!computed[0].cached && !computed[1].cached));
  CHECK(session.said.empty());

  const std::vector<Outcome> reformatted = session.run(simulations, build_law(folder, "a folder with a much longer name", reformat));
  CHECK((reformatted[0].cached && reformatted[1].cached));
  CHECK(session.said == std::vector<std::string>{"simulations found in the cache: 2 of 2"});

  const std::vector<Outcome> stiffer = session.run(simulations, build_law(folder, "stiffer", stiffen));
  CHECK_FALSE(stiffer[0].cached);
  CHECK(stiffer[1].cached);  // hertz_mindlin is what it was
  CHECK(state_hash(stiffer[0]) != state_hash(computed[0]));
  REQUIRE(session.said.size() == 2);
  CHECK(session.said[0] == "simulations found in the cache: 1 of 2");
  CHECK(session.said[1] ==
        "simulations in the cache that another program computed and that are not used: 1; what differs: contact_law own_spring");
}

TEST_CASE("what another kernel has computed is not used, and it is said") {
  const Folder folder;
  Options options = folder.options();
  std::vector<std::string> said;
  options.say = [&](const std::string& line) { said.push_back(line); };
  const std::vector<Simulation> simulations{folder.simulation()};
  const Outcome first = run(simulations, options)[0];
  const fs::path entry = first.folder.parent_path(), other = options.cache / (case_of(first.key) + "-0123456789abcdef");
  fs::rename(entry, other);
  nlohmann::json task = nlohmann::json::parse(base::text_of(other / "task.json"));
  CHECK(task["program"]["compiler"].get<std::string>().size() > 3);
  task["program"]["code"] = "0000000000000000";
  task["program"]["flags"] = "-Ofast";
  write(other / "task.json", task.dump());
  const Outcome again = run(simulations, options)[0];
  CHECK_FALSE(again.cached);
  CHECK(again.key == first.key);
  REQUIRE(said.size() == 1);
  CHECK_THAT(said[0], Contains("not used: 1; what differs: code, flags"));

  // An entry of a millscope that did not tell programs apart.
  fs::remove_all(entry);
  fs::rename(other, options.cache / case_of(first.key));
  write(options.cache / case_of(first.key) / "task.json", "{}");
  said.clear();
  CHECK_FALSE(run({{folder.simulation({"seed=2"})}}, options)[0].cached);
  REQUIRE(said.size() == 1);
  CHECK_THAT(said[0], Contains("all of other programs") && Contains(": 1"));
}

}  // namespace millscope::campaign::test
