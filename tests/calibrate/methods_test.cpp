#include "studies/calibrate/methods.hpp"

#include "studies/calibrate/validate.hpp"
#include "tests/calibrate/made_up_mill.hpp"

using namespace millscope;
using namespace millscope::calibrate;
using testing::Folder;
using testing::MadeUpMill;
using testing::message_of;

namespace {

const std::string kTwo = "  a.mu: {range: [0.1, 0.8]}\n  a.e: {range: [0.3, 0.9]}\n";
const std::string kFour = kTwo + "  b.mu: {range: [0.1, 0.8], name: mu_w}\n  b.e: {range: [0.3, 0.9], name: e_w}\n";

Calibration calibrated(const Study& study, MadeUpMill& mill) {
  Evaluator evaluator(study, mill.machinery(), mill.recorded());
  return calibrate::calibrate(evaluator);
}

}  // namespace

TEST_CASE("the study's chain finds the dominant factor and the optimum") {
  const Folder folder;
  const Study study = testing::study_of(folder, kFour,
                                        "method: response_surface\nobjective: likelihood\nbudget: {simulations: 40}\n"
                                        "design: {generators: [\"e_w=mu*e*mu_w\"], composite_step: 1}\n");
  MadeUpMill mill(study, Eigen::Vector4d(0.42, 0.62, 0.45, 0.6), 0.02);
  const Calibration c = calibrated(study, mill);
  REQUIRE(c.screening);
  CHECK(c.screening->run.trials.size() == 11);
  CHECK(c.screening->run.design.resolution == "IV");
  CHECK(c.screening->kept.size() == 2);
  REQUIRE(c.composite);
  CHECK(c.composite->run.trials.size() == 13);
  CHECK(mill.computed() <= 40);
  REQUIRE(c.at_best);
  CHECK(c.at_best->misfit < c.screening->run.response.minCoeff());
  REQUIRE(c.inference);
  CHECK(c.inference->posterior.marginal[0].low90 < 0.42);
  CHECK(c.inference->posterior.marginal[0].high90 > 0.42);
}

TEST_CASE("the emulator finds the truth and reaches less than the surface with as many simulations") {
  const Folder folder;
  const std::string budget = "budget: {simulations: 30}\n";
  const Study modern = testing::study_of(folder, kTwo, "method: emulator\nobjective: likelihood\n" + budget);
  MadeUpMill mill(modern, Eigen::Vector2d(0.42, 0.7), 0.02);
  const Calibration c = calibrated(modern, mill);
  CHECK(mill.computed() == 30);
  CHECK(c.best[0] == Approx(0.42).margin(0.05));
  CHECK(c.best[1] == Approx(0.7).margin(0.1));
  REQUIRE(c.inference);
  CHECK(c.inference->posterior.marginal[0].determined == emulate::Determined::well);
  const Study classic = testing::study_of(folder, kTwo, "method: response_surface\nobjective: likelihood\n" + budget);
  MadeUpMill again(classic, Eigen::Vector2d(0.42, 0.7), 0.02);
  const Calibration surface = calibrated(classic, again);
  REQUIRE(surface.at_best);
  REQUIRE(c.at_best);
  CHECK(c.at_best->misfit < surface.at_best->misfit + 12);
}

TEST_CASE("CMA-ES goes down, the objective of Chagas 2015 too") {
  const Folder folder;
  const Study study = testing::study_of(folder, kTwo, "method: cma_es\nobjective: chagas2015\nbudget: {simulations: 60}\n");
  MadeUpMill mill(study, Eigen::Vector2d(0.3, 0.5), 0.002);
  const Calibration c = calibrated(study, mill);
  CHECK(c.best[0] == Approx(0.3).margin(0.05));
  REQUIRE(c.at_best);
  CHECK(c.at_best->chagas.value() < 0.5);
  const Study guided = testing::study_of(folder, kTwo, "method: emulator\nobjective: chagas2015\nbudget: {simulations: 30}\n");
  MadeUpMill again(guided, Eigen::Vector2d(0.3, 0.5), 0.002);
  CHECK(calibrated(guided, again).best[0] == Approx(0.3).margin(0.05));
}

TEST_CASE("a study that is interrupted again and again ends as if it had not been") {
  const Folder folder;
  for (const char* method : {"emulator", "response_surface", "cma_es"}) {
    const Study study = testing::study_of(folder, kTwo, std::string("method: ") + method + "\nbudget: {simulations: 24}\n");
    const Eigen::Vector2d truth(0.5, 0.6);
    MadeUpMill whole(study, truth), broken(study, truth);
    const Calibration once = calibrated(study, whole);
    int interruptions = 0;
    std::optional<Calibration> c;
    for (broken.interrupted_after = 1; !c; broken.interrupted_after += 5) {
      try {
        c = calibrated(study, broken);
      } catch (const campaign::Interrupted&) {
        ++interruptions;
      }
    }
    CHECK(interruptions >= 3);
    CHECK(c->best == once.best);
    CHECK(broken.computed() == whole.computed());
    REQUIRE(c->inference);
    CHECK(c->inference->posterior.samples == once.inference->posterior.samples);
  }
}

TEST_CASE("failed simulations are left out, their study goes on") {
  const Folder folder;
  const Study study = testing::study_of(folder, kTwo, "method: emulator\nbudget: {simulations: 30}\n");
  MadeUpMill mill(study, Eigen::Vector2d(0.42, 0.7), 0.02);
  mill.fails = [](const Eigen::VectorXd& p) { return p[0] > 0.65; };
  Evaluator evaluator(study, mill.machinery(), mill.recorded());
  const Calibration c = calibrate::calibrate(evaluator);
  CHECK(std::any_of(evaluator.trials().begin(), evaluator.trials().end(),
                    [](const Trial& t) { return t.failed && t.message == "condition 'dry75': a bead ran away"; }));
  CHECK(c.best[0] == Approx(0.42).margin(0.06));
}

