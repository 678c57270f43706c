#include "geometry/import/cad_file.hpp"

#include <dlfcn.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "millscope/parameters.hpp"

namespace millscope::geometry {

namespace {

/// Stands beside the folder of the plugins, in a build and in an installation.
std::string program() {
  Dl_info here{};
  if (::dladdr(reinterpret_cast<const void*>(&cad_limits), &here) == 0) return {};
  const auto path = std::filesystem::absolute(here.dli_fname).parent_path().parent_path() / "read_cad";
  return path.string();
}

void check_extension(const std::string& extension) {
  if (!extension.empty() && ("|" + std::string(kCadExtensions) + "|").find("|" + extension + "|") != std::string::npos) return;
  throw Refusal("'." + extension + "' is no CAD format that is read here: use step, stp, iges or igs; for triangles (STL, OBJ, …) write " +
                "'kind: mesh'");
}

/// No program is started from where others can write: the rule of the plugins' loader (kernel/host).
void require_private(const std::string& path) {
  struct stat info {};
  for (const std::string& place : {path, std::filesystem::path(path).parent_path().string()}) {
    if (::stat(place.c_str(), &info) == 0 && (info.st_mode & (S_IWGRP | S_IWOTH)) != 0)
      throw Refusal("is not read, because others can write to " + place + ", from where its reader would be started: chmod go-w " + place);
  }
}

/// Of the child: becomes the program, whose answer goes into the pipe.
[[noreturn]] void become(const std::string& path, std::array<std::string, 7> words, int pipe) {
  if (::fcntl(pipe, F_SETFD, 0) != 0) throw Refusal(std::string("no pipe to the reader: ") + std::strerror(errno));
  std::array<char*, 8> pointers{};
  for (std::size_t i = 0; i < words.size(); ++i) pointers[i] = words[i].data();
  ::execv(path.c_str(), pointers.data());
  throw Refusal("its reader " + path + " cannot be started (" + std::strerror(errno) + "): install millscope's STEP plugin again");
}

}  // namespace

ImportLimits cad_limits(std::size_t max_triangles) {
  ImportLimits limits;
  limits.max_triangles = max_triangles;
  limits.base_seconds = 60, limits.seconds_per_megabyte = 15;  // 1 to 3 s a megabyte were seen
  limits.base_bytes = std::size_t{2} << 30;
  limits.bytes_per_byte = 400;
  return limits;
}

Soup import_cad(const std::string& path, const ImportLimits& limits, const Tessellation& tessellation) {
  try {
    const auto read = [&](int pipe) {
      check_extension(lower_extension(path));
      const std::string reader = program();
      require_private(reader);
      become(reader,
             {reader, path, std::to_string(1e3 * tessellation.chord), std::to_string(tessellation.angle),
              tessellation.by_colour ? "colour" : "name", std::to_string(limits.max_triangles), std::to_string(pipe)},
             pipe);
    };
    return read_guarded(path, limits, read);
  } catch (const std::exception& e) {
    throw Refusal("CAD file " + path + ": " + e.what());
  }
}

}  // namespace millscope::geometry
