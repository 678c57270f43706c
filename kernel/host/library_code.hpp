// What of a plugin library can change a result.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace millscope::host {

/// 16 hexadecimal digits over the code and the constants of a library, and over the names of the functions that it takes from others. Not
/// over names of its own, debugging data, the build's identity or the place where it was built or lies: comments, formatting and
/// installation leave it. Over all bytes where they are no whole ELF file.
std::string code_digest(std::string_view library);

/// The libraries that a library names as needed, by their file names with all links resolved, which carry the version: "libfcl.so.0.7.0".
/// Those of the C and C++ runtime are left out, but for the mathematical functions: "libm.so.6 of glibc 2.36". The library is loaded.
std::vector<std::string> needed_libraries(std::string_view library);

}  // namespace millscope::host
