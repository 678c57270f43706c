// What of a case LIGGGHTS cannot play, and what it plays in its own way.
#pragma once

#include <string>
#include <vector>

#include "kernel/host/registry.hpp"
#include "kernel/run/assembly.hpp"

namespace millscope::engine::liggghts {

/// "file:line: contact.law 'jkr': LIGGGHTS has no such law; the nearest is hertz_mindlin", one for each thing, all at once.
std::vector<std::string> obstacles_of(const run::Assembly& a, const host::Registry& registry);

/// Throws base::UserError with all of them, a line each, where there are any.
void require_playable(const run::Assembly& a, const host::Registry& registry);

/// What both engines play, but define differently: a sentence for each.
std::vector<std::string> differences_of(const run::Assembly& a, const host::Registry& registry);

}  // namespace millscope::engine::liggghts
