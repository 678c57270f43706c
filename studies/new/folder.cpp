#include "studies/new/folder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>

#include "kernel/config/document.hpp"
#include "kernel/output/file.hpp"
#include "kernel/output/new_folder.hpp"
#include "kernel/run/assembly.hpp"
#include "kernel/run/simulation.hpp"

namespace millscope::new_mill {
namespace {

namespace fs = std::filesystem;
using base::UserError;

constexpr std::uint64_t kQuickBeads = 200000;  // more take long to place, and are placed by 'millscope check'

void copy_into(const fs::path& from, const fs::path& to) {
  std::error_code trouble;
  fs::copy_file(from, to, trouble);
  if (trouble)
    throw UserError(
        fmt::format("{} cannot be copied: {}; check its permissions and the room on the disk", from.string(), trouble.message()));
}

Found look_at(const fs::path& case_file, const Choices& choices, const host::Registry& registry) {
  Found found;
  run::RunOptions options;
  options.quiet = true;
  if (choices.beads <= kQuickBeads) {
    const run::Estimate e = run::estimate(case_file.string(), registry, options);
    return {e.beads, static_cast<std::uint64_t>(e.steps), e.time_step, e.wall_seconds};
  }
  const run::Assembly a = run::assemble(config::read_case(case_file.string()), registry);
  return {a.bead_count, static_cast<std::uint64_t>(a.end_step - a.first_step), a.time_step, 0};
}

std::string replaced(std::string text, const std::string& what, const std::string& with) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + with.size()))
    text.replace(at, what.size(), with);
  return text;
}

}  // namespace

std::string liner_name(const Liner& liner) {
  const std::string own = liner.file.filename().string();
  const bool plain =
      own[0] != '.' && std::all_of(own.begin(), own.end(), [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' || c == '_' || c == '-';
      });
  return plain ? own : "liner" + liner.file.extension().string();
}

Found write_folder(const fs::path& folder, const Mill& mill, const Choices& choices, const host::Registry& registry) {
  output::NewFolder aside(folder);
  const std::string title = folder.filename().string();
  fs::create_directory(aside.path() / "materials");
  for (const Material* m : {&mill.bead_material, &mill.liner_material}) {
    const fs::path to = aside.path() / "materials" / (m->name + ".yaml");
    if (!fs::exists(to)) copy_into(m->file, to);
  }
  if (mill.liner) copy_into(mill.liner->file, aside.path() / liner_name(*mill.liner));
  output::write_file(aside.path() / "case.yaml", case_text(mill, choices, title));
  output::write_file(aside.path() / "README.md", readme_text(mill, choices, title));
  Found found;
  try {
    found = look_at(aside.path() / "case.yaml", choices, registry);
  } catch (const UserError& e) {
    throw UserError("nothing was written, because the case would not run: " + replaced(e.what(), aside.path().string(), folder.string()),
                    e.exit_code());
  }
  aside.publish();
  return found;
}

}  // namespace millscope::new_mill
