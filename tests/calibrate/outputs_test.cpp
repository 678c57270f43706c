#include "studies/calibrate/outputs.hpp"
#include "kernel/base/text.hpp"
#include "kernel/output/summary.hpp"

#include <fstream>
#include <span>
#include <sstream>

#include "studies/calibrate/validate.hpp"
#include "tests/calibrate/made_up_mill.hpp"

using namespace millscope;
using namespace millscope::calibrate;
using testing::Folder;

TEST_CASE("a calibration leaves its numbers, its case, its runs and its report") {
  const Folder folder;
  const Study study =
      testing::study_of(folder, "  pairs.glass~glass.mu: {range: [0.1, 0.8], tied: [pairs.glass~liner.mu]}\n  a.e: {range: [0.3, 0.9]}\n",
                        "method: response_surface\nbudget: {simulations: 26}\n");
  testing::MadeUpMill mill(study, Eigen::Vector2d(0.42, 0.7), 0.02);
  mill.fails = [](const Eigen::VectorXd& p) { return p[0] > 0.62 && p[1] > 0.74; };
  folder.write("summary.json", R"({"doubts": [{"name": "short_window", "of": "", "value": 1.5, "limit": 2,
    "unit": "turns", "finding": "a short window", "may_change": "errors", "remedy": "raise time.end_s"}]})");
  Machinery machinery = mill.machinery();
  machinery.run = [&, run = machinery.run](std::span<const campaign::Simulation> simulations) {
    std::vector<campaign::Outcome> outcomes = run(simulations);
    for (campaign::Outcome& o : outcomes) o.folder = folder.path;
    return outcomes;
  };
  Evaluator evaluator(study, machinery, mill.recorded());
  const Calibration c = calibrate::calibrate(evaluator);
  const std::filesystem::path out = folder.path / "out";
  write_outputs(evaluator, c, out);
  CHECK(calibrated_set(out / "calibration.json", study) == c.best);
  const config::Node found = config::load_document((out / "calibrated.yaml").string());
  CHECK(std::stod(found.at("pairs").at("glass~liner").at("mu").text()) == c.best[0]);
  CHECK(found.at("schema_version").text() == "1");  // of the base, too, which is found from here
  const std::string runs = base::text_of(out / "runs.csv"), report = base::text_of(out / "report.md");
  CHECK(std::count(runs.begin(), runs.end(), '\n') == static_cast<std::ptrdiff_t>(evaluator.trials().size()) + 1);
  CHECK(runs.find("a bead ran away") != std::string::npos);
  CHECK(report.find("The dominant factor is **mu**") != std::string::npos);
  CHECK(report.find("parameter sets failed") != std::string::npos);
  CHECK(report.find("Doubt: 1 of 1 simulations: a short window; errors; raise time.end_s") != std::string::npos);
  CHECK(output::read_json(out / "calibration.json")["doubts"][0]["name"] == "short_window");
  for (const char* picture : {"dry75_x.svg", "dry75_speed.svg", "surface.svg", "profile_mu.svg", "posterior_mu_e.svg"})
    CHECK(std::filesystem::exists(out / "pictures" / picture));
  const Validation v = validate(evaluator, c.best, {1});
  write_validation(v, evaluator, folder.path / "val");
  CHECK(base::text_of(folder.path / "val" / "validation.md").find("## dry50 (held out)") != std::string::npos);
  CHECK(std::filesystem::exists(folder.path / "val" / "validation.json"));
}

TEST_CASE("a value outside its own interval says why that can be") {
  const Folder folder;
  const Study study = testing::study_of(folder, "  a.mu: {range: [0.1, 0.8]}\n", "objective: chagas2015\n");
  emulate::Marginal marginal{};
  marginal.low90 = 0.102, marginal.high90 = 0.112, marginal.mode = 0.1;
  CHECK(contradiction(study, 0, 0.105, marginal).empty());
  CHECK(contradiction(study, 0, 0.1, marginal).empty());  // where the posterior piles up
  const std::string said = contradiction(study, 0, 0.376, marginal);
  CHECK(said ==
        "mu: retuned to the few numbers of chagas2015 it is 0.376, outside its own interval (0.102 … 0.112): that moves it where the "
        "recordings as a whole do not want it");
  const Study likely = testing::study_of(folder, "  a.mu: {range: [0.1, 0.8]}\n", "objective: likelihood\n");
  CHECK(contradiction(likely, 0, 0.376, marginal).empty());
}

TEST_CASE("a calibration of another study is refused") {
  const Folder folder;
  const Study study = testing::study_of(folder, "  a.mu: {range: [0.1, 0.8]}\n", "");
  const auto other = folder.write("c.json", R"({"parameters": [{"path": "a.e", "value": 1}]})");
  CHECK(testing::message_of([&] { calibrated_set(other, study); }).find("parameter 'a.mu' has no value in") != std::string::npos);
  CHECK_FALSE(testing::message_of([&] { calibrated_set(folder.write("n.json", "[]"), study); }).empty());
  CHECK_FALSE(testing::message_of([&] { calibrated_set(folder.path / "gone.json", study); }).empty());
}
