#include "app/file_kinds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <vector>

#include "kernel/config/document.hpp"

namespace millscope::app {
namespace {

constexpr std::ptrdiff_t kEnough = 2;  // keys that tell a kind; one may be a slip

struct FileKind {
  const char* name;
  const char* place;  ///< of the command line, as Options::positional() names it
  const char* readers;
  std::vector<std::string> keys;  ///< that tell it; what stands in files of every kind (name, seed) is left out
};

const std::vector<FileKind>& file_kinds() {
  static const std::vector<FileKind> kinds = {
      {"a case",
       "CASE.yaml",
       "'millscope check' and 'run' read cases",
       {"materials", "groups", "beads", "fill", "contact", "pairs", "body_forces", "mill", "geometry", "domain", "time", "output"}},
      {"a study",
       "STUDY.yaml",
       "'millscope calibrate', 'validate', 'diagnose' and 'bank' read studies",
       {"base", "conditions", "parameters", "nuisances", "hypotheses", "bank", "objective", "budget", "observe"}},
      {"a challenge", "CHALLENGE.yaml", "'millscope challenge' reads challenges", {"study", "camera", "truth", "sets", "held_out_seconds"}},
      {"a list of tasks", "TASKS.yaml", "'millscope campaign' reads lists of tasks", {"case", "set", "simulations"}},
      {"a recording",
       "RECORDING",
       "'millscope pept' and 'analyze' read recordings",
       {"files", "format", "columns", "axes", "condition", "frame", "encoder"}},
      {"a mill of another program's files",
       "MILL.yaml",
       "'millscope import' reads such files",
       {"files", "length_unit", "velocity_unit", "spin_unit", "axis", "gravity", "mill", "beads", "time"}}};
  return kinds;
}

std::vector<std::string> keys_of(const std::string& file) {
  try {
    return config::load_document_with_paths(file).keys();
  } catch (const base::UserError&) {
    return {};
  }
}

}  // namespace

void refuse_other_kind(const std::string& place, const std::string& file) {
  const std::vector<FileKind>& kinds = file_kinds();
  const auto wanted = std::find_if(kinds.begin(), kinds.end(), [&](const FileKind& k) { return place == k.place; });
  if (wanted == kinds.end() || std::filesystem::path(file).extension() != ".yaml") return;
  const std::vector<std::string> keys = keys_of(file);
  const auto told_by = [&keys](const FileKind& kind) {
    return std::count_if(keys.begin(), keys.end(),
                         [&](const std::string& key) { return std::ranges::find(kind.keys, key) != kind.keys.end(); });
  };
  const auto likely =
      std::max_element(kinds.begin(), kinds.end(), [&](const FileKind& a, const FileKind& b) { return told_by(a) < told_by(b); });
  if (told_by(*likely) < kEnough || told_by(*likely) <= told_by(*wanted)) return;
  throw base::UserError(fmt::format("{}: is {}, and {} is wanted here; {}", file, likely->name, wanted->name, likely->readers));
}

}  // namespace millscope::app
