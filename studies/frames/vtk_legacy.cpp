// "VTK File Formats" (Kitware), part "Simple Legacy Formats", to version 5.1: ASCII, and BINARY in big-endian order.
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cctype>
#include <cmath>

#include "studies/frames/vtk.hpp"

namespace millscope::frames {
namespace {

std::string upper(std::string_view text) {
  std::string out(text);
  std::transform(out.begin(), out.end(), out.begin(), [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return out;
}

/// Names of arrays are written with %20 for a blank.
std::string decoded(const std::string& name) {
  std::string out;
  for (std::size_t i = 0; i < name.size(); ++i) {
    if (name[i] == '%' && i + 2 < name.size() && std::isxdigit(static_cast<unsigned char>(name[i + 1])) != 0 &&
        std::isxdigit(static_cast<unsigned char>(name[i + 2])) != 0) {
      out += static_cast<char>(std::stoi(name.substr(i + 1, 2), nullptr, 16));
      i += 2;
    } else {
      out += name[i];
    }
  }
  return out;
}

constexpr std::size_t kMostNumbers = 10'000'000'000;  // of an array

class Legacy : public FrameStream {
 public:
  Legacy(const std::filesystem::path& file, const ReadOptions& options) : in_(file), options_(options) {}

  bool next(Frame& frame) override {
    if (done_) return false;
    done_ = true;
    read_head();
    std::string_view text;
    while (in_.word(text)) read_section(upper(text));
    if (!has_points_) in_.fail("the file ends without POINTS; it is cut short, or holds no beads");
    to_frame(picture_, in_.file(), options_, frame);
    return true;
  }

 private:
  enum class Owner { whole, points, cells };

  void read_head() {
    std::string_view text;
    in_.line(text);  // "# vtk DataFile Version 4.2": the format was known by it
    if (!in_.line(text) || !in_.line(text)) in_.fail("the file ends in its head; it is cut short");
    const std::string coding = upper(text).substr(0, text.find_last_not_of(" \t") + 1);
    if (coding != "ASCII" && coding != "BINARY")
      in_.fail(fmt::format("'{}' stands where ASCII or BINARY is expected", coding.substr(0, 40)));
    binary_ = coding == "BINARY";
    if (upper(word("DATASET")) != "DATASET") in_.fail("DATASET is expected here; the file is damaged");
    const std::string kind = upper(word("the kind of the data"));
    if (kind != "POLYDATA" && kind != "UNSTRUCTURED_GRID")
      in_.fail(fmt::format("holds {}; beads are the points of POLYDATA or UNSTRUCTURED_GRID: name such files alone in 'files'", kind));
  }

  std::string word(const char* what) { return std::string(in_.word(what)); }

  std::size_t count(const char* what) {
    const double number = in_.number(what);
    if (!(number >= 0 && number < 1e10 && number == std::floor(number)))
      in_.fail(fmt::format("{} is no {}; the file is damaged", number, what));
    return static_cast<std::size_t>(number);
  }

  void read_section(const std::string& key) {
    if (key == "POINTS") return read_points();
    if (key == "FIELD") return read_field();
    if (key == "POINT_DATA") return begin_data(Owner::points);
    if (key == "CELL_DATA") return begin_data(Owner::cells);
    if (key == "METADATA") return pass_metadata();
    if (key == "CELL_TYPES") return pass(count("the number of cells"), "int");
    if (key == "VERTICES" || key == "LINES" || key == "POLYGONS" || key == "TRIANGLE_STRIPS" || key == "CELLS") return pass_cells();
    if (key == "OFFSETS" || key == "CONNECTIVITY") {
      const std::string type = word("a type");
      return pass(key == "OFFSETS" ? cells_ : corners_, type);
    }
    read_attribute(key);
  }

  void read_points() {
    const std::size_t n = count("number of points");
    const std::string type = word("the type of the points");
    picture_.points = values(3 * n, type, true);
    has_points_ = true;
  }

  void begin_data(Owner owner) {
    owner_ = owner;
    tuples_ = count("number of values");
    if (owner == Owner::points && has_points_ && tuples_ != picture_.points.size() / 3)
      in_.fail(fmt::format("POINT_DATA is of {} points, the file has {}; it is damaged", tuples_, picture_.points.size() / 3));
  }

  /// "VERTICES n size" and n lists; from version 5.1 on OFFSETS and CONNECTIVITY follow, of n and size numbers.
  void pass_cells() {
    cells_ = count("number of cells");
    corners_ = count("size of the cells");
    std::string_view next = in_.look(64);
    while (!next.empty() && std::isspace(static_cast<unsigned char>(next.front())) != 0) next.remove_prefix(1);
    if (upper(next.substr(0, 7)) != "OFFSETS") pass(corners_, "int");
  }

  void pass_metadata() {
    std::string_view text;
    in_.line(text);  // the rest of its own line
    while (in_.line(text) && text.find_first_not_of(" \t") != std::string_view::npos) {
    }
  }

  void read_field() {
    word("the name of the field");
    const std::size_t arrays = count("number of arrays");
    for (std::size_t a = 0; a < arrays; ++a) {
      std::string name = word("the name of an array");
      while (upper(name) == "METADATA") pass_metadata(), name = word("the name of an array");
      const std::size_t components = count("number of components"), tuples = count("number of values");
      if (components > 0 && tuples > kMostNumbers / components)
        in_.fail(fmt::format("array '{}' has {} times {} numbers; the file is damaged", decoded(name), components, tuples));
      const std::string type = word("the type of an array");
      keep(decoded(name), components, values(components * tuples, type, false));
    }
  }

  void read_attribute(const std::string& key) {
    if (key == "LOOKUP_TABLE") {
      word("the name of a table");
      return pass(4 * count("size of the table"), binary_ ? "unsigned_char" : "float");
    }
    const bool known = key == "SCALARS" || key == "VECTORS" || key == "NORMALS" || key == "TENSORS" || key == "TENSORS6" ||
                       key == "GLOBAL_IDS" || key == "PEDIGREE_IDS" || key == "TEXTURE_COORDINATES" || key == "COLOR_SCALARS";
    if (!known)
      in_.fail(fmt::format("'{}' is no keyword of a VTK file: the data before it are longer than said, or the file is damaged",
                           key.substr(0, 40)));
    const std::string name = decoded(word("the name of an array"));
    std::size_t components = key == "VECTORS" || key == "NORMALS" ? 3 : key == "TENSORS" ? 9 : key == "TENSORS6" ? 6 : 1;
    if (key == "TEXTURE_COORDINATES" || key == "COLOR_SCALARS") components = count("number of components");
    const std::string type = key == "COLOR_SCALARS" ? (binary_ ? "unsigned_char" : "float") : word("the type of an array");
    if (key == "SCALARS") {
      std::string next = word("LOOKUP_TABLE");
      double number = 0;
      if (parse_number(next, number)) components = static_cast<std::size_t>(number), next = word("LOOKUP_TABLE");
      if (upper(next) != "LOOKUP_TABLE")
        in_.fail(fmt::format("'{}' stands where LOOKUP_TABLE is expected; the file is damaged", next.substr(0, 40)));
      word("the name of a table");
    }
    keep(name, components, values(components * tuples_, type, false));
  }

  void keep(const std::string& name, std::size_t components, std::vector<double> numbers) {
    VtkArray array{name, components, std::move(numbers)};
    if (owner_ == Owner::points) picture_.arrays.push_back(std::move(array));
    if (owner_ == Owner::cells) picture_.pass_over_cells(name);
    if (owner_ == Owner::whole) take_field(picture_, array);
  }

  NumberType type_of(const std::string& name) {
    const NumberType type = number_type_of(name);
    if (type.bytes == 0) in_.fail(fmt::format("arrays of '{}' cannot be read here; write numbers (float, double, int, …)", name));
    return type;
  }

  /// Behind the line that was read last: where the bytes of an array begin.
  void end_line() {
    std::string_view ignored;
    in_.line(ignored);
  }

  std::vector<double> values(std::size_t n, const std::string& type_name, bool places) {
    const NumberType type = type_of(type_name);
    if (!binary_) {
      std::vector<double> numbers;
      for (std::size_t i = 0; i < n; ++i) numbers.push_back(in_.number("a number of an array"));
      return numbers;
    }
    end_line();
    // Grows with what is there, so that a false count takes no memory.
    std::vector<char> bytes;
    constexpr std::size_t kPart = std::size_t{16} << 20U;
    for (std::size_t all = n * type.bytes; bytes.size() < all;) {
      const std::size_t part = std::min(kPart, all - bytes.size());
      bytes.resize(bytes.size() + part);
      in_.bytes(bytes.data() + bytes.size() - part, part, "an array");
    }
    constexpr bool reversed = std::endian::native == std::endian::little;
    if (places && looks_reversed(bytes.data(), n, type, reversed))
      in_.fail_here(
          "the points make sense only in little-endian order, but binary legacy files are big-endian: the program writes them wrongly; let "
          "it write ASCII, or XML (.vtp, .vtu)");
    return numbers_from(bytes.data(), n, type, reversed);
  }

  void pass(std::size_t n, const std::string& type_name) {
    if (binary_) {
      const NumberType type = type_of(type_name);
      end_line();
      return in_.pass_over(n * type.bytes, "the cells");
    }
    for (std::size_t i = 0; i < n; ++i) in_.number("a number of the cells");
  }

  Input in_;
  ReadOptions options_;
  VtkPicture picture_;
  Owner owner_ = Owner::whole;
  std::size_t tuples_ = 0, cells_ = 0, corners_ = 0;
  bool binary_ = false, has_points_ = false, done_ = false;
};

}  // namespace

std::unique_ptr<FrameStream> open_legacy_vtk(const std::filesystem::path& file, const ReadOptions& options) {
  return std::make_unique<Legacy>(file, options);
}

}  // namespace millscope::frames
