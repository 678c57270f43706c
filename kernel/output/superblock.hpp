// The one place where bytes of an HDF5 file are touched without HDF5.
#pragma once

#include <filesystem>

namespace millscope::output::hdf5 {

/// Clears the mark "open for writing" of a version-3 superblock, as `h5clear --status` does. True when the file now has no mark (or is
/// of a kind without one), false when it cannot be read or written.
bool clear_writer_mark(const std::filesystem::path& path);

/// As above, and makes the file's length and the end that the superblock states agree, whichever is greater: a writer that was killed
/// between two of its writes leaves either behind the other. False when it is damaged.
bool repair_superblock(const std::filesystem::path& path);

}  // namespace millscope::output::hdf5
