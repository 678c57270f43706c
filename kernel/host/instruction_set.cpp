#include "kernel/host/instruction_set.hpp"

#include <fmt/core.h>

#include <cstdlib>

#include "kernel/base/error.hpp"

namespace millscope::host {

std::string text(InstructionSet level) { return fmt::format("v{}", static_cast<int>(level)); }

InstructionSet machine_instruction_set() {
  static const InstructionSet level = [] {
    __builtin_cpu_init();
    if (__builtin_cpu_supports("x86-64-v4")) return InstructionSet::v4;
    if (__builtin_cpu_supports("x86-64-v3")) return InstructionSet::v3;
    if (__builtin_cpu_supports("x86-64-v2")) return InstructionSet::v2;
    throw base::UserError("this processor does not run x86-64-v2 (SSE4.2), the least that millscope is built for");
  }();
  return level;
}

std::optional<InstructionSet> parse_instruction_set(std::string_view word) {
  if (word.starts_with("x86-64-")) word.remove_prefix(7);
  if (word == "v2") return InstructionSet::v2;
  if (word == "v3") return InstructionSet::v3;
  if (word == "v4") return InstructionSet::v4;
  return {};
}

InstructionSet choose_instruction_set(std::optional<InstructionSet> asked) {
  std::string source = "the instruction set asked for";
  const char* variable = std::getenv("MILLSCOPE_INSTRUCTION_SET");
  if (!asked && variable != nullptr && *variable != '\0') {
    source = "MILLSCOPE_INSTRUCTION_SET";
    asked = parse_instruction_set(variable);
    if (!asked) throw base::UserError(fmt::format("{} is '{}'; known: v2, v3, v4 (unset it to take the best)", source, variable));
  }
  const InstructionSet best = machine_instruction_set();
  if (asked && *asked > best) {
    throw base::UserError(
        fmt::format("{} is x86-64-{}, but this machine runs x86-64-{} at most; take that or less", source, text(*asked), text(best)));
  }
  return asked.value_or(best);
}

std::vector<std::string> folders_for(InstructionSet level) {
  std::vector<std::string> folders;
  for (int n = static_cast<int>(level); n >= static_cast<int>(InstructionSet::v2); --n) folders.push_back(fmt::format("v{}", n));
  folders.emplace_back();
  return folders;
}

}  // namespace millscope::host
