// Reading tables and telling what plan they hold.
#include <fmt/format.h>
#include <catch2/catch.hpp>
#include <cmath>

#include "studies/doe/plan_table.hpp"
#include "support.hpp"

using namespace doe_test;
using Catch::Matchers::Contains;
using Catch::Matchers::WithinAbs;

namespace {

std::string read_refusal(const std::string& text) {
  const File file(text);
  return refusal([&] { base::Table::read(file.path()); });
}

std::string recognise_refusal(const std::string& text, const Choice& choice = {}) {
  const File file(text);
  return refusal([&] { recognise(base::Table::read(file.path()), choice); });
}

RecognisedTable recognised(const std::string& text, const Choice& choice = {}) {
  const File file(text);
  return recognise(base::Table::read(file.path()), choice);
}

const std::string kSquare = "A,B,y\n1,10,3\n2,10,4\n1,20,5\n2,20,6.5\n1.5,15,4\n";

}  // namespace

TEST_CASE("a table may have comments, quotes, a byte order mark, Windows lines and spaces") {
  const File file("\xEF\xBB\xBF# made here\r\ncase,\"a, \"\"b\"\"\" , y\r\n\r\nx 1, 2.50 ,+3e-2\r\n");
  const base::Table t = base::Table::read(file.path());
  CHECK(t.names() == std::vector<std::string>{"case", "a, \"b\"", "y"});
  REQUIRE(t.rows() == 1);
  CHECK(t.cell(0, 0) == "x 1");
  CHECK(t.numbers(1).value[0] == 2.5);
  CHECK_THAT(t.numbers(1).half_digit, WithinAbs(0.005, 1e-15));
  CHECK_THAT(t.numbers(2).half_digit, WithinAbs(0.005, 1e-15));
  CHECK_THAT(t.place(0), Contains(":4"));
}

TEST_CASE("a table that cannot be read says why and where") {
  CHECK_THAT(refusal([] { base::Table::read("/no/such/table.csv"); }), Contains("cannot be read"));
  CHECK_THAT(read_refusal(""), Contains("is empty"));
  CHECK_THAT(read_refusal("A,B\n"), Contains("no rows"));
  CHECK_THAT(read_refusal("A,A\n1,2\n"), Contains(":1: column 'A' stands twice"));
  CHECK_THAT(read_refusal("A,\n1,2\n"), Contains("column 2 has no name"));
  CHECK_THAT(read_refusal("A,B\n1,2\n1,2,3\n"), Contains(":3: 3 cells for 2 columns"));
  CHECK_THAT(read_refusal("A,B\n1,\"2\n"), Contains(":2: a quote"));
  CHECK_THAT(recognise_refusal("A,y\n1,2\n2,x\n1,3\n2,5\n"), Contains(":3: y 'x' is no finite number"));
  CHECK_THAT(recognise_refusal("A,y\n1,2\n2,nan\n1,3\n2,5\n"), Contains("'nan' is no finite number"));
  CHECK_THAT(recognise_refusal("A,y\n1,2\n2,\n1,3\n2,5\n"), Contains(":3: y ''"));
}

TEST_CASE("factors and responses are told apart, or asked for") {
  const RecognisedTable t = recognised(kSquare);
  CHECK(t.kind == PlanKind::two_level);
  CHECK(t.design.factors.size() == 2);
  CHECK(t.responses == std::vector<std::string>{"y"});
  CHECK(t.labels[4] == "5");
  CHECK_THAT(recognise_refusal("A,y\n1.1,2\n2.3,3\n3.7,4\n"), Contains("--factors"));
  CHECK_THAT(recognise_refusal(kSquare, {.factors = {"A", "C"}, .responses = {}, .generators = {}}), Contains("has no column 'C'"));
  CHECK_THAT(recognise_refusal(kSquare, {.factors = {"A", "A"}, .responses = {}, .generators = {}}), Contains("stands twice"));
  CHECK_THAT(recognise_refusal(kSquare, {.factors = {"A"}, .responses = {"A"}, .generators = {}}), Contains("as factor and as response"));
  CHECK_THAT(recognise_refusal(kSquare, {.factors = {"A", "B", "y"}, .responses = {}, .generators = {}}),
             Contains("no column is left for responses"));
}

TEST_CASE("columns of words and constants are left aside and named") {
  const RecognisedTable t = recognised("run,A,y,state,mill\na,1,3,done,300\nb,2,4,done,300\nc,1,3.5,done,300\nd,2,4.5,done,300\n");
  CHECK(t.responses == std::vector<std::string>{"y"});
  CHECK(t.labels == std::vector<std::string>{"a", "b", "c", "d"});
  REQUIRE(t.notes.size() == 1);
  CHECK(t.notes[0] == "columns left aside: state (text), mill (one value in all runs)");
}

