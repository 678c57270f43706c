// What kind of file a YAML file is: a study that was given as a case is told so, and not a misspelt key of it.
#pragma once

#include <string>

namespace millscope::app {

/// Throws base::UserError where the file's keys say clearly that it is of another kind than what stands at this place of the command
/// line ("CASE.yaml", "STUDY.yaml", "RECORDING", …) has to be. Silent for any other place, and for a file that cannot be read: its
/// reader says why.
void refuse_other_kind(const std::string& place, const std::string& file);

}  // namespace millscope::app
