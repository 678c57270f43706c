#include "kernel/output/hdf5_tools.hpp"

#include <fmt/format.h>

#include <cstdlib>

#include "kernel/base/error.hpp"
#include "kernel/base/program.hpp"
#include "kernel/output/file.hpp"

namespace millscope::output::hdf5 {

namespace {

herr_t note_fault(unsigned, const H5E_error2_t* entry, void* into) {
  auto& fault = *static_cast<Fault*>(into);
  if (entry->desc == nullptr) return 0;
  if (fault.text.empty()) fault.text = entry->desc;
  const std::string text = entry->desc;
  const std::size_t at = text.find("errno = ");
  if (at != std::string::npos && fault.error == 0) fault.error = std::atoi(text.c_str() + at + 8);
  return 0;
}

void write_attribute(hid_t object, const char* name, hid_t type, hid_t space, const void* value) {
  const Handle attribute(H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  if (attribute.valid()) H5Awrite(attribute, type, value);
}

}  // namespace

Handle text_type() {
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type, H5T_VARIABLE);
  H5Tset_cset(type, H5T_CSET_UTF8);
  return type;
}

void prepare() {
  // After a full disk HDF5 would try at exit to write what it still holds, and complain about it.
  static const bool once = H5dont_atexit() >= 0;
  static_cast<void>(once);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

Fault last_fault() {
  Fault fault;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, note_fault, &fault);
  return fault;
}

void fail(const std::filesystem::path& file, const std::string& doing) {
  const Fault fault = last_fault();
  if (fault.error != 0) throw_write_error(file, fault.error);
  throw base::UserError(fmt::format("{}: {} failed ({}); the file may be damaged or in use: move it away and try again", file.string(),
                                    doing, fault.text.empty() ? "HDF5 gives no reason" : fault.text),
                        kExitDisk);
}

Handle checked(Handle handle, const std::filesystem::path& file, const std::string& doing) {
  if (!handle.valid()) fail(file, doing);
  return handle;
}

void check(herr_t status, const std::filesystem::path& file, const std::string& doing) {
  if (status < 0) fail(file, doing);
}

void set_attribute(hid_t object, const char* name, std::uint32_t value) {
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  write_attribute(object, name, H5T_STD_U32LE, space, &value);
}

void set_attribute(hid_t object, const char* name, double value) {
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  write_attribute(object, name, H5T_IEEE_F64LE, space, &value);
}

void set_attribute(hid_t object, const char* name, const std::string& value) {
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const char* text = value.c_str();
  write_attribute(object, name, text_type(), space, &text);
}

void set_attribute(hid_t object, const char* name, const std::vector<std::string>& values) {
  const hsize_t count = values.size();
  const Handle space(count > 0 ? H5Screate_simple(1, &count, nullptr) : H5Screate(H5S_NULL), H5Sclose);
  std::vector<const char*> texts;
  for (const std::string& value : values) texts.push_back(value.c_str());
  write_attribute(object, name, text_type(), space, texts.data());
}

std::uint32_t get_attribute(hid_t object, const char* name, std::uint32_t missing) {
  if (H5Aexists(object, name) <= 0) return missing;
  const Handle attribute(H5Aopen(object, name, H5P_DEFAULT), H5Aclose);
  std::uint32_t value = missing;
  return H5Aread(attribute, H5T_STD_U32LE, &value) < 0 ? missing : value;
}

std::string get_text_attribute(hid_t object, const char* name) {
  if (H5Aexists(object, name) <= 0) return "";
  const Handle attribute(H5Aopen(object, name, H5P_DEFAULT), H5Aclose);
  char* text = nullptr;
  if (H5Aread(attribute, text_type(), &text) < 0 || text == nullptr) return "";
  std::string result = text;
  H5free_memory(text);
  return result;
}

void stamp_schema(hid_t file, const std::string& format, std::uint32_t schema_version) {
  set_attribute(file, "format", format);
  set_attribute(file, "schema_version", schema_version);
  set_attribute(file, "created_by", "millscope " + base::version_and_commit());
}

void require_schema(hid_t file, const std::filesystem::path& path, const std::string& format, std::uint32_t schema_version) {
  const std::string found = get_text_attribute(file, "format");
  if (found != format) {
    throw base::UserError(
        fmt::format("{}: its attribute 'format' is '{}', not '{}'; give a file that millscope wrote", path.string(), found, format));
  }
  const std::uint32_t version = get_attribute(file, "schema_version", 0);
  if (version == schema_version) return;
  throw base::UserError(fmt::format("{}: its schema_version is {}, this millscope reads {}; use the {} millscope ({})", path.string(),
                                    version, schema_version, version > schema_version ? "newer" : "older",
                                    get_text_attribute(file, "created_by")));
}

}  // namespace millscope::output::hdf5
