#include "geometry/import/mesh_file.hpp"

#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>

#include "geometry/import/answer.hpp"
#include "geometry/import/preflight.hpp"
#include "geometry/import/stl.hpp"
#include "millscope/element.hpp"
#include "millscope/parameters.hpp"

namespace millscope::geometry {

namespace {

void check_extension(const std::string& extension) {
  if (is_supported(extension)) return;
  for (const char* solid : {"step", "stp", "iges", "igs"}) {
    if (extension == solid) {
      throw Refusal("'." + extension +
                    "' holds CAD surfaces, not triangles: write 'kind: step' in the place of 'kind: mesh' (docs/importing_a_liner.md), or "
                    "export the body as STL");
    }
  }
  for (const char* cad : {"sldprt", "ipt", "brep", "x_t", "dwg", "dxf"}) {
    if (extension == cad)
      throw Refusal("'." + extension + "' holds CAD surfaces, not triangles: export the body from the CAD program as STEP or STL");
  }
  throw Refusal("'." + extension + "' is not a mesh format that is read here: use stl, obj, ply, off, gltf, glb or 3mf");
}

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

}  // namespace

Soup import_mesh(const std::string& path, const ImportLimits& limits) {
  try {
    const std::string extension = lower_extension(path);
    const auto read = [&](int pipe) {
      check_extension(extension);
      Solids file = extension == "stl" ? read_stl(MappedFile(path).view(), limits.max_triangles)
                                       : read_by_assimp(path, extension, limits.max_triangles);
      if (file.single_precision) note_rounding(file);
      send_solids(pipe, file);
    };
    return read_guarded(path, limits, read);
  } catch (const std::exception& e) {
    throw Refusal("mesh file " + path + ": " + e.what());
  }
}

}  // namespace millscope::geometry
