// What the names of files say: which comes first, and of which time step each is.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

namespace millscope::frames {

/// dump.9 before dump.10, v_1.9 before v_1.10, at_5e-4 before at_1e-3; files stay as they are where one has no number. Throws
/// base::UserError where the point in the names can be read in two ways that give two orders.
std::vector<std::filesystem::path> in_order(std::vector<std::filesystem::path> files);

/// The last number of a name, where it is whole: drum_1804000.vtk.gz → 1804000, run2.500.txt → 500; at_0.05.csv: nothing.
std::optional<std::int64_t> step_in_name(const std::filesystem::path& file);

}  // namespace millscope::frames
