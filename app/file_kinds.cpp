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
  std::vector<std::string> sure;  ///< keys of which a file of this kind has one at least
  std::vector<std::string> more;  ///< its other keys; what stands in files of every kind (name, seed) is left out
};

const std::vector<FileKind>& file_kinds() {
  static const std::vector<FileKind> kinds = {
      {"a case",
       "CASE.yaml",
       "'millscope check' and 'run' read cases",
       {"materials", "fill", "contact", "pairs", "geometry"},
       {"groups", "beads", "body_forces", "mill", "domain", "time", "start", "output", "run", "stiffness_factor"}},
      {"a study",
       "STUDY.yaml",
       "'millscope calibrate', 'validate', 'diagnose' and 'bank' read studies",
       {"base", "conditions"},
       {"parameters", "constraints", "nuisances", "hypotheses", "bank", "objective", "method", "design", "budget", "runner", "observe",
        "analyzers", "power_error", "level"}},
      {"a challenge",
       "CHALLENGE.yaml",
       "'millscope challenge' reads challenges",
       {"study", "truth", "sets"},
       {"camera", "beads", "seconds", "held_out_seconds"}},
      {"a list of tasks", "TASKS.yaml", "'millscope campaign' reads lists of tasks", {"simulations"}, {"case", "set"}},
      {"a recording",
       "RECORDING",
       "'millscope pept' and 'analyze' read recordings",
       {"files"},
       {"format", "columns", "separator", "skip_lines", "axes", "mirror", "condition", "frame", "gap_limit", "encoder", "labels"}},
      {"a mill of another program's files",
       "MILL.yaml",
       "'millscope import' reads such files",
       {"gravity"},
       {"files", "length_unit", "velocity_unit", "spin_unit", "axis", "mill", "beads", "time"}}};
  return kinds;
}

std::ptrdiff_t count_of(const std::vector<std::string>& among, const std::vector<std::string>& keys) {
  return std::count_if(keys.begin(), keys.end(), [&](const std::string& key) { return std::ranges::find(among, key) != among.end(); });
}

/// How many of the keys tell this kind; none where all of its sure ones are missing.
std::ptrdiff_t told_by(const FileKind& kind, const std::vector<std::string>& keys) {
  const std::ptrdiff_t sure = count_of(kind.sure, keys);
  return sure == 0 ? 0 : sure + count_of(kind.more, keys);
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
  const std::string ending = std::filesystem::path(file).extension();
  if (wanted == kinds.end() || (ending != ".yaml" && ending != ".yml")) return;
  const std::vector<std::string> keys = keys_of(file);
  const auto less = [&](const FileKind& a, const FileKind& b) { return told_by(a, keys) < told_by(b, keys); };
  const auto likely = std::max_element(kinds.begin(), kinds.end(), less);
  if (told_by(*likely, keys) < kEnough || !less(*wanted, *likely)) return;
  throw base::UserError(fmt::format("{}: is {}, and {} is wanted here; {}", file, likely->name, wanted->name, likely->readers));
}

}  // namespace millscope::app
