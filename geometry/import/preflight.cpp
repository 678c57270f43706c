#include "geometry/import/preflight.hpp"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <cstring>

#include "millscope/parameters.hpp"

namespace millscope::geometry {

namespace detail {

bool Lines::next(std::string_view& line) {
  if (rest_.empty()) return false;
  const std::size_t end = rest_.find_first_of("\r\n");
  line = rest_.substr(0, end);
  if (end == std::string_view::npos) {
    rest_ = {};
  } else {
    rest_.remove_prefix(end + (rest_.substr(end, 2) == "\r\n" ? 2 : 1));
  }
  const std::size_t first = line.find_first_not_of(" \t"), last = line.find_last_not_of(" \t");
  line = first == std::string_view::npos ? std::string_view{} : line.substr(first, last - first + 1);
  ++number_;
  return true;
}

std::string lower(std::string_view text) {
  std::string out(text);
  for (char& c : out) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return out;
}

std::string_view take_word(std::string_view& line) {
  const std::size_t begin = line.find_first_not_of(" \t\r\n");
  if (begin == std::string_view::npos) return line = {};
  line.remove_prefix(begin);
  const std::string_view word = line.substr(0, line.find_first_of(" \t\r\n"));
  line.remove_prefix(word.size());
  return word;
}

bool read_count(std::string_view word, long long& value) {
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error == std::errc{} && end == word.data() + word.size();
}

void refuse(const std::string& reason_and_remedy) { throw Refusal(reason_and_remedy); }

void refuse_cut_short(const std::string& reason) { refuse(reason + ": the file is cut short or damaged, export it again"); }

void check_number(std::string_view word, std::size_t line_number) {
  const std::string where = "line " + std::to_string(line_number) + ": ";
  const std::string shown(word.substr(0, 40));
  if (word.find(',') != std::string_view::npos) {
    refuse(where + "'" + shown + "' has a decimal comma: export with decimal points");
  }
  const bool plain = word.find_first_not_of("0123456789+-.eE") == std::string_view::npos;
  if (!plain || word.find_first_of("0123456789") == std::string_view::npos) {
    refuse(where + "'" + shown + "' is not a finite number: repair the mesh in the CAD program and export it again");
  }
}

void check_numbers(std::string_view line, std::size_t wanted, std::size_t line_number) {
  for (std::size_t i = 0; i < wanted; ++i) {
    const std::string_view word = take_word(line);
    if (word.empty()) {
      refuse_cut_short("line " + std::to_string(line_number) + ": " + std::to_string(wanted) + " numbers expected, " + std::to_string(i) +
                       " found");
    }
    check_number(word, line_number);
  }
}

void check_size(long long triangles, std::size_t max_triangles) {
  if (triangles < 0) refuse_cut_short("a count below zero");
  if (static_cast<unsigned long long>(triangles) > max_triangles) {
    refuse(std::to_string(triangles) + " faces, more than max_triangles = " + std::to_string(max_triangles) +
           ": export a coarser mesh (facets of half a bead's size are enough) or raise max_triangles");
  }
}

/// Brackets of a JSON text must close, and not be nested so deep that a recursive reader runs out of stack.
void check_gltf(std::string_view data) {
  constexpr int kDeepest = 64;
  int depth = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < data.size(); ++i) {
    const char c = data[i];
    if (in_string) {
      if (c == '\\') ++i;
      in_string = c != '"';
      continue;
    }
    in_string = c == '"';
    depth += (c == '{' || c == '[') - (c == '}' || c == ']');
    if (depth > kDeepest)
      refuse("JSON nested more than " + std::to_string(kDeepest) + " deep: this is no mesh from a CAD program, export it again");
  }
  if (depth != 0 || in_string || data.find('{') == std::string_view::npos) refuse_cut_short("JSON brackets do not close");
}

void check_glb(std::string_view data) {
  const auto number_at = [&](std::size_t at) {
    std::uint32_t value = 0;
    if (at + 4 <= data.size()) std::memcpy(&value, data.data() + at, 4);
    return value;
  };
  if (data.substr(0, 4) != "glTF") refuse("does not begin with 'glTF': not a GLB file, export it again");
  if (number_at(8) != data.size()) {
    refuse_cut_short("the header says " + std::to_string(number_at(8)) + " bytes, the file has " + std::to_string(data.size()));
  }
  const std::size_t json = number_at(12);
  if (data.size() < 20 || json > data.size() - 20) refuse_cut_short("the JSON part is longer than the file");
  check_gltf(data.substr(20, json));
}

void check_3mf(std::string_view data) {
  if (data.substr(0, 2) != "PK") refuse("is not a ZIP archive, as 3MF must be: export it again");
  const std::size_t tail = std::min<std::size_t>(data.size(), 66000);  // the directory's end may be followed by a comment of 64 KB
  if (data.substr(data.size() - tail).find("PK\x05\x06") == std::string_view::npos) refuse_cut_short("the archive's directory is missing");
}

}  // namespace detail

bool is_supported(const std::string& extension) {
  constexpr const char* kKnown[] = {"stl", "obj", "ply", "off", "gltf", "glb", "3mf"};
  return std::find(std::begin(kKnown), std::end(kKnown), extension) != std::end(kKnown);
}

void preflight(std::string_view data, const std::string& extension, std::size_t max_triangles) {
  if (extension == "obj") return detail::check_obj(data, max_triangles);
  if (extension == "ply") return detail::check_ply(data, max_triangles);
  if (extension == "off") return detail::check_off(data, max_triangles);
  if (extension == "gltf") return detail::check_gltf(data);
  if (extension == "glb") return detail::check_glb(data);
  if (extension == "3mf") return detail::check_3mf(data);
}

}  // namespace millscope::geometry
