#include "studies/challenge/run.hpp"

#include <fmt/format.h>

#include "kernel/output/file.hpp"
#include "studies/challenge/answer.hpp"
#include "studies/diagnose/pages/outputs.hpp"

namespace millscope::challenge {
namespace {

namespace fs = std::filesystem;

void diagnose_set(const fs::path& folder, const host::Registry& registry, const calibrate::SessionOptions& session_of,
                  const naming::Options& naming) {
  const diagnose::Question question = diagnose::read_question(folder / "study.yaml", {}, registry);
  calibrate::Session session(question.study, registry, session_of);
  const diagnose::Diagnosis found =
      diagnose::diagnose(question, session.machinery(), diagnose::evidence_of(question, registry, session), naming);
  diagnose::write_outputs({question, found}, session_of.output);
}

std::string one_line(std::string text) {
  for (char& c : text) c = c == '\n' ? ' ' : c;
  return text;
}

}  // namespace

RunCount run(const fs::path& sets, const host::Registry& registry, calibrate::SessionOptions session, const naming::Options& naming) {
  const auto say = [&](const std::string& line) {
    if (session.say) session.say(line);
  };
  if (session.cache.empty()) session.cache = sets / "cache";
  RunCount count;
  for (const std::string& name : set_names(sets)) {
    session.output = sets / name / "diagnosis";
    if (fs::exists(session.output / "diagnosis.json")) {
      ++count.known;
      continue;
    }
    say(fmt::format("{}:", name));
    fs::create_directories(session.output);
    fs::remove(session.output / "failed.txt");
    std::string failure;
    try {
      diagnose_set(sets / name, registry, session, naming);
    } catch (const base::UserError& e) {
      if (e.exit_code() != base::kExitBadInput) throw;
      failure = e.what();
    } catch (const fs::filesystem_error&) {
      throw;
    } catch (const std::exception& e) {
      failure = fmt::format("internal error: {}", e.what());
    }
    if (failure.empty()) {
      ++count.done;
      continue;
    }
    ++count.failed;
    output::write_file(session.output / "failed.txt", one_line(failure) + "\n");
    say(fmt::format("{} failed: {}", name, failure));
  }
  return count;
}

}  // namespace millscope::challenge
