// Which of the builds v2, v3, v4 (x86-64 micro-architecture levels) of a plugin to take.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace millscope::host {

/// x86-64-v2 (SSE4.2), -v3 (AVX2, FMA), -v4 (AVX-512 F, BW, CD, DQ, VL).
enum class InstructionSet { v2 = 2, v3 = 3, v4 = 4 };

/// "v2", "v3" or "v4".
std::string text(InstructionSet level);

/// The highest level that processor and operating system run. Throws UserError below v2.
InstructionSet machine_instruction_set();

/// `asked`, or else the environment variable MILLSCOPE_INSTRUCTION_SET (v2, v3, v4), or else the machine's. Throws UserError for a
/// word that is none of these and for a level that the machine does not run.
InstructionSet choose_instruction_set(std::optional<InstructionSet> asked = {});

/// Parses "v2", "v3", "v4" (or with "x86-64-" before it).
std::optional<InstructionSet> parse_instruction_set(std::string_view word);

/// The sub-folders to look into, best first: for v3 {"v3", "v2", ""}.
std::vector<std::string> folders_for(InstructionSet level);

}  // namespace millscope::host