TEST_CASE("all simulations failed: said, and nothing is lost") {
  const Folder folder;
  const Study study = testing::study_of(folder, kTwo, "method: emulator\nbudget: {simulations: 30}\n");
  MadeUpMill mill(study, Eigen::Vector2d(0.42, 0.7));
  mill.fails = [](const Eigen::VectorXd&) { return true; };
  const std::string message = message_of([&] { calibrated(study, mill); });
  CHECK(message.find("simulations have failed, the first so: condition 'dry75': a bead ran away; nothing is lost") != std::string::npos);
  mill.fails = {};
  CHECK(calibrated(study, mill).best[0] == Approx(0.42).margin(0.08));
}

TEST_CASE("budgets that are too small and designs that break constraints are said") {
  const Folder folder;
  const auto message = [&](const std::string& parameters, const std::string& more) {
    const Study study = testing::study_of(folder, parameters, more);
    MadeUpMill mill(study, 0.5 * (study.low() + study.high()));
    return message_of([&] { calibrated(study, mill); });
  };
  CHECK(message(kTwo, "method: response_surface\nbudget: {simulations: 10}\n")
            .find("the budget allows 10 parameter sets, screening and central") != std::string::npos);
  CHECK(message(kTwo, "method: emulator\nbudget: {simulations: 5}\n").find("the budget allows 5 parameter sets, an emulator") !=
        std::string::npos);
  CHECK(message(kTwo, "method: response_surface\nconstraints: [mu < 0.4]\n").find("breaks the constraint 'mu < 0.4'") != std::string::npos);
  CHECK(message("  a.mu: {range: [0, 1]}\n", "method: response_surface\n").find("at least two parameters") != std::string::npos);
}

TEST_CASE("the wall budget ends a study") {
  const Folder folder;
  const Study study = testing::study_of(folder, kTwo, "method: emulator\nbudget: {simulations: 60, wall: 100 s}\n");
  MadeUpMill mill(study, Eigen::Vector2d(0.42, 0.7));
  calibrated(study, mill);
  CHECK(mill.computed() >= 18);  // 10 s each, two at once
  CHECK(mill.computed() <= 31);
}

TEST_CASE("validation passes with the truth and fails far from it") {
  const Folder folder;
  const Study study = testing::study_of(folder, kTwo, "");
  MadeUpMill mill(study, Eigen::Vector2d(0.42, 0.7), 0.02);
  Evaluator evaluator(study, mill.machinery(), mill.recorded());
  const Validation good = validate(evaluator, Eigen::Vector2d(0.42, 0.7), study.with_role(Role::held_out));
  CHECK(good.pass());
  CHECK(good.judged == 6);
  CHECK(good.at_once);
  const Validation bad = validate(evaluator, Eigen::Vector2d(0.7, 0.4), study.with_role(Role::held_out));
  CHECK_FALSE(bad.pass());
  CHECK(bad.conditions[0].power.low < bad.conditions[0].power.difference);
}

TEST_CASE("validation fails where each difference is small and all at once are too much") {
  const Folder folder;
  const Study study = testing::study_of(folder, kTwo, "");
  MadeUpMill mill(study, Eigen::Vector2d(0.42, 0.7), 0.02);
  std::vector<Observation> recorded = mill.recorded();
  const auto held_out = study.with_role(Role::held_out);
  // Errors that all go one way, recorded two of them off, up and down by turns: each alone is no surprise, all together are.
  Observation& of = recorded[held_out[0]];
  const Eigen::VectorXd sign = Eigen::VectorXd::NullaryExpr(of.value.size(), [](Eigen::Index i) { return i % 2 == 0 ? 1.0 : -1.0; }),
                        error = 5 * of.covariance.diagonal().cwiseSqrt();
  of.covariance = error.asDiagonal() *
                  (Eigen::MatrixXd::Constant(sign.size(), sign.size(), 0.95) + 0.05 * Eigen::MatrixXd::Identity(sign.size(), sign.size())) *
                  error.asDiagonal();
  of.value += (2 * error).cwiseProduct(sign);
  Evaluator evaluator(study, mill.machinery(), recorded);
  const Validation found = validate(evaluator, Eigen::Vector2d(0.42, 0.7), held_out);
  CHECK(found.passed == found.judged);
  CHECK_FALSE(found.at_once);
  CHECK_FALSE(found.pass());
  CHECK(found.conditions[0].p < 1e-6);
  CHECK(validation_text(found, evaluator)
            .find("The simulation and the recordings differ. One by one, 6 of 6 observables pass. All of a condition at once: fail at "
                  "dry50.") != std::string::npos);
}

TEST_CASE("a validation with a failed simulation does not pass") {
  const Folder folder;
  const Study study = testing::study_of(folder, kTwo, "");
  MadeUpMill mill(study, Eigen::Vector2d(0.42, 0.7), 0.02);
  Evaluator evaluator(study, mill.machinery(), mill.recorded());
  Validation found = validate(evaluator, Eigen::Vector2d(0.42, 0.7), {0, 1});
  REQUIRE(found.pass());
  found.conditions[0].failed = true;
  CHECK_FALSE(found.pass());
  CHECK(validation_text(found, evaluator).find("1 of 2 simulations failed. The simulation agrees with the recordings.") !=
        std::string::npos);
}
