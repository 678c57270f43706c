// The formats that hold text or a header with counts: OBJ, OFF, PLY.
#include <algorithm>
#include <vector>

#include "geometry/import/preflight.hpp"
#include "millscope/element.hpp"

namespace millscope::geometry::detail {

namespace {

/// Index of an OBJ face corner such as "7", "7/2/3" or "-1".
void check_obj_index(std::string_view word, long long vertices, long long& largest, std::size_t line_number) {
  long long index = 0;
  const bool read = read_count(word.substr(0, word.find('/')), index);
  if (!read || index == 0 || -index > vertices) {
    refuse_cut_short("line " + std::to_string(line_number) + ": '" + std::string(word.substr(0, 40)) + "' names no vertex");
  }
  largest = std::max(largest, index);
}

void check_obj_vertex(std::string_view line, std::size_t line_number) {
  std::string_view rest = line;
  for (std::string_view word = take_word(rest); !word.empty(); word = take_word(rest)) {
    const std::size_t sign = word[0] == '-' || word[0] == '+' ? 1 : 0;
    if (word.substr(sign, 1) == ".") {
      refuse("line " + std::to_string(line_number) + ": '" + std::string(word.substr(0, 40)) +
             "' has no digit before its point, which the OBJ reader drops silently: write 0.5 for .5, or export as STL");
    }
  }
  check_numbers(line, 3, line_number);
}

struct PlyElement {
  std::string name;
  long long count = 0;
  std::size_t bytes = 0;       // least bytes of one in a binary file; an empty list is its count only
  std::size_t properties = 0;  // least words of one in a text file
};

std::size_t ply_size(std::string_view type) {
  for (const auto& [name, size] : {std::pair{"char", 1},
                                   {"uchar", 1},
                                   {"int8", 1},
                                   {"uint8", 1},
                                   {"short", 2},
                                   {"ushort", 2},
                                   {"int16", 2},
                                   {"uint16", 2},
                                   {"int", 4},
                                   {"uint", 4},
                                   {"int32", 4},
                                   {"uint32", 4},
                                   {"float", 4},
                                   {"float32", 4},
                                   {"double", 8},
                                   {"float64", 8}}) {
    if (type == name) return as_size(size);
  }
  refuse("PLY property of unknown type '" + std::string(type.substr(0, 40)) + "': export as STL or with float properties");
}

/// Reads up to end_header; true for a text file.
bool read_ply_header(Lines& lines, std::vector<PlyElement>& elements) {
  constexpr std::size_t kLongest = 1000;  // lines
  bool text = false;
  for (std::string_view line; lines.next(line) && lines.number() < kLongest;) {
    const std::string_view word = take_word(line);
    if (word == "end_header") return text;
    if (word == "format") text = take_word(line) == "ascii";
    if (word == "element") {
      PlyElement e;
      e.name = take_word(line);
      if (!read_count(take_word(line), e.count) || e.count < 0) refuse_cut_short("element " + e.name + " without a count");
      elements.push_back(e);
    }
    if (word != "property" || elements.empty()) continue;
    std::string_view type = take_word(line);
    const bool list = type == "list";
    if (list) type = take_word(line);
    elements.back().bytes += ply_size(type) + (list && elements.back().name == "face" ? 3 : 0);  // three indices of one byte at least
    elements.back().properties += 1;
  }
  refuse_cut_short("the PLY header has no end_header");
}

void check_ply_text(Lines& lines, const std::vector<PlyElement>& elements) {
  for (const PlyElement& e : elements) {
    for (long long i = 0; i < e.count;) {
      std::string_view line;
      if (!lines.next(line))
        refuse_cut_short("element " + e.name + ": " + std::to_string(e.count) + " announced, " + std::to_string(i) + " found");
      if (line.empty()) continue;
      check_numbers(line, e.properties, lines.number());
      ++i;
    }
  }
}

}  // namespace

void check_obj(std::string_view data, std::size_t max_triangles) {
  Lines lines(data);
  long long vertices = 0, faces = 0, largest = 0;
  for (std::string_view line; lines.next(line);) {
    const std::string_view word = take_word(line);
    if (word == "v") {
      ++vertices;
      check_obj_vertex(line, lines.number());
    } else if (word == "f") {
      ++faces;
      int corners = 0;
      for (std::string_view corner = take_word(line); !corner.empty() && corner != "\\"; corner = take_word(line), ++corners) {
        check_obj_index(corner, vertices, largest, lines.number());
      }
      if (corners < 3 && line.empty()) refuse_cut_short("line " + std::to_string(lines.number()) + ": a face of fewer than three corners");
    }
  }
  if (largest > vertices) refuse_cut_short("a face names vertex " + std::to_string(largest) + " of " + std::to_string(vertices));
  if (faces == 0) refuse("holds no faces: export the body as a mesh");
  check_size(faces, max_triangles);
}

void check_off(std::string_view data, std::size_t max_triangles) {
  Lines lines(data);
  long long counts[3] = {-1, -1, -1}, words = 0;
  int read = 0;
  bool header = false;
  for (std::string_view line; lines.next(line);) {
    line = line.substr(0, line.find('#'));
    for (std::string_view word = take_word(line); !word.empty(); word = take_word(line)) {
      if (!header && word.size() >= 3 && word.substr(word.size() - 3) == "OFF") {
        header = true;
        continue;
      }
      if (!header) refuse("does not begin with 'OFF': export it again");
      check_number(word, lines.number());
      if (read < 3) {
        if (!read_count(word, counts[read++])) refuse_cut_short("line " + std::to_string(lines.number()) + ": counts expected");
      } else {
        ++words;
      }
    }
  }
  if (read < 3 || counts[0] < 0 || counts[1] < 0) refuse_cut_short("the OFF header has no counts");
  if (counts[1] == 0) refuse("holds no faces: export the body as a mesh");
  check_size(counts[1], max_triangles);
  check_size(counts[0] / 3, max_triangles);
  if (words < 3 * counts[0] + 4 * counts[1]) {
    refuse_cut_short(std::to_string(counts[0]) + " vertices and " + std::to_string(counts[1]) + " faces announced, " +
                     std::to_string(words) + " numbers found");
  }
}

void check_ply(std::string_view data, std::size_t max_triangles) {
  if (data.substr(0, 3) != "ply") refuse("does not begin with 'ply': export it again");
  Lines lines(data);
  std::vector<PlyElement> elements;
  const bool text = read_ply_header(lines, elements);
  long long faces = 0;
  std::size_t least = 0;
  for (const PlyElement& e : elements) {
    check_size(e.count / 3, max_triangles);
    if (e.name == "face") faces = e.count;
    least += as_size(e.count) * e.bytes;
  }
  check_size(faces, max_triangles);
  if (faces == 0) refuse("holds no faces: export the body as a mesh, not as points");
  if (text) return check_ply_text(lines, elements);
  if (lines.rest().size() < least) {
    refuse_cut_short("the header announces at least " + std::to_string(least) + " bytes, " + std::to_string(lines.rest().size()) +
                     " follow");
  }
}

}  // namespace millscope::geometry::detail
