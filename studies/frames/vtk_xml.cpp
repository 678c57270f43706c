// "VTK File Formats" (Kitware), part "XML File Formats": PolyData (.vtp) and UnstructuredGrid (.vtu); arrays as text, as base64 in their
// place, or appended, raw or base64; packed by zlib or not.
//
// The XML is read by pugixml: a small library that many try to break, reads in place, and does not recurse into what it reads. Appended
// raw bytes are no XML; they are cut out before.
#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <bit>
#include <pugixml.hpp>

#include "kernel/base/error.hpp"
#include "studies/frames/vtk.hpp"

namespace millscope::frames {
namespace {

using base::UserError;

constexpr std::size_t kMostBytes = std::size_t{64} << 30U;  // of one array: more is a damaged length

constexpr std::size_t kMostUnpacked = 1100;  // bytes of one: zlib packs at most 1032 into it

std::string value_of(const pugi::xml_node& node, const char* name) { return node.attribute(name).value(); }

int digit_of(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  return c == '+' ? 62 : c == '/' ? 63 : -1;
}

/// Base64 from `text` on, taken group by group; groups that end in '=' may stand in the middle, where one stream ends and another begins.
class Base64 {
 public:
  explicit Base64(std::string_view text) : text_(text) {}

  /// Appends until `out` has `size` bytes or the text ends; false in the latter case.
  bool fill(std::string& out, std::size_t size) {
    while (out.size() < size) {
      if (left_ == 0 && !decode()) return false;
      const std::size_t part = std::min(left_, size - out.size());
      out.append(group_ + held_ - left_, part);
      left_ -= part;
    }
    return true;
  }
  /// What is left of a group is the end of a stream.
  void end_stream() { left_ = 0; }

 private:
  bool decode() {
    int digits[4], got = 0;
    while (got < 4) {
      if (text_.empty()) return false;
      const char c = text_.front();
      if (c == '=' && got >= 2) break;
      const int digit = digit_of(c);
      if (digit < 0 && c != ' ' && c != '\n' && c != '\r' && c != '\t') return false;
      text_.remove_prefix(1);
      if (digit >= 0) digits[got++] = digit;
    }
    while (got < 4 && !text_.empty() && text_.front() == '=') text_.remove_prefix(1);
    unsigned bits = 0;
    for (int i = 0; i < 4; ++i) bits = bits << 6U | static_cast<unsigned>(i < got ? digits[i] : 0);
    group_[0] = static_cast<char>(bits >> 16U), group_[1] = static_cast<char>(bits >> 8U), group_[2] = static_cast<char>(bits);
    held_ = left_ = static_cast<std::size_t>(got - 1);
    return true;
  }

  std::string_view text_;
  char group_[3] = {};
  std::size_t held_ = 0, left_ = 0;
};

/// Bytes of one array, encoded or as they are.
class Bytes {
 public:
  Bytes(std::string_view text, bool base64) : raw_(text), base64_(text), encoded_(base64) {}

  bool fill(std::string& out, std::size_t size) {
    if (encoded_) return base64_.fill(out, size);
    const std::size_t part = std::min(raw_.size(), size - out.size());
    out.append(raw_.substr(0, part));
    raw_.remove_prefix(part);
    return out.size() == size;
  }
  void end_stream() { base64_.end_stream(); }

 private:
  std::string_view raw_;
  Base64 base64_;
  bool encoded_;
};

class Xml : public FrameStream {
 public:
  Xml(const std::filesystem::path& file, const ReadOptions& options) : file_(file), options_(options) {}

