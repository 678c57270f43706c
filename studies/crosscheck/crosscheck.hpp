// Does another engine say the same of a mill? One case, played by both from the same beads at the same places, for several seeds.
//
//   OUT/common/              the case that both play (common_case.hpp), and its walls as STL
//   OUT/cache/               the runs, each once: the same command goes on where it was stopped
//   OUT/crosscheck.json      what was found; quantities.csv: the same as a table
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "kernel/host/registry.hpp"
#include "studies/campaign/campaign.hpp"
#include "studies/crosscheck/agreement.hpp"

namespace millscope::crosscheck {

struct Request {
  std::string case_file;
  std::vector<std::string> settings;  ///< as --set
  std::string engine = "liggghts";
  int ranks = 1;
  int seeds = 6;                      ///< seed, seed + 1, … of the case; at least 3
  std::vector<std::string> switches;  ///< settings that are tried on our side alone, one at a time
  Limits limits;
  std::filesystem::path output;
  campaign::Options campaign;  ///< its cache is OUT/cache where none is given
};

/// One of the settings tried on our side alone.
struct Switched {
  std::string setting;
  std::vector<Compared> moves;  ///< from ours as it is to ours with the setting
  std::vector<Compared> left;   ///< from ours with the setting to theirs
};

/// One run.
struct Played {
  std::string label;  ///< "millscope, seed 3"
  std::filesystem::path folder;
  double wall_s = 0;
};

struct Found {
  std::string name, engine, engine_version;
  std::size_t seeds = 0;
  double window_s = 0;  ///< of each run that counts
  std::vector<Compared> quantities;
  std::vector<Switched> switches;
  std::vector<std::string> differs;   ///< what the engine defines in its own way, a sentence each
  std::vector<std::string> left_out;  ///< quantities that one of the two does not tell
  std::vector<Played> runs;
};

/// Throws base::UserError before anything is computed where the engine cannot play the case; campaign::Interrupted.
Found crosscheck(const Request& request, const host::Registry& registry);

/// "agree", "differ" or "not resolved", with the reason: one line.
std::string sentence(const Found& found);

/// The table for a terminal.
std::string table(const Found& found);

nlohmann::ordered_json json_of(const Found& found);

/// crosscheck.json and quantities.csv, each whole or not at all.
void write(const Found& found, const std::filesystem::path& folder);

}  // namespace millscope::crosscheck
