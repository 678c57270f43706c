// Opening a plugin library in its own test, without millscope.
#pragma once

#include <dlfcn.h>

#include <cstdio>
#include <cstring>
#include <string>

#include "millscope/conformance/values.hpp"

namespace millscope::conformance {

/// What a library file lists; it stays open. Throws Refusal when there is no such library, or when it was built against another SDK.
inline const DescriptorList& open_library(const std::string& path) {
  void* handle = ::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (handle == nullptr) throw Refusal(::dlerror());
  const auto* list = static_cast<const DescriptorList*>(::dlsym(handle, "millscope_plugins"));
  if (list == nullptr) throw Refusal(path + " has no symbol millscope_plugins");
  if (list->magic != kMagic || list->abi_version != kAbiVersion) throw Refusal(path + " was built against another SDK");
  return *list;
}

/// The descriptor of that name in a library file. Throws Refusal as `open_library` does, and when the name is not there.
inline const Descriptor& open_plugin(const std::string& path, std::string_view name) {
  const DescriptorList& list = open_library(path);
  for (std::uint64_t i = 0; i < list.count; ++i) {
    if (name == list.items[i]->name) return *list.items[i];
  }
  throw Refusal(path + " has no plugin called '" + std::string(name) + "'");
}

/// The build of a plugin (v4, v3 or v2 of its directory, or the directory itself) that this machine runs best.
inline std::string best_build(const std::string& directory, const std::string& library) {
  __builtin_cpu_init();
  const auto build_in = [&](const char* folder) { return directory + folder + "/lib" + library + ".so"; };
  const auto exists = [](const std::string& path) {
    std::FILE* file = std::fopen(path.c_str(), "rb");
    if (file != nullptr) std::fclose(file);
    return file != nullptr;
  };
  if (__builtin_cpu_supports("x86-64-v4") && exists(build_in("/v4"))) return build_in("/v4");
  if (__builtin_cpu_supports("x86-64-v3") && exists(build_in("/v3"))) return build_in("/v3");
  return exists(build_in("/v2")) ? build_in("/v2") : build_in("");
}

/// Prints what is violated; the exit code of a test program.
inline int report(const char* what, const Violations& violations) {
  for (const Violation& v : violations) std::printf("%s: %s: %s\n", what, v.check.c_str(), v.message.c_str());
  std::printf("%s: %zu violations\n", what, violations.size());
  return violations.empty() ? 0 : 1;
}

}  // namespace millscope::conformance
