#include <fmt/format.h>

#include <algorithm>

#include "kernel/base/error.hpp"
#include "kernel/output/reading.hpp"
#include "studies/analysis/results_file.hpp"

namespace millscope::analysis {
namespace {

namespace fs = std::filesystem;
namespace hdf5 = output::hdf5;
using base::UserError;
using hdf5::Dataset;
using hdf5::Handle;

class Reader {
 public:
  Reader(const Handle& file, fs::path path) : file_(file), path_(std::move(path)) {}

  template <class T>
  std::vector<T> read(hid_t parent, const std::string& name, int rank) const {
    const Dataset set = hdf5::open_dataset(parent, name, rank, path_);
    return hdf5::read_rows<T>(set, rank == 0 ? 1 : set.extent[0], path_);
  }
  std::string text(const std::string& name) const {
    const Dataset set = hdf5::open_dataset(file_, name, 0, path_);
    const Handle type(H5Dget_type(set.id), H5Tclose);
    char* raw = nullptr;
    if (H5Tis_variable_str(type) <= 0 || H5Dread(set.id, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, &raw) < 0 || raw == nullptr)
      damaged("'" + name + "' is no text");
    std::string result = raw;
    H5free_memory(raw);
    return result;
  }
  Handle group(hid_t parent, const std::string& name) const {
    return hdf5::checked({H5Gopen2(parent, name.c_str(), H5P_DEFAULT), H5Gclose}, path_, "opening '" + name + "'");
  }
  std::vector<std::string> names(hid_t group) const {
    std::vector<std::string> all;
    const auto note = [](hid_t, const char* name, const H5L_info_t*, void* into) -> herr_t {
      static_cast<std::vector<std::string>*>(into)->emplace_back(name);
      return 0;
    };
    hdf5::check(H5Literate(group, H5_INDEX_NAME, H5_ITER_INC, nullptr, note, &all), path_, "listing a group");
    return all;
  }
  hid_t file() const { return file_; }
  [[noreturn]] void damaged(const std::string& what) const {
    throw UserError(fmt::format("{}: {}; it is damaged: write it again with 'millscope analyze'", path_.string(), what));
  }

