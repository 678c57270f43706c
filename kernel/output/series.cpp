#include "kernel/output/series.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string_view>

#include "kernel/base/error.hpp"
#include "kernel/base/text.hpp"
#include "kernel/output/file.hpp"

namespace millscope::output {

namespace fs = std::filesystem;
using base::UserError;

namespace {

constexpr std::size_t kTableBufferBytes = 64 * 1024;

std::string header(std::span<const std::string> columns) { return fmt::format("{}\n", fmt::join(columns, ",")); }

std::vector<std::string_view> cells_of(std::string_view line) {
  std::vector<std::string_view> cells;
  for (std::size_t from = 0; from <= line.size();) {
    const std::size_t to = std::min(line.find(',', from), line.size());
    cells.push_back(line.substr(from, to - from));
    from = to + 1;
  }
  return cells;
}

double number_of(std::string_view cell) {
  const char* const end = cell.data() + cell.size();
  double value = 0;
  const auto [stopped, error] = std::from_chars(cell.data(), end, value);
  return error == std::errc() && stopped == end ? value : std::nan("");
}

// Bytes of the file that are kept: the header and all complete rows up to `time`.
std::uint64_t kept_bytes(const fs::path& path, const std::string& head, double time) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw UserError(fmt::format("{}: is missing, the run cannot be continued; put it back or start the run again", path.string()));
  std::string line;
  std::getline(in, line);
  if (line + "\n" != head) {
    throw UserError(fmt::format("{}: its columns are not those of this run; move it away or use another -o", path.string()));
  }
  std::uint64_t kept = head.size();
  while (std::getline(in, line) && !in.eof() && std::strtod(line.c_str(), nullptr) <= time) kept += line.size() + 1;
  return kept;
}

}  // namespace

struct SeriesWriter::Impl {
  File file;
  std::size_t columns;
  std::string buffer{};

  void write_through() {
    file.write(buffer);
    buffer.clear();
  }
};

SeriesWriter::SeriesWriter(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
SeriesWriter::SeriesWriter(SeriesWriter&&) noexcept = default;
SeriesWriter& SeriesWriter::operator=(SeriesWriter&&) noexcept = default;

SeriesWriter::~SeriesWriter() {
  if (!impl_) return;
  try {
    impl_->write_through();
  } catch (const std::exception&) {
    // A destructor cannot report; `flush` and `close` do.
  }
}

SeriesWriter SeriesWriter::create(const fs::path& path, std::span<const std::string> columns) {
  refuse_existing(path);
  SeriesWriter writer(std::unique_ptr<Impl>(new Impl{File(path, O_WRONLY | O_CREAT | O_EXCL), columns.size()}));
  writer.impl_->file.write(header(columns));
  return writer;
}

SeriesWriter SeriesWriter::resume(const fs::path& path, std::span<const std::string> columns, double time) {
  const std::uint64_t kept = kept_bytes(path, header(columns), time);
  SeriesWriter writer(std::unique_ptr<Impl>(new Impl{File(path, O_WRONLY), columns.size()}));
  writer.impl_->file.truncate(kept);
  ::lseek(writer.impl_->file.descriptor(), 0, SEEK_END);
  return writer;
}

void SeriesWriter::append(std::span<const double> values) {
  if (values.size() != impl_->columns) throw std::logic_error("SeriesWriter: a row needs one value per column");
  // "{}" is the shortest text that reads back to the same double.
  fmt::format_to(std::back_inserter(impl_->buffer), "{}\n", fmt::join(values, ","));
  if (impl_->buffer.size() >= kTableBufferBytes) impl_->write_through();
}

void SeriesWriter::flush() {
  impl_->write_through();
  impl_->file.sync();
}

void SeriesWriter::close() {
  if (!impl_) return;
  flush();
  impl_->file.close();
  impl_.reset();
}

const std::vector<double>& Series::column(const std::string& name) const {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) throw UserError(fmt::format("series.csv has no column '{}', but {}", name, fmt::join(names, ", ")));
  return columns[found - names.begin()];
}

Series read_series(const fs::path& path) {
  const std::string text = base::text_of(path);
  Series series;
  std::size_t from = 0;
  for (std::size_t to = text.find('\n'); to != std::string::npos; from = to + 1, to = text.find('\n', from)) {
    const std::vector<std::string_view> cells = cells_of(std::string_view(text).substr(from, to - from));
    if (series.names.empty()) {
      series.names.assign(cells.begin(), cells.end());
      series.columns.resize(cells.size());
      continue;
    }
    if (cells.size() != series.names.size())
      throw UserError(fmt::format("{}: a row of {} numbers where the first line has {} names; the file is damaged", path.string(),
                                  cells.size(), series.names.size()));
    for (std::size_t c = 0; c < cells.size(); ++c) series.columns[c].push_back(number_of(cells[c]));
  }
  return series;
}

}  // namespace millscope::output
