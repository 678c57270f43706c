// A whole text file in memory, unpacked where it is gzipped.
#pragma once

#include <filesystem>
#include <string>

namespace millscope::studies {

/// The file's bytes; a gzip file (known by its first bytes, whatever its name) is inflated. Throws config::UserError when it cannot be
/// opened, is no file, or is a damaged or cut gzip file.
std::string read_text_file(const std::filesystem::path& file);

}  // namespace millscope::studies
