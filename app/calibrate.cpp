// calibrate, validate: from recordings to contact parameters, and whether they hold elsewhere.
#include <fmt/core.h>

#include <filesystem>

#include "app/commands.hpp"
#include "app/study_options.hpp"
#include "kernel/output/file.hpp"
#include "studies/calibrate/outputs.hpp"
#include "studies/calibrate/session.hpp"

namespace millscope::app {
namespace {

namespace po = boost::program_options;
namespace fs = std::filesystem;
using base::UserError;

void print_found(const calibrate::Study& study, const calibrate::Calibration& c, const fs::path& output) {
  fmt::print("\n{:<24} {:>10} {:>12}   90 % interval\n", "parameter", "value", "most likely");
  for (std::size_t p = 0; p < study.parameters.size(); ++p) {
    fmt::print("{:<24} {:>10.4g}", study.parameters[p].name, c.best[static_cast<Eigen::Index>(p)]);
    if (c.inference) {
      const auto& m = c.inference->posterior.marginal[p];
      fmt::print(" {:>12.4g}   {:.4g} … {:.4g}", m.mode, m.low90, m.high90);
    }
    fmt::print("\n");
  }
  if (c.inference) {
    for (const std::string& statement : c.inference->posterior.statements) fmt::print("{}\n", statement);
    for (const auto& m : c.inference->posterior.marginal) fmt::print("{}\n", m.statement);
  }
  for (const std::string& note : c.notes) fmt::print("note: {}\n", note);
  for (const campaign::SharedDoubt& doubt : c.doubts) fmt::print("doubt: {}\n", campaign::sentence_of(doubt));
  fmt::print("results in {}: report.md, calibration.json, calibrated.yaml, runs.csv, pictures\n", output.string());
}

/// A study that may be one of `diagnose`, too.
calibrate::Study study_of(const Options& options) {
  calibrate::Study study = calibrate::read_study(options.text("STUDY.yaml"), options.list("set"), calibrate::kDiagnoseSections);
  if (options.has("quiet")) return study;
  for (const std::string_view section : calibrate::kDiagnoseSections) {
    if (study.root.has(section)) fmt::print("section '{}' is for diagnose and is not used here\n", section);
  }
  return study;
}

}  // namespace

int calibrate_study(const Arguments& arguments) {
  Options options("calibrate STUDY.yaml -o OUT",
                  "Finds the parameters of a case with which its simulations look like the recordings. Started again, it goes on where it "
                  "stopped and computes nothing twice.",
                  "millscope calibrate configs/chagas2015/study.yaml -o study-out");
  add_study_options(options);
  if (!options.parse(arguments)) return kDone;
  const fs::path output = options.text("output");
  const calibrate::Study study = study_of(options);
  const host::Registry registry = options.registry();
  calibrate::Session session(study, registry, study_session(options, output));
  const calibrate::Calibration found = calibrate::calibrate(session.evaluator());
  calibrate::write_outputs(session.evaluator(), found, output);
  if (!options.has("quiet")) print_found(study, found, output);
  return kDone;
}

int validate(const Arguments& arguments) {
  Options options(
      "validate STUDY.yaml --calibration OUT/calibration.json -o OUT2",
      "Simulates the calibrated set in the conditions that were held out of the fit and judges every observable, and all of them "
      "at once: difference with interval, pass or fail.",
      "millscope validate configs/chagas2015/study.yaml --calibration study-out/calibration.json -o validation-out");
  add_study_options(options);
  options.add()("calibration", po::value<std::string>()->value_name("FILE"), "calibration.json of 'millscope calibrate'");
  options.add()("all", "also the conditions that were fitted");
  if (!options.parse(arguments)) return kDone;
  const fs::path output = options.text("output"), file = options.text("calibration");
  const calibrate::Study study = study_of(options);
  const Eigen::VectorXd point = calibrate::calibrated_set(file, study);
  std::vector<std::size_t> conditions = study.with_role(calibrate::Role::held_out);
  if (options.has("all")) {
    conditions = study.with_role(calibrate::Role::fit);
    for (const std::size_t c : study.with_role(calibrate::Role::held_out)) conditions.push_back(c);
  }
  if (conditions.empty())
    throw UserError(fmt::format("{}: no condition has 'role: held_out'; add one, or validate with --all", study.file.string()));
  const host::Registry registry = options.registry();
  calibrate::SessionOptions session_of = study_session(options, output);
  const fs::path beside = fs::absolute(file).parent_path() / "cache";
  if (session_of.cache.empty() && fs::exists(beside)) session_of.cache = beside;  // what calibrate simulated serves here, too
  calibrate::Session session(study, registry, session_of);
  const calibrate::Validation validation = calibrate::validate(session.evaluator(), point, conditions);
  calibrate::write_validation(validation, session.evaluator(), output);
  if (!options.has("quiet"))
    fmt::print("\n{}\nwritten to {}: validation.json, validation.md\n", calibrate::validation_text(validation, session.evaluator()),
               output.string());
  return kDone;
}

}  // namespace millscope::app
