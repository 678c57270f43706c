#include "kernel/host/library_code.hpp"

#include <elf.h>
#include <fmt/core.h>
#include <gnu/libc-version.h>
#include <link.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>
#include <optional>

#include "kernel/base/hash.hpp"

namespace millscope::host {
namespace {

using base::Hash;
using Section = ElfW(Shdr);

/// The sections of an ELF file of this machine's class. Empty where the file is none, or cut.
class Image {
 public:
  explicit Image(std::string_view bytes) : bytes_(bytes) {
    const auto header = at<ElfW(Ehdr)>(0);
    if (!header || !bytes.starts_with(ELFMAG) || header->e_shentsize != sizeof(Section)) return;
    for (std::size_t i = 0; i < header->e_shnum; ++i) {
      const auto section = at<Section>(header->e_shoff + i * sizeof(Section));
      const bool inside = section && (section->sh_type == SHT_NOBITS ||
                                      (section->sh_offset <= bytes.size() && section->sh_size <= bytes.size() - section->sh_offset));
      if (!inside) {
        sections_.clear();
        return;
      }
      sections_.push_back(*section);
    }
    names_ = header->e_shstrndx;
  }

  const std::vector<Section>& sections() const { return sections_; }
  std::string_view content(const Section& s) const {
    return s.sh_type == SHT_NOBITS ? std::string_view{} : bytes_.substr(s.sh_offset, s.sh_size);
  }
  /// The text that begins at a place of the section of texts with that number.
  std::string_view text(std::size_t section, std::size_t place) const {
    const std::string_view all = section < sections_.size() ? content(sections_[section]) : std::string_view{};
    return place < all.size() ? all.substr(place, all.find('\0', place) - place) : std::string_view{};
  }
  std::string_view name(const Section& s) const { return text(names_, s.sh_name); }

  /// The entries of a section that is a table of them.
  template <class Entry>
  std::vector<Entry> entries(const Section& s) const {
    const std::string_view all = content(s);
    std::vector<Entry> out(all.size() / sizeof(Entry));
    if (!out.empty()) std::memcpy(out.data(), all.data(), out.size() * sizeof(Entry));
    return out;
  }

  /// An address as its section's name and the place in it: what lies before, such as the paths of a build, does not move it.
  std::string place(ElfW(Addr) address) const {
    for (const Section& s : sections_) {
      if ((s.sh_flags & SHF_ALLOC) != 0 && address >= s.sh_addr && address - s.sh_addr < s.sh_size)
        return fmt::format("{}+{}", name(s), address - s.sh_addr);
    }
    return fmt::format("{}", address);
  }

 private:
  template <class Entry>
  std::optional<Entry> at(std::size_t offset) const {
    if (offset > bytes_.size() || bytes_.size() - offset < sizeof(Entry)) return {};
    Entry entry;
    std::memcpy(&entry, bytes_.data() + offset, sizeof entry);
    return entry;
  }

