// Names of what is kept in the cache: hashes of all that it depends on. For the files of this room.
#pragma once

#include <string>
#include <vector>

#include "studies/calibrate/processing.hpp"

namespace millscope::calibrate {

/// What of this program decides what is seen of a recording and of a simulation: the code that runs and tracks pass, compiler, flags,
/// libraries.
const std::string& observing_program();

/// Case, files and plugins' code of a condition's simulations: what the mill that a recording is held against rests on.
std::string content_of_base(const Processing& how, std::size_t condition);

/// Of everything that the results of a recording depend on.
std::string identity_of(const recording::Recording& recording, const Processing& how, std::size_t condition);

/// FNV-1a over texts.
std::string hash_of(const std::vector<std::string>& texts);

/// A subtree of the study as text, for hashes.
std::string dump(const config::Node& node);

}  // namespace millscope::calibrate
