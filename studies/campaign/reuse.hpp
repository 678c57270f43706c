// Why a campaign does not find in its cache what has been computed before.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "studies/campaign/identity.hpp"

namespace millscope::campaign {

/// One sentence: how many of the simulations that are not in the cache have been computed by another program, and in which parts that
/// differs from this one; where none of them has and this kernel has computed nothing of what lies there, how many others do. Empty else.
std::string other_programs_sentence(const std::filesystem::path& cache, std::span<const Identity> missing);

}  // namespace millscope::campaign
