#include "studies/campaign/reuse.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <set>

#include "studies/campaign/cache.hpp"

namespace millscope::campaign {
namespace {

namespace fs = std::filesystem;

/// Case → key of each entry of the cache.
using Entries = std::multimap<std::string, std::string>;

Entries entries_of(const fs::path& cache) {
  Entries entries;
  std::error_code none;
  for (const fs::directory_entry& folder : fs::directory_iterator(cache, none)) {
    const std::string key = folder.path().filename().string();
    if (fs::exists(folder.path() / "task.json")) entries.emplace(case_of(key), key);
  }
  return entries;
}

/// Adds the parts in which the programs differ that have finished this simulation; whether there are any.
bool add_differences(const fs::path& cache, const Entries& entries, const Identity& missing, std::set<std::string>& different) {
  bool any = false;
  const auto [begin, end] = entries.equal_range(case_of(missing.key));
  for (auto entry = begin; entry != end; ++entry) {
    const TaskRecord record = Entry(cache, entry->second).read();
    if (entry->second == missing.key || record.stage != Stage::done) continue;
    any = true;
    for (const auto& [part, text] : missing.program) {
      const auto other = record.program.find(part);
      if (other == record.program.end() || other->second != text) different.insert(part);
    }
  }
  return any;
}

/// How many finished simulations there are if this kernel has computed none of them, else 0.
std::size_t all_of_others(const fs::path& cache, const Entries& entries) {
  const base::ProgramParts kernel = base::program_parts(base::simulating_folders());
  std::size_t others = 0;
  for (const auto& [of, key] : entries) {
    const TaskRecord record = Entry(cache, key).read();
    if (record.stage != Stage::done) continue;
    const auto agrees = [&](const auto& part) {
      const auto found = record.program.find(part.first);
      return found != record.program.end() && found->second == part.second;
    };
    if (std::all_of(kernel.begin(), kernel.end(), agrees)) return 0;
    ++others;
  }
  return others;
}

}  // namespace

std::string other_programs_sentence(const fs::path& cache, std::span<const Identity> missing) {
  if (missing.empty()) return {};
  const Entries entries = entries_of(cache);
  std::set<std::string> different;
  std::size_t known = 0;
  for (const Identity& identity : missing) known += add_differences(cache, entries, identity, different) ? 1 : 0;
  if (known > 0)
    return fmt::format("simulations in the cache that another program computed and that are not used: {}; what differs: {}", known,
                       fmt::join(different, ", "));
  const std::size_t others = all_of_others(cache, entries);
  return others == 0 ? ""
                     : fmt::format("simulations in the cache, all of other programs and other cases and none of them used: {}", others);
}

}  // namespace millscope::campaign
