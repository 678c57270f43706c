#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>

#include "kernel/output/file.hpp"
#include "kernel/output/hdf5_tools.hpp"
#include "studies/analysis/results_file.hpp"

namespace millscope::analysis {
namespace {

namespace fs = std::filesystem;
namespace hdf5 = output::hdf5;
using hdf5::Handle;

/// Datasets of one file; any failure is a UserError naming it.
class Writer {
 public:
  Writer(hid_t file, fs::path path) : file_(file), path_(std::move(path)) {}

  Handle group(hid_t parent, const std::string& name) const {
    return hdf5::checked({H5Gcreate2(parent, name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose}, path_,
                         "creating '" + name + "'");
  }
  /// [shape…] of T; compressed where that pays.
  template <class T>
  Handle write(hid_t parent, const std::string& name, const std::vector<hsize_t>& shape, const std::vector<T>& values) const {
    const Handle space(shape.empty() ? H5Screate(H5S_SCALAR) : H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr),
                       H5Sclose);
    const Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    if (values.size() > 4096 && !shape.empty()) {
      std::vector<hsize_t> chunk = shape;
      hsize_t rest = 1;
      for (std::size_t axis = 1; axis < shape.size(); ++axis) rest *= shape[axis];
      chunk[0] = std::clamp<hsize_t>((hsize_t{1} << 18U) / std::max<hsize_t>(1, rest), 1, shape[0]);
      H5Pset_chunk(creation, static_cast<int>(chunk.size()), chunk.data());
      H5Pset_shuffle(creation);
      H5Pset_deflate(creation, 2);
    }
    Handle set = hdf5::checked({H5Dcreate2(parent, name.c_str(), hdf5::type_of<T>(), space, H5P_DEFAULT, creation, H5P_DEFAULT), H5Dclose},
                               path_, "creating '" + name + "'");
    hdf5::check(H5Dwrite(set, hdf5::type_of<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), path_, "writing '" + name + "'");
    return set;
  }
  hid_t file() const { return file_; }

 private:
  hid_t file_;
  fs::path path_;
};

std::vector<hsize_t> extent(const ResultArray& a) { return {a.shape.begin(), a.shape.end()}; }

void write_array(const Writer& writer, hid_t parent, const ResultArray& a, std::uint32_t order, std::uint32_t draws) {
  const Handle group = writer.group(parent, a.name);
  hdf5::set_attribute(group, "unit", a.unit);
  hdf5::set_attribute(group, "doc", a.doc);
  hdf5::set_attribute(group, "order", order);
  hdf5::set_attribute(group, "is_axis", std::uint32_t{a.is_axis ? 1U : 0U});
  hdf5::set_attribute(group, "traits", a.traits);
  if (!a.axes.empty()) hdf5::set_attribute(group, "axes", a.axes);
  const std::vector<hsize_t> shape = extent(a);
  writer.write(group, "value", shape, a.value);
  if (a.is_axis) return;
  writer.write(group, "sem", shape, a.sem);
  writer.write(group, "low", shape, a.low);
  writer.write(group, "high", shape, a.high);
  writer.write(group, "effective_blocks", shape, a.effective_blocks);
  writer.write(group, "flags", shape, a.flags);
  if (a.draws.empty()) return;
  std::vector<hsize_t> drawn{draws};
  drawn.insert(drawn.end(), shape.begin(), shape.end());
  writer.write(group, "draws", drawn, a.draws);
}

void write_blocks(const Writer& writer, const std::vector<ResultBlock>& blocks) {
  const Handle group = writer.group(writer.file(), "blocks");
  std::vector<double> start, end, duration;
  std::vector<std::uint32_t> stretch;
  for (const ResultBlock& b : blocks) {
    start.push_back(b.start);
    end.push_back(b.end);
    duration.push_back(b.duration);
    stretch.push_back(b.stretch);
  }
  const std::vector<hsize_t> shape{blocks.size()};
  const std::string seconds = "s";
  hdf5::set_attribute(writer.write(group, "start", shape, start), "unit", seconds);
  hdf5::set_attribute(writer.write(group, "end", shape, end), "unit", seconds);
  hdf5::set_attribute(writer.write(group, "duration", shape, duration), "unit", seconds);
  writer.write(group, "stretch", shape, stretch);
}

void write_covariance(const Writer& writer, const ResultSet& results) {
  const Handle group = writer.group(writer.file(), "covariance");
  const hsize_t size = results.covariance_entries.size();
  std::vector<std::uint32_t> array, element;
  std::vector<std::string> names;
  for (const CovarianceEntry& entry : results.covariance_entries) {
    array.push_back(entry.array);
    element.push_back(entry.element);
    names.push_back(entry_name(results, entry));
  }
  hdf5::set_attribute(group, "rank", results.covariance_rank);
  hdf5::set_attribute(group, "names", names);
  writer.write(group, "array", {size}, array);
  writer.write(group, "element", {size}, element);
  writer.write(group, "matrix", {size, size}, results.covariance);
}

void write_text(const Writer& writer, const std::string& name, const std::string& text) {
  const Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type, H5T_VARIABLE);
  H5Tset_cset(type, H5T_CSET_UTF8);
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Handle set(H5Dcreate2(writer.file(), name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Dclose);
  const char* raw = text.c_str();
  H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, &raw);
}

void write_all(const Writer& writer, const ResultSet& results) {
  hdf5::stamp_schema(writer.file(), kResultsFormat, kResultsSchema);
  hdf5::set_attribute(writer.file(), "description", results.meta.description);
  using Json = nlohmann::ordered_json;
  write_text(writer, "meta", meta_json(results.meta).dump(2, ' ', false, Json::error_handler_t::replace));
  write_blocks(writer, results.meta.blocks);
  const Handle analyzers = writer.group(writer.file(), "analyzers");
  std::string name;
  Handle group;
  for (std::size_t i = 0; i < results.arrays.size(); ++i) {
    const ResultArray& a = results.arrays[i];
    if (a.analyzer != name) group = writer.group(analyzers, a.analyzer);
    name = a.analyzer;
    write_array(writer, group, a, static_cast<std::uint32_t>(i), results.meta.draws);
  }
  write_covariance(writer, results);
}

}  // namespace

void write_results(const fs::path& file, const ResultSet& results, bool overwrite) {
  hdf5::prepare();
  if (!overwrite) output::refuse_existing(file);
  const fs::path temporary = output::temporary_name(file);
  output::require_space(file, 0);
  try {
    const Handle list(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
    H5Pset_libver_bounds(list, H5F_LIBVER_LATEST, H5F_LIBVER_LATEST);
    Handle opened = hdf5::checked({H5Fcreate(temporary.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, list), H5Fclose}, file, "creating the file");
    write_all(Writer(opened, file), results);
    hdf5::check(H5Fflush(opened, H5F_SCOPE_GLOBAL), file, "writing");
    if (!opened.close()) hdf5::fail(file, "closing the file");
    output::publish(temporary, file);
  } catch (...) {
    ::unlink(temporary.c_str());
    throw;
  }
}

}  // namespace millscope::analysis
