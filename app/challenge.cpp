// challenge: sets whose physics is drawn and hidden, diagnosed and scored.
#include <fmt/core.h>

#include <filesystem>

#include "app/actions.hpp"
#include "app/commands.hpp"
#include "app/study_options.hpp"
#include "kernel/output/directory.hpp"
#include "kernel/output/file.hpp"
#include "kernel/output/summary.hpp"
#include "studies/challenge/concealment.hpp"
#include "studies/challenge/make.hpp"
#include "studies/challenge/page.hpp"
#include "studies/challenge/run.hpp"

namespace millscope::app {
namespace {

namespace po = boost::program_options;
namespace fs = std::filesystem;
using base::UserError;

/// As it was given, without the place of the program.
std::string command_text() {
  std::string out = "millscope";
  for (std::size_t i = 1; i < command_line.size(); ++i) out += " " + command_line[i];
  return out;
}

int make_sets(const Arguments& arguments) {
  Options options("challenge make CHALLENGE.yaml -o SETS",
                  "Draws mills with hidden physics, simulates them with another step and law than the study fits with, and writes what a "
                  "camera would have "
                  "recorded of them; the answers are sealed. Stopped, it goes on where it was.",
                  "millscope challenge make configs/mill10/challenge.yaml -o sets");
  options.positional("CHALLENGE.yaml", "study, camera, truth and sets");
  options.add()("output,o", po::value<std::string>()->value_name("SETS"), "directory for the sets");
  add_runner_options(options, "where the truths' simulations are kept (default: SETS/answers/cache)");
  options.with_overrides("replace a value of the challenge (may be repeated), e.g. --set seed=7");
  options.with_plugins();
  if (!options.parse(arguments)) return kDone;
  const fs::path output = options.text("output");
  const host::Registry registry = options.registry();
  const challenge::Challenge what = challenge::read_challenge(options.text("CHALLENGE.yaml"), options.list("set"));
  const diagnose::Question question = challenge::question_of(what, registry);
  const calibrate::SessionOptions session = study_session(options, output);
  challenge::make(what, question, registry, {output, calibrate::campaign_of(session), session.say});
  if (!options.has("quiet")) {
    fmt::print("sets in {}; hash of its manifest: {}\nkeep {} and the seed from those who diagnose\n", output.string(),
               challenge::manifest_hash(output), (output / "answers").string());
  }
  return kDone;
}

int run_sets(const Arguments& arguments) {
  Options options("challenge run SETS",
                  "Diagnoses all sets that have no diagnosis yet, from one bank; a set that fails is noted and the rest goes on.",
                  "millscope challenge run sets");
  options.positional("SETS", "what 'challenge make' wrote");
  add_runner_options(options, "where the bank is kept (default: SETS/cache)");
  add_draws_option(options);
  options.with_plugins();
  if (!options.parse(arguments)) return kDone;
  const fs::path sets = options.text("SETS");
  const host::Registry registry = options.registry();
  const calibrate::SessionOptions session = study_session(options, "");
  naming::Options naming;
  naming.say = session.say;
  naming.draws = draws_of(options);
  const challenge::RunCount count = challenge::run(sets, registry, session, naming);
  if (!options.has("quiet"))
    fmt::print("{} sets diagnosed now, {} before, {} failed; score them: millscope challenge score {}\n", count.done, count.known,
               count.failed, sets.string());
  return kDone;
}

int score_sets(const Arguments& arguments) {
  Options options("challenge score SETS…",
                  "Opens the sealed answers and counts how often the diagnoses met them: misses as plainly as hits. Several folders are "
                  "counted together.",
                  "millscope challenge score sets -o docs/proof.md");
  options.positional("SETS", "what 'challenge make' wrote and 'challenge run' diagnosed", true);
  options.add()("output,o", po::value<std::string>()->value_name("FILE.md"), "page to write (default: score.md in the first SETS)");
  options.add()("quiet,q", "print nothing but errors");
  if (!options.parse(arguments)) return kDone;
  const std::vector<std::string> named = options.list("SETS");
  if (named.empty())
    throw UserError("SETS is missing: name the folder that 'challenge make' wrote; usage: millscope challenge score SETS…");
  const std::vector<fs::path> folders(named.begin(), named.end());
  const fs::path page = options.has("output") ? fs::path(options.text("output")) : folders.at(0) / "score.md";
  if (page.extension() != ".md") throw UserError(fmt::format("--output {}: name a page that ends in .md", page.string()));
  const std::vector<challenge::Marked> marked = challenge::read_all_sets(folders);
  const challenge::Score score = challenge::score(marked);
  std::vector<std::pair<std::string, std::string>> manifests;
  for (const fs::path& folder : folders) manifests.emplace_back(output::name_of_folder(folder), challenge::manifest_hash(folder));
  output::write_file(page, challenge::page_text({marked, score, command_text(), manifests}));
  for (std::size_t k = 0; k < folders.size(); ++k) {
    const std::vector<challenge::Marked> own = challenge::read_sets(folders[k]);
    const std::string command = "millscope challenge score " + folders[k].string();
    output::write_json(folders[k] / "score.json", challenge::score_json({own, challenge::score(own), command, {manifests[k]}}));
  }
  if (!options.has("quiet")) {
    fmt::print(
        "{} of {} sets diagnosed\nfalse alarms             {}\nbest candidate is right  {}\namong those named        {}\nsee {}, and "
        "score.json in {}\n",
        score.diagnosed, score.sets, challenge::count_text(score.false_alarms), challenge::count_text(score.best_right),
        challenge::count_text(score.in_class), page.string(), folders.size() == 1 ? folders[0].string() : "each folder");
  }
  return kDone;
}

int look_for_concealment(const Arguments& arguments) {
  Options options(
      "challenge conceal CHALLENGE.yaml SETS",
      "After the answers are opened: what the practice would have seen of each set. Simulates for long the truth, the base "
      "that was retuned to its power and the one that was refitted to everything, and writes SETS/concealment.json, which 'score' "
      "shows. What stands there is kept.",
      "millscope challenge conceal configs/story/challenge.yaml sets");
  options.positional("CHALLENGE.yaml", "the challenge that the sets were made from");
  options.positional("SETS", "diagnosed sets, with their answers");
  options.add()("seconds", po::value<double>()->value_name("T"), "of every run that are looked at (default: 40)");
  add_runner_options(options, "where these simulations are kept (default: SETS/answers/cache)");
  options.with_plugins();
  if (!options.parse(arguments)) return kDone;
  const fs::path sets = options.text("SETS");
  const host::Registry registry = options.registry();
  const challenge::Challenge what = challenge::read_challenge(options.text("CHALLENGE.yaml"), {});
  calibrate::SessionOptions session = study_session(options, "");
  if (session.cache.empty()) session.cache = sets / "answers" / "cache";
  challenge::ConcealOptions how{40, calibrate::campaign_of(session)};
  if (options.has("seconds")) how.seconds = options.number("seconds");
  if (!(how.seconds > 0)) throw UserError(fmt::format("--seconds {}: give a time above 0", how.seconds));
  challenge::conceal(challenge::question_of(what, registry), sets, registry, how);
  if (!options.has("quiet")) fmt::print("see {}\n", (sets / "concealment.json").string());
  return kDone;
}

constexpr Action kChallengeActions[] = {
    {"make", "draw mills with hidden physics and record them", make_sets},
    {"run", "diagnose the sets", run_sets},
    {"conceal", "long runs: what the practice would have seen", look_for_concealment},
    {"score", "hold the diagnoses against the sealed answers", score_sets},
};

}  // namespace

int challenge_sets(const Arguments& arguments) {
  return call_action({"challenge", "Sets with hidden physics: made, diagnosed, scored against sealed answers. Particles are spheres.",
                      kChallengeActions, "millscope challenge make configs/mill10/challenge.yaml -o sets"},
                     arguments);
}

}  // namespace millscope::app
