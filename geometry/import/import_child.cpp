#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <exception>
#include <new>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "geometry/import/guarded_import.hpp"
#include "geometry/import/preflight.hpp"
#include "geometry/import/stl.hpp"
#include "millscope/element.hpp"
#include "millscope/parameters.hpp"

namespace millscope::geometry {

namespace {

void write_all(int pipe, const void* data, std::size_t size) {
  const char* at = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t written = ::write(pipe, at, size);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) _exit(1);  // the host is gone
    at += written;
    size -= as_size(written);
  }
}

void write_text(int pipe, const std::string& text) {
  const auto size = static_cast<std::uint32_t>(text.size());
  write_all(pipe, &size, sizeof size);
  write_all(pipe, text.data(), text.size());
}

void write_block(int pipe, Block block) { write_all(pipe, &block, 1); }

/// A file seen as memory, for the preflight.
class MappedFile {
 public:
  explicit MappedFile(const std::string& path) {
    const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    struct stat info {};
    if (file < 0 || ::fstat(file, &info) != 0)
      throw Refusal(std::string("cannot be read (") + std::strerror(errno) + "): check its permissions");
    size_ = as_size(info.st_size);
    data_ = ::mmap(nullptr, size_, PROT_READ, MAP_PRIVATE, file, 0);
    ::close(file);
    if (data_ == MAP_FAILED) throw Refusal("does not fit into the memory allowed for it: export a coarser mesh or raise max_triangles");
  }
  ~MappedFile() { ::munmap(data_, size_); }
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;
  std::string_view view() const { return {static_cast<const char*>(data_), size_}; }

 private:
  void* data_;
  std::size_t size_;
};

struct Placed {
  const aiNode* node;
  aiMatrix4x4t<double> to_world;
};

aiMatrix4x4t<double> in_double(const aiMatrix4x4& m) {
  return {m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4, m.d1, m.d2, m.d3, m.d4};
}

/// Names that the importer makes up begin with '<' or '$'; one solid without a name is "all".
std::string solid_name(const aiMesh& mesh, const aiNode& node, bool is_root) {
  const auto made_up = [](const std::string& s) { return s.empty() || s[0] == '<' || s[0] == '$' || s == "defaultobject"; };
  std::string name = mesh.mName.C_Str();
  const bool is_number = name.find_first_not_of("0123456789") == std::string::npos;  // 3MF: the object's id; its name is the node's
  if ((is_number && !made_up(node.mName.C_Str()) && !is_root) || made_up(name)) name = is_root ? "" : node.mName.C_Str();
  return made_up(name) ? "all" : name;
}

void append_triangles(const aiMesh& mesh, const aiMatrix4x4t<double>& to_world, std::vector<double>& out) {
  for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
    const aiFace& face = mesh.mFaces[f];
    if (face.mNumIndices != 3) continue;  // points and lines
    for (unsigned k = 0; k < 3; ++k) {
      if (face.mIndices[k] >= mesh.mNumVertices)
        throw Refusal("a face names a vertex that does not exist: the file is damaged, export it again");
      const aiVector3D& v = mesh.mVertices[face.mIndices[k]];
      const aiVector3t<double> p = to_world * aiVector3t<double>(v.x, v.y, v.z);
      for (const double x : {p.x, p.y, p.z}) out.push_back(x);
    }
  }
}

Solids solids_of(const aiScene& scene, std::size_t max_triangles) {
  std::vector<Placed> open{{scene.mRootNode, in_double(scene.mRootNode->mTransformation)}};
  Solids out;
  std::size_t total = 0;
  while (!open.empty()) {
    const Placed placed = open.back();
    open.pop_back();
    for (unsigned i = 0; i < placed.node->mNumMeshes; ++i) {
      const aiMesh& mesh = *scene.mMeshes[placed.node->mMeshes[i]];
      Solid solid{solid_name(mesh, *placed.node, placed.node == scene.mRootNode), {}};
      append_triangles(mesh, placed.to_world, solid.corners);
      total += solid.corners.size() / 9;
      detail::check_size(static_cast<long long>(total), max_triangles);
      out.solids.push_back(std::move(solid));
    }
    for (unsigned i = placed.node->mNumChildren; i-- > 0;) {  // the first child is taken first
      const aiNode* child = placed.node->mChildren[i];
      open.push_back({child, placed.to_world * in_double(child->mTransformation)});
    }
  }
  return out;
}

/// Assimp takes a first byte of a binary PLY that is a line end for one of the header, and reads all that follows a byte too early. Where a
/// number of floating point begins so, its last bit is another one here (of the larger byte first: a number below 1e-30 becomes 0).
/// Returns "" for files that are read as they are.
std::string ply_without_line_end(std::string_view data) {
  const std::size_t end = data.find("end_header"), line = data.find('\n', end);
  if (end == std::string_view::npos || line == std::string_view::npos || line + 1 >= data.size()) return {};
  const std::string_view head = data.substr(0, end);
  const char first = data[line + 1];
  if (head.find("format binary") == std::string_view::npos || (first != '\n' && first != '\r')) return {};
  const std::size_t property = head.find("property ");
  std::string_view type = property == std::string_view::npos ? std::string_view() : head.substr(property + 9);
  type = type.substr(0, type.find(' '));
  if (type != "float" && type != "float32" && type != "double" && type != "float64") return {};
  std::string out(data);
  out[line + 1] = head.find("little_endian") != std::string_view::npos ? static_cast<char>(first + 1) : '\0';
  return out;
}