 private:
  const Handle& file_;
  fs::path path_;
};

struct Numbered {
  std::uint32_t order;
  ResultArray array;
};

/// [draws, shape…]; empty where the group has none.
std::vector<float> read_draws(const Reader& reader, hid_t group, const ResultArray& a, std::uint32_t draws) {
  if (!hdf5::has(group, "draws")) return {};
  std::vector<hsize_t> wanted{draws};
  wanted.insert(wanted.end(), a.shape.begin(), a.shape.end());
  const Dataset set = hdf5::open_dataset(group, "draws", static_cast<int>(wanted.size()), a.analyzer + "." + a.name);
  if (draws < 2 || !std::equal(wanted.begin(), wanted.end(), set.extent.begin(), set.extent.end())) {
    reader.damaged(fmt::format("'{}.{}' has draws of the shape {}, {} are needed (and at least 2 draws)", a.analyzer, a.name,
                               fmt::join(set.extent, " × "), fmt::join(wanted, " × ")));
  }
  return reader.read<float>(group, "draws", static_cast<int>(wanted.size()));
}

/// Every axis is a result of the same analyzer, with the dimension's length or one more; no result is there twice or empty.
void check_axes(const Reader& reader, const ResultSet& results) {
  for (const ResultArray& a : results.arrays) {
    if (a.size() == 0) reader.damaged(fmt::format("'{}.{}' holds no value", a.analyzer, a.name));
    for (std::size_t d = 0; d < a.shape.size(); ++d) {
      if (a.axes[d].empty()) continue;
      const ResultArray* const axis = results.axis(a, d);
      if (axis == nullptr || !axis->is_axis || axis->shape.size() != 1 || (axis->size() != a.shape[d] && axis->size() != a.shape[d] + 1))
        reader.damaged(fmt::format("'{}.{}' has the axis '{}', which is no axis of that length", a.analyzer, a.name, a.axes[d]));
    }
  }
}

Numbered read_array(const Reader& reader, hid_t parent, const std::string& analyzer, const std::string& name, std::uint32_t draws) {
  const Handle group = reader.group(parent, name);
  ResultArray a;
  a.analyzer = analyzer;
  a.name = name;
  a.unit = hdf5::get_text_attribute(group, "unit");
  a.doc = hdf5::get_text_attribute(group, "doc");
  a.axes = hdf5::get_texts(group, "axes");
  a.is_axis = hdf5::get_attribute(group, "is_axis", 0) != 0;
  a.traits = hdf5::get_attribute(group, "traits", 0);
  const int rank = static_cast<int>(a.axes.size());
  const Dataset value = hdf5::open_dataset(group, "value", rank, name);
  a.shape.assign(value.extent.begin(), value.extent.end());
  a.value = reader.read<double>(group, "value", rank);
  const std::uint32_t order = hdf5::get_attribute(group, "order", 0);
  if (a.is_axis) return {order, std::move(a)};
  a.sem = reader.read<double>(group, "sem", rank);
  a.low = reader.read<double>(group, "low", rank);
  a.high = reader.read<double>(group, "high", rank);
  a.effective_blocks = reader.read<double>(group, "effective_blocks", rank);
  a.flags = reader.read<std::uint8_t>(group, "flags", rank);
  for (const std::size_t size : {a.sem.size(), a.low.size(), a.high.size(), a.effective_blocks.size(), a.flags.size()}) {
    if (size != a.size()) reader.damaged(fmt::format("'{}.{}' has arrays of different lengths", analyzer, name));
  }
  a.draws = read_draws(reader, group, a, draws);
  return {order, std::move(a)};
}

void read_blocks(const Reader& reader, ResultMeta& meta) {
  const Handle group = reader.group(reader.file(), "blocks");
  const auto start = reader.read<double>(group, "start", 1), end = reader.read<double>(group, "end", 1),
             duration = reader.read<double>(group, "duration", 1);
  const auto stretch = reader.read<std::uint32_t>(group, "stretch", 1);
  if (end.size() != start.size() || duration.size() != start.size() || stretch.size() != start.size())
    reader.damaged("'blocks' does not fit together");
  for (std::size_t i = 0; i < start.size(); ++i) meta.blocks.push_back({start[i], end[i], duration[i], stretch[i]});
}

void read_covariance(const Reader& reader, ResultSet& results) {
  const Handle group = reader.group(reader.file(), "covariance");
  const auto array = reader.read<std::uint32_t>(group, "array", 1), element = reader.read<std::uint32_t>(group, "element", 1);
  results.covariance = reader.read<double>(group, "matrix", 2);
  results.covariance_rank = hdf5::get_attribute(group, "rank", 0);
  if (element.size() != array.size() || results.covariance.size() != array.size() * array.size())
    reader.damaged("'covariance' does not fit together");
  for (std::size_t i = 0; i < array.size(); ++i) {
    if (array[i] >= results.arrays.size() || element[i] >= results.arrays[array[i]].size())
      reader.damaged("'covariance' names a result that is not there");
    results.covariance_entries.push_back({array[i], element[i]});
  }
}

}  // namespace

ResultSet read_results(const fs::path& file_or_directory) {
  const fs::path file = fs::is_directory(file_or_directory) ? file_or_directory / "results.h5" : file_or_directory;
  const Handle opened = hdf5::open_for_reading(file, "give a directory that 'millscope analyze … -o OUT' wrote, or its results.h5");
  hdf5::require_schema(opened, file, kResultsFormat, kResultsSchema);
  const Reader reader(opened, file);
  ResultSet results;
  try {
    read_meta_json(nlohmann::ordered_json::parse(reader.text("meta")), results.meta);
  } catch (const nlohmann::json::exception& e) {
    reader.damaged(fmt::format("'meta' is not what it should be ({})", e.what()));
  }
  read_blocks(reader, results.meta);
  std::vector<Numbered> arrays;
  const Handle analyzers = reader.group(opened, "analyzers");
  for (const std::string& analyzer : reader.names(analyzers)) {
    const Handle group = reader.group(analyzers, analyzer);
    for (const std::string& name : reader.names(group)) arrays.push_back(read_array(reader, group, analyzer, name, results.meta.draws));
  }
  std::sort(arrays.begin(), arrays.end(), [](const Numbered& a, const Numbered& b) { return a.order < b.order; });
  for (Numbered& n : arrays) results.arrays.push_back(std::move(n.array));
  check_axes(reader, results);
  read_covariance(reader, results);
  return results;
}

}  // namespace millscope::analysis
