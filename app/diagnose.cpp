// diagnose: which physics a base case has left out; bank: the simulations that it is answered from.
#include <fmt/core.h>

#include <cmath>
#include <filesystem>

#include "app/commands.hpp"
#include "app/study_options.hpp"
#include "studies/diagnose/pages/outputs.hpp"

namespace millscope::app {
namespace {

namespace fs = std::filesystem;

void print_found(const diagnose::Question& question, const diagnose::Diagnosis& d, const fs::path& output) {
  fmt::print("\n{}\n{}\n", diagnose::name_of(d.verdict), d.sentence);
  if (!d.next_experiment.empty()) fmt::print("next: {}\n", d.next_experiment);
  fmt::print("\n{:<28} {:>8} {:>10} {:>16}\n", "candidate", "delta Q", "p", "visible (sigma)");
  for (std::size_t j = 0; j < d.naming.judged.size(); ++j) {
    const naming::Judged& g = d.naming.judged[j];
    if (!g.tested) {
      fmt::print("{:<28} not tested, see the notes in diagnosis.md\n", d.problem.alternatives[j].name);
      continue;
    }
    fmt::print("{:<28} {:>8.1f} {:>10.2g} {:>16.1f}\n", d.problem.alternatives[j].name, g.delta_q, g.p_family, std::sqrt(g.lambda));
  }
  for (const diagnose::HeldOut& h : d.held_out)
    fmt::print("held out '{}': {}\n", question.study.conditions[h.condition].name, diagnose::sources_sentence(h));
  for (const campaign::SharedDoubt& doubt : d.doubts) fmt::print("doubt: {}\n", campaign::sentence_of(doubt));
  fmt::print("results in {}: diagnosis.md, diagnosis.json, pictures{}\n", output.string(), d.naming.best ? ", corrected" : "");
}

}  // namespace

int diagnose_study(const Arguments& arguments) {
  Options options("diagnose STUDY.yaml -o OUT",
                  "Locates where simulation and recordings differ, tests which physics was left out, and shows on held-out recordings what "
                  "naming it gains. Started again, it goes on where it stopped and computes nothing twice.",
                  "millscope diagnose configs/mill10/diagnose.yaml -o diagnosis --set conditions.speed75.recording=r75.yaml");
  add_study_options(options);
  add_draws_option(options);
  if (!options.parse(arguments)) return kDone;
  const fs::path output = options.text("output");
  naming::Options naming;
  naming.draws = draws_of(options);
  const host::Registry registry = options.registry();
  const diagnose::Question question = diagnose::read_question(options.text("STUDY.yaml"), options.list("set"), registry);
  const calibrate::SessionOptions session_of = study_session(options, output);
  calibrate::Session session(question.study, registry, session_of);
  naming.say = session_of.say;
  const diagnose::Diagnosis found =
      diagnose::diagnose(question, session.machinery(), diagnose::evidence_of(question, registry, session), naming);
  diagnose::write_outputs({question, found}, output);
  if (!options.has("quiet")) print_found(question, found, output);
  return kDone;
}

}  // namespace millscope::app
