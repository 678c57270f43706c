// A digest of sources counts what is compiled: not comments, not formatting.
#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "kernel/base/code_digest/tokens.hpp"
#include "kernel/base/program.hpp"
#include "scratch.hpp"

using namespace millscope::base;
using testing::Scratch;
namespace fs = std::filesystem;

namespace {

bool same(const char* one, const char* other) { return tokens_of(one) == tokens_of(other); }

/// What the build's tool writes for a tree with one room of one file.
std::string digests(const fs::path& root, const std::string& source) {
  fs::create_directories(root / "room");
  std::ofstream(root / "room/law.cpp") << source;
  const fs::path output = root / "digests.cpp";
  const std::string command = "'" MILLSCOPE_CODE_DIGEST "' '" + output.string() + "' '" + root.string() + "' room";
  REQUIRE(std::system(command.c_str()) == 0);
  std::ifstream in(output);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace

TEST_CASE("comments and formatting leave the tokens of a source") {
  CHECK(same("double f(double x) { return -x; }", "double f( double x )\n{\n  // minus\n  return - x ; /* of\n x */\n}\n"));
  CHECK(same("a = b / c;", "a = b /* by */ / c;"));
  CHECK(same("x = 1'000;  // it's 'quoted' \"here\"\ny = 2;", "x=1'000;y=2;"));
  CHECK(same("#define A b\nc;", "#define A b  // comment\n\n\nc;"));
  CHECK(same("#define A \\\n  b\nc;", "#define A b\nc;"));
  CHECK(same("// a comment that goes on \\\n int x;\nint y;", "int y;"));
  CHECK(same("x = u8\"//\";", "x = u8\"//\"; // text"));
}

TEST_CASE("what is compiled otherwise has other tokens") {
  CHECK_FALSE(same("x = 1.0;", "x = 1.1;"));
  CHECK_FALSE(same("x = a - -b;", "x = a-- b;"));
  CHECK_FALSE(same("x = a + +b;", "x = a ++b;"));
  CHECK_FALSE(same("intx;", "int x;"));
  CHECK_FALSE(same("#define A b\nc;", "#define A b c;"));
  CHECK_FALSE(same("x = \"a b\";", "x = \"a  b\";"));
  CHECK_FALSE(same("x = \"http://a\"; y = 1;", "x = \"http://a\"; y = 2;"));  // nothing of it is a comment
  CHECK_FALSE(same("x = \"\\\"\"; /* a */ y = '\"'; z = 1;", "x = \"\\\"\"; /* b */ y = '\"'; z = 2;"));
  CHECK_FALSE(same("x = R\"(a // b\" )\"; y = 1;", "x = R\"(a // b\" )\"; y = 2;"));
  CHECK_FALSE(same("x = R\"-(  )\" )-\"; y = 1;", "x = R\"-( )\" )-\"; y = 1;"));
}

TEST_CASE("the digest of a folder follows its code, wherever the tree lies") {
  const Scratch one, other;
  const std::string first = digests(one.path, "int law() { return 1; }\n");
  CHECK(first.find("{\"room\", 0x") != std::string::npos);
  CHECK(digests(other.path, "// A law.\nint law()\n{\n  return 1;\n}\n") == first);
  CHECK(digests(other.path, "int law() { return 2; }\n") != first);
}

TEST_CASE("this program tells its kernel's code, compiler, flags and libraries") {
  const ProgramParts parts = program_parts(simulating_folders());
  REQUIRE(parts.size() == 4);
  CHECK(parts.at("code").size() == 16);
  CHECK(parts.at("compiler").find_first_of("0123456789") != std::string::npos);
  CHECK(parts.at("flags").find("-ffp-contract=off") != std::string::npos);
  CHECK(parts.at("flags").find("-march=x86-64-v3") != std::string::npos);
  CHECK(parts.at("flags").find("-Wall") == std::string::npos);  // a warning changes no number
  CHECK(parts.at("libraries").find("glibc 2.") != std::string::npos);
  for (const char* library : {"Boost 1", "Eigen 3", "HDF5 1", "yaml-cpp 0"})
    CHECK(parts.at("libraries").find(library) != std::string::npos);
  CHECK(program_parts(std::span(simulating_folders()).first(3)).at("code") != parts.at("code"));
  CHECK(version_and_commit().rfind(version() + " (commit not known", 0) == 0);  // a test program is of no commit
}
