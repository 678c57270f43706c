#include "kernel/host/library.hpp"

#include <dlfcn.h>
#include <elf.h>
#include <fmt/core.h>
#include <link.h>

#include <boost/dll/shared_library.hpp>
#include <filesystem>
#include <utility>

#include "kernel/base/error.hpp"
#include "kernel/base/hash.hpp"
#include "kernel/base/text.hpp"
#include "kernel/host/descriptor_check.hpp"
#include "kernel/host/directory_check.hpp"
#include "kernel/host/library_code.hpp"

namespace millscope::host {

namespace {

constexpr const char* kSymbol = "millscope_plugins";

[[noreturn]] void refuse(const std::string& path, const std::string& what) {
  throw base::UserError(fmt::format("plugin library '{}' is not loaded: {}", path, what));
}

/// The bytes of a file; refuses what is no shared library before the system's loader sees it.
std::string read_library(const std::string& path) {
  std::optional<std::string> bytes = base::text_if_readable(path);
  if (!bytes) refuse(path, "it cannot be read");
  if (bytes->size() < sizeof(ElfW(Ehdr)) || !bytes->starts_with(ELFMAG)) refuse(path, "it is not a shared library (no ELF file)");
  return *std::move(bytes);
}

/// Over the builds for all instruction sets, whichever of them this machine takes, as their results are the same, and over the libraries
/// that the one that was loaded needs.
std::string code_hash_of(const std::filesystem::path& path, const std::string& level, const std::string& loaded) {
  const std::filesystem::path folder = level.empty() ? path.parent_path() : path.parent_path().parent_path();
  base::Hash hash;
  for (const char* build : {"", "v2", "v3", "v4"}) {
    if (const auto bytes = base::text_if_readable(folder / build / path.filename())) hash.add(build).add(code_digest(*bytes));
  }
  for (const std::string& library : needed_libraries(loaded)) hash.add(library);
  return hash.text();
}

boost::dll::shared_library open_handle(const std::string& path) {
  try {
    return boost::dll::shared_library(std::filesystem::path(path), boost::dll::load_mode::rtld_now | boost::dll::load_mode::rtld_local);
  } catch (const std::exception& e) {
    refuse(path, fmt::format("the system's loader says: {}", e.what()));
  }
}

/// The library's list, once the symbol is known to be data that holds at least the part which is the same in every ABI.
const DescriptorList& list_of(const std::string& path, const boost::dll::shared_library& handle) {
  if (!handle.has(kSymbol)) {
    refuse(path, fmt::format("it has no symbol {}; it is no millscope plugin, or it lacks MILLSCOPE_PLUGINS(…)", kSymbol));
  }
  const void* address = &handle.get<const char>(kSymbol);
  Dl_info info{};
  void* extra = nullptr;
  if (::dladdr1(address, &info, &extra, RTLD_DL_SYMENT) == 0 || extra == nullptr) refuse(path, "its plugin list cannot be read");
  const auto& symbol = *static_cast<const ElfW(Sym)*>(extra);
  if (ELF64_ST_TYPE(symbol.st_info) != STT_OBJECT || symbol.st_size < offsetof(DescriptorList, count) ||
      reinterpret_cast<std::uintptr_t>(address) % alignof(DescriptorList) != 0) {
    refuse(path, fmt::format("its symbol {} is no plugin list", kSymbol));
  }
  return *static_cast<const DescriptorList*>(address);
}

std::vector<const Descriptor*> checked_descriptors(const std::string& path, const DescriptorList& list) {
  std::string trouble = complaint(list);
  if (!trouble.empty()) refuse(path, trouble);
  std::vector<const Descriptor*> descriptors;
  for (std::uint64_t i = 0; i < list.count; ++i) {
    const Descriptor* d = list.items[i];
    constexpr std::uint64_t fixed_part = offsetof(Descriptor, layout);
    trouble = is_mapped(d, fixed_part) ? complaint(*d) : "a descriptor cannot be read";
    if (!trouble.empty()) refuse(path, trouble);
    for (const Descriptor* other : descriptors) {
      if (other->kind == d->kind && std::string_view(other->name) == d->name)
        refuse(path, fmt::format("it lists the plugin '{}' twice", d->name));
    }
    descriptors.push_back(d);
  }
  return descriptors;
}

}  // namespace

struct Library::State {
  std::string path, level, hash, code_hash;
  boost::dll::shared_library handle;
  std::vector<const Descriptor*> descriptors;
};

std::shared_ptr<const Library> Library::open(const std::string& path, const std::string& level) {
  std::error_code trouble;
  auto state = std::make_unique<State>();
  state->path = std::filesystem::canonical(path, trouble).string();
  if (trouble) throw base::UserError(fmt::format("plugin library '{}' does not exist or cannot be reached", path));
  state->level = level;
  require_private(state->path);
  const std::string bytes = read_library(state->path);
  state->hash = base::Hash().add(bytes).text();
  state->handle = open_handle(state->path);
  state->descriptors = checked_descriptors(state->path, list_of(state->path, state->handle));
  state->code_hash = code_hash_of(state->path, level, bytes);
  return std::shared_ptr<const Library>(new Library(std::move(state)));
}

Library::Library(std::unique_ptr<State> state) : state_(std::move(state)) {}
Library::~Library() = default;

const std::string& Library::path() const { return state_->path; }
const std::string& Library::level() const { return state_->level; }
const std::string& Library::hash() const { return state_->hash; }
const std::string& Library::code_hash() const { return state_->code_hash; }
const std::vector<const Descriptor*>& Library::descriptors() const { return state_->descriptors; }

}  // namespace millscope::host