const aiScene* read_scene(Assimp::Importer& importer, const std::string& path, const std::string& extension, std::size_t max_triangles) {
  const MappedFile file(path);
  preflight(file.view(), extension, max_triangles);
  const std::string ply = extension == "ply" ? ply_without_line_end(file.view()) : std::string();
  if (ply.empty()) return importer.ReadFile(path, aiProcess_Triangulate);
  return importer.ReadFileFromMemory(ply.data(), ply.size(), aiProcess_Triangulate, "ply");
}

Solids read_by_assimp(const std::string& path, const std::string& extension, std::size_t max_triangles) {
  Assimp::Importer importer;
  const aiScene* scene = read_scene(importer, path, extension, max_triangles);
  if (scene && scene->mRootNode) return solids_of(*scene, max_triangles);
  std::string why = importer.GetErrorString();
  for (char& c : why) c = static_cast<unsigned char>(c) < ' ' ? ' ' : c;
  if (why.empty()) why = "its content is damaged";
  throw Refusal("cannot be read as " + extension + " (" + why.substr(0, 300) + "): export it again, as STL if that is possible");
}

/// Far from the origin single precision is coarse: at 7 km half a millimetre.
void note_rounding(Solids& file) {
  constexpr double kRounding = 1.0 / (1 << 24), kMuch = 1e-5;  // of the body's size
  double farthest = 0, low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
  for (const Solid& s : file.solids) {
    for (std::size_t i = 0; i < s.corners.size(); ++i) {
      farthest = std::max(farthest, std::fabs(s.corners[i]));
      low[i % 3] = std::min(low[i % 3], s.corners[i]), high[i % 3] = std::max(high[i % 3], s.corners[i]);
    }
  }
  const double size = std::hypot(high[0] - low[0], high[1] - low[1], high[2] - low[2]);
  if (!std::isfinite(size) || kRounding * farthest <= kMuch * size) return;
  char text[300];
  std::snprintf(
      text, sizeof text,
      "coordinates up to %.4g are read in single precision, to within %.2g of the file's unit: move the body to the origin before "
      "it is exported, or export it as text STL",
      farthest, kRounding * farthest);
  file.notes.emplace_back(text);
}

/// A name that a list of slots can hold: no bars, no control characters, not too long.
std::string slot_name(std::string name) {
  for (char& c : name) {
    if (c == '|' || static_cast<unsigned char>(c) < ' ') c = '_';
  }
  return name.substr(0, 100);
}

/// The slot of each solid: its name, another one where a shorter or cleaner name is taken; of several without a name each has a number,
/// but where they are many, as of an exporter that makes a solid of every face, they are one.
std::vector<std::string> slots_of(const std::vector<Solid>& solids) {
  constexpr std::size_t kManyNameless = 50, kMostSlots = 250;
  const auto nameless =
      static_cast<std::size_t>(std::count_if(solids.begin(), solids.end(), [](const Solid& s) { return s.name.empty(); }));
  const bool numbered = solids.size() > 1 && nameless <= kManyNameless;
  std::unordered_map<std::string, std::string> slot_of;  // name: slot
  std::unordered_set<std::string> taken;
  std::vector<std::string> slots;
  for (std::size_t i = 0; i < solids.size(); ++i) {
    const std::string name = !solids[i].name.empty() ? solids[i].name : numbered ? "solid_" + std::to_string(i + 1) : "all";
    const auto [at, fresh] = slot_of.try_emplace(name, slot_name(name));
    for (int k = 2; fresh && !taken.insert(at->second).second; ++k) at->second = slot_name(name).substr(0, 90) + "_" + std::to_string(k);
    if (taken.size() > kMostSlots)
      throw Refusal("has more than " + std::to_string(kMostSlots) +
                    " solids with names of their own: join those of one material and export again");
    slots.push_back(at->second);
  }
  return slots;
}

void send(int pipe, const Solids& file) {
  const std::vector<std::string> slots = slots_of(file.solids);
  for (std::size_t i = 0; i < file.solids.size(); ++i) {
    const Solid& s = file.solids[i];
    write_block(pipe, Block::solid);
    write_text(pipe, slots[i]);
    const std::uint64_t count = s.corners.size() / 9;
    write_all(pipe, &count, sizeof count);
    write_all(pipe, s.corners.data(), s.corners.size() * sizeof(double));
  }
  for (const std::string& note : file.notes) {
    write_block(pipe, Block::note);
    write_text(pipe, note);
  }
  write_block(pipe, Block::done);
}

void import_into(int pipe, const std::string& path, const std::string& extension, std::size_t max_triangles) {
  Solids file = extension == "stl" ? read_stl(MappedFile(path).view(), max_triangles) : read_by_assimp(path, extension, max_triangles);
  if (file.single_precision) note_rounding(file);
  send(pipe, file);
}

}  // namespace

void import_child(int pipe, const std::string& path, const std::string& extension, std::size_t max_triangles) noexcept {
  const auto refuse = [pipe](const char* reason) {
    write_block(pipe, Block::refused);
    write_text(pipe, reason);
    _exit(0);
  };
  try {
    import_into(pipe, path, extension, max_triangles);
  } catch (const std::bad_alloc&) {
    refuse("needs more memory than is allowed for a file of its size: it is damaged or hostile; export it again");
  } catch (const std::exception& e) {
    refuse(e.what());
  } catch (...) {
    refuse("the reader failed: export it again, as STL if that is possible");
  }
  _exit(0);
}

}  // namespace millscope::geometry
