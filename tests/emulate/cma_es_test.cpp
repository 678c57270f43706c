// The search without an emulator, on the problems every such search is tried on.
#include <catch2/catch.hpp>
#include <limits>

#include "kernel/base/error.hpp"
#include "studies/emulate/cma_es.hpp"
#include "studies/emulate/cma_transform.hpp"
#include "support.hpp"

using namespace millscope::emulate;
using namespace millscope::emulate::test;
using Catch::Matchers::Contains;
using Catch::Matchers::WithinAbs;

namespace {

using Value = std::function<double(const VectorXd&)>;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

Box box_of(Index n, double low, double high) { return {VectorXd::Constant(n, low), VectorXd::Constant(n, high)}; }

int minimise(CmaEs& search, const Value& f, int generations) {
  int evaluations = 0;
  while (search.generation() < generations && search.finished().empty()) {
    std::vector<double> values;
    for (const VectorXd& x : search.ask()) values.push_back(f(x));
    evaluations += static_cast<int>(values.size());
    search.tell(values);
  }
  return evaluations;
}

double ellipsoid(const VectorXd& x) {
  double sum = 0;
  for (Index i = 0; i < x.size(); ++i) sum += std::pow(1e6, static_cast<double>(i) / static_cast<double>(x.size() - 1)) * x[i] * x[i];
  return sum;
}

double rosenbrock(const VectorXd& x) {
  double sum = 0;
  for (Index i = 0; i + 1 < x.size(); ++i) sum += 100 * std::pow(x[i + 1] - x[i] * x[i], 2) + std::pow(1 - x[i], 2);
  return sum;
}

}  // namespace

TEST_CASE("the bottom of an ellipsoid of axes 1 to 1000 is found") {
  CmaEs search(box_of(5, -3, 5), VectorXd::Constant(5, 2.0), 0.3, 1);
  const int evaluations = minimise(search, ellipsoid, 500);
  CHECK(search.best_value() < 1e-6);
  CHECK(evaluations < 3000);
  CHECK(search.best().norm() < 1e-3);
}

TEST_CASE("the bent valley of Rosenbrock is followed to its end") {
  for (const std::uint64_t seed : {1, 2, 3}) {
    CmaEs search(box_of(4, -2, 2), VectorXd::Zero(4), 0.2, seed);
    minimise(search, rosenbrock, 800);
    CHECK(search.best_value() < 1e-8);
    CHECK((search.best() - VectorXd::Ones(4)).norm() < 1e-3);
  }
}

TEST_CASE("an optimum in a corner of the box is reached") {
  const Value slope = [](const VectorXd& x) {
    return (x.array() - VectorXd::LinSpaced(4, 1.0, 2.0).array().eval() * -3).square().sum() + x.sum();
  };
  CmaEs search(box_of(4, 0.1, 0.9), VectorXd::Constant(4, 0.6), 0.3, 1);
  minimise(search, slope, 300);
  CHECK((search.best() - VectorXd::Constant(4, 0.1)).norm() < 1e-5);
}

TEST_CASE("one parameter and several units are no special case") {
  const Box box{VectorXd{{1e6}}, VectorXd{{9e6}}};
  CmaEs search(box, VectorXd{{8e6}}, 0.3, 1);
  minimise(
      search, [](const VectorXd& x) { return std::pow(x[0] - 3.3e6, 2); }, 200);
  CHECK_THAT(search.best()[0], WithinAbs(3.3e6, 20));
}

TEST_CASE("points that fail cost nothing but themselves") {
  // a third of the box fails, the optimum lies at the failing region's border
  const Value f = [](const VectorXd& x) { return x[0] > 0.6 ? kInfinity : std::pow(x[0] - 0.65, 2) + std::pow(x[1] - 0.3, 2); };
  CmaEs search(unit_box(2), VectorXd::Constant(2, 0.5), 0.3, 3);
  minimise(search, f, 150);
  CHECK((search.best() - VectorXd{{0.6, 0.3}}).norm() < 2e-2);

  CmaEs lost(unit_box(2), VectorXd::Constant(2, 0.5), 0.3, 3);
  minimise(
      lost, [](const VectorXd&) { return kInfinity; }, 1000);
  CHECK_THAT(lost.finished(), Contains("failed") || Contains("millionth"));
  CHECK(lost.best_value() == kInfinity);
  CHECK(lost.best() == VectorXd::Constant(2, 0.5));

  lost.ask();
  CHECK_THROWS_AS(lost.tell({1, 2}), std::invalid_argument);
  CHECK_THROWS_AS(lost.tell(std::vector<double>(lost.ask().size(), std::nan(""))), std::invalid_argument);
}

TEST_CASE("only allowed points are asked for") {
  Box box = unit_box(2);
  box.allowed = [](const VectorXd& x) { return x[0] + 0.2 < x[1]; };
  CmaEs search(box, VectorXd{{0.1, 0.9}}, 0.5, 1);
  bool all = true;
  minimise(
      search,
      [&](const VectorXd& x) {
        all = all && box.contains(x);
        return (x - VectorXd{{0.7, 0.3}}).squaredNorm();
      },
      200);
  CHECK(all);
  CHECK((search.best() - VectorXd{{0.4, 0.6}}).norm() < 0.02);
}

TEST_CASE("a search that was saved and read back goes on as if nothing had been") {
  Box box = box_of(3, -2, 2);
  CmaEs whole(box, VectorXd::Constant(3, -1.0), 0.3, 42);
  CmaEs first(box, VectorXd::Constant(3, -1.0), 0.3, 42);
  minimise(whole, rosenbrock, 60);
  minimise(first, rosenbrock, 20);
  first.ask();  // killed between asking and telling
  CmaEs second = CmaEs::restore(box, first.save());
  CHECK(second.ask() == first.ask());
  minimise(second, rosenbrock, 60);
  CHECK(second.best() == whole.best());
  CHECK(second.best_value() == whole.best_value());
  CHECK(second.save() == whole.save());

  CHECK_THROWS_WITH(CmaEs::restore(box, "{}"), Contains("start the search again"));
  CHECK_THROWS_WITH(CmaEs::restore(box, "half a fi"), Contains("start the search again"));
  CHECK_THROWS_WITH(CmaEs::restore(box_of(3, -2, 3), first.save()), Contains("other ranges"));
  CHECK_THROWS_WITH(CmaEs::restore(box_of(2, -2, 2), first.save()), Contains("3 numbers where 2 belong"));
}

TEST_CASE("a start that cannot be is refused") {
  Box box = unit_box(2);
  CHECK_THROWS_WITH(CmaEs(box, VectorXd::Constant(2, 1.5), 0.3, 1), Contains("outside the ranges"));
  CHECK_THROWS_WITH(CmaEs(box, VectorXd::Constant(2, 0.5), 0, 1), Contains("fraction of the ranges"));
  box.upper[1] = 0;
  CHECK_THROWS_WITH(CmaEs(box, VectorXd::Constant(2, 0.5), 0.3, 1), Contains("range of parameter 2: 0 to 0 is empty"));
}

TEST_CASE("the way into the range and back") {
  for (double y = 0; y <= 1; y += 0.01) CHECK_THAT(into_range(out_of_range(y)), WithinAbs(y, 1e-12));
  for (double x = -5; x <= 5; x += 0.013) {
    CHECK(into_range(x) >= 0);
    CHECK(into_range(x) <= 1);
    CHECK_THAT(into_range(x + 1e-7), WithinAbs(into_range(x), 1.01e-7));  // no jumps
  }
}
