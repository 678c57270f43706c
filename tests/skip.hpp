// Tests that cannot run everywhere: they say so and return, and ctest reports them as skipped, not as passed.
#pragma once

#include <catch2/catch.hpp>
#include <filesystem>
#include <string>

namespace testing {

/// Says that this test does not run here; it returns then. To be called before the first CHECK: ctest takes a test that says this for
/// skipped, also when it fails. tests/CMakeLists.txt tells ctest the words.
inline void skip(const std::string& why) { WARN("this test is skipped: " << why); }

/// A recording, or the folder of all; they are large and lie beside the repository, where they are there at all.
inline std::filesystem::path recording(const std::string& name = "") {
  return std::filesystem::path(MILLSCOPE_SOURCE_DIR).parent_path() / "shared/recordings" / name;
}

/// An input on which other people's tools failed.
inline std::filesystem::path public_case(const std::string& name) {
  return std::filesystem::path(MILLSCOPE_SOURCE_DIR).parent_path() / "shared/public_cases" / name;
}

/// Whether a file is not there, which skips the test.
inline bool absent(const std::filesystem::path& file) {
  if (std::filesystem::exists(file)) return false;
  skip(file.string() + " is not there");
  return true;
}

/// Whether a recording is not there, which skips the test.
inline bool absent(const std::string& name) { return absent(recording(name)); }
inline bool absent(const char* name) { return absent(recording(name)); }

}  // namespace testing
