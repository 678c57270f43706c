// The digest of a library follows its code.
#include "kernel/host/library_code.hpp"

#include <catch2/catch.hpp>
#include <cstdlib>
#include <fstream>
#include <iterator>

#include "scratch.hpp"

using namespace millscope::host;
using testing::Scratch;
namespace fs = std::filesystem;

namespace {

const std::string kSource = R"(#include <cmath>
static const double table[3] = {1.0, 2.5, 3.0};
extern "C" double law(double x) { return table[static_cast<int>(x) % 3] * std::sin(x); }
static double other(double x) { return x + 1.0; }
struct Table { double (*call)(double); };
extern "C" const Table functions = {other};
)";

std::string bytes_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

/// The library that is built of a source in a folder of its own.
std::string build(const Scratch& scratch, const std::string& folder, const std::string& source, const std::string& options = "") {
  const fs::path place = scratch / folder;
  fs::create_directories(place);
  std::ofstream(place / "law.cpp") << source;
  const std::string command = std::string(MILLSCOPE_CXX) + " -std=c++20 -O2 -fPIC -shared " + options + " -o '" +
                              (place / "law.so").string() + "' '" + (place / "law.cpp").string() + "'";
  REQUIRE(std::system(command.c_str()) == 0);
  return bytes_of(place / "law.so");
}

std::string with(const std::string& old, const std::string& text) {
  std::string source = kSource;
  REQUIRE(source.find(old) != std::string::npos);
  return source.replace(source.find(old), old.size(), text);
}

}  // namespace

TEST_CASE("comments, formatting, folders, search paths and debugging data leave a library's digest") {
  const Scratch scratch;
  const std::string first = code_digest(build(scratch, "first", kSource));
  CHECK(first.size() == 16);
  CHECK(code_digest(build(scratch, "a folder with a longer name", kSource)) == first);
  CHECK(code_digest(build(scratch, "comment", with("return table", "\n\n  // a comment\n  return   table"))) == first);
  CHECK(code_digest(build(scratch, "names", with("other(double x) { return x", "other(double length) { return length"))) == first);
  CHECK(code_digest(build(scratch, "debug", kSource, "-g")) == first);
  const std::string path = "-Wl,-rpath,/p", long_path = path + std::string(5000, 'p');  // beyond a page, so that all that follows it moves
  CHECK(code_digest(build(scratch, "path", kSource, path)) == code_digest(build(scratch, "long path", kSource, long_path)));
}

TEST_CASE("a constant, an operation, a called function, a table of functions change a library's digest") {
  const Scratch scratch;
  const std::string first = code_digest(build(scratch, "first", kSource));
  CHECK(code_digest(build(scratch, "constant", with("2.5", "2.500001"))) != first);
  CHECK(code_digest(build(scratch, "operation", with("x + 1.0", "x - 1.0"))) != first);
  CHECK(code_digest(build(scratch, "call", with("std::sin", "std::cos"))) != first);
  CHECK(code_digest(build(scratch, "table", with("= {other}", "= {law}"))) != first);
  CHECK(code_digest(build(scratch, "flags", kSource, "-O0")) != first);
}

TEST_CASE("what is no whole library has the digest of its bytes") {
  const Scratch scratch;
  const std::string library = build(scratch, "first", kSource), cut = library.substr(0, library.size() / 2);
  CHECK(code_digest(cut) != code_digest(library));
  CHECK(code_digest(cut) != code_digest(cut.substr(0, cut.size() - 1)));
  CHECK(code_digest("") != code_digest("no library"));
}

TEST_CASE("the libraries that a library needs are named with their versions, without the runtime of the language") {
  const Scratch scratch;
  const std::string library = build(scratch, "first", kSource, "-Wl,--no-as-needed -lm -lyaml-cpp");
  const std::vector<std::string> needed = needed_libraries(library);
  REQUIRE(needed.size() == 2);
  CHECK(needed[0].rfind("libm.so.6 of glibc 2.", 0) == 0);
  CHECK(needed[1].rfind("libyaml-cpp.so.", 0) == 0);
  // This program has it loaded, with all of its version: so.0.7 is a link to so.0.7.0.
  CHECK(std::count(needed[1].begin(), needed[1].end(), '.') >= 3);
}
