#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <fstream>

#include "kernel/base/error.hpp"
#include "kernel/output/file.hpp"
#include "kernel/output/vtk.hpp"

namespace millscope::output {

namespace {

constexpr std::array<std::pair<char, const char*>, 4> kEscapes{{{'&', "&amp;"}, {'<', "&lt;"}, {'>', "&gt;"}, {'"', "&quot;"}}};

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    const auto* found = std::find_if(kEscapes.begin(), kEscapes.end(), [c](const auto& e) { return e.first == c; });
    result += found == kEscapes.end() ? std::string(1, c) : found->second;
  }
  return result;
}

std::string unescaped(std::string text) {
  for (auto escape = kEscapes.rbegin(); escape != kEscapes.rend(); ++escape) {  // "&amp;" last
    const std::string from = escape->second;
    for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + 1))
      text.replace(at, from.size(), 1, escape->first);
  }
  return text;
}

// The value of `name="…"` in a line that `save` wrote; "" when there is none.
std::string attribute(const std::string& line, const std::string& name) {
  const std::size_t at = line.find(" " + name + "=\"");
  if (at == std::string::npos) return "";
  const std::size_t start = at + name.size() + 3;
  return unescaped(line.substr(start, line.find('"', start) - start));
}

}  // namespace

PictureSeries PictureSeries::create(const std::filesystem::path& path) {
  refuse_existing(path);
  return PictureSeries(path);
}

PictureSeries PictureSeries::resume(const std::filesystem::path& path, double time) {
  PictureSeries series(path);
  std::ifstream in(path);
  std::size_t found = 0;
  for (std::string line; std::getline(in, line);) {
    if (line.find("<DataSet ") == std::string::npos) continue;
    Entry entry{std::strtod(attribute(line, "timestep").c_str(), nullptr), attribute(line, "file"),
                std::atoi(attribute(line, "part").c_str())};
    if (entry.file.empty()) throw base::UserError(path.string() + ": was changed by another program; move it away and resume again");
    ++found;
    if (entry.time <= time) series.entries_.push_back(std::move(entry));
  }
  if (series.entries_.size() != found) series.save();
  return series;
}

void PictureSeries::add(double time, const std::string& file, int part) {
  entries_.push_back({time, file, part});
  save();
}

void PictureSeries::save() const {
  AtomicFile file(path_);
  file.write("<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n<Collection>\n");
  for (const Entry& entry : entries_) {
    file.write(fmt::format("<DataSet timestep=\"{}\" part=\"{}\" file=\"{}\"/>\n", entry.time, entry.part, escaped(entry.file)));
  }
  file.write("</Collection>\n</VTKFile>\n");
  file.commit();
}

}  // namespace millscope::output