TEST_CASE("generators that are said are held against the runs") {
  const std::string text = "A,B,C,y\n0,0,1,3\n1,0,0,4\n0,1,0,5\n1,1,1,7\n";
  CHECK(recognised(text, {.factors = {}, .responses = {"y"}, .generators = {"C=A*B"}}).design.resolution == "III");
  CHECK_THAT(recognise_refusal(text, {.factors = {}, .responses = {"y"}, .generators = {"C=-A*B"}}),
             Contains(":2: this run does not obey"));
}

TEST_CASE("composites: face-centred, fractional corners, distances of the user's own") {
  const RecognisedTable face = recognised("A,B,y\n0,0,1\n2,0,2\n0,2,3\n2,2,4\n0,1,5\n2,1,6\n1,0,7\n1,2,8\n1,1,9\n1,1,9.5\n",
                                          {.factors = {"A", "B"}, .responses = {}, .generators = {}});
  CHECK(face.kind == PlanKind::central_composite);
  CHECK(face.design.coded.cwiseAbs().maxCoeff() == 1);
  const std::string own =
      "A,B,y\n1.000,1.000,1\n3.000,1.000,2\n1.000,3.000,3\n3.000,3.000,4\n0.800,2.000,5\n3.200,2.000,6\n2.000,0.800,7\n2.000,3.200,8\n2."
      "000,2.000,9\n";
  CHECK_THAT(recognised(own).design.coded.maxCoeff(), WithinAbs(1.2, 1e-12));  // three decimals: 1.2 is no rounded 1.414
  CHECK_THAT(recognised(own, {.factors = {}, .responses = {}, .generators = {}, .axial = "rotatable"}).design.coded.maxCoeff(),
             WithinAbs(std::sqrt(2.0), 1e-12));
  CHECK_THAT(recognise_refusal(own, {.factors = {}, .responses = {}, .generators = {}, .axial = "far"}), Contains("--axial 'far'"));
  CHECK_THAT(recognise_refusal(kSquare, {.factors = {}, .responses = {}, .generators = {}, .axial = "rotatable"}), Contains("--axial"));
}

TEST_CASE("a plan that is written as a table is recognised as what it was") {
  const std::vector<Factor> list{parse_factor("speed=40:80"), parse_factor("friction=0.25:0.35"), parse_factor("fill=20:40")};
  for (const Design& plan :
       {two_level(list, {"fill=speed*friction"}, 3), central_composite(list, rotatable(3), 4), central_composite(list, 1, 4)}) {
    std::string text = plan_table(plan), filled;
    int run = 0;
    for (std::size_t at = 0; at < text.size();) {
      const std::size_t end = text.find('\n', at);
      const std::string line = text.substr(at, end - at);
      filled += line + (line[0] == '#' ? "" : line.starts_with("run,") ? ",y" : fmt::format(",{}", 1.7 + run * run % 11)) + "\n";
      at = end + 1;
      ++run;
    }
    const RecognisedTable back = recognised(filled);
    CHECK(back.kind == (plan.resolution == "III" ? PlanKind::two_level : PlanKind::central_composite));
    CHECK(back.design.coded.isApprox(plan.coded, 1e-6));
    CHECK(back.design.kind == plan.kind);
    for (std::size_t i = 0; i < 3; ++i) CHECK_THAT(back.design.factors[i].step, WithinAbs(list[i].step, 1e-6));
  }
  CHECK_THAT(refusal([] { parse_factor("speed=80:40"); }), Contains("above the low one"));
  CHECK_THAT(refusal([] { parse_factor("speed=40"); }), Contains("NAME=LOW:HIGH"));
  CHECK_THAT(refusal([] { parse_factor("speed=a:b"); }), Contains("'a' is no number"));
}

TEST_CASE("a plan without a pattern is coded over its range and fitted by a quadratic") {
  std::string text = "A,B,y\n";
  const Design plan = latin_hypercube({{"A", 5, 5, ""}, {"B", 0, 1, ""}}, 15, 3);
  for (Eigen::Index run = 0; run < 15; ++run) {
    const Eigen::VectorXd x = natural(plan.factors, plan.coded.row(run).transpose());
    text += fmt::format("{},{},{}\n", x[0], x[1],
                        (x[0] - 4) * (x[0] - 4) + (x[1] - 0.2) * (x[1] - 0.2) * 8 + 0.01 * static_cast<double>(run * run % 7));
  }
  const File file(text);
  const TableAnalysis a = analyze_table(base::Table::read(file.path()), {.factors = {"A", "B"}, .responses = {}, .generators = {}},
                                        ModelChoice::automatic, 0.95, {});
  const Surface& s = std::get<Surface>(a.results[0]);
  CHECK_THAT(s.stationary->natural[0], WithinAbs(4, 0.05));
  CHECK_THAT(s.stationary->natural[1], WithinAbs(0.2, 0.05));
  CHECK_THAT(s.lack_of_fit_sentence, Contains("no run is repeated"));
}
