#include "studies/new/materials.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "kernel/base/nearest.hpp"
#include "kernel/config/document.hpp"
#include "kernel/config/units.hpp"

namespace millscope::new_mill {
namespace {

namespace fs = std::filesystem;
using base::UserError;
using config::Node;

fs::path library() {
  std::error_code trouble;
  if (const auto installed = shared_file("materials")) return *installed;
  if (fs::is_directory(MILLSCOPE_SOURCE_MATERIALS, trouble)) return MILLSCOPE_SOURCE_MATERIALS;
  throw UserError("the materials are missing: there is no share/millscope/materials beside the command; install millscope again");
}

Material read_material(const std::string& option, const fs::path& file) {
  const Node root = config::load_document(file.string());
  const Node all = root.at("materials", "materials by name: {steel: {density, young_modulus, poisson_ratio}}");
  const std::vector<std::string> names = all.keys();
  if (names.size() != 1) all.fail(fmt::format("has {} materials; {} takes a file with one", names.size(), option));
  const Node node = all.at(names.front());
  Material m;
  m.name = names.front();
  m.file = file;
  m.density = config::read_number(node.at("density", "e.g. 7850 kg/m^3"), "kg/m^3", config::positive());
  m.poisson = config::read_number(node.at("poisson_ratio", "e.g. 0.3"), "1", config::Range{-1, 0.5, true, true, ""});
  if (const auto young = node.find("young_modulus")) {
    m.young = config::read_number(*young, "Pa", config::positive());
  } else {
    const Node shear = node.at("shear_modulus", "or young_modulus, e.g. 210 GPa");
    m.young = 2 * (1 + m.poisson) * config::read_number(shear, "Pa", config::positive());
  }
  return m;
}

}  // namespace

std::optional<fs::path> shared_file(const std::string& file) {
  std::error_code trouble;
  const fs::path path = fs::read_symlink("/proc/self/exe", trouble).parent_path().parent_path() / MILLSCOPE_DATADIR / "millscope" / file;
  if (fs::exists(path, trouble)) return path;
  return {};
}

std::vector<std::string> library_materials() {
  std::vector<std::string> names;
  for (const fs::directory_entry& entry : fs::directory_iterator(library())) {
    if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

Material find_material(const std::string& option, const std::string& name_or_file) {
  const fs::path given = name_or_file;
  if (given.extension() == ".yaml" || given.extension() == ".yml") return read_material(option, given);
  const std::vector<std::string> names = library_materials();
  if (std::find(names.begin(), names.end(), name_or_file) == names.end()) {
    throw UserError(fmt::format("{} '{}' is no material of the library; {}; or give a YAML file with one material", option, name_or_file,
                                base::suggestion(name_or_file, names)));
  }
  return read_material(option, library() / (name_or_file + ".yaml"));
}

}  // namespace millscope::new_mill
