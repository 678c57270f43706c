// One file or many, of whatever format, as one stream of frames.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <pugixml.hpp>

#include "kernel/base/error.hpp"
#include "studies/frames/dump.hpp"
#include "studies/frames/table.hpp"
#include "studies/frames/vtk.hpp"

namespace millscope::frames {
namespace {

using base::UserError;
namespace fs = std::filesystem;

enum class Format { dump, legacy_vtk, xml_vtk, collection, table };

Format format_by_bytes(const fs::path& file) {
  Input in(file);
  std::string head(in.look(4096));
  if (head.starts_with("\xEF\xBB\xBF")) head.erase(0, 3);
  const std::size_t first = head.find_first_not_of(" \t\r\n");
  if (first == std::string::npos) throw UserError(fmt::format("{}: is empty; let the program write it again", file.string()));
  if (head.compare(first, 5, "ITEM:") == 0) return Format::dump;
  if (head.starts_with("# vtk DataFile")) return Format::legacy_vtk;
  if (head.find("<VTKFile") != std::string::npos)
    return head.find("\"Collection\"") != std::string::npos ? Format::collection : Format::xml_vtk;
  if (head.starts_with("\x89HDF"))
    throw UserError(fmt::format("{}: is an HDF5 file; export the particles as text (EDEM: File > Export > Results Data), a dump, or VTK",
                                file.string()));
  if (head.find('\0') != std::string::npos)
    throw UserError(fmt::format(
        "{}: holds bytes that no format known here begins with; give dumps as text, tables, or VTK (docs/import.md)", file.string()));
  return Format::table;
}

struct Part {
  fs::path file;
  std::optional<double> time;
};

/// The last number of a name without its ending: drum_1804000.vtk.gz → 1804000, dump.500 → 500, at_0.05.csv → 0.05, run2.500.txt → 500.
std::optional<double> number_in_name(const fs::path& file) {
  constexpr std::string_view kDigits = "0123456789";
  fs::path plain = file.filename();
  if (plain.extension() == ".gz") plain = plain.stem();
  if (plain.extension().string().find_first_not_of(".0123456789") != std::string::npos) plain = plain.stem();
  const std::string name = plain.string();
  const std::size_t end = name.find_last_of(kDigits);
  if (end == std::string::npos) return std::nullopt;
  const auto start_of = [&](std::size_t last) {
    const std::size_t before = name.find_last_not_of(kDigits, last);
    return before == std::string::npos ? 0 : before + 1;
  };
  std::size_t begin = start_of(end);
  // With a decimal point only where the digits before it are a number of their own.
  if (begin >= 2 && name[begin - 1] == '.' && kDigits.find(name[begin - 2]) != std::string_view::npos) {
    const std::size_t whole = start_of(begin - 2);
    if (whole == 0 || std::isalnum(static_cast<unsigned char>(name[whole - 1])) == 0) begin = whole;
  }
  double number = 0;
  return parse_number(std::string_view(name).substr(begin, end + 1 - begin), number) ? std::optional(number) : std::nullopt;
}

std::optional<std::int64_t> step_in_name(const fs::path& file) {
  const std::optional<double> number = number_in_name(file);
  if (!number || *number != std::floor(*number) || *number > 9e15) return std::nullopt;
  return static_cast<std::int64_t>(*number);
}

std::vector<Part> parts_of(const fs::path& collection) {
  const std::string text = Input(collection).rest();
  pugi::xml_document document;
  const pugi::xml_parse_result result = document.load_buffer(text.data(), text.size());
  if (!result)
    throw UserError(
        fmt::format("{}: byte {}: {}; the file is damaged or cut short", collection.string(), result.offset, result.description()));
  std::vector<Part> parts;
  for (const pugi::xml_node set : document.child("VTKFile").child("Collection").children("DataSet")) {
    const std::string file = set.attribute("file").value(), time = set.attribute("timestep").value();
    Part part{collection.parent_path() / file, std::nullopt};
    double value = 0;
    if (parse_number(time, value)) part.time = value;
    if (!parts.empty() && part.time && parts.back().time == part.time)
      throw UserError(fmt::format("{}: lists '{}' and '{}' for one time, {}; name the files of the beads alone", collection.string(),
                                  parts.back().file.filename().string(), file, time));
    parts.push_back(std::move(part));
  }
  if (parts.empty()) throw UserError(fmt::format("{}: lists no file; name the files themselves", collection.string()));
  return parts;
}

class Series : public FrameStream {
 public:
  Series(std::vector<Part> parts, const ReadOptions& options) : parts_(std::move(parts)), options_(options) {}

  bool next(Frame& frame) override {
    for (; at_ < parts_.size(); ++at_, open_.reset()) {
      if (!open_) open_ = open_frames(parts_[at_].file, options_);
      if (!open_->next(frame)) continue;
      if (parts_[at_].time) frame.time = parts_[at_].time;
      if (!frame.step) frame.step = step_in_name(parts_[at_].file);
      return true;
    }
    return false;
  }

 private:
  std::vector<Part> parts_;
  ReadOptions options_;
  std::size_t at_ = 0;
  std::unique_ptr<FrameStream> open_;
};

}  // namespace

std::string Frame::place(std::size_t bead) const {
  return first_line > 0 ? fmt::format("{}:{}", file.string(), first_line + bead) : fmt::format("{}: point {}", file.string(), bead);
}

std::string format_of(const fs::path& file) {
  switch (format_by_bytes(file)) {
    case Format::dump:
      return "LIGGGHTS/LAMMPS dump";
    case Format::legacy_vtk:
      return "legacy VTK";
    case Format::xml_vtk:
      return "VTK XML";
    case Format::collection:
      return "collection of VTK XML (.pvd)";
    case Format::table:
      break;
  }
  return "table";
}

std::unique_ptr<FrameStream> open_frames(const fs::path& file, const ReadOptions& options) {
  switch (format_by_bytes(file)) {
    case Format::dump:
      return open_dump(file, options);
    case Format::legacy_vtk:
      return open_legacy_vtk(file, options);
    case Format::xml_vtk:
      return open_xml_vtk(file, options);
    case Format::collection:
      return std::make_unique<Series>(parts_of(file), options);
    case Format::table:
      break;
  }
  return open_table(file, options);
}

std::unique_ptr<FrameStream> read_frames(const std::vector<fs::path>& files, const ReadOptions& options) {
  std::vector<Part> parts;
  for (const fs::path& file : files) parts.push_back({file, std::nullopt});
  // dump.9 stands before dump.10; files without numbers stay as they were named.
  const bool numbered = std::all_of(files.begin(), files.end(), [](const fs::path& file) { return number_in_name(file).has_value(); });
  const auto earlier = [](const Part& a, const Part& b) { return *number_in_name(a.file) < *number_in_name(b.file); };
  if (numbered) std::stable_sort(parts.begin(), parts.end(), earlier);
  return std::make_unique<Series>(std::move(parts), options);
}

}  // namespace millscope::frames
