// code_digest OUTPUT ROOT FOLDER…: writes OUTPUT, a C++ source with one digest for each folder below ROOT, and OUTPUT.d, what it was read
// from. A digest changes with the code of the folder's files, not with comments or formatting, nor with where ROOT lies.
#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <vector>

#include "kernel/base/code_digest/tokens.hpp"
#include "kernel/base/hash.hpp"

namespace {

namespace fs = std::filesystem;

std::string text_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw std::runtime_error(file.string() + " cannot be read");
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

std::vector<fs::path> sources_in(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
    const fs::path extension = entry.path().extension();
    if (entry.is_regular_file() && (extension == ".cpp" || extension == ".hpp")) files.push_back(entry.path());
  }
  if (files.empty()) throw std::runtime_error(folder.string() + " has no sources");
  std::sort(files.begin(), files.end());
  return files;
}

void write_if_changed(const fs::path& file, const std::string& text) {
  if (fs::exists(file) && text_of(file) == text) return;
  std::ofstream out(file, std::ios::binary);
  if (!(out << text).flush()) throw std::runtime_error(file.string() + " cannot be written");
}

void write_digests(const fs::path& output, const fs::path& root, const std::vector<std::string>& folders) {
  std::string table, read = output.string() + ":";
  for (const std::string& folder : folders) {
    millscope::base::Hash digest;
    for (const fs::path& file : sources_in(root / folder)) {
      const std::string name = file.lexically_relative(root / folder).string();
      digest.add(name).add_word(0).add(millscope::base::tokens_of(text_of(file))).add_word(0);
      read += " \\\n  " + file.string();
    }
    char line[100];
    std::snprintf(line, sizeof line, "0x%016llxU},\n", static_cast<unsigned long long>(digest.value()));
    table += "    {\"" + folder + "\", " + line;
  }
  write_if_changed(
      output,
      "#include \"kernel/base/program_tables.hpp\"\n\nnamespace millscope::base {\n\nconst std::vector<FolderDigest>& folder_digests() {\n"
      "  static const std::vector<FolderDigest> table = {\n" +
          table + "  };\n  return table;\n}\n\n}  // namespace millscope::base\n");
  write_if_changed(output.string() + ".d", read + "\n");
}

}  // namespace

int main(int count, char** words) {
  try {
    if (count < 4) throw std::runtime_error("usage: code_digest OUTPUT ROOT FOLDER…");
    write_digests(words[1], words[2], {words + 3, words + count});
    return 0;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "code_digest: %s\n", e.what());
    return 1;
  }
}
