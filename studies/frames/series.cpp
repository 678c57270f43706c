// One file or many, of whatever format, as one stream of frames.
#include <fmt/format.h>

#include <pugixml.hpp>

#include "kernel/base/error.hpp"
#include "studies/frames/dump.hpp"
#include "studies/frames/file_names.hpp"
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

/// A part of a .pvd, which lies in its folder or below.
fs::path listed(const fs::path& collection, const fs::path& name) {
  const fs::path plain = name.lexically_normal();
  if (name.is_absolute() || (!plain.empty() && *plain.begin() == ".."))
    throw UserError(fmt::format("{}: lists '{}', which is not in its folder; put the files there, or name them in 'files'",
                                collection.string(), name.string()));
  return collection.parent_path() / name;
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
    Part part{listed(collection, file), std::nullopt};
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

std::unique_ptr<FrameStream> open_as(Format format, const fs::path& file, const ReadOptions& options);

class Series : public FrameStream {
 public:
  /// `collection`: that lists the parts; empty: mill.yaml does.
  Series(std::vector<Part> parts, const ReadOptions& options, fs::path collection = {})
      : parts_(std::move(parts)), options_(options), collection_(std::move(collection)) {}

  bool next(Frame& frame) override {
    for (; at_ < parts_.size(); ++at_, open_.reset()) {
      if (!open_) open_ = open_part(parts_[at_].file);
      if (!open_->next(frame)) continue;
      if (parts_[at_].time) frame.time = parts_[at_].time, frame.time_of_picture = true;
      if (!frame.step) frame.step = step_in_name(parts_[at_].file);
      return true;
    }
    return false;
  }

 private:
  std::unique_ptr<FrameStream> open_part(const fs::path& file) const {
    const Format format = format_by_bytes(file);
    if (!collection_.empty() && format == Format::collection)
      throw UserError(fmt::format("{}: lists '{}', which is a list itself; list the files of the beads", collection_.string(),
                                  file.filename().string()));
    return open_as(format, file, options_);
  }

  std::vector<Part> parts_;
  ReadOptions options_;
  fs::path collection_;
  std::size_t at_ = 0;
  std::unique_ptr<FrameStream> open_;
};

std::unique_ptr<FrameStream> open_as(Format format, const fs::path& file, const ReadOptions& options) {
  switch (format) {
    case Format::dump:
      return open_dump(file, options);
    case Format::legacy_vtk:
      return open_legacy_vtk(file, options);
    case Format::xml_vtk:
      return open_xml_vtk(file, options);
    case Format::collection:
      return std::make_unique<Series>(parts_of(file), options, file);
    case Format::table:
      break;
  }
  return open_table(file, options);
}

}  // namespace

int TypeWords::number(std::string_view word) {
  const auto found = numbers_.find(word);
  if (found != numbers_.end()) return found->second;
  words_.emplace_back(word);
  return numbers_.emplace(word, static_cast<int>(words_.size())).first->second;
}

std::string TypeWords::word(long long number) const {
  return number >= 1 && number <= static_cast<long long>(words_.size()) ? words_[static_cast<std::size_t>(number) - 1] : "";
}

void Frame::begin(const fs::path& from) {
  file = from;
  first_line = 0;
  time.reset(), step.reset();
  time_of_picture = spin_without_unit = false;
  clear();
}

void Frame::clear() {
  for (std::vector<double>& values : value) values.clear();
  count = 0;
  passed_over.clear();
}

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
  return open_as(format_by_bytes(file), file, options);
}

std::unique_ptr<FrameStream> read_frames(const std::vector<fs::path>& files, const ReadOptions& options) {
  std::vector<Part> parts;
  for (const fs::path& file : in_order(files)) parts.push_back({file, std::nullopt});
  return std::make_unique<Series>(std::move(parts), options);
}

}  // namespace millscope::frames
