// The score as a page for people and as JSON.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "studies/challenge/score.hpp"

namespace millscope::challenge {

struct Page {
  const std::vector<Marked>& sets;
  const Score& score;
  std::string command;                                         ///< that made it
  std::vector<std::pair<std::string, std::string>> manifests;  ///< folder of sets and hash of its manifest
};

/// Markdown; every sentence is made from the figures.
std::string page_text(const Page& page);
/// Of one folder of sets.
nlohmann::ordered_json score_json(const Page& page);

/// "3 of 4 (75 %; 90 %: 25 … 99 %)"; "none tried".
std::string count_text(const Count& count);
/// Parts of the page: what went wrong; power, held-out gain, strengths, coverage, recovery; every set and what of it is concealed.
std::string misses_text(const Page& page);
std::string figures_text(const Page& page);
std::string sets_text(const Page& page);

}  // namespace millscope::challenge
