// Plans and responses from which nothing can be concluded are refused in one line.
#include <Eigen/Dense>
#include <catch2/catch.hpp>
#include <limits>

#include "support.hpp"

using namespace doe_test;
using Catch::Matchers::Contains;

namespace {

std::string analysis_refusal(const std::string& text, ModelChoice model = ModelChoice::automatic) {
  const File file(text);
  const std::string message = refusal([&] {
    analyze_table(base::Table::read(file.path()), {.factors = {"A", "B"}, .responses = {"y"}, .generators = {}}, model, 0.95, {});
  });
  CHECK(message.find('\n') == std::string::npos);
  CHECK_THAT(message, Contains(file.path().string()));
  return message;
}

}  // namespace

TEST_CASE("what does not vary is refused") {
  CHECK_THAT(analysis_refusal("A,B,y\n1,5,1\n2,5,2\n1,5,3\n2,5,4\n"), Contains("factor B has one value in all runs"));
  CHECK_THAT(analysis_refusal("A,B,y\n1,1,7\n2,1,7\n1,2,7\n2,2,7\n"), Contains("y: the response is 7 in all runs"));
}

TEST_CASE("factors that vary together are refused") {
  CHECK_THAT(analysis_refusal("A,B,y\n1,1,1\n2,2,2\n1,1,3\n2,2,4\n"), Contains("A and B vary together"));
  CHECK_THAT(analysis_refusal("A,B,y\n1,9,1\n2,8,2\n1,9,3\n2,8,4\n"), Contains("A and B vary together"));
  CHECK_THAT(analysis_refusal("A,B,y\n1,10,1\n2,20,2\n3,30,3\n4,40,4\n5,50,4\n6,60,4\n7,70,4\n"), Contains("A and B vary together"));
}

TEST_CASE("a model that the runs do not carry is refused and says which term") {
  const std::string square = "A,B,y\n1,1,1\n2,1,2\n1,2,3\n2,2,5\n1,1,1.1\n2,1,2.2\n1,2,3.1\n2,2,5\n";
  CHECK_THAT(analysis_refusal(square, ModelChoice::quadratic), Contains("is a combination of the mean"));
  CHECK_THAT(analysis_refusal("A,B,y\n1,1,1\n2,1,2\n1,2,3\n2,2,5\n1.5,1.5,4\n", ModelChoice::quadratic), Contains("5 runs for 6 terms"));
  const std::string line = "A,B,y\n1,1,1\n2,3,2\n3,2,3\n";
  CHECK_THAT(analysis_refusal(line, ModelChoice::main_effects), Contains("neither -1 nor +1"));
}

TEST_CASE("copied runs do not make a plan of enough different runs") {
  std::string text = "A,B,y\n";
  for (int copy = 0; copy < 4; ++copy) text += "0,0,1\n2,0,2\n0,2,3\n2,2,4\n1,1,3\n";
  CHECK_THAT(analysis_refusal(text, ModelChoice::quadratic), Contains("cannot tell all terms apart"));
}

TEST_CASE("numbers that fit no run or are not finite are refused") {
  const Design d = two_level(factors(2), {}, 0);
  CHECK_THAT(refusal([&] { analyze_two_level(d, Eigen::Vector3d(1, 2, 3)); }), Contains("3 responses for 4 runs"));
  CHECK_THAT(refusal([&] { analyze_two_level(d, Eigen::Vector4d(1, 2, 3, std::numeric_limits<double>::quiet_NaN())); }), Contains("run 4"));
  CHECK_THAT(refusal([&] { fit_surface(central_composite(factors(2), 1, 1), Eigen::VectorXd::LinSpaced(9, 0, 1), 1.5); }),
             Contains("confidence 1.5"));
}

TEST_CASE("a saturated plan has effects and says that nothing is left to test them by") {
  const Design d = two_level(factors(3), {"C=A*B"}, 0);
  const Anova a = analyze_two_level(d, Eigen::Vector4d(1, 2, 4, 8));
  CHECK(a.residual.df == 0);
  CHECK(std::isnan(a.effects[0].sum.F));
  REQUIRE(a.notes.size() == 2);
  CHECK_THAT(a.notes[1], Contains("no degrees of freedom"));
}