  bool next(Frame& frame) override {
    if (done_) return false;
    done_ = true;
    load();
    const pugi::xml_node root = document_.child("VTKFile");
    if (!root) fail("holds no VTKFile; it is no picture of VTK");
    read_head(root);
    const std::string kind = value_of(root, "type");
    const pugi::xml_node data = root.child(kind.c_str());
    if (kind != "PolyData" && kind != "UnstructuredGrid")
      fail(fmt::format("holds {}; beads are the points of PolyData (.vtp) or UnstructuredGrid (.vtu){}", kind,
                       kind.starts_with('P') ? "; save the parts of all processes as one file" : ""));
    VtkPicture picture;
    for (const pugi::xml_node array : data.child("FieldData").children("DataArray")) {
      if (is_time_field(value_of(array, "Name"))) take_field(picture, read_array(array, array.attribute("NumberOfTuples").as_ullong(1), 1));
    }
    for (const pugi::xml_node piece : data.children("Piece")) add_piece(piece, picture);
    to_frame(picture, file_, options_, frame);
    return true;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { throw UserError(fmt::format("{}: {}", file_.string(), what)); }

  [[noreturn]] void fail(const pugi::xml_node& array, const std::string& what) const {
    const auto at = array.offset_debug();
    fail(fmt::format("byte {}: array '{}' {}", std::max<std::ptrdiff_t>(at, 0), value_of(array, "Name"), what));
  }

  void load() {
    text_ = Input(file_).rest();
    std::size_t end = text_.size();
    if (const std::size_t tag = text_.find("<AppendedData"); tag != std::string::npos) {
      const std::size_t close = text_.find('>', tag), begin = text_.find('_', tag);
      if (close == std::string::npos || begin == std::string::npos)
        fail("the file ends in its AppendedData; it is cut short: copy it again");
      appended_base64_ = std::string_view(text_).substr(tag, close - tag).find("base64") != std::string_view::npos;
      appended_ = std::string_view(text_).substr(begin + 1);
      end = tag;
    }
    xml_ = text_.substr(0, end) + (end < text_.size() ? "</VTKFile>" : "");
    const pugi::xml_parse_result result = document_.load_buffer(xml_.data(), xml_.size());
    if (!result) fail(fmt::format("byte {}: {}; the file is damaged or cut short", result.offset, result.description()));
  }

  void read_head(const pugi::xml_node& root) {
    const std::string order = value_of(root, "byte_order"), header = value_of(root, "header_type"), packer = value_of(root, "compressor");
    reversed_ = (order == "BigEndian") != (std::endian::native == std::endian::big);
    header_ = {NumberType::natural, header == "UInt64" ? std::size_t{8} : std::size_t{4}};
    packed_ = !packer.empty();
    if (packed_ && packer != "vtkZLibDataCompressor")
      fail(fmt::format("is packed by {}; save it with ZLib or without compression", packer));
  }

  void add_piece(const pugi::xml_node& piece, VtkPicture& picture) {
    const std::size_t points = piece.attribute("NumberOfPoints").as_ullong();
    if (points == 0) return;
    const pugi::xml_node places = piece.child("Points").child("DataArray");
    if (!places) fail(fmt::format("a piece of {} points says no places; the file is damaged", points));
    const VtkArray array = read_array(places, points, 3);
    picture.points.insert(picture.points.end(), array.values.begin(), array.values.end());
    for (const pugi::xml_node node : piece.child("CellData").children("DataArray")) picture.pass_over_cells(value_of(node, "Name"));
    std::size_t which = 0;
    const bool first = picture.points.size() == array.values.size();
    for (const pugi::xml_node node : piece.child("PointData").children("DataArray")) {
      if (value_of(node, "type") == "String") continue;
      VtkArray one = read_array(node, points, 0);
      if (first) {
        picture.arrays.push_back(std::move(one));
      } else if (which < picture.arrays.size() && picture.arrays[which].name == one.name) {
        picture.arrays[which].values.insert(picture.arrays[which].values.end(), one.values.begin(), one.values.end());
      } else {
        fail(node, "is not in every piece in the same place; save the file as one piece");
      }
      ++which;
    }
  }

  /// `components` 0: as the file says.
  VtkArray read_array(const pugi::xml_node& node, std::size_t tuples, std::size_t components) {
    VtkArray array{value_of(node, "Name"), std::max<std::size_t>(node.attribute("NumberOfComponents").as_ullong(1), 1), {}};
    if (components == 3 && array.components != 3) fail(node, fmt::format("has {} components; places have 3", array.components));
    const NumberType type = number_type_of(value_of(node, "type"));
    if (type.bytes == 0) fail(node, fmt::format("is of the type '{}', which cannot be read here; write numbers", value_of(node, "type")));
    if (array.components > kMostBytes / type.bytes || tuples > kMostBytes / type.bytes / array.components)
      fail(node, fmt::format("has {} values of {} components, more than any file holds; it is damaged", tuples, array.components));
    const std::size_t count = tuples * array.components;
    const std::string format = value_of(node, "format");
    if (format == "ascii") {
      array.values = words_of(node, count);
    } else if (format == "binary" || format == "appended") {
      const std::string bytes =
          format == "binary" ? decoded(node, Bytes(node.child_value(), true), count * type.bytes) : appended(node, count * type.bytes);
      if (components == 3 && looks_reversed(bytes.data(), count, type, reversed_))
        fail(node,
             fmt::format("makes sense only in the other byte order than {}, which the file says; let the program say the right byte_order",
                         reversed_ ? "BigEndian" : "LittleEndian"));
      array.values = numbers_from(bytes.data(), count, type, reversed_);
    } else {
      fail(node, fmt::format("has the format '{}'; known are ascii, binary, appended", format));
    }
    return array;
  }

  std::vector<double> words_of(const pugi::xml_node& node, std::size_t count) {
    std::vector<double> values;
    const std::string_view text = node.child_value(), blanks = " \t\r\n";
    for (std::size_t at = 0; (at = text.find_first_not_of(blanks, at)) != std::string_view::npos;) {
      const std::size_t end = std::min(text.find_first_of(blanks, at), text.size());
      double value = 0;
      if (!parse_number(text.substr(at, end - at), value))
        fail(node, fmt::format("holds '{}', which is no number", text.substr(at, std::min<std::size_t>(end - at, 40))));
      values.push_back(value);
      at = end;
    }
    if (values.size() != count)
      fail(node, fmt::format("holds {} numbers, {} are expected; the file is damaged or cut short", values.size(), count));
    return values;
  }

  std::string appended(const pugi::xml_node& node, std::size_t size) {
    const std::size_t offset = node.attribute("offset").as_ullong();
    if (offset >= appended_.size())
      fail(node,
           fmt::format("stands at byte {} of appended data that have {}; the file is cut short: copy it again", offset, appended_.size()));
    return decoded(node, Bytes(appended_.substr(offset), appended_base64_), size);
  }

  std::uint64_t length_in(const std::string& header, std::size_t which) const {
    std::uint64_t length = 0;
    for (std::size_t i = 0; i < header_.bytes; ++i) {
      const std::size_t from_high = (reversed_ == (std::endian::native == std::endian::big)) ? header_.bytes - 1 - i : i;
      length = length << 8U | static_cast<unsigned char>(header[which * header_.bytes + from_high]);
    }
    return length;
  }

  /// Unpacked: a length, then the bytes. Packed: number of blocks, their size, size of the last, packed sizes; then the blocks.
  std::string decoded(const pugi::xml_node& node, Bytes bytes, std::size_t size) const {
    std::string header, out;
    const auto need = [&](std::string& to, std::size_t all) {
      if (!bytes.fill(to, all))
        fail(node, fmt::format("ends after {} of {} bytes; the file is cut short or damaged: copy it again", to.size(), all));
    };
    if (!packed_) {
      need(header, header_.bytes);
      if (length_in(header, 0) != size)
        fail(node, fmt::format(
                       "says that it holds {} bytes, {} are expected; the byte order or header_type of the file is wrong, or it is damaged",
                       length_in(header, 0), size));
      need(out, size);
      return out;
    }
    need(header, 3 * header_.bytes);
    const std::uint64_t blocks = length_in(header, 0), whole = length_in(header, 1), last = length_in(header, 2);
    // Whole blocks are no more than all of it, so that nothing below goes beyond 64 bits.
    if (blocks > size || last > whole || (blocks > 1 && whole > size / (blocks - 1)))
      fail(node, fmt::format("says that it holds {} blocks of {} bytes, the last of {}, where {} bytes are expected; the byte order or "
                             "header_type of the file is wrong, or it is damaged",
                             blocks, whole, last, size));
    const std::uint64_t said = blocks == 0 ? 0 : last == 0 ? blocks * whole : (blocks - 1) * whole + last;
    if (said != size)
      fail(node,
           fmt::format("says that it holds {} bytes, {} are expected; the byte order or header_type of the file is wrong, or it is damaged",
                       said, size));
    need(header, (3 + blocks) * header_.bytes);
    bytes.end_stream();
    for (std::uint64_t b = 0; b < blocks; ++b)
      unpack(node, bytes, length_in(header, 3 + b), b + 1 == blocks && last != 0 ? last : whole, out);
    return out;
  }

  void unpack(const pugi::xml_node& node, Bytes& bytes, std::uint64_t packed, std::uint64_t size, std::string& out) const {
    std::string block;
    if (size / kMostUnpacked > packed)
      fail(node, fmt::format("says that {} bytes are packed into {}, which zlib cannot; the file is damaged", size, packed));
    if (packed > kMostBytes || !bytes.fill(block, packed))
      fail(node, fmt::format("ends after {} of {} bytes of a packed block; the file is cut short or damaged: copy it again", block.size(),
                             packed));
    const std::size_t before = out.size();
    out.resize(before + size);
    uLongf got = size;
    const int result =
        uncompress(reinterpret_cast<Bytef*>(out.data() + before), &got, reinterpret_cast<const Bytef*>(block.data()), block.size());
    if (result != Z_OK || got != size) fail(node, "has a block that zlib cannot unpack; the file is damaged: copy it again");
  }

  std::filesystem::path file_;
  ReadOptions options_;
  std::string text_, xml_;
  std::string_view appended_;
  pugi::xml_document document_;
  NumberType header_;
  bool appended_base64_ = false, reversed_ = false, packed_ = false, done_ = false;
};

}  // namespace

std::unique_ptr<FrameStream> open_xml_vtk(const std::filesystem::path& file, const ReadOptions& options) {
  return std::make_unique<Xml>(file, options);
}

}  // namespace millscope::frames
