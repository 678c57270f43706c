// Tables, files and pictures of a comparison.
#include "studies/compare/report.hpp"

#include <catch2/catch.hpp>
#include <sstream>

#include "host/temporary.hpp"
#include "made_up.hpp"

using namespace millscope;
using compare_test::make_results;

namespace {

std::vector<std::string> lines_of(const std::filesystem::path& path) {
  std::ifstream in(path);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

compare::Comparison example() { return compare::compare(make_results({.seed = 3}), make_results({.seed = 4, .power = 0.6}), {}); }

}  // namespace

TEST_CASE("the table ranks, marks what differs and lines up") {
  const std::string table = compare::comparison_table(example(), 3);
  std::istringstream in(table);
  std::string head, first;
  std::getline(in, head), std::getline(in, first);
  CHECK(head.find("rank  observable") == 0);
  CHECK(first.find("1 *   power.power_gravity") == 0);
  CHECK(first.find(" W ") != std::string::npos);
  CHECK(table.find("… and 5 more\n") != std::string::npos);
}

TEST_CASE("files hold every judged value and can be read by machine") {
  const host_test::Temporary folder;
  const compare::Comparison c = example();
  compare::write_comparison(c, folder.path() / "out");
  const auto observables = lines_of(folder.path() / "out" / "observables.csv"), elements = lines_of(folder.path() / "out" / "elements.csv");
  CHECK(observables.size() == 1 + c.observables.size());
  std::size_t all = 1;
  for (const compare::ComparedObservable& o : c.observables) all += o.elements.size();
  CHECK(elements.size() == all);
  CHECK(observables[1].find("1,power.power_gravity,W,1,") == 0);
  std::ifstream in(folder.path() / "out" / "comparison.json");
  const auto json = nlohmann::json::parse(in);
  CHECK(json["verdict"] == "differ");
  CHECK(json["observables"].size() == c.observables.size());
  CHECK(json["observables"][0]["differs"] == true);
  CHECK(json["observables"][0]["strongest"]["difference"].get<double>() ==
        Approx(c.observables[0].elements[0].b - c.observables[0].elements[0].a));
  for (const auto& entry : std::filesystem::directory_iterator(folder.path() / "out")) CHECK(entry.path().extension() != ".tmp");
}

TEST_CASE("every map and curve has a picture, the same on each call") {
  const host_test::Temporary folder;
  const compare::Comparison c = example();
  const picture::MillOutline mill{.radius = 0.15, .omega = -6};
  const auto drawn = compare::draw_comparison(c, folder.path() / "one", mill);
  CHECK(drawn.size() == 4);  // two distributions, two maps
  compare::draw_comparison(c, folder.path() / "two", mill);
  for (const auto& stem : drawn) {
    const auto other = folder.path() / "two" / stem.filename();
    CHECK(lines_of(stem.string() + ".svg") == lines_of(other.string() + ".svg"));
    CHECK(lines_of(stem.string() + ".png") == lines_of(other.string() + ".png"));
    CHECK(lines_of(stem.string() + ".svg").size() > 50);
  }
}
