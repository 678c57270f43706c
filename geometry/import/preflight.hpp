// Looks at a mesh file before assimp does: assimp hangs, crashes or silently reads wrong triangles from some damaged files. Every
// refusal is a reason and a remedy; the caller puts the file's name before it.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace millscope::geometry {

/// Throws Refusal. `extension` is lower case without the dot, one of those that `is_supported` knows; STL looks at itself (stl.hpp).
void preflight(std::string_view data, const std::string& extension, std::size_t max_triangles);

bool is_supported(const std::string& extension);

namespace detail {

/// Lines of a text, with their numbers; '\r' and blanks at both ends are cut off.
class Lines {
 public:
  explicit Lines(std::string_view text) : rest_(text) {}
  bool next(std::string_view& line);
  std::size_t number() const { return number_; }
  std::string_view rest() const { return rest_; }

 private:
  std::string_view rest_;
  std::size_t number_ = 0;
};

std::string lower(std::string_view text);
/// Takes the next word off the front; empty at the end.
std::string_view take_word(std::string_view& line);
bool read_count(std::string_view word, long long& value);
/// At least `wanted` plain numbers must stand in `line`.
void check_numbers(std::string_view line, std::size_t wanted, std::size_t line_number);
/// One number: no NaN, infinity, decimal comma.
void check_number(std::string_view word, std::size_t line_number);
[[noreturn]] void refuse(const std::string& reason_and_remedy);
[[noreturn]] void refuse_cut_short(const std::string& reason);
void check_size(long long triangles, std::size_t max_triangles);

void check_obj(std::string_view data, std::size_t max_triangles);
void check_off(std::string_view data, std::size_t max_triangles);
void check_ply(std::string_view data, std::size_t max_triangles);
void check_gltf(std::string_view data);
void check_glb(std::string_view data);
void check_3mf(std::string_view data);

}  // namespace detail

}  // namespace millscope::geometry
