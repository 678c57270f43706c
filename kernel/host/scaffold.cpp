#include "kernel/host/scaffold.hpp"

#include <fmt/core.h>

#include <filesystem>
#include <fstream>
#include <utility>

#include "kernel/base/text.hpp"
#include "kernel/host/registry.hpp"

namespace millscope::host {

namespace fs = std::filesystem;

namespace {

void check_name(std::string_view name) {
  bool fine = !name.empty() && name.size() <= 48 && name.front() >= 'a' && name.front() <= 'z';
  for (const char c : name) fine = fine && ((c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_');
  if (!fine) {
    throw UserError(fmt::format("plugin name '{}': only a to z, 0 to 9 and _, beginning with a letter, at most 48, e.g. my_law", name));
  }
}

void replace_all(std::string& where, std::string_view what, std::string_view with) {
  for (std::size_t at = where.find(what); at != std::string::npos; at = where.find(what, at + with.size())) {
    where.replace(at, what.size(), with);
  }
}

/// my_law → MyLaw
std::string class_name(std::string_view name) {
  std::string result;
  bool upper = true;
  for (const char c : name) {
    if (c == '_') {
      upper = true;
      continue;
    }
    result += upper && c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
    upper = false;
  }
  return result;
}

std::string filled(std::string line, Kind kind, std::string_view name) {
  replace_all(line, "@NAME@", name);
  replace_all(line, "@CLASS@", class_name(name));
  replace_all(line, "@KIND@", text(kind));
  replace_all(line, "@VERSION@", MILLSCOPE_VERSION);
  replace_all(line, "@WIDE@", kind == Kind::contact_law || kind == Kind::interaction || kind == Kind::pair_parameter ? " WIDE" : "");
  return line;
}

void write_filled(const fs::path& source, const fs::path& target, Kind kind, std::string_view name) {
  const std::string text = filled(base::text_of(source), kind, name);
  std::ofstream out(target, std::ios::binary);
  out << text;
  out.flush();
  if (!out) throw UserError(fmt::format("'{}' cannot be written; check the permissions and the space on the disk", target.string()));
}

/// Copies a template folder's files; NAME in a file's name becomes the plugin's.
void copy_folder(const fs::path& source, const fs::path& target, Kind kind, std::string_view name) {
  for (const fs::directory_entry& entry : fs::directory_iterator(source)) {
    std::string file = entry.path().filename().string();
    if (!entry.is_regular_file() || !file.ends_with(".in")) continue;
    file.resize(file.size() - 3);
    replace_all(file, "NAME", name);
    write_filled(entry.path(), target / file, kind, name);
  }
}

}  // namespace

std::string template_directory() {
  std::error_code trouble;
  const fs::path prefix = fs::read_symlink("/proc/self/exe", trouble).parent_path().parent_path();
  for (const fs::path& candidate : {prefix / MILLSCOPE_DATADIR / "millscope" / "template", fs::path(MILLSCOPE_SOURCE_TEMPLATE)}) {
    if (fs::is_directory(candidate, trouble)) return candidate.string();
  }
  throw UserError(fmt::format("the plugin template is missing: neither {} nor {} exists; install millscope again",
                              (prefix / MILLSCOPE_DATADIR / "millscope" / "template").string(), MILLSCOPE_SOURCE_TEMPLATE));
}

std::string scaffold(Kind kind, std::string_view name, const std::string& parent) {
  check_name(name);
  const fs::path templates = template_directory();
  if (!fs::is_directory(templates / text(kind))) {
    throw UserError(fmt::format("the template of a {} is missing in {}; install millscope again", text(kind), templates.string()));
  }
  std::error_code trouble;
  const fs::path target = fs::absolute(fs::path(parent) / name);
  if (fs::exists(fs::symlink_status(target, trouble))) {
    throw UserError(fmt::format("'{}' exists already; nothing was written; choose another name or remove it", target.string()));
  }
  if (!fs::create_directories(target, trouble)) {
    throw UserError(fmt::format("'{}' cannot be created: {}", target.string(), trouble.message()));
  }
  try {
    copy_folder(templates / "common", target, kind, name);
    copy_folder(templates / text(kind), target, kind, name);
  } catch (...) {
    fs::remove_all(target, trouble);
    throw;
  }
  return target.string();
}

}  // namespace millscope::host
