#include "geometry/import/stl.hpp"

#include <algorithm>
#include <charconv>
#include <cstring>

#include "geometry/import/preflight.hpp"
#include "millscope/element.hpp"

namespace millscope::geometry {

namespace {

using detail::lower;
using detail::refuse;
using detail::refuse_cut_short;

constexpr std::size_t kHeader = 84, kTriangle = 50, kNormal = 12;  // bytes of a binary file
constexpr std::string_view kBlanks = " \t";

bool looks_like_text(std::string_view data) {
  const std::string head = lower(data.substr(0, 4096));
  const std::size_t start = head.find_first_not_of(" \t\r\n");
  return start != std::string::npos && head.compare(start, 5, "solid") == 0 &&
         (head.find("facet") != std::string::npos || head.find("endsolid") != std::string::npos ||
          head.find("end solid") != std::string::npos);
}

/// Line by line; several statements may share one, but for `solid` and `facet`, whose rest is a name and a normal.
class TextReader {
 public:
  explicit TextReader(std::string_view data) : lines_(data) {}

  Solids read(std::size_t max_triangles) {
    for (std::string_view line; lines_.next(line);) {
      for (std::string_view word = detail::take_word(line); !word.empty(); word = detail::take_word(line)) take(lower(word), line);
    }
    if (solid_open_) refuse_cut_short("the last 'solid' has no 'endsolid'");
    std::size_t triangles = 0;
    for (const Solid& s : file_.solids) triangles += s.corners.size() / 9;
    if (triangles == 0) refuse("holds no triangles: export the body, not an empty selection");
    detail::check_size(static_cast<long long>(triangles), max_triangles);
    file_.single_precision = false;
    return std::move(file_);
  }

 private:
  void take(std::string word, std::string_view& line) {
    if (word == "end") word += lower(detail::take_word(line));
    if (word == "solid" || word == "endsolid") {
      expect(word == "endsolid" ? solid_open_ && !facet_open_ : !solid_open_, word);
      solid_open_ = word == "solid";
      if (solid_open_) file_.solids.push_back({rest_of(line), {}});
      line = {};  // a name is all that stands behind the word
    } else if (word == "facet") {
      expect(solid_open_ && !facet_open_, word);
      facet_open_ = true;
      line = {};  // the normal
    } else if (word == "vertex") {
      expect(facet_open_ && corners_ < 3, word);
      detail::check_numbers(line, 3, lines_.number());
      for (int k = 0; k < 3; ++k) file_.solids.back().corners.push_back(number(detail::take_word(line)));
      ++corners_;
    } else if (word == "endfacet") {
      expect(facet_open_ && corners_ == 3, word);
      facet_open_ = false, corners_ = 0;
    }
  }

  static std::string rest_of(std::string_view line) {
    const std::size_t first = line.find_first_not_of(kBlanks);
    return first == std::string_view::npos ? std::string() : std::string(line.substr(first));
  }

  static double number(std::string_view word) {
    if (word.starts_with('+')) word.remove_prefix(1);
    double value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc{} || end != word.data() + word.size()) refuse("'" + std::string(word) + "' is no number: export the mesh again");
    return value;
  }

  void expect(bool right, const std::string& word) const {
    if (!right) refuse_cut_short("line " + std::to_string(lines_.number()) + ": '" + word + "' stands where something else belongs");
  }

  detail::Lines lines_;
  Solids file_;
  bool solid_open_ = false, facet_open_ = false;
  int corners_ = 0;
};

Solids read_binary(std::string_view data, std::uint32_t count, std::size_t max_triangles) {
  if (count == 0) refuse("holds no triangles: export the body, not an empty selection");
  detail::check_size(count, max_triangles);
  Solids file;
  file.solids.emplace_back();
  std::vector<double>& corners = file.solids[0].corners;
  corners.reserve(9 * as_size(count));
  for (std::size_t t = 0; t < count; ++t) {
    float xyz[9];
    std::memcpy(xyz, data.data() + kHeader + t * kTriangle + kNormal, sizeof xyz);
    corners.insert(corners.end(), std::begin(xyz), std::end(xyz));
  }
  return file;
}

}  // namespace

Solids read_stl(std::string_view data, std::size_t max_triangles) {
  std::uint32_t count = 0;
  if (data.size() >= kHeader) std::memcpy(&count, data.data() + 80, 4);
  const std::size_t expected = kHeader + kTriangle * count;
  if (data.size() == expected) return read_binary(data, count, max_triangles);
  if (looks_like_text(data)) return TextReader(data).read(max_triangles);
  if (data.size() < kHeader) refuse_cut_short(std::to_string(data.size()) + " bytes are no STL file");
  if (data.size() < expected)
    refuse_cut_short("a binary STL of " + std::to_string(count) + " triangles has " + std::to_string(expected) + " bytes, this one has " +
                     std::to_string(data.size()));
  const std::string_view more = data.substr(expected);
  const std::string bytes = std::to_string(more.size());
  // What is shorter than a triangle hides none, nor do zeros that fill a block.
  if (more.size() >= kTriangle && more.find_first_not_of('\0') != std::string_view::npos)
    refuse(bytes + " bytes too many behind the " + std::to_string(count) + " triangles that the header announces: export it again");
  Solids file = read_binary(data, count, max_triangles);
  file.notes.push_back(bytes + " bytes behind the last triangle are passed over");
  return file;
}

}  // namespace millscope::geometry