  std::string_view bytes_;
  std::vector<Section> sections_;
  std::size_t names_ = 0;
};

/// Code and constants, not what the linker makes of them: tables for the unwinder, jumps to other libraries.
bool is_code(const Section& s, std::string_view name) {
  constexpr std::array<std::string_view, 10> kMade{".interp", ".eh_frame", ".eh_frame_hdr", ".init", ".fini",
                                                   ".plt",    ".plt.got",  ".plt.sec",      ".got",  ".got.plt"};
  const bool content = s.sh_type == SHT_PROGBITS || s.sh_type == SHT_NOBITS || s.sh_type == SHT_INIT_ARRAY || s.sh_type == SHT_FINI_ARRAY;
  return content && (s.sh_flags & SHF_ALLOC) != 0 && std::find(kMade.begin(), kMade.end(), name) == kMade.end();
}

/// The content without the words that are filled in when the library is loaded: the linker may have put addresses there.
std::string unlinked_content(const Image& image, const Section& s, const std::vector<ElfW(Addr)>& filled) {
  std::string content{image.content(s)};
  for (const ElfW(Addr) address : filled) {
    if (address < s.sh_addr || address - s.sh_addr >= content.size()) continue;
    const std::size_t place = address - s.sh_addr;
    std::fill_n(content.begin() + static_cast<std::ptrdiff_t>(place), std::min(sizeof address, content.size() - place), '\0');
  }
  return content;
}

bool holds_links(const Section& s) { return s.sh_type == SHT_RELA && (s.sh_flags & SHF_ALLOC) != 0; }

/// What is filled in when the library is loaded: which function of which name is called where, which address stands in which table.
void add_links(const Image& image, const Section& s, Hash& hash) {
  const std::vector<Section>& all = image.sections();
  const std::vector<ElfW(Sym)> symbols = s.sh_link < all.size() ? image.entries<ElfW(Sym)>(all[s.sh_link]) : std::vector<ElfW(Sym)>{};
  for (const ElfW(Rela) & link : image.entries<ElfW(Rela)>(s)) {
    const std::size_t symbol = ELF64_R_SYM(link.r_info);
    const std::string_view name =
        symbol < symbols.size() ? image.text(all[s.sh_link].sh_link, symbols[symbol].st_name) : std::string_view{};
    const bool relative = ELF64_R_TYPE(link.r_info) == R_X86_64_RELATIVE;
    const std::string addend = relative ? image.place(static_cast<ElfW(Addr)>(link.r_addend)) : fmt::format("{}", link.r_addend);
    hash.add(fmt::format("{} {} {} {}\n", image.place(link.r_offset), ELF64_R_TYPE(link.r_info), name, addend));
  }
}

/// Its arithmetic is in the code of those who use it, or does not touch numbers.
bool is_runtime(std::string_view name) {
  constexpr std::array<std::string_view, 6> kRuntime{"libstdc++.so", "libgcc_s.so", "libc.so", "ld-linux", "libpthread.so", "libdl.so"};
  return std::any_of(kRuntime.begin(), kRuntime.end(), [&](std::string_view r) { return name.starts_with(r); });
}

/// The file that was loaded for a name, links resolved; the name itself where none was.
std::string loaded_file(const std::string& name) {
  struct Search {
    const std::string& name;
    std::string found;
  } search{name, name};
  const auto look = [](dl_phdr_info* info, std::size_t, void* data) {
    auto& s = *static_cast<Search*>(data);
    const std::filesystem::path file = info->dlpi_name;
    if (file.filename() != s.name) return 0;
    std::error_code ignored;
    s.found = std::filesystem::canonical(file, ignored).filename().string();
    return 1;
  };
  ::dl_iterate_phdr(look, &search);
  return search.found.empty() ? name : search.found;
}

}  // namespace

std::string code_digest(std::string_view library) {
  const Image image(library);
  Hash hash;
  if (image.sections().empty()) return hash.add(library).text();
  std::vector<ElfW(Addr)> filled;
  for (const Section& s : image.sections()) {
    if (!holds_links(s)) continue;
    for (const ElfW(Rela) & link : image.entries<ElfW(Rela)>(s)) filled.push_back(link.r_offset);
  }
  for (const Section& s : image.sections()) {
    const std::string_view name = image.name(s);
    if (is_code(s, name)) hash.add(name).add_word(s.sh_size).add(unlinked_content(image, s, filled));
    if (holds_links(s)) add_links(image, s, hash);
  }
  return hash.text();
}

std::vector<std::string> needed_libraries(std::string_view library) {
  const Image image(library);
  std::vector<std::string> needed;
  for (const Section& s : image.sections()) {
    if (s.sh_type != SHT_DYNAMIC) continue;
    for (const ElfW(Dyn) & entry : image.entries<ElfW(Dyn)>(s)) {
      if (entry.d_tag != DT_NEEDED) continue;
      const std::string name{image.text(s.sh_link, entry.d_un.d_val)};
      if (is_runtime(name)) continue;
      needed.push_back(name.starts_with("libm.so") ? fmt::format("{} of glibc {}", name, gnu_get_libc_version()) : loaded_file(name));
    }
  }
  std::sort(needed.begin(), needed.end());
  return needed;
}

}  // namespace millscope::host
